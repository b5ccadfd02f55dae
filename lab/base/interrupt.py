"""Ctrl-C, SIGTERM and SIGHUP: the first asks the run to save and stop, the second stops it at once.

A signal that is ignored, as SIGHUP is under nohup, stays ignored. Only the main thread can handle signals; in other
threads nothing changes.
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

_received = signal.SIGINT  # the last signal received
_afterwards = signal.SIG_DFL  # the handler of the next signal


def exit_code() -> int:
    """Exit code of a process that ended because of a signal: 128 plus the signal's number."""
    return 128 + _received


def handle_signals(patient: bool = False) -> None:
    """Make the first signal that asks the process to end raise KeyboardInterrupt; the next one ends it at once.

    patient: ignore the next ones, for a process that gets the request from several others.
    """
    global _afterwards, _received
    _afterwards, _received = _ignore if patient else signal.SIG_DFL, signal.SIGINT
    for number in _handlers():
        signal.signal(number, _raise)


@contextmanager
def handling_signals() -> Iterator[None]:
    """`handle_signals` inside this context."""
    before = _handlers()
    handle_signals()
    try:
        yield
    finally:
        _restore(before)


class Interrupt:
    """A context manager in which the first signal sets `asked`; the second meets the handler set before."""

    def __init__(self) -> None:
        self.asked = False
        self._before = _handlers()

    def __enter__(self) -> "Interrupt":
        for number in self._before:
            signal.signal(number, self._receive)
        return self

    def __exit__(self, *_: object) -> None:
        if not self.asked:
            _restore(self._before)

    def _receive(self, number: int, _: FrameType | None) -> None:
        self.asked = True
        _restore({one: _afterwards if act is _raise else act for one, act in self._before.items()})
        _note(number)


def _raise(number: int, _: FrameType | None) -> None:
    _restore(dict.fromkeys(_handlers(), _afterwards))
    _note(number)
    raise KeyboardInterrupt


def _ignore(*_: object) -> None:
    """Do nothing. SIG_IGN will not do: Python complains if a signal is pending when it becomes ignored."""


def _note(number: int) -> None:
    """Remember the signal and restore the terminal: the process may end at once, or the terminal may be gone."""
    global _received
    _received = number
    if number not in (signal.SIGINT, signal.SIGTERM):
        _let_go_of_terminal()
    elif os.isatty(2):
        os.write(2, SHOW_CURSOR)


def _let_go_of_terminal() -> None:
    """Send output to the null device instead of to a closed terminal, where writing would be an error."""
    with suppress(OSError):
        null = os.open(os.devnull, os.O_WRONLY)
        for stream in (1, 2):
            if stat.S_ISCHR(os.fstat(stream).st_mode):
                os.dup2(null, stream)
        os.close(null)


def _handlers() -> dict[int, Callable | int]:
    """The present handler of each signal that this thread can handle and that is not ignored."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    found = {number: signal.getsignal(number) for number in SIGNALS}
    return {number: act for number, act in found.items() if act not in (None, signal.SIG_IGN)}


def _restore(acts: dict[int, Callable | int]) -> None:
    for number, act in acts.items():
        signal.signal(number, act)
