"""What a plug-in may do wrong: raise, or take too long."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

PATIENCE = 60.0  # s that a plug-in may take to load, or for a number


def told(error: BaseException) -> str:
    """What went wrong in a plug-in, in a clause."""
    first = (str(error).strip().splitlines() or [""])[0].removesuffix(".")
    return f"{type(error).__name__}: {first}" if first else type(error).__name__


@contextmanager
def within(seconds: float = PATIENCE) -> Iterator[None]:
    """Raise TimeoutError in what takes longer; in the main thread, and where there are such signals."""
    if threading.current_thread() is not threading.main_thread() or not hasattr(signal, "SIGALRM"):
        yield
        return

    def late(*_: object) -> None:
        raise TimeoutError(f"it took longer than {seconds:g} s")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)
