"""Run launches on the workers of a Dask scheduler, and fetch the files of their runs.

A launch is one task. A worker runs it in a folder of its own, with the number of threads and the kind of device that
this machine would have used, so that its recordings have the same bits as here. Recordings are sent as bytes, one run
at a time: a worker holds all runs of its last launches in memory until they are fetched, this machine only one. If a
worker is lost, Dask repeats its launch.

Dask sends Python pickles, which run code when they are read: whoever can reach a scheduler can run code on its workers
and on its clients. Use only schedulers of your own; those that other machines can reach need TLS (distributed.dask.org,
"TLS/SSL").
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
from lab.base.progress import Progress
from lab.preset.find import LoadedPreset
from lab.preset.schema import Resolved
from lab.preset.units import quoted
from lab.recording import versions
from lab.runs.launch import Run, launch, prepare
from lab.runs.runner import report
from solvers.machine.runtime import available_cores, choose_arch

if TYPE_CHECKING:
    from distributed import Client

PATIENCE = 10.0  # s to wait for an answer from the scheduler
LAST = "summary.json"  # the last file of a run to arrive: with it the run counts as done
PLAIN = re.compile(r"\w[\w.-]*")  # the name of a file of a run
ALIKE = ("cargo-shift-lab", "taichi")  # packages of which a worker needs the same version, for the same bits

Files = dict[str, bytes]


@dataclass(frozen=True)
class Errand:
    """A launch for a worker: the presets of its runs by their folders on this machine."""

    runs: Mapping[Path, LoadedPreset]


@dataclass(frozen=True)
class Terms:
    """The settings with which a worker runs a launch: those of this machine, for the same bits."""

    threads: int
    arch: str
    versions: Mapping[str, str]
    sources: str


def fetch(errands: Sequence[Errand], address: str, progress: Progress) -> None:
    """Let the workers of the scheduler at `address` run all launches, and put each run's files into its folder.

    Runs that have arrived stay, whatever happens to the others; launches that are still running when this ends are
    cancelled. Raises LabError, Unavailable if a worker lacks the device, and KeyboardInterrupt.
    """
    if not errands:
        return
    _warn_of(address, progress)
    with _connected(address) as client:
        if (heard := client.scheduler_info()["address"]) != address:
            _warn_of(heard, progress)
        if not client.nthreads():
            progress.say(f"The scheduler at {address} has no worker yet: waiting for one.")
        _fetch(client, errands, progress)


def _warn_of(address: str, progress: Progress) -> None:
    if is_open(address):
        progress.say(
            f"note: the scheduler at {address} listens beyond this machine without TLS, so whoever reaches it can run "
            "programs here and on its workers: start it with --host 127.0.0.1, or with TLS."
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
        texts = [(one.name, one.given_text, one.resolved.model_dump_json()) for one in presets]
        work = pickle.dumps(partial(run_launch, texts, _terms(presets[0])))
        done = client.submit(_unpacked({name: versions().get(name, "") for name in ALIKE}), work, pure=False)
        # One more task per run, before any further launch, so that runs are sent and freed on the worker one by one.
        folders |= {client.submit(getitem, done, k, pure=False, priority=1): at for k, at in enumerate(errand.runs)}
    del done
    total = len(folders)
    progress.start("cluster", total)
    for count, future in enumerate(as_completed(list(folders), loop=client.loop), start=1):
        _put(future.result(), folders.pop(future))
        future.release()
        progress.reach(count)
        if not progress.live:
            progress.say(f"{count} of {total} runs are back")
    progress.finish()


def _terms(preset: LoadedPreset) -> Terms:
    run = preset.resolved.run
    return Terms(run.threads or available_cores(), choose_arch(run.arch, run.precision), versions(), sources())


@cache
def sources() -> str:
    """A hash of the source of lab and solvers: it tells edited copies of one version apart."""
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


def run_launch(texts: Sequence[tuple[str, str, str]], terms: Terms) -> list[Files]:
    """Run presets side by side in a task of a worker; returns the files of each run, the summary last.

    texts: for each preset its name, its TOML text and its resolved values as JSON. Raises LabError if the worker has
    several threads, and as `launch` does.
    """
    from distributed import get_worker

    worker = get_worker()
    if worker.state.nthreads > 1:
        raise LabError(
            f"--cluster: a worker has {worker.state.nthreads} threads, but a process can run one launch at a time: "
            "start workers with --nthreads 1."
        )
    presets = [LoadedPreset(name, given, Resolved.model_validate_json(resolved)) for name, given, resolved in texts]
    progress = _Dutiful()
    if sources() != terms.sources:
        raise LabError(
            "--cluster: the lab of a worker has other source files than the one here, though the same version: install "
            "the lab there as here."
        )
    if versions() != terms.versions:
        progress.warn("The run was made with other versions of the lab or its libraries than it was asked for with.")
    with _in_a_folder(worker.local_directory) as home:
        runs = [prepare(preset, home / f"{k:03}") for k, preset in enumerate(presets)]
        settled, worlds = [_on_terms(run, terms) for run in runs], sum(len(run.scene.radius) for run in runs)
        for run, on_terms in zip(runs, settled, strict=True):
            run.make_recording(engaged=on_terms.engaged(worlds))
        launch(settled, home, progress)
        for run in runs:
            report(run.folder, progress, video=False, plots=False)
        return [_taken(run.folder) for run in runs]


@contextmanager
def _in_a_folder(place: str | Path) -> Iterator[Path]:
    """A temporary folder for a launch on a worker; write errors name the worker as their place."""
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


class _Dutiful(Progress):
    """Silent progress in a task; it ends the task once that has been cancelled."""

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


def _on_terms(run: Run, terms: Terms) -> Run:
    """The run with the threads and device of `terms`; its recording, made before, has the requested ones."""
    resolved = run.loaded.resolved
    settled = replace(resolved.run, threads=terms.threads, arch=terms.arch)
    return replace(run, loaded=replace(run.loaded, resolved=resolved.model_copy(update={"run": settled})))


def _taken(folder: Path) -> Files:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir(), key=lambda path: path.name == LAST)}


def _put(sent: Files, folder: Path) -> None:
    """Write files in order, each atomically."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        for name, content in sent.items():
            if not PLAIN.fullmatch(name):
                raise LabError(f"--cluster: a worker sent a file for another folder ({quoted(name)}): ask another one.")
            unfinished = folder / f"{name}.new"
            unfinished.write_bytes(content)
            unfinished.replace(folder / name)
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

    async def knock() -> None:
        """Try the address first: a client without a scheduler waits once more when it closes, and logs errors."""
        found = await connect(address, timeout=PATIENCE, **Security().get_connection_args("client"))
        await found.close()

    try:
        asyncio.run(knock())
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
                f"--cluster: {error.allowed_failures + 1} workers died with the same launch: "
                "look at their logs, and give them more memory or fewer worlds (--repeats)."
            ) from error
        except ImportError as error:
            raise LabError(f"--cluster: a worker lacks {error.name}: install the lab there as here.") from error
        except (CancelledError, OSError) as error:
            raise LabError(
                f"--cluster: the scheduler at {address} is gone: start it again and ask again; what came back is kept."
            ) from error
