"""A window of `ti.GUI`, drawn by the CPU; it works on any display."""

import sys

import numpy as np
import taichi as ti

from lab.view.panel.chooser import Chooser
from lab.view.session import Session
from lab.view.windows.window import Window

# Names that ti.GUI gives to keys, and ours.
NAMES = {
    ti.GUI.SPACE: "space",
    ti.GUI.LEFT: "left",
    ti.GUI.RIGHT: "right",
    ti.GUI.UP: "up",
    ti.GUI.DOWN: "down",
    ti.GUI.ESCAPE: "escape",
    ti.GUI.RETURN: "return",
}
BUTTONS = {ti.GUI.LMB: "left", ti.GUI.RMB: "right"}
A_TURN = 120.0  # the wheel's count per notch


class PlainWindow(Window):
    """The window; it shows the picture and nothing else."""

    types = False

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(size)
        self._window = ti.GUI("Cargo Shift Lab", size, fast_gui=True)

    def close(self) -> None:
        """Close the window."""
        self._window.close()

    def _is_open(self) -> bool:
        return self._window.running

    def _show(self, session: Session | Chooser, picture: np.ndarray) -> None:
        _pack(picture, self._window.img)  # set_image would turn the picture first, and then back
        self._window.core.update()  # show would then clear what is painted over anyway

    def _pass_on(self, session: Session | Chooser) -> None:
        for event in self._window.get_events():
            x, y = event.pos[0] * self._size[0], (1.0 - event.pos[1]) * self._size[1]
            if event.type == ti.GUI.PRESS and event.key in BUTTONS:
                session.press(x, y, BUTTONS[event.key])
            elif event.type == ti.GUI.PRESS:
                session.key(NAMES.get(event.key, str(event.key).lower()))
            elif event.type == ti.GUI.RELEASE and event.key in BUTTONS:
                session.release(x, y)
            elif event.type == ti.GUI.MOTION and event.key == ti.GUI.MOVE:
                session.drag(x, y)
            elif event.type == ti.GUI.MOTION and event.key == ti.GUI.WHEEL:
                session.wheel(event.delta[1] / A_TURN, x, y)


def _pack(picture: np.ndarray, packed: np.ndarray) -> None:
    """Pack pixels into the integers of ti.GUI, 0xffRRGGBB, on macOS 0xffBBGGRR, row by row from the top."""
    channels = packed.view(np.uint8).reshape(*picture.shape[:2], 4)
    for channel, colour in enumerate((0, 1, 2) if sys.platform == "darwin" else (2, 1, 0)):
        channels[..., channel] = picture[..., colour]
    channels[..., 3] = 255


def open_window(size: tuple[int, int]) -> PlainWindow | None:
    """Open the window; None if the display refuses it."""
    try:
        return PlainWindow(size)
    except RuntimeError:
        return None
