"""Ctrl-C in a run: the first asks the run to stop where it can be saved, the second stops it at once."""

import signal
import threading


class Interrupt:
    """A context manager in which Ctrl-C sets `asked`, and a second one acts as it did before.

    Only the main thread can hear Ctrl-C; elsewhere, and where the system has it ignored, nothing changes.
    """

    def __init__(self) -> None:
        self.asked = False
        self._before = signal.getsignal(signal.SIGINT)
        main = threading.current_thread() is threading.main_thread()
        self._hears = main and self._before not in (None, signal.SIG_IGN)

    def __enter__(self) -> "Interrupt":
        if self._hears:
            signal.signal(signal.SIGINT, self._hear)
        return self

    def __exit__(self, *_: object) -> None:
        if self._hears:
            signal.signal(signal.SIGINT, self._before)

    def _hear(self, *_: object) -> None:
        self.asked = True
        signal.signal(signal.SIGINT, self._before)
