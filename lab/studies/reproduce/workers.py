"""Run batches side by side: one process per core, each running one batch after the other.

Settling beds, compiling kernels and writing files use one core only; with one batch per core the others need not wait.
"""

import os
import signal
import threading
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import suppress
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait as wait_for
from pathlib import Path

from lab.base.errors import LabError
from lab.base.interrupt import SIGNALS, handle_signals
from lab.base.progress import Progress
from lab.studies.reproduce.runs import Batch, carry_out, outcomes
from solvers.machine import runtime

BROKEN = "a process that ran a batch was ended from outside, maybe for want of memory"
GRACE = 60.0  # s that a worker has to save its state when it is stopped
_asked: list[bool] = []  # of a worker: whether it was asked to stop while it had no work


def carry_out_all(batches: Mapping[Path, Batch], progress: Progress) -> Iterator[Path]:
    """Run what has not been run yet of all batches, by folder; yields each folder when its batch is done.

    A single batch, or any on a GPU or a single core, runs in this process; else there is one process per core. Raises
    LabError, one sentence, and KeyboardInterrupt; running batches are then stopped where they can be continued.
    """
    cores = min(runtime.available_cores(), len(batches))
    if cores <= 1 or runtime.choose_arch("auto", "f64") != "cpu":
        for folder, batch in batches.items():
            progress.say(f"{named(folder)} …")
            carry_out(batch, folder, progress.console.quiet)
            yield folder
    else:
        yield from _by_workers(batches, cores, progress)


def named(folder: Path) -> str:
    """An experiment and one of its batches."""
    return f"{folder.parent.name}: {folder.name}"


def _by_workers(batches: Mapping[Path, Batch], cores: int, progress: Progress) -> Iterator[Path]:
    with progress, ProcessPoolExecutor(cores, get_context("spawn"), _begin) as workers:
        known = {folder for folder in batches if outcomes(folder)}  # these are only looked at
        progress.begin_whole("batches", len(batches), len(known))
        left, running = iter(batches.items()), {}
        try:
            _hand_out(workers, left, running, cores, progress)
            while running:
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    folder = running.pop(future)
                    future.result()
                    _hand_out(workers, left, running, cores, progress)
                    if folder not in known:
                        progress.count_one(f"{named(folder)} is done")
                    yield folder
        except BaseException as error:
            for worker in active_children():
                with suppress(ProcessLookupError):  # it may have ended meanwhile
                    os.kill(worker.pid, signal.SIGINT)
            if isinstance(error, BrokenProcessPool):
                raise LabError(f"{BROKEN}: run the command again to continue.") from None
            raise


def _hand_out(
    workers: ProcessPoolExecutor,
    left: Iterator[tuple[Path, Batch]],
    running: dict[Future, Path],
    cores: int,
    progress: Progress,
) -> None:
    """Give batches to idle workers only, since batches waiting in a queue cannot be withdrawn."""
    while len(running) < cores and (following := next(left, None)):
        folder, batch = following
        progress.say(f"{named(folder)} …")
        running[workers.submit(_work, batch, folder)] = folder


def _begin() -> None:
    """Set up a worker: use one core, leave Ctrl-C to the parent process, and end with the parent."""
    runtime.use_cores(1)
    signal.signal(signal.SIGINT, _be_asked)  # what runs in the background would be deaf to it
    if hasattr(os, "setpgrp"):
        os.setpgrp()
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _work(batch: Batch, folder: Path) -> None:
    """Run a batch in a worker, unless it was asked to stop. Only at work does a signal interrupt it.

    While it waits for work an interrupt would end it with a traceback; it ends with the parent's queue.
    """
    if _asked:
        raise KeyboardInterrupt
    before = {number: signal.getsignal(number) for number in SIGNALS}
    try:
        handle_signals(patient=True)  # who ends all processes asks this one twice
        carry_out(batch, folder, True)
    finally:
        for number, act in before.items():
            signal.signal(number, act)


def _be_asked(*_: object) -> None:
    """Remember that a worker without work was asked to stop."""
    _asked.append(True)


def _end_with_parent() -> None:
    wait_for([parent_process().sentinel])
    if signal.getsignal(signal.SIGINT) is _be_asked:
        os._exit(1)
    os.kill(os.getpid(), signal.SIGINT)
    time.sleep(GRACE)
    os._exit(1)
