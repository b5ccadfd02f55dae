"""A state put back into another simulation goes on bit for bit: in another process, on other numbers of threads."""

import os
import subprocess
import sys
from pathlib import Path
from unittest.mock import MagicMock

import numpy as np
import pytest

from solvers.machine.runtime import available_cores
from solvers.motion import Roll, Sway
from solvers.simulation import Simulation
from solvers.tank.parts import Part
from solvers.time import schedules
from solvers.time.schedules.per_band import PerBand
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material

RADIUS, COUNT = 3e-3, 30
GATE = Part(((0.005, 0.0), (0.005, 0.03)), move=(0.0, 0.04), start=0.01, speed=0.5, acceleration=50.0)
LATER = 200  # steps between the state and the end

# The two cases differ in all that a state must hold.
CASES = {
    "bands that grew": {"worlds": 1, "schedule": "auto", "tangential": "mindlin", "outline": box(0.05, 0.08)},
    "single grains, settled and spilled": {
        "worlds": 2,
        "schedule": "per-grain",
        "tangential": "haff-werner",
        "integrator": "gear",
        "precision": "mixed",
        "fixed": np.array([[-0.01, 0.0, 2e-3]]),
        "outline": box(0.0298, 0.03),  # the first column of grains stands outside
        "open_edges": (2,),
    },
}
THREADS = {"bands that grew": (2, 2), "single grains, settled and spilled": (1, 2)}  # here and elsewhere


def made(case: str, threads: int) -> Simulation:
    """A swayed and rolled box with a gate that opens; grains in a stack beside it."""
    context = dict(CASES[case])
    worlds = context.pop("worlds")
    rng = np.random.default_rng(3)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(5), np.arange(6), indexing="ij"))
    place = RADIUS * np.stack([2.1 * column - 6.0, 2.1 * row + 1.2], axis=1)
    place = place + RADIUS * rng.uniform(-0.05, 0.05, (worlds, COUNT, 2))
    scene = scene_of(
        radius=RADIUS * rng.uniform(0.8, 1.0, (worlds, COUNT)),
        grain=material(young=4e6),
        wall=material(young=4e6, friction=0.4),
        motions=[(Sway(0.01, 5.0), Roll(0.1, 3.0, phase=w)) for w in range(worlds)],
        parts=(GATE,),
        step=2e-5,
        sizes=(0.8 * RADIUS, RADIUS),
        **context,
    )
    return Simulation(scene, place, threads, arch="cpu")


def lead_up(run: Simulation, case: str) -> None:
    """What happens before the state is kept: the lists grow between two looks, or grains settle, fall out and go."""
    if case == "bands that grew":
        assert run.schedule.together == (available_cores() > 1)
        run.schedule.together = False  # spinning on shared cores takes its time
        run.advance(3000)
        run.observe()
        run._make_room()
    else:
        run.settle(1e-6, 0.05)
        run.advance(3000)
        assert np.all(run.observe()["spilled"] > 0)
        assert np.isnan(run.snapshot()["position"]).any()
    run.advance(50)


def end(run: Simulation) -> dict[str, np.ndarray]:
    """The final state of a simulation."""
    run.advance(LATER)
    return run.observe() | run.snapshot() | run.placed() | {"time": np.array(run.time)}


def go_on(folder: Path, case: str) -> None:
    """Restore the state of a case and continue."""
    run = made(case, THREADS[case][1])
    with np.load(folder / "state.npz") as state:
        run.restore(dict(state))
    np.savez(folder / "end.npz", **end(run))
    run.close()


def ends(case: str, folder: Path) -> tuple[dict, dict]:
    """The end of a case here, and elsewhere, of a process that began with this one's state."""
    run = made(case, THREADS[case][0])
    lead_up(run, case)
    np.savez(folder / "state.npz", **run.state())
    found = end(run)
    run.close()
    here = "import pathlib; from tests.solvers.time.test_state import go_on"
    code = f"{here}; go_on(pathlib.Path({str(folder)!r}), {case!r})"
    environment = os.environ | {"PYTHONPATH": str(Path(__file__).parents[3])}
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=300, env=environment)
    assert done.returncode == 0, done.stderr[-2000:]
    return found, dict(np.load(folder / "end.npz"))


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES)
def test_another_process_continues_bit_for_bit(tmp_path, monkeypatch, case):
    monkeypatch.setattr(schedules, "WORTH_BANDS", COUNT)
    here, elsewhere = ends(case, tmp_path)
    assert here["contacts"].min() > 1
    assert np.all(here["part"][..., 1] > 0.01)
    assert here.keys() == elsewhere.keys()
    for name in here:
        assert here[name].tobytes() == elsewhere[name].tobytes(), name


@pytest.mark.slow
def test_bands_continue_in_bands_on_any_number_of_threads(monkeypatch):
    """`auto` stands for bands on two threads, and for the whole world on one. What differs is rounding."""
    case, ends = "bands that grew", []
    monkeypatch.setattr(schedules, "WORTH_BANDS", COUNT)
    run = made(case, 2)
    lead_up(run, case)
    state = run.state()
    for threads in (2, 1):
        run.close()
        run = made(case, threads)
        assert run.schedule_name == ("per-band" if threads == 2 else "per-world")
        run.restore(state)
        assert (run.schedule_name, run.units_a_world) == ("per-band", 2)
        run.schedule.together = False
        run.advance(LATER)
        ends.append(run.snapshot())
    run.close()
    for name in ends[0]:
        np.testing.assert_allclose(ends[1][name], ends[0][name], rtol=1e-9, atol=1e-12, err_msg=name)


def test_bands_do_not_wait_for_missing_cores():
    """Taichi starts no more threads than there are cores; a band at the barrier would wait for ever for its mates."""
    clock, cores = MagicMock(), available_cores()
    for bands in (cores, cores + 1):
        clock.units.count = bands
        assert PerBand(MagicMock(), clock, bands).together == (bands == cores)
