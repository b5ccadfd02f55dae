"""Ctrl-C, SIGTERM and SIGHUP: the first asks to stop where all can be saved, a second one stops at once.

A signal that is ignored, as SIGHUP is under nohup, stays ignored. Only the main thread can hear signals; elsewhere
nothing changes.
"""

import os
import signal
import stat
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType

SIGNALS = tuple(getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name))
SHOW_CURSOR = b"\x1b[?25h"

_heard = signal.SIGINT  # the last one
_afterwards = signal.SIG_DFL  # what the next one is to do


def exit_code() -> int:
    """Of a process that has ended since it was asked to: 128 and the number of the signal."""
    return 128 + _heard


def heed(patient: bool = False) -> None:
    """Have all signals that ask a process to end raise KeyboardInterrupt, once; the next one ends it at once.

    patient: nothing comes of the next ones, for a process that is asked by several others.
    """
    global _afterwards, _heard
    _afterwards, _heard = _ignore if patient else signal.SIG_DFL, signal.SIGINT
    for number in _audible():
        signal.signal(number, _raise)


@contextmanager
def heeding() -> Iterator[None]:
    """`heed` while this lasts."""
    before = _audible()
    heed()
    try:
        yield
    finally:
        _restore(before)


class Interrupt:
    """A context manager in which the first signal sets `asked`; a second one acts as it did before, or ends at once."""

    def __init__(self) -> None:
        self.asked = False
        self._before = _audible()

    def __enter__(self) -> "Interrupt":
        for number in self._before:
            signal.signal(number, self._hear)
        return self

    def __exit__(self, *_: object) -> None:
        if not self.asked:
            _restore(self._before)

    def _hear(self, number: int, _: FrameType | None) -> None:
        self.asked = True
        _restore({one: _afterwards if act is _raise else act for one, act in self._before.items()})
        _note(number)


def _raise(number: int, _: FrameType | None) -> None:
    _restore(dict.fromkeys(_audible(), _afterwards))
    _note(number)
    raise KeyboardInterrupt


def _ignore(*_: object) -> None:
    """Not SIG_IGN: Python complains of signals that wait while they become ignored."""


def _note(number: int) -> None:
    """Remember the signal, and leave the terminal in order: the process may end at once, or has lost it."""
    global _heard
    _heard = number
    if number not in (signal.SIGINT, signal.SIGTERM):
        _let_go_of_terminal()
    elif os.isatty(2):
        os.write(2, SHOW_CURSOR)


def _let_go_of_terminal() -> None:
    """What is said from now on goes nowhere, where it would go to a terminal that is closed and be an error there."""
    with suppress(OSError):
        nowhere = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            if stat.S_ISCHR(os.fstat(stream).st_mode):
                os.dup2(nowhere, stream)
        os.close(nowhere)


def _audible() -> dict[int, Callable | int]:
    """What each signal does now that this thread can hear and that is not ignored."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    found = {number: signal.getsignal(number) for number in SIGNALS}
    return {number: act for number, act in found.items() if act not in (None, signal.SIG_IGN)}


def _restore(acts: dict[int, Callable | int]) -> None:
    for number, act in acts.items():
        signal.signal(number, act)
