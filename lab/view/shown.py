"""The data for a picture of a live experiment: its frames so far, and how they are shown."""

import time
from dataclasses import dataclass

from lab.preset.sections.video import colours_of
from lab.recording.ship_end import End, end_of
from lab.view.footage import LiveFootage
from solvers.machine.quantity import ROLL

SHOWN_FOR = 6.0  # s; how long a message is shown


@dataclass
class Look:
    """How the experiment is shown; `pan` in pixels."""

    colour: str
    frame: str
    zoom: float = 1.0
    pan: tuple[float, float] = (0.0, 0.0)
    overlay: str = "nothing"
    inset: str = "shift"
    picked: int | None = None
    help: bool = False
    typing: bool = False  # the window's own panel is shown instead of the sliders


class Shown:
    """An experiment as it is shown.

    values: its controls as the user has set them (SI); playhead: the frame shown, None for the newest; pace: the
    requested speed over real time, factor: the speed reached; settling: whether its bed is still settling, status: how
    far that is; over: how it ended; keys: names and actions of the keys.
    """

    name: str
    look: Look
    values: dict[str, float]
    keys: list[tuple[str, str]]
    footage: LiveFootage | None = None
    going: bool = False
    settling: bool = True
    playhead: int | None = None
    pace: float = 1.0
    factor: float = 0.0
    status: str = ""
    over: str = ""
    _said: tuple[str, float] = "", 0.0

    @property
    def curve(self) -> str:
        """The name of the curve that is drawn; while a bed settles, its kinetic energy."""
        return "energy" if self.settling else self.look.inset

    def say(self, sentence: str) -> None:
        """Show a sentence for some seconds."""
        self._said = sentence, time.monotonic()

    @property
    def said(self) -> str:
        """The sentence to show now."""
        sentence, when = self._said
        return self.over or (sentence if time.monotonic() - when < SHOWN_FOR else "")

    @property
    def lost(self) -> End | None:
        """How the ship was lost, if she is lost in the frame shown."""
        if self.settling or not self.footage or not self.footage.sea:
            return None
        names = ("capsized", "flooded", *(("sunk",) if self.footage.leaks else ()))
        capsized, flooded, *sunk = (self.footage.row(self.frame, name) for name in names)
        return end_of(capsized, flooded, self.footage.row(self.frame, "pose")[ROLL], *sunk)

    @property
    def colours(self) -> tuple[str, ...]:
        """The colourings of what the tank holds."""
        return colours_of(self.footage.matters if self.footage else ())

    @property
    def frame(self) -> int:
        """The number of the frame shown."""
        return len(self.footage) - 1 if self.playhead is None else min(self.playhead, len(self.footage) - 1)
