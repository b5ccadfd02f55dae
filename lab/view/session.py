"""The user's side of a live experiment: its picture, and the actions of keys, mouse and sliders.

A front end calls `tick`, shows `picture`, and passes on events, in pixels of that picture and names of keys.
"""

import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.video import colours_of
from lab.runs.runner import RENDERS, free_folder
from lab.view.footage import LiveFootage, StaticScene
from lab.view.page import Page
from lab.view.panel.controls import CONTROLS, RESTARTS, offered
from lab.view.panel.curves import offered_curves
from lab.view.shown import Look, Shown
from lab.view.worker import begin
from solvers.grains.shapes.cargo import cargoes

PACES = (0.02, 0.05, 0.1, 0.25, 0.5, 1.0, 2.0, 5.0, np.inf)
NUDGE = np.radians(5.0)  # change of the tilt by a key
CLICK = 4.0  # pixels: a mouse that moves less was not dragged
ZOOM = 1.25
PATIENCE = 5.0  # s to wait for the experiment to end
OVERLAYS = ("nothing", "forces", "velocities")


@dataclass
class Session(Shown):
    """A preset with `overrides`, live in a window of `size` pixels; `types`: the window has a panel to type values.

    Raises LabError if the preset cannot be run.
    """

    name: str
    overrides: dict
    size: tuple[int, int] = (1280, 720)
    out: Path | None = None
    types: bool = False
    ended: bool = field(default=False, init=False)

    def __post_init__(self) -> None:
        from lab.preset.find import load

        preset = load(self.name, self.overrides).resolved
        self.look = Look(preset.video.colour or colours_of(preset.matters)[0], preset.video.frame or "tank")
        self.page = Page(self.size)
        self._grip, self._shape = None, "disc"
        self._restart(self.overrides)

    def _restart(self, overrides: Mapping) -> None:
        """Start again with these overrides and the changes that needed a restart."""
        self.overrides = dict(overrides)
        self.footage, self.values, self._own, self.settling = None, {}, {}, True
        self.going, self.playhead, self.factor, self.over = False, None, 0.0, ""
        self.status = "starting …"
        folder = self.out or RENDERS / "view" / self.name.removesuffix(".toml")
        self.folder = free_folder(folder)
        self._process, self._pipe = begin(self.name, self.overrides, self.folder)

    # Messages from the experiment

    def tick(self) -> None:
        """Process the messages that the experiment has sent."""
        try:
            while not self.over and self._pipe.poll():
                word, what = self._pipe.recv()
                getattr(self, f"_on_{word}")(what)
        except (EOFError, ConnectionResetError):
            self._miss()

    def _miss(self) -> None:
        """End the session: the experiment's process is gone."""
        self.over, self.going = self.over or f"the experiment broke off; {self.left}.", False

    @property
    def left(self) -> str:
        """A sentence on what an experiment that did not end by itself has left behind."""
        return "nothing was recorded yet" if self.settling else f"{self.folder} has what was recorded"

    def _on_message(self, sentence: str) -> None:
        if self.settling:
            self.status = sentence
        else:
            self.say(sentence)

    def _on_settling(self, static: StaticScene) -> None:
        self.footage, self.playhead = LiveFootage(static), None

    def _on_ready(self, what: tuple[StaticScene, dict]) -> None:
        static, own = what
        self.settling = False
        self.footage = LiveFootage(static)
        if self.footage.sea or self.footage.bed.empty:
            self.look.inset = "water" if self.footage.water else "turn"
        self.values = offered(static.preset) | own
        self._own = own
        for name, value in own.items():
            self._send("set", (name, value))
        self._send("pace", self.pace)
        self.go(True)

    def _on_frame(self, what: tuple) -> None:
        frame, self.factor = what
        dropped = self.footage.add(frame)
        if self.playhead is not None:
            self.playhead = max(0, self.playhead - dropped)

    def _on_kept(self, folder: Path) -> None:
        self.say(f"kept in {folder}; its video and summary follow")
        log = (folder / "report.log").open("wb")
        line = [sys.executable, "-m", "lab.view.keep", str(folder)]
        subprocess.Popen(line, stdout=log, stderr=log, start_new_session=True)  # it outlives the terminal

    def _on_over(self, sentence: str) -> None:
        self.over, self.going = sentence, False

    def _send(self, word: str, what: object = None) -> None:
        if not self.over:
            try:
                self._pipe.send((word, what))
            except (BrokenPipeError, ConnectionResetError):
                self._miss()

    # Actions of the user

    def go(self, going: bool) -> None:
        """Run or pause; running returns to the newest frame."""
        self.going = going
        if going:
            self.playhead = None
        self._send("go", going)

    def set(self, name: str, value: float) -> None:
        """Set a control (SI), within its range; a control that needs a restart waits for `restart`."""
        if name not in self.values:
            return
        control = CONTROLS[name]
        value = float(np.clip(value, control.low, control.high))
        self.values[name] = value
        if control.kind == RESTARTS:
            self.say(f"{control.label}: {control.shown(value)} from the next start; press R to start again")
        else:
            self._send("set", (name, value))

    def restart(self) -> None:
        """Start again with the changes that wait for it; the recording so far stays where it is."""
        asked = {
            control.key: control.shown(self.values[name])
            for name, control in CONTROLS.items()
            if control.kind == RESTARTS and name in self.values and self._changed(name)
        }
        self._begin_with({**self.overrides, **asked})

    def reshape(self) -> None:
        """Start again with grains of the next cargo's outlines; discs follow the last cargo."""
        from lab.preset.find import load

        order = ["disc", *cargoes()]
        self._shape = order[(order.index(self._shape) + 1) % len(order)]
        given = dict.fromkeys(load(self.name).resolved.shapes, False)
        how = {"disc": True} if self._shape == "disc" else {"cargo": self._shape}
        others = {key: value for key, value in self.overrides.items() if key != "shapes"}
        changes = {**others, "shapes": {**given, self._shape: how}}
        try:
            load(self.name, changes)
        except LabError as error:
            self.say(str(error))
        else:
            self._begin_with(changes)

    def _begin_with(self, overrides: Mapping) -> None:
        self._end_experiment()
        self._restart(overrides)

    def _changed(self, name: str) -> bool:
        given = offered(self.footage.static.preset).get(name) if self.footage else None
        return given is not None and abs(given - self.values[name]) > 1e-9 * abs(given)

    def keep(self) -> None:
        """Keep the experiment so far in a folder of its own, with video, figures and summary."""
        self._send("keep", free_folder(self.folder.with_name(f"{self.folder.name}-kept")))

    def rewind(self, frames: int) -> None:
        """Pause, and move back or forth by a number of frames."""
        if not self.footage or not len(self.footage):
            return
        if self.going:
            self.go(False)
        last = len(self.footage) - 1
        now = last if self.playhead is None else self.playhead
        wanted = int(np.clip(now + frames, 0, last))
        self.playhead = None if wanted == last else wanted

    def zoom(self, turns: float) -> None:
        """Zoom in, or with negative turns out, about the middle of the view."""
        left, top, right, bottom = self.page.view
        self.wheel(turns, 0.5 * (left + right), 0.5 * (top + bottom))

    def toggle_typing(self) -> None:
        """Switch between the sliders and the window's own panel."""
        self.look.typing = self.types and not self.look.typing

    @property
    def keys(self) -> list[tuple[str, str]]:
        """Names and actions of the keys in this experiment."""
        return [(name, says) for name, (says, _) in KEYS.items() if self.types or name != "p"]

    def key(self, name: str) -> None:
        """Handle a key by its name: a letter, space, left, right, up, down, escape."""
        action = KEYS.get(name)
        if action:
            action[1](self)

    def press(self, x: float, y: float, button: str = "left") -> None:
        """Handle a mouse button pressed at a pixel."""
        slider = self.page.slider_at(x, y)
        centre = self.page.centre_at(self, x, y)
        self._grip = ("slider", slider) if slider else ("centre",) if centre else ("view", button)
        self._start = self._last = (x, y)
        self.drag(x, y)

    def drag(self, x: float, y: float) -> None:
        """Handle a mouse move with the button down."""
        if not self._grip:
            return
        what, (x0, y0) = self._grip[0], self._last
        if what == "slider":
            name = self._grip[1]
            control = CONTROLS[name]
            share = self.page.share_of_slider(name, x)
            self.set(name, control.low + share * (control.high - control.low))
        elif what == "centre":
            y_centre, z_centre = self.page.earth_place(self, x, y)
            self.set("centre_y", y_centre)
            self.set("centre_z", z_centre)
        elif self._grip[1] == "right":
            self.set("tilt", self.values.get("tilt", 0.0) - np.radians(0.2) * (x - x0))
        elif np.hypot(x - self._start[0], y - self._start[1]) > CLICK:
            self.look.pan = (self.look.pan[0] + x - x0, self.look.pan[1] + y - y0)
        self._last = (x, y)

    def release(self, x: float, y: float) -> None:
        """Handle the button's release; a click picks the grain at the pixel."""
        clicked = self._grip == ("view", "left") and np.hypot(x - self._start[0], y - self._start[1]) <= CLICK
        self._grip = None
        if clicked and self.footage and len(self.footage):
            self.look.picked = self.page.grain_at(self, x, y)

    def wheel(self, turns: float, x: float, y: float) -> None:
        """Zoom about the pixel under the mouse."""
        before = self.look.zoom
        self.look.zoom = float(np.clip(before * ZOOM**turns, 0.2, 50.0))
        grown = self.look.zoom / before
        middle = self.page.middle(self) if self.footage else (x, y)
        pan = zip(self.look.pan, (x, y), middle, strict=True)
        self.look.pan = tuple(grown * moved + (1.0 - grown) * (at - half) for moved, at, half in pan)

    def picture(self) -> np.ndarray:
        """The picture (height, width, 3), u8."""
        return self.page.picture(self)

    def close(self) -> None:
        """End the experiment; its recording is complete."""
        self._end_experiment()
        self.ended = True

    def _end_experiment(self) -> None:
        self._send("end")
        if self.settling:  # nothing is recorded yet, and it does not listen before its bed is ready
            self._process.terminate()
        until = time.monotonic() + PATIENCE
        while self._process.is_alive() and time.monotonic() < until:
            try:  # it cannot end before its last messages are received
                while self._pipe.poll(0.02):
                    self._pipe.recv()
            except (EOFError, ConnectionResetError):
                break
        self._process.join(PATIENCE)
        if self._process.is_alive():
            self._process.terminate()
        self._pipe.close()


def _next(words: tuple, now: str) -> str:
    return words[(words.index(now) + 1) % len(words) if now in words else 0]


def _faster(steps: int) -> Callable[[Session], None]:
    def action(session: Session) -> None:
        place = int(np.clip(PACES.index(session.pace) + steps, 0, len(PACES) - 1))
        session.pace = PACES[place]
        session._send("pace", session.pace)

    return action


def _look(name: str, words: Callable[[Session], tuple]) -> Callable[[Session], None]:
    return lambda session: setattr(session.look, name, _next(words(session), getattr(session.look, name)))


def _tilt(nudge: float | None) -> Callable[[Session], None]:
    return lambda session: session.set("tilt", 0.0 if nudge is None else session.values.get("tilt", 0.0) + nudge)


def _calm(session: Session) -> None:
    for name in ("sway", "heave", "roll", "tilt"):
        session.set(name, 0.0)


def _as_preset(session: Session) -> None:
    for name, value in session._own.items():
        session.set(name, value)


def _one_piece(session: Session) -> None:
    if session.going:
        session.go(False)
    session.playhead = None
    session._send("piece")


def _whole(session: Session) -> None:
    session.look.zoom, session.look.pan = 1.0, (0.0, 0.0)


# What each key does, and how the help says it, in its order.
KEYS: dict[str, tuple[str, Callable[[Session], None]]] = {
    "space": ("run or pause", lambda session: session.go(not session.going)),
    "n": ("run one sampling interval", _one_piece),
    "left": ("one picture back", lambda session: session.rewind(-1)),
    "right": ("one picture forward", lambda session: session.rewind(1)),
    "g": ("go to the newest picture", lambda session: setattr(session, "playhead", None)),
    "up": ("faster", _faster(1)),
    "down": ("slower", _faster(-1)),
    "a": ("tilt to port by 5°", _tilt(NUDGE)),
    "d": ("tilt to starboard by 5°", _tilt(-NUDGE)),
    "w": ("hold everything upright and still", _calm),
    "m": ("move as the preset does", _as_preset),
    "c": ("another colouring", _look("colour", lambda session: session.colours)),
    "f": ("frame of the tank or the earth", _look("frame", lambda _: ("tank", "earth"))),
    "o": ("overlay of forces or velocities", _look("overlay", lambda _: OVERLAYS)),
    "i": ("another curve", _look("inset", lambda session: offered_curves(session.footage))),
    "z": ("show everything", _whole),
    "e": ("zoom in", lambda session: session.zoom(1.0)),
    "q": ("zoom out", lambda session: session.zoom(-1.0)),
    "k": ("keep: video and data of this experiment", lambda session: session.keep()),
    "r": ("start again", lambda session: session.restart()),
    "s": ("start again with the grains of another cargo", lambda session: session.reshape()),
    "p": ("a panel to type values in: Ctrl and a click on one", lambda session: session.toggle_typing()),
    "h": ("this help", lambda session: setattr(session.look, "help", not session.look.help)),
    "escape": ("close", lambda session: session.close()),
}
"""What keys do; front ends give their own keys these names."""
