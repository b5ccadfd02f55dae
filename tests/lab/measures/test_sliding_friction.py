"""The friction of a plate that slides under a bed: of made-up loads, and of a bed of grains."""

from types import SimpleNamespace

import numpy as np
import pytest

import lab
from lab.measures import measure_all, sliding_friction
from lab.recording import open_recording


def told(place: np.ndarray, along: float, across: float, ends: float = 0.0, **how: object) -> SimpleNamespace:
    """What is read of a recording of a plate at places (T,) m, its right end higher by `ends` (m).

    `how`: what else the preset says of it. The bed drags it against its way by `along` (N), and presses it by `across`.
    """
    time, way = np.linspace(0.0, 1.0, len(place)), np.sign(np.diff(place, prepend=place[0]))
    force = np.stack([-along * way, np.full(len(place), -across), np.zeros(len(place))], axis=-1)[:, None, None]
    displaced = np.stack([place, np.zeros(len(place))], axis=-1)[:, None, None]
    part = {"closed": False, "move": (1.0, 0.0), "moves": {}}
    return SimpleNamespace(
        series={"time": time, "part_load": force},
        frames={"time": time, "part": displaced},
        parts={"floor": np.array([(0.0, 0.0), (9.0, ends)])},
        preset=SimpleNamespace(parts={"floor": SimpleNamespace(**part | how)}),
        mean_diameter=np.array([0.1]),
    )


@pytest.mark.parametrize("place", [np.linspace(0.0, 4.0, 101), 2.0 * np.sin(np.linspace(0.0, 12.0, 401))])
def test_a_constant_drag_is_found_whichever_way_the_plate_goes(place):
    found = sliding_friction.measure(told(place, 3.0, 10.0))["sliding_friction"]
    assert found.value == pytest.approx(0.3, rel=1e-9)
    assert found.uncertainty == pytest.approx(0.0, abs=1e-9)


def test_what_does_not_slide_along_itself_has_no_friction():
    """A slope, a piston, a plate that turns, one that hardly moves, and a bed that bears on none."""
    moved = np.linspace(0.0, 4.0, 101)
    assert not sliding_friction.applies(told(moved, 3.0, 10.0, ends=1.0))
    assert not sliding_friction.applies(told(moved, 3.0, 10.0, move=(1.0, 1.0)))
    assert not sliding_friction.applies(told(moved, 3.0, 10.0, moves={"roll": None}))
    assert not sliding_friction.applies(told(moved, 3.0, 10.0, move=(0.0, 0.0)))
    assert sliding_friction.measure(told(0.0 * moved, 3.0, 10.0))["sliding_friction"].value is None
    assert sliding_friction.measure(told(moved, 0.0, 0.0))["sliding_friction"].value is None


@pytest.mark.slow
def test_grains_that_stay_in_their_places_slide_at_their_coefficient(tmp_path):
    """Coulomb: where all contacts slip, the force along is μ of that across. Floor and frame carry the weight."""
    shorter = {"wall.friction": 0.2, "parts.floor.move": ["2 m", "0 m"], "run.duration": "7 s"}
    folder = lab.run("bulk/sliding-quick", tmp_path / "run", video=False, plots=False, quiet=True, **shorter).folder
    with open_recording(folder) as recording:
        found = measure_all(recording)["sliding_friction"]
        assert found.value == pytest.approx(0.2, rel=0.02) and found.value < 0.2 + 1e-6
        rows = recording.series["time"] > 3.0
        carried = -recording.series["part_load"][rows, 0, :, 1].sum(axis=1).mean()
        weight = 9.81 * 1400.0 * 4.0 / 3.0 * np.pi * (recording.radius**3).sum()
        assert carried == pytest.approx(weight, rel=0.01)
