"""The base of all windows: show a session's pictures at their rate and pass on the user's events."""

import time
from abc import ABC, abstractmethod

import numpy as np

from lab.view.panel.chooser import Chooser
from lab.view.session import Session

PICTURES = 30.0  # Hz
LATEST = 0.1  # s; a larger delay of the pictures is not caught up


class Window(ABC):
    """The window of one toolkit; `types`: whether it has a panel to type values in."""

    types: bool

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size

    def run(self, session: Session | Chooser) -> None:
        """Run until the window or the session ends; after a slow picture the next one waits less."""
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
        """Close the window."""

    @abstractmethod
    def _is_open(self) -> bool: ...

    @abstractmethod
    def _pass_on(self, session: Session | Chooser) -> None:
        """Turn the events since the last call into calls of the session."""

    @abstractmethod
    def _show(self, session: Session | Chooser, picture: np.ndarray) -> None:
        """Show the picture (height, width, 3), u8, and the window's own panel for a session."""
