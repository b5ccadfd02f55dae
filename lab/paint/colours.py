"""Colourings: the quantity that a grain's colour shows.

A new colouring takes one function from beds to `Colouring`, one line in MODES, and its name in the COLOURS of the
presets. Matplotlib is imported only with the first picture.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.video import OF_AIR, OF_WATER

if TYPE_CHECKING:
    from lab.paint.footage import Bed

SAMPLED_FRAMES = 100  # frames of a bed sampled to set the ends of a scale
PERCENTILE = 98.0  # a scale ends at this percentile of the values in the frame where it is largest
LIGHT, DARK = (255.0, 255.0, 255.0), (25.0, 30.0, 40.0)  # spin marks
MOST_LAYERS = 8


@dataclass(frozen=True)
class Colouring:
    """A colour scale that is fixed through the film, and the value of each grain on it.

    label: with its unit; low, high: ends of the scale; table: its colours (k, 3) in 0..255;
    values: function from bed and frame to numbers (n,); ticks: positions and texts (None: round numbers).
    """

    label: str
    low: float
    high: float
    table: np.ndarray
    values: Callable[[Bed, int], np.ndarray]
    ticks: dict[float, str] | None = field(default=None)

    def shares(self, bed: Bed, frame: int) -> np.ndarray:
        """How far along the scale the values (n,) are, 0 to 1 on it."""
        return (self.values(bed, frame) - self.low) / (self.high - self.low)

    def colours(self, bed: Bed, frame: int) -> np.ndarray:
        """Colours (n, 3) of the grains in 0..255."""
        index = np.nan_to_num(self.shares(bed, frame) * len(self.table))
        return self.table[np.clip(index, 0, len(self.table) - 1).astype(int)]


def speed(beds: Sequence[Bed]) -> Colouring:
    """|v| relative to the tank."""
    top = round_up(max(_largest(beds, lambda bed, frame: bed.speed(frame)), beds[0].diameter))
    factor, unit = (1.0, "m/s") if top >= 1.0 else (1000.0, "mm/s")

    def values(bed: Bed, frame: int) -> np.ndarray:
        return factor * bed.speed(frame)

    return Colouring(f"speed in the tank ({unit})", 0.0, factor * top, table("viridis"), values)


def spin(beds: Sequence[Bed]) -> Colouring:
    """|ω| relative to the tank, in turns a second."""

    def values(bed: Bed, frame: int) -> np.ndarray:
        return np.abs(bed.spin(frame)) / (2 * np.pi)

    top = round_up(max(_largest(beds, values), 0.1))
    return Colouring("spin in the tank (turns a second)", 0.0, top, table("magma", low=0.3), values)


def displacement(beds: Sequence[Bed]) -> Colouring:
    """Distance from the position in the first frame, in mean grain diameters."""
    starts = {bed: bed.position(0) for bed in beds}

    def values(bed: Bed, frame: int) -> np.ndarray:
        moved = bed.position(frame) - starts[bed]
        return np.hypot(*moved.T) / bed.diameter

    top = round_up(max(_largest(beds, values), 1.0))
    return Colouring("displacement (diameters)", 0.0, top, table("plasma"), values)


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
    "speed": speed,
    "displacement": displacement,
    "layer": layer,
    "size": size,
    "kind": kind,
    "shape": shape,
    "spin": spin,
}


def colouring(name: str, beds: Sequence[Bed]) -> Colouring | None:
    """The colouring of that name, one scale for all beds, None without grains; raises LabError for an unknown one.

    Where the name is one of a colour of water, grains show their speed.
    """
    if name not in MODES and name not in (*OF_WATER, *OF_AIR):
        raise LabError(f"Unknown colour '{name}': choose one of {', '.join(MODES)}.")
    filled = [bed for bed in beds if not bed.empty]
    return MODES.get(name, speed)(filled) if filled else None


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
    return Colouring(label, 0.0, len(names), table("viridis", len(names)), values, ticks)


def _largest(beds: Sequence[Bed], values: Callable[[Bed, int], np.ndarray]) -> float:
    """The largest value of PERCENTILE over all sampled frames; 0 if no grain is left."""
    samples = [values(bed, frame) for bed, frame in spread(beds)]
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


def round_up(value: float) -> float:
    """The smallest round number that is not below `value`."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(step for step in (1, 1.5, 2, 3, 4, 5, 6, 8, 10) if step >= value / power - 1e-9))
