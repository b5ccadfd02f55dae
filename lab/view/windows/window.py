"""What every window does: show a session's pictures at their pace and pass on what a hand does."""

import time
from abc import ABC, abstractmethod

import numpy as np

from lab.view.panel.chooser import Chooser
from lab.view.session import Session

PICTURES = 30.0  # Hz
LATEST = 0.1  # s by which pictures may be late and still be caught up with


class Window(ABC):
    """A front end of one toolkit; `types` where it has a panel to type values in."""

    types: bool

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size

    def run(self, session: Session | Chooser) -> None:
        """Until the window or what it shows ends; a picture that took long is followed by one that waits less."""
        due = time.monotonic()
        while self._is_open() and not session.ended:
            session.tick()
            self._pass_on(session)
            if session.ended:
                break
            self._show(session, session.picture())
            due = max(due + 1.0 / PICTURES, time.monotonic() - LATEST)
            time.sleep(max(0.0, due - time.monotonic()))

    @abstractmethod
    def close(self) -> None:
        """Done with it."""

    @abstractmethod
    def _is_open(self) -> bool: ...

    @abstractmethod
    def _pass_on(self, session: Session | Chooser) -> None:
        """Turn the events since the last time into the session's calls."""

    @abstractmethod
    def _show(self, session: Session | Chooser, picture: np.ndarray) -> None:
        """Show the picture (height, width, 3), u8, and what the window itself has for a session."""
