"""How a film looks, as the user chooses it, and which beds it shows."""

import math
from dataclasses import asdict, dataclass, fields, replace

import numpy as np

from lab.base.errors import LabError
from lab.paint.footage import Bed, Footage
from lab.preset.fields import taken_of
from lab.preset.reader import read
from lab.preset.sections.video import OF_SPACE, Video, check_viewpoint, colours_of
from lab.preset.units import quoted

WORDS = {name: taken_of(Video)[name].words for name in ("frame", "theme", "overlay", "inset", "cargo")}
SMALLEST, LARGEST = (180, 180), (7680, 4320)  # pixels
LONG = 5.5  # width over height of a tank whose surface is shown larger
LEAST_SIDE = 320  # pixels, of the longer side
MOVES = 1e-6  # m, rad: a tank that moves by less stands still


@dataclass(frozen=True)
class Look:
    """The user's choices: size in pixels, colour, frame and others by name, playback speed (1: real time).

    Of scenes in space, None by default: azimuth, elevation (rad), turns in an orbit, cut and slice (m).
    """

    width: int
    height: int
    colour: str
    frame: str
    speed: float
    cargo: str | None = None
    theme: str = "light"
    overlay: str = "none"
    inset: str | None = None
    azimuth: float | None = None
    elevation: float | None = None
    orbit: float | None = None
    cut: float | None = None
    slice: float | None = None


def choose_look(footage: Footage, **options: object) -> Look:
    """The look from the `options` that are not None, else the preset's [video]; raises LabError."""
    wanted = {key: _in_si(key, value) for key, value in options.items() if value is not None}
    chosen = {**asdict(footage.settings), **wanted}
    look = Look(**{field.name: chosen[field.name] for field in fields(Look)})
    words = colours_of(footage.matters)
    look = look if look.colour else replace(look, colour=words[0])
    if look.frame is None:
        poses = footage.space.stance if footage.space else footage.pose
        moves = np.ptp(poses, axis=0).max() > MOVES
        look = replace(look, frame="earth" if moves else "tank")
    if look.inset is None:
        look = replace(look, inset="surface" if _is_flume(footage) else "none")
    _check_size(look)
    check_viewpoint(look, footage.space is not None, footage.matters)
    if look.colour not in words:
        raise LabError(f"Unknown colour '{quoted(str(look.colour))[1:-1]}': choose one of {', '.join(words)}.")
    for name, known in WORDS.items():
        value = getattr(look, name)
        if value not in known and not (name == "cargo" and value is None):
            raise LabError(f"Unknown {name} '{quoted(str(value))[1:-1]}': choose one of {', '.join(known)}.")
    if not isinstance(look.speed, int | float) or not 0 < look.speed < math.inf:
        raise LabError(f"The playback speed {quoted(look.speed)} cannot be used: choose one above 0.")
    return look


def _in_si(name: str, value: object) -> object:
    """What a user asks for; of a scene in space a quantity such as "30 deg", by the key's own unit and range."""
    asked = name in OF_SPACE and isinstance(value, str)
    return getattr(read(Video, {name: value}, "video"), name) if asked else value


def _is_flume(footage: Footage) -> bool:
    """Whether a recording is of one long low tank ashore with water."""
    wide, high = np.ptp(footage.outline, axis=0)
    return bool(footage.water and not footage.space and not footage.sea and footage.worlds == 1 and wide > LONG * high)


def _check_size(look: Look) -> None:
    pairs = zip((look.width, look.height), SMALLEST, LARGEST, strict=True)
    fits = all(isinstance(size, int) and size % 2 == 0 and low <= size <= high for size, low, high in pairs)
    if not fits or max(look.width, look.height) < LEAST_SIDE:
        raise LabError(
            f"Pictures of {quoted(look.width)} x {quoted(look.height)} pixels cannot be filmed: width and height must "
            f"be even, {SMALLEST[1]} at least, one of them {LEAST_SIDE}, and {LARGEST[0]} x {LARGEST[1]} at most."
        )


def choose_beds(footage: Footage, world: int | None = None) -> list[Bed]:
    """The beds of a recording, or only number `world`, counted from 0; raises LabError."""
    if world is not None and not 0 <= world < footage.worlds:
        last = footage.worlds - 1
        raise LabError(f"There is no world {world} in this recording: choose 0 to {last}.")
    worlds = range(footage.worlds) if world is None else [world]
    return [Bed(footage, k, f"bed {k + 1}" if footage.worlds > 1 else "") for k in worlds]
