"""The comparison of water with other codes: their files, and the errors of made-up runs whose errors are known."""

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.peers import dualsphysics, pysph
from benchmarks.peers.bi4 import BOOL, DOUBLE3, TEXT, UINT, Item, read_file, write_file
from benchmarks.peers.pool import Frame, tait_density, tait_pressure, wall_densities, wall_particles
from benchmarks.water.accuracy import LOST, errors
from benchmarks.water.cases import DENSITY, GRAVITY, HIGH, dam, frequency, gentle, mode
from benchmarks.water.errors import front_speed, pressure_error, wave_errors
from benchmarks.water.front import spread


def test_a_file_of_particles_is_read_as_written(tmp_path):
    place = np.random.default_rng(1).normal(size=(7, 3))
    part = Item("PART_0000", {"Npok": (UINT, 7)}, {"Posd": (DOUBLE3, place), "Idp": (UINT, np.arange(7))})
    root = Item("JPartDataBi4", {"Name": (TEXT, "pool"), "Flat": (BOOL, 1), "Low": (DOUBLE3, place[0])}, {}, [part])
    write_file(tmp_path / "pool.bi4", root)
    found = read_file(tmp_path / "pool.bi4")
    assert (found.name, found.values["Name"][1], found.values["Flat"][1]) == ("JPartDataBi4", "pool", 1)
    np.testing.assert_array_equal(found.values["Low"][1], place[0])
    np.testing.assert_array_equal(found.items[0].arrays["Posd"][1], place)
    np.testing.assert_array_equal(found.items[0].arrays["Idp"][1], np.arange(7))


def test_walls_continue_the_lattice():
    pool = gentle(10).pool(1.0, 1.0)
    points, nearest = wall_particles(pool, 2)
    assert len(points) == (20 + 4) * (12 + 4) - 20 * 12
    away = np.abs(points - nearest).max(axis=1) / pool.spacing
    assert set(np.round(away, 9)) == {0.5, 1.5}


def test_walls_of_calm_water_start_with_its_pressure():
    """That of the depth of their points; those of a column that collapses have none."""
    calm, fallen = gentle(10).pool(1.0, 1.0), gentle(10, steep=1.0).pool(1.0, 1.0)
    points = np.array([[0.0, -0.05], [1.05, 0.6], [1.05, 1.1]])
    excess = wall_densities(calm, points) / DENSITY - 1.0
    np.testing.assert_allclose(excess, GRAVITY * np.array([1.05, 0.4, 0.0]) / calm.sound_speed**2, rtol=1e-9)
    np.testing.assert_array_equal(wall_densities(fallen, points), DENSITY)


def test_tait_is_undone():
    pool = dam(10).pool(1.0, 1.0)
    np.testing.assert_allclose(tait_pressure(pool, tait_density(pool, 7), 7), pool.pressure, rtol=1e-9)


def test_errors_of_a_made_up_wave():
    """1 % too fast, a tenth lost in a period."""
    place, omega = gentle(10).drops["position"], frequency()
    loss = -np.log(0.9) * omega / (2.0 * np.pi)
    frames = [
        Frame(t, place, 0.1 * np.cos(1.01 * omega * t) * np.exp(-loss * t) * mode(place), place[:, 0])
        for t in np.linspace(0.0, 2.0 * np.pi / omega, 17)
    ]
    fast, lost = wave_errors(frames)
    assert fast == pytest.approx(0.01, abs=1e-6)
    assert lost == pytest.approx(0.1, abs=1e-6)


def test_the_mode_fits_the_tank():
    """No flow through walls and floor, no divergence."""
    case = gentle(10)
    sides = np.array([[-1.0, 0.3], [1.0, 0.7]])
    assert np.abs(mode(sides)[:, 0]).max() < 1e-12
    assert np.abs(mode(np.array([[0.2, 0.0]]))[:, 1]).max() < 1e-12
    step = 1e-5
    place = case.drops["position"][::17]
    right, up = step * np.eye(2)
    across = (mode(place + right) - mode(place - right))[:, 0]
    upwards = (mode(place + up) - mode(place - up))[:, 1]
    np.testing.assert_allclose(across, -upwards, atol=1e-9)


def test_errors_of_a_made_up_rest_and_front():
    case = gentle(10, steep=0.0)
    place = case.drops["position"]
    rest = Frame(1.0, place, 0.0 * place, DENSITY * GRAVITY * (1.0 - place[:, 1] + 0.02))
    assert pressure_error(rest) == pytest.approx(0.02)
    column, unit = dam(10), np.sqrt(GRAVITY * HIGH)
    start = column.drops["position"].copy()
    times = np.linspace(0.0, 0.5, 21)
    frames = [Frame(t, start + np.array([1.7 * unit * t, 0.0]), start, start[:, 0]) for t in times]
    assert front_speed(column, frames)[0] == pytest.approx(1.7)


def test_a_code_that_loses_its_water_is_told_so(tmp_path):
    """A column that falls through its floor has no front; what stays in its tank keeps its errors."""

    def leaking(case, seconds):
        still = case.width > 1.9
        place = case.drops["position"][: case.count if still else case.count // 2]
        return [Frame(time, place, mode(place), DENSITY * GRAVITY * (1.0 - place[:, 1])) for time in (0.0, seconds)]

    told = errors(leaking, 10, tmp_path)
    assert told[4:] == [LOST, LOST]
    assert told[0] == pytest.approx(0.0, abs=1e-9)


def test_labels_keep_their_order_and_do_not_overlap():
    wanted = [0.5, 0.52, 0.51, 0.98, 0.99, 0.1]
    found = spread(wanted, 0.1)
    np.testing.assert_array_equal(np.argsort(found), np.argsort(wanted))
    assert np.diff(np.sort(found)).min() > 0.1 - 1e-9
    assert found.max() <= 1.0
    assert found[5] == 0.1


@pytest.mark.skipif(dualsphysics.available() is None, reason="DualSPHysics is not installed")
@pytest.mark.parametrize("walls", ["dbc", "mdbc"])
def test_dualsphysics_keeps_its_particles(tmp_path, walls):
    pool = replace(gentle(10).pool(0.02, 0.01), workdir=tmp_path)
    run = dualsphysics.run_dualsphysics(pool, walls=walls)
    assert [len(frame.pressure) for frame in run.frames] == [200] * 3
    np.testing.assert_allclose(run.frames[0].position, pool.position, atol=1e-9)
    assert run.seconds == pytest.approx(0.02, rel=0.1)


@pytest.mark.skipif(pysph.available() is None, reason="PySPH is not installed")
def test_pysph_takes_its_steps():
    pool = gentle(10).pool(0.1, 0.05)
    run = pysph.run_pysph(pool)
    assert [frame.time for frame in run.frames] == pytest.approx([0.0, 0.05, 0.1], abs=0.01)
    assert run.frames[-1].position.shape == pool.position.shape
    np.testing.assert_allclose(run.frames[0].position, pool.position, atol=1e-9)
    np.testing.assert_allclose(run.frames[0].pressure, pool.pressure, atol=1e-6 * pool.pressure.max())
    assert run.seconds / run.steps == pytest.approx(pysph.COURANT * pool.length / pool.sound_speed, rel=0.02)
