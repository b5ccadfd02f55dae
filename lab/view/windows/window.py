"""What every window does: show a session's pictures at their pace and pass on what a hand does."""

import time
from abc import ABC, abstractmethod

import taichi as ti

from lab.view.chooser import Chooser
from lab.view.session import Session

PICTURES = 30.0  # Hz


class Window(ABC):
    """A front end of one toolkit; `types` where it has a panel to type values in."""

    types: bool

    def __init__(self, size: tuple[int, int]) -> None:
        self._size = size
        self._shown = ti.Vector.field(3, ti.u8, size)  # the picture, its first row the lowest

    def run(self, session: Session | Chooser) -> None:
        """Until the window or what it shows ends."""
        while self._is_open() and not session.ended:
            begun = time.monotonic()
            session.tick()
            self._pass_on(session)
            if session.ended:
                break
            _turn(session.picture(), self._shown)
            self._show(session)
            time.sleep(max(0.0, 1.0 / PICTURES - (time.monotonic() - begun)))

    @abstractmethod
    def close(self) -> None:
        """Done with it."""

    @abstractmethod
    def _is_open(self) -> bool: ...

    @abstractmethod
    def _pass_on(self, session: Session | Chooser) -> None:
        """Turn the events since the last time into the session's calls."""

    @abstractmethod
    def _show(self, session: Session | Chooser) -> None:
        """Show the picture, and what the window itself has for a session."""


@ti.kernel
def _turn(picture: ti.types.ndarray(dtype=ti.u8, ndim=3), shown: ti.template()):
    """From rows of pixels, the highest first, to columns, the lowest pixel first."""
    for row, column in ti.ndrange(picture.shape[0], picture.shape[1]):
        for c in ti.static(range(3)):
            shown[column, picture.shape[0] - 1 - row][c] = picture[row, column, c]
