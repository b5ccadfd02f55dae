"""Run batches on the workers of a Dask scheduler, and fetch the files of their runs.

A batch is one task. A worker runs it in a temporary folder, with the number of threads and the kind of device that this
machine would have used, so that its recordings have the same bits as here. Recordings are sent as bytes, one run at a
time: a worker keeps all runs of its last batches in memory until they are fetched, this machine only one. If a worker
is lost, Dask repeats its batch.

Dask sends Python pickles, which run code when they are read: anybody who can reach a scheduler can run code on its
workers and on its clients. Use only your own schedulers; those that other machines can reach need TLS
(distributed.dask.org, "TLS/SSL").
"""

import asyncio
import hashlib
import logging
import pickle
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cache, partial
from importlib.resources import files
from ipaddress import ip_address
from operator import getitem
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from lab.base.errors import LabError
from lab.base.files import replacing
from lab.base.progress import Progress
from lab.preset.find import LoadedPreset
from lab.preset.recorded import from_table, to_table
from lab.preset.units import quoted
from lab.recording import versions
from lab.runs.batch import run_batch
from lab.runs.run import Run, prepare
from lab.runs.runner import report
from solvers.machine.runtime import available_cores, choose_arch

if TYPE_CHECKING:
    from distributed import Client

PATIENCE = 10.0  # s to wait for an answer from the scheduler
LAST = "summary.json"  # the last file of a run to be written here: with it the run counts as done
PLAIN = re.compile(r"\w[\w.-]*")  # permitted names of a run's files
SAME_VERSION = ("cargo-shift-lab", "taichi")  # packages of which a worker needs the same version, for the same bits

Files = dict[str, bytes]


@dataclass(frozen=True)
class Errand:
    """A batch for a worker: the presets of its runs by their folders on this machine."""

    runs: Mapping[Path, LoadedPreset]


@dataclass(frozen=True)
class WorkerSettings:
    """The settings with which a worker runs a batch: those of this machine, for the same bits."""

    threads: int
    arch: str
    versions: Mapping[str, str]
    sources: str


def fetch(errands: Sequence[Errand], address: str, progress: Progress) -> None:
    """Run all batches on the workers of the scheduler at `address`, and put each run's files into its folder.

    Runs that were fetched are kept in any case; batches that are still running when this ends are cancelled. Raises
    LabError, Unavailable if a worker lacks the device, and KeyboardInterrupt.
    """
    if not errands:
        return
    _warn_of(address, progress)
    with _connected(address) as client:
        if (actual := client.scheduler_info()["address"]) != address:
            _warn_of(actual, progress)
        if not client.nthreads():
            progress.say(f"The scheduler at {address} has no worker yet: waiting for one.")
        _fetch(client, errands, progress)


def _warn_of(address: str, progress: Progress) -> None:
    if is_open(address):
        progress.say(
            f"note: other machines can reach the scheduler at {address} without TLS, so anybody there can run programs "
            "here and on its workers: start it with --host 127.0.0.1, or with TLS."
        )


def is_open(address: str) -> bool:
    """Whether other machines can reach a scheduler at this address without TLS."""
    protocol, _, rest = address.rpartition("://")
    host = rest.rpartition(":")[0].strip("[]")
    if protocol in ("tls", "wss", "inproc") or host == "localhost":
        return False
    try:
        return not ip_address(host).is_loopback
    except ValueError:  # a host name
        return True


def _fetch(client: "Client", errands: Sequence[Errand], progress: Progress) -> None:
    from distributed import as_completed

    folders = {}
    for errand in errands:
        presets = list(errand.runs.values())
        texts = [(one.name, one.given_text, to_table(one.resolved)) for one in presets]
        work = pickle.dumps(partial(run_on_worker, texts, _worker_settings(presets[0])))
        done = client.submit(_unpacked({name: versions().get(name, "") for name in SAME_VERSION}), work, pure=False)
        # One more task per run, before any further batch, so that runs are sent and freed on the worker one by one.
        folders |= {client.submit(getitem, done, k, pure=False, priority=1): at for k, at in enumerate(errand.runs)}
    del done
    total = len(folders)
    progress.start("cluster", total)
    for count, future in enumerate(as_completed(list(folders), loop=client.loop), start=1):
        _put(future.result(), folders.pop(future))
        future.release()
        progress.reach(count)
        if not progress.live:
            progress.say(f"{count} of {total} runs are done")
    progress.finish()


def _worker_settings(preset: LoadedPreset) -> WorkerSettings:
    run = preset.resolved.run
    return WorkerSettings(run.threads or available_cores(), choose_arch(run.arch, run.precision), versions(), sources())


@cache
def sources() -> str:
    """A hash of the source of lab and solvers, which differs between edited copies of one version."""
    digest = hashlib.blake2b(digest_size=16)
    for package in ("lab", "solvers"):
        home = Path(str(files(package)))
        for path in sorted(home.rglob("*.py")):
            digest.update(path.relative_to(home).as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()


def _unpacked(wanted: Mapping[str, str]) -> Callable[[bytes], list[Files]]:
    """A function that unpickles and runs work. It is pickled by value: a failed import would kill a worker silently.

    wanted: the versions that a worker must have, by package; they are checked before the work is unpickled.
    """

    def task(work: bytes) -> list[Files]:
        import pickle

        for package, version in wanted.items():
            if package == "cargo-shift-lab":
                import lab

                found = getattr(lab, "__version__", "an earlier version")
            else:
                from importlib.metadata import version as version_of

                found = version_of(package)
            if found != version:
                raise ImportError("another version", name=f"{package} {version} (it has {found})")
        return pickle.loads(work)()

    return task


def run_on_worker(texts: Sequence[tuple[str, str, str]], settings: WorkerSettings) -> list[Files]:
    """Run presets as a batch in a task of a worker; returns the files of each run, the summary last.

    texts: for each preset its name, its TOML text and its table in SI. Raises LabError if the worker has
    several threads, and as `run_batch` does.
    """
    from distributed import get_worker

    worker = get_worker()
    if worker.state.nthreads > 1:
        raise LabError(
            f"--cluster: a worker has {worker.state.nthreads} threads, but a process can run one batch at a time: "
            "start workers with --nthreads 1."
        )
    presets = [LoadedPreset(name, given, from_table(resolved)) for name, given, resolved in texts]
    progress = _TaskProgress()
    if sources() != settings.sources:
        raise LabError(
            "--cluster: the lab of a worker has the same version but other source files than the one here: install "
            "the same lab there."
        )
    if versions() != settings.versions:
        progress.warn("The run was made on a worker with other versions of the lab or its libraries.")
    with _in_a_folder(worker.local_directory) as home:
        runs = [prepare(preset, home / f"{k:03}") for k, preset in enumerate(presets)]
        local, worlds = [_with_settings(run, settings) for run in runs], sum(run.scene.worlds for run in runs)
        for run, here in zip(runs, local, strict=True):
            run.make_recording(device=here.device(worlds))
        run_batch(local, home, progress)
        for run in runs:
            report(run.folder, progress, video=False, plots=False)
        return [_taken(run.folder) for run in runs]


@contextmanager
def _in_a_folder(place: str | Path) -> Iterator[Path]:
    """A temporary folder for a batch on a worker; messages of write errors say that they come from a worker."""
    try:
        with TemporaryDirectory(prefix="cargolab-", dir=place) as home:
            yield Path(home)
    except OSError as error:
        raise LabError(
            f"--cluster: on a worker, {place} cannot be written ({error.strerror}): make room there."
        ) from error
    except LabError as error:
        if str(place) not in str(error):
            raise
        raise LabError(f"--cluster: on a worker, {error}") from error


class _TaskProgress(Progress):
    """Silent progress in a task, which ends the task if it has been cancelled."""

    def __init__(self) -> None:
        from distributed import get_worker

        super().__init__(quiet=True)
        self._tasks, self._own = get_worker().state.tasks, get_worker().get_current_task()

    def reach(self, done: float) -> None:
        """Go on, or raise Reschedule if the task has been cancelled."""
        from distributed import Reschedule

        super().reach(done)
        task = self._tasks.get(self._own)
        if task is None or task.state == "cancelled":
            raise Reschedule


def _with_settings(run: Run, settings: WorkerSettings) -> Run:
    """The run with the threads and device of `settings`; its recording keeps the requested ones."""
    resolved = run.loaded.resolved
    changed = replace(resolved.run, threads=settings.threads, arch=settings.arch)
    return replace(run, loaded=replace(run.loaded, resolved=replace(resolved, run=changed)))


def _taken(folder: Path) -> Files:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir(), key=lambda path: path.name == LAST)}


def _put(sent: Files, folder: Path) -> None:
    """Write files in order, each atomically."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in sent.items():
            if not PLAIN.fullmatch(name):
                raise LabError(f"--cluster: a worker sent a file for another folder ({quoted(name)}): do not use it.")
            with replacing(folder / name) as part:
                part.write_bytes(content)
    except OSError as error:
        raise LabError(f"{folder} cannot be written ({error.strerror}): make room there.") from error


@contextmanager
def _connected(address: str) -> Iterator["Client"]:
    """A client of the scheduler; Dask's errors become one sentence."""
    try:
        from distributed import Client, KilledWorker, Security
        from distributed.comm import connect
    except ImportError as error:
        raise LabError("--cluster: the package distributed is missing here: pip install distributed.") from error
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # it logs every lost connection at length

    async def try_connection() -> None:
        """Try the address first: a client without a scheduler waits once more when it closes, and logs errors."""
        found = await connect(address, timeout=PATIENCE, **Security().get_connection_args("client"))
        await found.close()

    try:
        asyncio.run(try_connection())
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError) as error:
        raise LabError(
            f"--cluster: no scheduler answers at {address}: start one with `dask scheduler` and give the address "
            "that it prints, e.g. tcp://node1:8786."
        ) from error
    with client:
        try:
            yield client
        except KilledWorker as error:
            raise LabError(
                f"--cluster: {error.allowed_failures + 1} workers died with the same batch: "
                "look at their logs, and give them more memory or fewer worlds (--repeats)."
            ) from error
        except ImportError as error:
            raise LabError(f"--cluster: a worker lacks {error.name}: install the same lab there.") from error
        except (CancelledError, OSError) as error:
            raise LabError(
                f"--cluster: the scheduler at {address} is gone: start both again; fetched runs are kept."
            ) from error
