"""How a column collapses, on recordings whose front and pressure are known."""

import numpy as np
import pytest

from lab.measures import collapse
from lab.recording import open_recording
from tests.oracles.recorded_wet import SIZE, WIDTH, lattice, record_wet, wet

TIME = np.linspace(0.0, 4.0, 81)
GATE = {"points": [["0 mm", "0 mm"], ["0 mm", "60 mm"]], "move": ["0 mm", "60 mm"], "sieve": True}
GATE |= {"speed": "0.5 m/s", "acceleration": "50 m/s^2", "start": "1 s"}
COLUMN = {"region": [["-48 mm", "0 mm"], ["48 mm", "0 mm"], ["48 mm", "190 mm"], ["-48 mm", "190 mm"]]}


def of(folder, way, **more) -> dict:
    """What is measured on a bed of which all grains to the right of the middle go so far (m) to the right."""
    still = lattice()
    preset = wet(parts={"gate": GATE}, grains=COLUMN, **more)

    def frame(now):
        place = still.copy()
        place[:, 0] += way(now) * (still[:, 0] > 0.0)
        return {"position": place}

    with open_recording(record_wet(folder / "run", TIME, frame, preset=preset)) as recording:
        assert collapse.applies(recording)
        return collapse.measure(recording)


def test_the_front_is_that_of_the_outermost_grains(tmp_path):
    """It comes as far as they do, and half as far 0.5 s after the gate began to move, at 1 s."""
    first = WIDTH - SIZE
    found = of(tmp_path, lambda now: 0.02 * min(max(now - 1.0, 0.0), 1.0))
    assert found["run_out"].value == pytest.approx(0.02 / first, rel=0.02)
    assert found["half_run_out_time"].value == pytest.approx(0.5, abs=0.026)


def test_a_front_that_does_not_move_has_no_time(tmp_path):
    """A fifth of a diameter is no collapse."""
    found = of(tmp_path, lambda now: 0.2 * SIZE * min(now, 1.0))
    assert found["half_run_out_time"].value is None


def test_grains_over_the_floor_are_no_column(tmp_path):
    """What falls out of a funnel has no front."""
    high = {"region": [["-48 mm", "40 mm"], ["48 mm", "40 mm"], ["48 mm", "190 mm"], ["-48 mm", "190 mm"]]}
    folder = record_wet(tmp_path / "run", TIME[:3], lambda now: {}, preset=wet(parts={"gate": GATE}, grains=high))
    with open_recording(folder) as recording:
        assert not collapse.applies(recording)
