"""What the tests of Python's front door share."""

import pytest

import cargolab
from solvers.machine import runtime

SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 16},
    "motion": {"tilt": {"rate": "60 deg/s", "angle": "20 deg", "hold": "0.5 s"}},
    "run": {"repeats": 2, "threads": 1},
    "record": {"picture_rate": "50 Hz"},
}


@pytest.fixture(scope="session", autouse=True)
def one_core():
    """Runs on one core, so that Taichi is not started anew for each."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runtime, "_most_cores", 1)
        yield


@pytest.fixture(scope="session")
def small() -> cargolab.Preset:
    """A tilt of 16 grains, two beds."""
    return cargolab.Preset("tilting/quick", **SMALL)
