"""What all tests share."""

import gc
import importlib
import os
import pickle
import tomllib
from contextlib import suppress
from functools import cache
from pathlib import Path

# Workers share the cores; threads of numpy's that wait for each other by spinning would take all of a busy machine.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy reads it when it is imported

import numpy as np
import pytest

from solvers.machine import runtime
from solvers.machine.state import Axis, State
from solvers.simulation import Simulation

ROUNDING = """stand in for a processor that rounds otherwise, in this process alone: strict compiles without fast-math;
a number puts every grain one last digit beside its place, to sides that follow from the number"""


AS_SHIPPED = """compile kernels as users have them: those of discs in nearly twice the time, for a fifth more speed,
which short tests do not win back; those of water and outlines in a third more"""


_of_file: list = [None]  # the file of the last test


def _read_once(parse):
    """Each text is parsed once: the lab's presets are read some thousand times."""

    @cache
    def kept(text) -> bytes | None:
        found = parse(text)
        try:
            return pickle.dumps(found)
        except RecursionError:  # tables in tables, very deep
            return None

    def read(text, **how):
        whole = None if how else kept(text)
        return pickle.loads(whole) if whole else parse(text, **how)

    return read


tomllib.loads = _read_once(tomllib.loads)


def pytest_addoption(parser):
    parser.addoption("--rounding", metavar="strict|NUMBER", help=ROUNDING)
    parser.addoption("--as-shipped", action="store_true", help=AS_SHIPPED)


def pytest_configure(config):
    """No verdict may hang on how a processor rounds; tests of exact places and of equal bits may see the last digit."""
    gc.disable()  # until all tests are found: what is imported and collected stays
    if config.getoption("--as-shipped"):
        os.environ.pop("CARGOLAB_COMPILE", None)
    else:
        os.environ["CARGOLAB_COMPILE"] = "quick"  # in processes that tests start, too: they find each other's kernels
    rounding = config.getoption("--rounding")
    if rounding == "strict":
        start = runtime._start
        runtime._start = lambda *plan: start(*plan[:-1], {"fast_math": False} | plan[-1])
    elif rounding:
        place = Simulation.place
        Simulation.place = lambda run, position, *rest: place(run, nudged(run, position, int(rounding)), *rest)


def nudged(run: Simulation, position: np.ndarray, seed: int) -> np.ndarray:
    """Positions with their last digit changed by a rule that depends on the value alone: equal ones stay equal."""
    kind, bits = (np.float32, np.uint32) if run.scene.precision == "f32" else (np.float64, np.uint64)
    position = np.ascontiguousarray(position, dtype=kind)
    mixed = (position.view(bits).astype(np.uint64) + np.uint64(seed)) * np.uint64(0x9E3779B97F4A7C15)
    side = np.where(mixed >> np.uint64(63), np.inf, -np.inf).astype(kind)
    return np.where(position == 0.0, position, np.nextafter(position, side)).astype(np.float64)


@pytest.fixture(scope="session", autouse=True)
def own_cache(tmp_path_factory):
    """Tests neither read nor fill the cache of the person who runs them; workers side by side share one."""
    base = tmp_path_factory.getbasetemp()
    os.environ["CARGOLAB_CACHE"] = str((base.parent if "PYTEST_XDIST_WORKER" in os.environ else base) / "cache")


@pytest.fixture(scope="module")
def one_start():
    """One start of Taichi for a whole file, whose small kernels take less time to compile than a start takes."""
    runtime.initialise(1)
    held = State()
    held.reals((Axis("one", 1),), "held")
    held.finish()
    yield
    held.release()


@pytest.hookimpl(tryfirst=True)
def pytest_collection(session):
    """Workers side by side begin with other files, so that each finds what others have compiled to bytecode."""
    worker, workers = (os.environ.get(f"PYTEST_XDIST_{name}", "") for name in ("WORKER", "WORKER_COUNT"))
    if not worker.startswith("gw") or worker == "gw0":
        return
    folders = [folder for folder in map(Path, session.config.args) if folder.is_dir()]
    files = sorted(file for folder in folders for file in folder.resolve().rglob("test_*.py"))
    first = int(worker[2:]) * len(files) // int(workers)
    for file in files[first:]:
        with suppress(Exception, pytest.skip.Exception):  # pytest says why, when it comes to this file
            importlib.import_module(".".join(file.relative_to(session.config.rootpath).with_suffix("").parts))


def pytest_collection_finish():
    """Look no more for garbage among the thousands of tests that are there now: that takes 0.25 s each time."""
    gc.enable()
    gc.collect()
    gc.freeze()


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Let go of what the fixtures of a file leave behind: they end after the last call."""
    before, _of_file[0] = _of_file[0], item.path
    if before != item.path and runtime.states():
        gc.collect()


@pytest.hookimpl(hookwrapper=True)
def pytest_runtest_call(item):
    """Let go of what a test leaves behind: kernels are found in the cache only by a Taichi that has no arrays yet."""
    before = runtime.states()
    yield
    if runtime.states() > before:
        gc.collect()  # simulations refer to themselves in circles
