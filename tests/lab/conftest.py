"""What the tests of the application share."""

import pytest

from lab.assembly import ship_tables
from lab.report import plots
from solvers.fluid.start import packing, round_bodies
from solvers.machine import runtime

PANELS = 32  # of 80: a tenth of the time; the tests of the potential flow say how it converges


@pytest.fixture(scope="session", autouse=True)
def coarse_hulls():
    """Hulls of few panels wherever a preset has a ship."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(ship_tables, "PANELS", PANELS)
        yield


@pytest.fixture(scope="session", autouse=True)
def one_core():
    """Runs and pictures on one core, as most tests ask for: Taichi is not started anew for each change of threads."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(runtime, "_most_cores", 1)
        yield


@pytest.fixture(scope="session", autouse=True)
def coarse_figures():
    """Figures of a third of the dots."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(plots.STYLE, "savefig.dpi", 60)
        yield


@pytest.fixture(scope="module")
def no_plots():
    """Runs without plots, which take long and are tested elsewhere."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("lab.report.plots.write_plots", lambda *_: {})
        yield


@pytest.fixture
def roughly_packed(monkeypatch):
    """Water that is not evened out before the start, for tests that only ask whether scenes can be built, and so on."""
    packing._packed.cache_clear()
    monkeypatch.setattr(packing, "STEPS", 2)
    monkeypatch.setattr(round_bodies, "STEPS", 2)
    yield
    packing._packed.cache_clear()
