"""Colourings: the quantity that a grain's colour shows.

A new colouring takes one function from beds to `Colouring`, one line in MODES, and its name in the COLOURS of the
presets. Matplotlib is imported only with the first picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError
from lab.paint.cargo.looks import looks
from lab.paint.cargo.style import CargoColours, aboard_of
from lab.paint.space.stance import lengths
from lab.preset.sections.video import OF_AIR, OF_BULK, OF_WATER, OF_WET
from lab.recording.contacts.stress import pressures

if TYPE_CHECKING:
    from lab.paint.footage import Bed

SAMPLED_FRAMES = 100  # frames of a bed sampled to set the ends of a scale
FEW = 12  # frames for the scale of what takes time to compute
PERCENTILE = 98.0  # a scale ends at this percentile of the values in the frame where it is largest
LIGHT, DARK = (255.0, 255.0, 255.0), (25.0, 30.0, 40.0)  # spin marks
MOST_LAYERS = 8
# Scales from the grey of what is at rest to a dark colour, so that what moves stands out; lightness falls all along.
EMBERS = (206, 211, 217), (248, 196, 76), (216, 92, 36), (112, 20, 56)
DEEPS = (208, 213, 218), (126, 200, 190), (36, 124, 164), (26, 40, 100)
ORCHID = (210, 212, 218), (228, 156, 194), (152, 64, 152), (66, 20, 88)
APART = (  # of a few kinds, for the colour-blind (Okabe and Ito 2008)
    *((86, 180, 233), (230, 159, 0), (0, 158, 115), (204, 121, 167), (240, 228, 66), (213, 94, 0)),
)
ON_DARK = {  # the same on dark paper, where lightness rises
    "pressure": ((60, 68, 78), (176, 62, 44), (244, 160, 58), (255, 244, 190)),
    "speed": ((60, 68, 78), (176, 62, 44), (244, 160, 58), (255, 244, 190)),
    "displacement": ((60, 68, 78), (34, 116, 150), (96, 200, 188), (226, 252, 240)),
    "spin": ((60, 68, 78), (146, 70, 150), (226, 140, 196), (255, 232, 244)),
}


@dataclass(frozen=True)
class Colouring:
    """A colour scale that is fixed through the film, and the value of each grain on it.

    label: with its unit; low, high: ends of the scale; table: its colours (k, 3) in 0..255;
    values: function from bed and frame to numbers (n,); ticks: positions and texts (None: round numbers);
    look: of cargo in its own colours, of which the table has one each.
    """

    label: str
    low: float
    high: float
    table: np.ndarray
    values: Callable[[Bed, int], np.ndarray]
    ticks: dict[float, str] | None = field(default=None)
    look: CargoColours | None = None

    def shares(self, bed: Bed, frame: int) -> np.ndarray:
        """How far along the scale the values (n,) are, 0 to 1 on it."""
        return (self.values(bed, frame) - self.low) / (self.high - self.low)

    def colours(self, bed: Bed, frame: int) -> np.ndarray:
        """Colours (n, 3) of the grains in 0..255."""
        if self.look:
            return self.look.colours(bed, frame)
        index = np.nan_to_num(self.shares(bed, frame) * len(self.table))
        return self.table[np.clip(index, 0, len(self.table) - 1).astype(int)]

    def style(self, bed: Bed, colour: np.ndarray) -> tuple:
        """The rest that `paint_grains` needs of grains of this colour (n, 3): marks, edges and finish."""
        if self.look:
            return self.look.marks(bed), bed.edges, self.look.finish(bed)
        return mark_colours(colour), bed.edges, None


def cargo(beds: Sequence[Bed]) -> Colouring:
    """The cargo as it looks; the table has a colour for each of those aboard."""
    look = CargoColours(beds)
    own = np.array([looks()[name].colour for name in look.names], dtype=float)

    def values(bed: Bed, frame: int) -> np.ndarray:
        number = {name: k + 0.5 for k, name in enumerate(look.names)}
        return np.array([number[name] for name in aboard_of(bed)])

    ticks = {k + 0.5: name.replace("-", " ") for k, name in enumerate(look.names)}
    return Colouring("cargo", 0.0, len(look.names), own, values, ticks, look)


def speed(beds: Sequence[Bed]) -> Colouring:
    """|v| relative to the tank."""
    top = round_up(max(_largest(beds, lambda bed, frame: bed.speed(frame)), beds[0].diameter))
    factor, unit = (1.0, "m/s") if top >= 1.0 else (1000.0, "mm/s")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * bed.speed(frame)

    return Colouring(f"speed in the tank ({unit})", 0.0, factor * top, ramp(EMBERS), values)


def spin(beds: Sequence[Bed]) -> Colouring:
    """|ω| relative to the tank, in turns a second."""

    def values(bed: Bed, frame: int) -> np.ndarray:
        return np.abs(bed.spin(frame)) / (2 * np.pi)

    top = round_up(max(_largest(beds, values), 0.1))
    return Colouring("spin in the tank (turns a second)", 0.0, top, ramp(ORCHID), values)


def displacement(beds: Sequence[Bed]) -> Colouring:
    """Distance from the position in the first frame, in mean grain diameters."""
    starts = {bed: bed.position(0) for bed in beds}

    def values(bed: Bed, frame: int) -> np.ndarray:
        return lengths(bed.position(frame) - starts[bed]) / bed.diameter

    top = round_up(max(_largest(beds, values), 1.0))
    return Colouring("displacement (diameters)", 0.0, top, ramp(DEEPS), values)


def pressure(beds: Sequence[Bed]) -> Colouring:
    """Mean pressure in each grain, of the elastic forces on it."""

    def pressed(bed: Bed, frame: int) -> np.ndarray:
        near = round(float(frame))
        return pressures(bed.pressing(near), bed.position(near), bed.radius)

    top = round_up(max(_largest(beds, pressed, FEW), 1e-3))
    factor, unit = (1e-6, "MPa") if top >= 1e6 else (1e-3, "kPa") if top >= 1e3 else (1.0, "Pa")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * pressed(bed, frame)

    return Colouring(f"pressure in grains ({unit})", 0.0, factor * top, ramp(EMBERS), values)


def layer(beds: Sequence[Bed]) -> Colouring:
    """Height over the lowest grain in the first frame, in bands of a whole number of mean grain diameters."""
    bottoms = {bed: bed.position(0)[:, 1] - bed.radius for bed in beds}
    heights = {bed: (low + bed.radius - np.nanmin(low)) / bed.diameter for bed, low in bottoms.items()}
    depth = max(np.nanmax(height) for height in heights.values())
    band = max(1, int(np.ceil(depth / MOST_LAYERS)))
    count = max(2, int(np.ceil(depth / band)))

    def values(bed: Bed, frame: int) -> np.ndarray:
        return np.floor(heights[bed] / band) + 0.5

    ticks = {k + 0.5: str(k + 1) for k in range(count)}
    wide = "1 diameter" if band == 1 else f"{band} diameters"
    return Colouring(f"starting layer ({wide})", 0.0, count, table("viridis", count), values, ticks)


def size(beds: Sequence[Bed]) -> Colouring:
    """Diameter, from the smallest grain to the largest."""
    radius = np.concatenate([bed.radius for bed in beds])
    low, high = 2e3 * radius.min(), 2e3 * radius.max()
    if high - low < 1e-3 * high:  # all equal: use any scale around the value
        low, high = 0.9 * high, 1.1 * high

    def values(bed: Bed, frame: int) -> np.ndarray:
        return 2e3 * bed.radius

    return Colouring("diameter (mm)", low, high, table("cividis"), values)


def kind(beds: Sequence[Bed]) -> Colouring:
    """The kinds of grains in the preset."""
    return _named("kind of grain", beds[0].footage.kinds, lambda bed: bed.footage.kind[bed.world])


def shape(beds: Sequence[Bed]) -> Colouring:
    """The classes of outlines in the preset."""
    return _named("shape", beds[0].footage.shape_names, lambda bed: bed.shape)


MODES: dict[str, Callable[[Sequence[Bed]], Colouring]] = {
    "cargo": cargo,
    "speed": speed,
    "displacement": displacement,
    "pressure": pressure,
    "layer": layer,
    "size": size,
    "kind": kind,
    "shape": shape,
    "spin": spin,
}


def colouring(name: str, beds: Sequence[Bed], dark: bool = False) -> Colouring | None:
    """The colouring of that name, one scale for all beds, None without grains; raises LabError for an unknown one.

    dark: for dark paper. Where the name is one of a colour of water, grains look like their cargo.
    """
    if name not in MODES and name not in (*OF_WATER, *OF_AIR, *OF_WET, *OF_BULK):
        raise LabError(f"Unknown colour '{name}': choose one of {', '.join(MODES)}.")
    filled = [bed for bed in beds if not bed.empty]
    found = MODES.get(name, cargo)(filled) if filled else None
    return replace(found, table=ramp(ON_DARK[name])) if found and dark and name in ON_DARK else found


def mark_colours(colours: np.ndarray) -> np.ndarray:
    """Spin marks (n, 3): light on dark grains, dark on light ones (luma of ITU-R BT.709)."""
    luma = colours @ np.array([0.2126, 0.7152, 0.0722])
    return np.where(luma[:, None] < 120.0, LIGHT, DARK)


def bed_colours(count: int) -> list[tuple[int, int, int]]:
    """Colours for the names and curves of `count` beds, in a perceptual order."""
    from matplotlib import colormaps

    shades = colormaps["turbo"](np.linspace(0.05, 0.95, count))[:, :3]
    return [tuple(int(205 * part) for part in shade) for shade in shades]  # darkened for white paper


def _named(label: str, names: Sequence[str], number: Callable[[Bed], np.ndarray]) -> Colouring:
    """A colour for each of these names; `number` gives the index of each grain's name."""

    def values(bed: Bed, frame: int) -> np.ndarray:
        return number(bed) + 0.5

    ticks = {k + 0.5: name for k, name in enumerate(names)}
    apart = np.array(APART, dtype=float)[: len(names)] if len(names) <= len(APART) else table("viridis", len(names))
    return Colouring(label, 0.0, len(names), apart, values, ticks)


def _largest(beds: Sequence[Bed], values: Callable[[Bed, int], np.ndarray], frames: int = SAMPLED_FRAMES) -> float:
    """The largest value of PERCENTILE over all sampled frames; 0 if no grain is left."""
    samples = [values(bed, frame) for bed, frame in spread(beds, frames)]
    finite = [sample[np.isfinite(sample)] for sample in samples]
    return max((float(np.percentile(sample, PERCENTILE)) for sample in finite if len(sample)), default=0.0)


def spread(beds: Sequence[Bed], frames: int = SAMPLED_FRAMES) -> Iterator[tuple[Bed, int]]:
    """Frames spread evenly over each bed's film, ordered by time across the beds, which suits the file's layout."""
    for share in np.linspace(0, 1, frames):
        yield from ((bed, round(share * (bed.frames - 1))) for bed in beds)


def table(name: str, size: int = 256, low: float = 0.06) -> np.ndarray:
    """One of matplotlib's perceptually uniform colour maps without its first part `low`, (size, 3) in 0..255."""
    from matplotlib import colormaps

    return 255.0 * colormaps[name](np.linspace(low, 0.98, size))[:, :3]


def ramp(stops: Sequence[tuple], size: int = 256) -> np.ndarray:
    """Colours (size, 3) in 0..255 that run evenly through these stops."""
    places = np.linspace(0.0, 1.0, len(stops))
    return np.column_stack([np.interp(np.linspace(0.0, 1.0, size), places, part) for part in np.array(stops).T])


def round_up(value: float) -> float:
    """The smallest round number that is not below `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(step for step in (1, 1.5, 2, 3, 4, 5, 6, 8, 10) if step >= value / power - 1e-9))
