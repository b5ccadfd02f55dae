"""Sweeps on a cluster: what comes back is what would have been made here, whatever becomes of the workers."""

import os
import shutil
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from lab import cluster
from lab import reproduce as package
from lab.checkpoint import Checkpoint
from lab.errors import LabError
from lab.launch import prepare
from lab.presets import load
from lab.reproduce import runs, workers
from lab.reproduce.experiment import Experiment
from lab.reproduce.runs import Batch
from lab.sweeps import errands, resume_any, run_sweep
from solvers import runtime

distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")

ROOT = Path(__file__).parents[2]
SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "motion": {"tilt": False, "sway": {"amplitude": "4 mm"}},
    "grains": {"count": 16},
    "run": {"repeats": 1, "threads": 1, "settle": False, "duration": "0.1 s"},
}
AXES = {"motion.sway.frequency": "1, 3 Hz"}
SINGLE = {"run.repeats": 1}
FOUR = {**AXES, "run.duration": "0.1, 0.2 s"}  # a launch for each duration


@pytest.fixture(scope="module")
def here(tmp_path_factory):
    """The sweep on this machine."""
    return run_sweep("tilting/quick", AXES, SMALL, tmp_path_factory.mktemp("here") / "s", video=False, quiet=True)


@pytest.fixture(scope="module")
def scheduler():
    """A scheduler with one worker, both in this process."""
    options = {"processes": False, "n_workers": 1, "threads_per_worker": 1, "dashboard_address": ":0"}
    with distributed.LocalCluster(protocol="tcp", **options) as started:
        yield started.scheduler_address


@pytest.fixture
def in_this_thread(tmp_path, monkeypatch):
    """A worker does its work before it is sent to it: Taichi cannot change the thread of this process."""
    state = SimpleNamespace(nthreads=1, tasks={"task": SimpleNamespace(state="executing")})
    worker = SimpleNamespace(state=state, local_directory=tmp_path, get_current_task=lambda: "task")

    def run(texts, terms):
        with monkeypatch.context() as patch:
            patch.setattr(distributed, "get_worker", lambda: worker)
            return partial(list, run_launch(texts, terms))

    run_launch = cluster.run_launch
    monkeypatch.setattr(cluster, "partial", lambda _, *arguments: run(*arguments))


def data_sets(folder):
    found = {}
    with h5py.File(folder / "recording.h5", "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return found, file.attrs["status"].decode()


def assert_equal(there, here):
    """Both sweeps have the same table and the same bits."""
    assert (there.folder / "results.csv").read_bytes() == (here.folder / "results.csv").read_bytes()
    for mine, reference in zip(there.points, here.points, strict=True):
        (found, status), (wanted, _) = data_sets(mine), data_sets(reference)
        assert status == "complete" and found.keys() == wanted.keys()
        assert all(np.array_equal(found[name], wanted[name]) for name in wanted)
        assert {path.name for path in mine.iterdir()} == {path.name for path in reference.iterdir()}


def test_a_sweep_on_a_worker_equals_the_local_one_and_what_is_done_is_not_sent(
    here, scheduler, in_this_thread, tmp_path, monkeypatch
):
    folder = tmp_path / "there"
    monkeypatch.setattr("lab.sweeps.launch", None)  # nothing is to be launched here
    options = {"video": False, "quiet": True, "cluster": scheduler}
    assert_equal(run_sweep("tilting/quick", AXES, SMALL, folder, **options), here)
    assert errands("tilting/quick", AXES, SMALL, folder) == []
    shutil.rmtree(folder / "points" / "001")
    (errand,) = errands("tilting/quick", AXES, SMALL, folder)
    assert [at.name for at in errand.runs] == ["001"]


def test_launches_are_planned_as_they_are_here_but_for_one_that_was_begun_here(tmp_path):
    sent = errands("tilting/quick", FOUR, SMALL, tmp_path)
    assert [[at.name for at in errand.runs] for errand in sent] == [["000", "002"], ["001", "003"]]
    Checkpoint({}, ("points/000", "points/002"), (0, 0)).write(tmp_path)
    assert errands("tilting/quick", FOUR, SMALL, tmp_path) == sent[1:]


def test_threads_and_device_are_those_of_the_asking_machine(monkeypatch):
    """A large world would be cut into other bands on a machine with other cores."""
    monkeypatch.setattr("lab.cluster.available_cores", lambda: 7)
    preset = load("tilting/quick", {**SMALL, "motion.sway.frequency": "1 Hz", "run.threads": 0, "run.arch": "cpu"})
    run = cluster._on_terms(prepare(preset, Path()), cluster._terms(preset))
    assert (run.loaded.resolved.run.threads, run.loaded.resolved.run.arch) == (7, "cpu")
    assert preset.resolved.run.threads == 0


def test_single_runs_of_experiments_are_sent_once(tmp_path):
    batch = Batch("tilting/quick", SINGLE)
    (errand,) = runs.errands(batch, tmp_path)
    assert list(errand.runs) == [tmp_path]
    (tmp_path / "recording.h5").touch()
    assert runs.errands(batch, tmp_path) == []


def test_all_experiments_are_sent_at_once_before_anything_runs_here(tmp_path, monkeypatch):
    done = []
    batches = {"one": Batch("tilting/quick", SINGLE), "two": Batch("tilting/quick", SINGLE, {"run.seed": [1, 2]})}
    tried = Experiment("tried", "A trial", "0.0", "nothing.", lambda quick: batches, None, "", ("one", 1.0))
    monkeypatch.setattr(package, "experiments", lambda _: {"tried": tried})
    monkeypatch.setattr(package, "fetch", lambda errands, address, _: done.append((len(errands), address)))
    monkeypatch.setattr(workers, "carry_out", lambda batch, *_: done.append(batch))
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    monkeypatch.setattr(package, "write_report", lambda *_: None)
    package.reproduce("granular", [], tmp_path, quick=True, quiet=True, cluster="tcp://node1:8786")
    assert done == [(2, "tcp://node1:8786"), *batches.values()]


def test_a_task_that_nobody_waits_for_ends(scheduler):
    def work():
        progress = cluster._Dutiful()
        progress.start("work", 1.0)
        while True:
            progress.reach(0.5)
            time.sleep(0.01)

    with distributed.Client(scheduler, set_as_default=False) as client:
        future = client.submit(work, pure=False)
        while not any(client.processing().values()):
            time.sleep(0.01)
        future.cancel()
        assert client.submit(int, "5", pure=False).result(timeout=10) == 5  # the one thread is free again


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (LabError("grains: the bed is too high for the tank."), r"^grains: the bed is too high for the tank\.$"),
        (ModuleNotFoundError("No module named 'lab'", name="lab"), "a worker lacks lab: install the lab there as here"),
    ],
)
def test_what_a_worker_cannot_do_is_one_sentence(scheduler, tmp_path, monkeypatch, error, said):
    def fail(work):
        raise error

    monkeypatch.setattr(cluster, "_unpacked", lambda: fail)
    with pytest.raises(LabError, match=said):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "there", video=False, quiet=True, cluster=scheduler)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (distributed.KilledWorker("task", None, 3), "4 workers died with the same launch: look at their logs"),
        (distributed.CancelledError("task"), "is gone: start it again and ask again; what came back is kept"),
    ],
)
def test_lost_workers_and_schedulers_are_one_sentence(scheduler, error, said):
    with pytest.raises(LabError, match=said), cluster._connected(scheduler):
        raise error


def test_without_the_extra_the_package_is_named(monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, "distributed", None)
    with pytest.raises(LabError, match="distributed is missing here: pip install distributed"):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", quiet=True, cluster="tcp://127.0.0.1:1")


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:1", "nonsense://x"])
def test_an_address_where_nobody_answers_is_named(address, monkeypatch, tmp_path):
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with pytest.raises(LabError, match=f"no scheduler answers at {address}: start one with"):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", quiet=True, cluster=address)


def test_a_worker_with_several_threads_is_refused(monkeypatch):
    monkeypatch.setattr(distributed, "get_worker", lambda: SimpleNamespace(state=SimpleNamespace(nthreads=4)))
    with pytest.raises(LabError, match=r"a worker has 4 threads.* start workers with --nthreads 1"):
        cluster.run_launch([], cluster.Terms(1, "cpu", {}))


@pytest.mark.slow
def test_a_worker_that_is_killed_midway_changes_nothing(tmp_path):
    here = run_sweep("tilting/quick", FOUR, SMALL, tmp_path / "here", video=False, quiet=True)
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    started = []

    def dask(*words):
        line = [sys.executable, "-m", "dask", *map(str, words), "--no-dashboard"]
        with (tmp_path / f"{len(started)}.log").open("w") as log:
            started.append(subprocess.Popen(line, cwd=tmp_path, env=environment, stdout=log, stderr=log))
        return started[-1]

    where = tmp_path / "scheduler.json"
    try:
        dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", where)
        worker = ("worker", "--scheduler-file", where, "--no-nanny", "--nthreads", 1)
        workers = {
            name: dask(*worker, "--name", name, "--local-directory", tmp_path / name) for name in ("first", "second")
        }
        with distributed.Client(scheduler_file=str(where), timeout=60, set_as_default=False) as client:
            client.wait_for_workers(2, timeout=60)
            named = {info["name"]: at for at, info in client.scheduler_info()["workers"].items()}
            address = client.scheduler.address

            def kill_midway():
                while not all(client.processing().get(at) for at in named.values()):
                    time.sleep(0.01)
                while not list((tmp_path / "first").rglob("cargolab-*/*/recording.h5")):
                    time.sleep(0.01)
                workers["first"].kill()
                return not list((tmp_path / "there").rglob("summary.json"))

            options = {"video": False, "quiet": True, "cluster": address}
            with ThreadPoolExecutor() as beside:
                killing = beside.submit(kill_midway)
                there = run_sweep("tilting/quick", FOUR, SMALL, tmp_path / "there", **options)
                assert killing.result()  # nothing had come back by then
            assert workers["first"].wait() == -9
        assert_equal(there, here)
    finally:
        for process in started:
            process.kill()
            process.wait()
    assert resume_any(tmp_path / "there", video=False, quiet=True).rows == there.rows
