"""Bodies and gates in water beside experiments: what is read off a run, of runs whose answer is known."""

from pathlib import Path

import numpy as np
import pytest

import lab
from lab.studies.reproduce.water import drag, measured, sinking, surfaces
from lab.studies.reproduce.water.theory import wavemaker
from tests.lab.studies.test_reproduce_water import judged, ran

RECORD = "ciemito_flume/piston_motion.csv"
given = pytest.mark.skipif(measured.series(RECORD) is None, reason=f"{measured.FOLDER} names no folder with {RECORD}")


def pushed(mass: float, drag_coefficient: float):
    """A square on which the water acts as an added mass (ρ L²) and, from 2 s on, a drag."""
    one = ran("validation/moving-square", {"run.duration": "7.8 s"})
    time = np.arange(0.0, 7.8, 5e-3)
    curve = one.recording.preset.parts["square"].history.history.motions["sway"].curve
    force = np.zeros((len(time), 1, 1, 3))
    force[1:, 0, 0, 0] = -mass * curve(0.5 * (time[1:] + time[:-1]), 2) - 0.5 * drag_coefficient * (time[1:] > 2.0)
    one.recording.series |= {"time": time, "part_force": force}
    return one


@pytest.mark.slow
def test_a_square_has_the_drag_and_the_added_mass_of_its_force():
    one = pushed(1.3, 1.9)
    assert drag.added_mass(one, (0.15, 0.25)) == pytest.approx(1.3, rel=5e-3)
    assert drag.mean_drag(one, (4.5, 5.5)) == pytest.approx(1.9, rel=1e-3)
    verdicts = {name: verdict.value for name, verdict in judged("square", "25 along a side", one).items()}
    assert verdicts["drag from 4.5 to 5.5 s"] == "agrees" and verdicts["drag from 0.4 to 0.7 s"] != "agrees"


def test_how_far_a_cylinder_has_sunk_is_in_its_radius_and_the_time_of_its_fall():
    one = ran("validation/sinking-cylinder")
    time = np.arange(0.0, 0.95, 2.5e-3)
    place = np.zeros((len(time), 1, 1, 3))
    place[..., 0, 0, 1] = 14.0 - 2.0 * time**2
    one.recording.series |= {"time": time, "body_place": place}
    when, way = sinking.sunk(one)
    np.testing.assert_allclose(way, -2.0 * (when / np.sqrt(9.81)) ** 2, rtol=0.01, atol=0.01)


def test_the_surface_is_half_a_spacing_over_the_highest_particle_near():
    side = np.arange(0.002, 2.0, 0.0038)
    place = np.stack(np.meshgrid(side, 0.0019 + 0.0038 * np.arange(10)), axis=-1).reshape(1, -1, 2)
    one = ran("validation/wet-bed", frames_time=np.array([0.0]), frames_water_position=[place])
    np.testing.assert_allclose(surfaces.surface(one, 0, np.array([500.0, 900.0])), 38.0, atol=0.1)


@pytest.mark.parametrize("kh", [0.2, 1.4, 4.0])
def test_a_piston_makes_waves_of_the_height_that_the_closed_form_has(kh):
    """Dean & Dalrymple (1991), eq. 6.26: far off 2 (cosh 2kh − 1)/(sinh 2kh + 2kh) of its way, with its speed."""
    depth = 0.31
    omega = np.sqrt(9.81 * kh / depth * np.tanh(kh))
    far = 50.0 * depth
    answer = wavemaker.transfer(np.array([omega]), depth, far)[0]
    exact = 2.0 * (np.cosh(2.0 * kh) - 1.0) / (np.sinh(2.0 * kh) + 2.0 * kh)
    np.testing.assert_allclose(answer * np.exp(1j * kh * far / depth), 1j * exact, rtol=1e-6)


def test_water_that_a_piston_pushes_away_is_in_its_waves():
    """Volume: a push by s raises s times the depth over the way that the wave has gone."""
    depth, push = 0.31, 0.01
    time = np.linspace(0.0, wavemaker.LONG, 2001)
    moved = push * np.sin(0.5 * np.pi * np.clip(time / 2.0, 0.0, 1.0)) ** 2 * np.clip((40.0 - time) / 20.0, 0.0, 1.0)
    distances = np.linspace(0.0, 12.0, 25)
    rises = np.array([np.interp(5.0, *wavemaker.rise(time, moved, depth, one)) for one in distances])
    assert np.trapezoid(rises, distances) == pytest.approx(np.interp(5.0, time, moved) * depth, rel=0.02)


@given
def test_the_piston_of_the_flume_moves_as_its_record():
    """The closed form, for six periods from when the record begins to move: as near as whole millimetres are."""
    time, place = measured.series(RECORD)[:2]
    table = Path(lab.__file__).parents[1] / "presets" / "validation" / "ciemito-flume.csv"
    own_time, own = np.loadtxt(table, delimiter=",", skiprows=1).T
    within = (time > surfaces.STARTED) & (time < 7.0)
    apart = np.interp(time[within] - surfaces.STARTED, own_time, own) - (place[within] - place[0])
    assert np.abs(1e3 * apart).max() < 1.2 and 1e3 * np.sqrt(np.mean(apart**2)) < 1.1 * 1.0 / np.sqrt(12.0)
