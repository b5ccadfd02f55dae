"""Front ends: each shows the pictures of a session and turns a window's events into calls of the session."""

import os
import sys
from pathlib import Path

from lab.base.errors import LabError
from lab.view.panel.chooser import Chooser
from lab.view.session import Session
from lab.view.windows import ggui, plain
from lab.view.windows.window import Window

FRONT_ENDS = {"ggui": ggui, "gui": plain}  # in the order in which they are tried


def open_window(
    name: str | None, overrides: dict, size: tuple[int, int], out: Path | None = None, front_end: str = "auto"
) -> Path | None:
    """Show a preset live until its window is closed; returns the folder of the last recording, None without one.

    Without a name, the user chooses a preset first, and another one when that is closed. Raises LabError if there is no
    display; its message names a command that needs none.
    """
    instead = f"`cargolab run {name or 'PRESET'}` runs it and films it."
    if not has_display():
        raise LabError(f"there is no display for a window here: {instead}")
    from solvers.machine.runtime import initialise

    initialise(fields=False)
    tried = FRONT_ENDS if front_end == "auto" else {front_end: FRONT_ENDS[front_end]}
    window = next(filter(None, (module.open_window(size) for module in tried.values())), None)
    if window is None:
        raise LabError(f"no window can be opened on this display: {instead}")
    try:
        if name:
            return _show(window, name, overrides, size, out)
        folder = None
        while chosen := _choose(window, size):
            folder = _show(window, chosen, overrides, size, out) or folder
        return folder
    finally:
        window.close()


def _choose(window: Window, size: tuple[int, int]) -> str:
    chooser = Chooser(size)
    window.run(chooser)
    return chooser.chosen


def _show(window: Window, name: str, overrides: dict, size: tuple[int, int], out: Path | None) -> Path | None:
    session = Session(name, overrides, size, out, types=window.types)
    try:
        window.run(session)
    except KeyboardInterrupt:
        raise KeyboardInterrupt(f"interrupted; {session.left}.") from None
    finally:
        if not session.ended:
            session.close()
    return None if session.settling else session.folder


def has_display() -> bool:
    """Whether windows can be opened: X11 or Wayland is there, or the system always has a display."""
    return sys.platform in ("win32", "darwin") or bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))
