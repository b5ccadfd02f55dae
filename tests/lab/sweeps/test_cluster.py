"""Sweeps on a cluster: the results equal those of this machine, whatever happens to the workers."""

import errno
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.preset.find import load
from lab.recording import versions
from lab.runs.checkpoint import Checkpoint
from lab.runs.run import prepare
from lab.studies import reproduce as package
from lab.studies.reproduce import runs, workers
from lab.studies.reproduce.experiment import Experiment
from lab.studies.reproduce.runs import Batch
from lab.sweeps import cluster
from lab.sweeps.resume import resume_any
from lab.sweeps.sweep import errands, run_sweep
from solvers.machine import runtime

distributed = pytest.importorskip("distributed", reason="the extra `cluster` is not installed")

ROOT = Path(__file__).parents[3]
SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "motion": {"tilt": False, "sway": {"amplitude": "4 mm"}},
    "grains": {"count": 16},
    "contact": {"tangential": "none"},
    "run": {"repeats": 1, "threads": 1, "settle": False, "duration": "0.1 s"},
}
AXES = {"motion.sway.frequency": "1, 2, 3 Hz"}  # as many as in the tests of sweeps: kernels are for so many worlds
SINGLE = {"run.repeats": 1}
FOUR = {"motion.sway.frequency": "1, 3 Hz", "run.duration": "0.1, 0.2 s"}  # a launch for each duration


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
            return partial(list, run_on_worker(texts, terms))

    run_on_worker = cluster.run_on_worker
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


@pytest.mark.slow
def test_a_sweep_on_a_worker_equals_the_local_one_and_finished_points_are_not_sent(
    here, scheduler, in_this_thread, tmp_path, monkeypatch
):
    folder = tmp_path / "there"
    monkeypatch.setattr("lab.sweeps.sweep.run_batch", None)  # nothing is to be launched here
    options = {"video": False, "quiet": True, "cluster": scheduler}
    assert_equal(run_sweep("tilting/quick", AXES, SMALL, folder, **options), here)
    assert errands("tilting/quick", AXES, SMALL, folder) == []
    shutil.rmtree(folder / "points" / "001")
    (errand,) = errands("tilting/quick", AXES, SMALL, folder)
    assert [at.name for at in errand.runs] == ["001"]


def test_batches_are_those_of_a_local_sweep_except_one_begun_locally(tmp_path):
    sent = errands("tilting/quick", FOUR, SMALL, tmp_path)
    assert [[at.name for at in errand.runs] for errand in sent] == [["000", "002"], ["001", "003"]]
    Checkpoint({}, ("points/000", "points/002"), (0, 0)).write(tmp_path)
    assert errands("tilting/quick", FOUR, SMALL, tmp_path) == sent[1:]


def test_threads_and_device_are_those_of_the_client(monkeypatch):
    """A large world would be cut into other bands on a machine with other cores."""
    monkeypatch.setattr("lab.sweeps.cluster.available_cores", lambda: 7)
    preset = load("tilting/quick", {**SMALL, "motion.sway.frequency": "1 Hz", "run.threads": 0, "run.arch": "cpu"})
    run = cluster._with_settings(prepare(preset, Path()), cluster._worker_settings(preset))
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


def test_a_cancelled_task_ends(scheduler):
    def work():
        progress = cluster._TaskProgress()
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
        (ModuleNotFoundError("No module named 'lab'", name="lab"), "a worker lacks lab: install the same lab there"),
    ],
)
def test_errors_of_a_worker_are_one_sentence(scheduler, tmp_path, monkeypatch, error, said):
    def fail(work):
        raise error

    monkeypatch.setattr(cluster, "_unpacked", lambda _: fail)
    with pytest.raises(LabError, match=said):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "there", video=False, quiet=True, cluster=scheduler)


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (distributed.KilledWorker("task", None, 3), "4 workers died with the same batch: look at their logs"),
        (distributed.CancelledError("task"), "is gone: start both again; fetched runs are kept"),
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
def test_an_address_without_a_scheduler_is_named(address, monkeypatch, tmp_path):
    monkeypatch.setattr(cluster, "PATIENCE", 0.5)
    with pytest.raises(LabError, match=f"no scheduler answers at {address}: start one with"):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "s", quiet=True, cluster=address)


def test_a_worker_with_several_threads_is_refused(monkeypatch):
    monkeypatch.setattr(distributed, "get_worker", lambda: SimpleNamespace(state=SimpleNamespace(nthreads=4)))
    with pytest.raises(LabError, match=r"a worker has 4 threads.* start workers with --nthreads 1"):
        cluster.run_on_worker([], cluster.WorkerSettings(1, "cpu", {}, ""))


@pytest.mark.parametrize(
    ("address", "opened"),
    [
        ("tcp://127.0.0.1:8786", False),
        ("127.0.0.1:8786", False),
        ("tcp://127.3.2.1:8786", False),
        ("tcp://[::1]:8786", False),
        ("tcp://localhost:8786", False),
        ("tls://node1:8786", False),
        ("inproc://10.0.0.1/1/1", False),
        ("tcp://0.0.0.0:8786", True),
        ("tcp://192.168.1.5:8786", True),
        ("tcp://[::]:8786", True),
        ("node1:8786", True),
        ("ws://node1:8786", True),
        ("tcp://localhost.elsewhere.net:8786", True),
        ("tcp://127.0.0.1.elsewhere.net:8786", True),
    ],
)
def test_schedulers_open_to_other_machines_are_recognised(address, opened):
    assert cluster.is_open(address) == opened


@pytest.mark.parametrize("version", ["0.0.1", "99.0"])
@pytest.mark.parametrize("package", ["cargo-shift-lab", "taichi"])
def test_a_worker_of_another_version_is_refused_before_it_unpickles_work(
    scheduler, tmp_path, monkeypatch, package, version
):
    monkeypatch.setattr(cluster, "versions", lambda: versions() | {package: version})
    monkeypatch.setattr(cluster, "run_on_worker", None)  # reading the work would fail
    monkeypatch.setattr(cluster, "partial", lambda *_: Unreadable())
    with pytest.raises(
        LabError, match=rf"a worker lacks {package} {version} \(it has .*\): install the same lab there"
    ):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "there", video=False, quiet=True, cluster=scheduler)


class Unreadable:
    """Work that cannot be read."""

    def __reduce__(self):
        return (eval, ("1 / 0",))


def test_a_worker_with_other_sources_of_the_same_version_is_refused(scheduler, tmp_path, monkeypatch):
    terms = cluster._worker_settings
    monkeypatch.setattr(cluster, "_worker_settings", lambda preset: replace(terms(preset), sources="others"))
    with pytest.raises(LabError, match="the same version but other source files"):
        run_sweep("tilting/quick", AXES, SMALL, tmp_path / "there", video=False, quiet=True, cluster=scheduler)


@pytest.mark.parametrize("name", ["../outside", "/tmp/outside", "a/b", ".."])
def test_a_worker_writes_into_no_other_folder(tmp_path, name):
    with pytest.raises(LabError, match="a worker sent a file for another folder"):
        cluster._put({name: b"x"}, tmp_path / "run")
    assert not list((tmp_path / "run").iterdir())


def test_a_full_folder_is_named(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(LabError, match=r"cannot be written \(No space left on device\): make room there"):
        cluster._put({"recording.h5": b"x" * 10}, tmp_path)


def test_a_full_worker_is_named(tmp_path):
    with pytest.raises(LabError, match=r"--cluster: on a worker, .*gone cannot be written .*: make room there"):
        cluster._in_a_folder(tmp_path / "gone").__enter__()
    with pytest.raises(LabError, match=f"--cluster: on a worker, {tmp_path}"), cluster._in_a_folder(tmp_path) as home:
        raise LabError(f"{home} cannot be written (No space left on device): make room there.")


# ---- with processes of their own


@pytest.fixture
def dask(tmp_path):
    """Starts `dask WORDS …` in a process of its own; all are ended with the test."""
    started = []

    def start(*words, lab=ROOT):
        environment = {**os.environ, "PYTHONPATH": str(lab)}
        line = [sys.executable, "-m", "dask", *map(str, words), "--no-dashboard"]
        with (tmp_path / f"{len(started)}.log").open("w") as log:
            started.append(subprocess.Popen(line, cwd=tmp_path, env=environment, stdout=log, stderr=log))
        return started[-1]

    yield start
    for process in started:
        process.kill()
        process.wait()


def address_in(path, patience=60.0):
    """The address in a scheduler's file, once it is there."""
    end = time.monotonic() + patience
    while time.monotonic() < end:
        if path.exists() and path.stat().st_size:
            return json.loads(path.read_text())["address"]
        time.sleep(0.05)
    raise TimeoutError(path)


def worker_of(dask, tmp_path, lab=ROOT):
    """A worker of the scheduler of `scheduler.json`, with the lab in that folder."""
    place = ("--scheduler-file", tmp_path / "scheduler.json", "--local-directory", tmp_path / "worker")
    return dask("worker", *place, "--no-nanny", "--nthreads", 1, lab=lab)


def asking(folder, address, *words):
    """The command that sweeps on a cluster, in a process of its own."""
    table = "tank.width=24 mm", "tank.height=24 mm", "motion.tilt=false", "motion.sway.amplitude=4 mm", "run.threads=1"
    table = *table, "grains.count=16", "run.settle=false", "run.duration=0.1 s", "motion.sway.frequency=1, 3 Hz"
    said = [word for setting in (*table, *words) for word in ("--set", setting)]
    line = [sys.executable, "-m", "lab", "sweep", "tilting/quick", *said, "--repeats", 1, "--no-video"]
    line += ["--out", folder, "--cluster", address]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    return subprocess.Popen(list(map(str, line)), env=environment, cwd=folder.parent, **pipes)


@pytest.mark.slow
def test_a_killed_scheduler_gives_one_sentence(dask, tmp_path):
    scheduler = dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", tmp_path / "scheduler.json")
    command = asking(tmp_path / "there", address_in(tmp_path / "scheduler.json"))
    assert "no worker yet: waiting for one" in command.stderr.readline()
    scheduler.kill()
    _, said = command.communicate(timeout=120)
    assert command.returncode == 2 and "is gone: start both again" in said and "Traceback" not in said


@pytest.mark.slow
def test_a_client_that_is_interrupted_leaves_the_worker_free(dask, tmp_path):
    dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", tmp_path / "scheduler.json")
    address = address_in(tmp_path / "scheduler.json")
    worker_of(dask, tmp_path)
    command = asking(tmp_path / "there", address, "run.duration=9000 s")
    with distributed.Client(address, timeout=60, set_as_default=False) as client:
        while not list((tmp_path / "worker").rglob("recording.h5")):
            time.sleep(0.1)
        command.send_signal(signal.SIGINT)
        _, said = command.communicate(timeout=120)
        assert command.returncode == 130 and "continue with: cargolab resume" in said and "Traceback" not in said
        assert client.submit(int, "5", pure=False).result(timeout=60) == 5  # the one thread is free again
    assert not list((tmp_path / "worker").rglob("recording.h5"))


@pytest.mark.slow
def test_a_worker_with_a_full_disk_gives_one_sentence(dask, tmp_path):
    dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", tmp_path / "scheduler.json")
    address = address_in(tmp_path / "scheduler.json")
    worker = worker_of(dask, tmp_path)
    with distributed.Client(address, timeout=60, set_as_default=False) as client:
        client.wait_for_workers(1, timeout=60)
    resource.prlimit(worker.pid, resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))
    command = asking(tmp_path / "there", address)
    _, said = command.communicate(timeout=240)
    assert command.returncode == 2 and "--cluster: on a worker, " in said and "make room there" in said
    assert "Traceback" not in said


@pytest.mark.slow
@pytest.mark.parametrize("said", ['__version__ = "0.0.1"\n', ""])
def test_a_worker_with_another_lab_gives_one_sentence(dask, tmp_path, said):
    (tmp_path / "other" / "lab").mkdir(parents=True)
    (tmp_path / "other" / "lab" / "__init__.py").write_text(said)
    dask("scheduler", "--host", "127.0.0.1", "--port", 0, "--scheduler-file", tmp_path / "scheduler.json")
    address = address_in(tmp_path / "scheduler.json")
    worker_of(dask, tmp_path, lab=tmp_path / "other")
    command = asking(tmp_path / "there", address)
    _, answer = command.communicate(timeout=120)
    assert command.returncode == 2 and "a worker lacks cargo-shift-lab" in answer and "Traceback" not in answer
    assert ("it has 0.0.1" if said else "it has an earlier version") in answer


@pytest.mark.slow
def test_a_scheduler_open_to_other_machines_gives_a_warning(dask, tmp_path):
    dask("scheduler", "--host", "0.0.0.0", "--port", 0, "--scheduler-file", tmp_path / "scheduler.json")
    address = address_in(tmp_path / "scheduler.json")
    command = asking(tmp_path / "there", f"tcp://127.0.0.1:{address.rpartition(':')[2]}")
    assert "other machines can reach the scheduler at" in command.stderr.readline()
    command.send_signal(signal.SIGINT)
    command.communicate(timeout=120)


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
