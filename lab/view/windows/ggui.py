"""A window of Taichi's GGUI, with imgui's panel on demand. It needs Vulkan, in hardware or in software."""

import contextlib
import tempfile

import numpy as np
import taichi as ti

from lab.view.panel.chooser import Chooser
from lab.view.panel.controls import CONTROLS, RESTARTS
from lab.view.session import Session
from lab.view.windows.window import Window

NAMES = {
    ti.ui.SPACE: "space",
    ti.ui.LEFT: "left",
    ti.ui.RIGHT: "right",
    ti.ui.UP: "up",
    ti.ui.DOWN: "down",
    ti.ui.ESCAPE: "escape",
    ti.ui.RETURN: "return",
}
BUTTONS = {ti.ui.LMB: "left", ti.ui.RMB: "right"}
# Width of imgui's panel, height of a row, height of its frame (pixels): imgui's font does not scale with the window.
PANEL, ROW, FRAME = 440, 23, 36


class VulkanWindow(Window):
    """The window; on demand imgui's sliders, in which numbers can be typed, replace those of the picture."""

    types = True

    def __init__(self, size: tuple[int, int]) -> None:
        super().__init__(size)
        self._shown = ti.Vector.field(3, ti.u8, size)  # the picture, its first row the lowest
        self._window = ti.ui.Window("Cargo Shift Lab", size, vsync=False)
        self._canvas, self._gui = self._window.get_canvas(), self._window.get_gui()
        self._held: str | None = None
        # imgui writes the layout of its panels to the working folder, which is the user's: use another one.
        self._scratch = tempfile.TemporaryDirectory()

    def close(self) -> None:
        """Close the window."""
        with contextlib.chdir(self._scratch.name):
            self._window.destroy()
        self._scratch.cleanup()

    def _is_open(self) -> bool:
        return self._window.running

    def _show(self, session: Session | Chooser, picture: np.ndarray) -> None:
        _turn(picture, self._shown)
        self._canvas.set_image(self._shown)
        if self._is_typing(session):
            self._panel(session)
        with contextlib.chdir(self._scratch.name):
            self._window.show()

    @staticmethod
    def _is_typing(session: Session | Chooser) -> bool:
        return isinstance(session, Session) and session.look.typing and not session.look.help

    def _panel(self, session: Session) -> None:
        """Show one slider per control, in its unit."""
        (width, height), (top, _) = self._size, session.page.controls
        tall = (ROW * len(session.values) + FRAME) / height
        with self._gui.sub_window("values", 1.0 - PANEL / width, top / height, PANEL / width, tall):
            for name in list(session.values):
                control, value = CONTROLS[name], session.values[name]
                scale = control.scale
                unit = "" if control.unit == "1" else f" ({control.unit})"
                label = f"{control.label}{unit}" + ("*" if control.kind == RESTARTS else "")
                shown = self._gui.slider_float(
                    f"{label}##{name}", value / scale, control.low / scale, control.high / scale
                )
                if abs(shown - value / scale) > 1e-5 * (control.high - control.low) / scale:
                    session.set(name, shown * scale)

    def _pass_on(self, session: Session | Chooser) -> None:
        x, y = self._cursor()
        for event in self._window.get_events(ti.ui.PRESS):
            if event.key in BUTTONS:
                if not self._is_typing(session) or x < self._size[0] - PANEL:  # else it is imgui's
                    self._held = event.key
                    session.press(x, y, BUTTONS[event.key])
            else:
                session.key(NAMES.get(event.key, str(event.key).lower()))
        for event in self._window.get_events(ti.ui.RELEASE):
            if event.key == self._held:
                self._held = None
                session.release(x, y)
        if self._held:
            session.drag(x, y)

    def _cursor(self) -> tuple[float, float]:
        across, up = self._window.get_cursor_pos()
        return across * self._size[0], (1.0 - up) * self._size[1]


@ti.kernel
def _turn(picture: ti.types.ndarray(dtype=ti.u8, ndim=3), shown: ti.template()):
    """Convert rows of pixels, the top row first, to columns, the bottom pixel first."""
    for column in range(picture.shape[1]):
        for row in range(picture.shape[0]):
            for c in ti.static(range(3)):
                shown[column, picture.shape[0] - 1 - row][c] = picture[row, column, c]


def open_window(size: tuple[int, int]) -> VulkanWindow | None:
    """Open the window; None if there is no Vulkan."""
    try:
        return VulkanWindow(size)
    except Exception:  # Taichi passes on many kinds of errors: no loader, no device, no surface
        return None
