"""What the colour of a grain says.

A new way to colour takes one function from footage to `Colouring` and one line in MODES.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import matplotlib
import numpy as np

from lab.errors import LabError
from lab.paint.footage import Footage

LOOKED_AT = 100  # frames looked at to fix a scale
LIGHT, DARK = (255.0, 255.0, 255.0), (25.0, 30.0, 40.0)  # spin marks


@dataclass(frozen=True)
class Colouring:
    """A scale that stays the same through the film, and a number on it for each grain.

    label: with its unit; low, high: ends of the scale; table: its colours (k, 3) in 0..255;
    values: from frame and world to numbers (n,); ticks: places and texts (None: round numbers).
    """

    label: str
    low: float
    high: float
    table: np.ndarray
    values: Callable[[int, int], np.ndarray]
    ticks: dict[float, str] | None = field(default=None)

    def colours(self, frame: int, world: int) -> np.ndarray:
        """Colours (n, 3) of the grains in 0..255."""
        share = (self.values(frame, world) - self.low) / (self.high - self.low)
        index = np.nan_to_num(share * len(self.table))
        return self.table[np.clip(index, 0, len(self.table) - 1).astype(int)]


def speed(footage: Footage) -> Colouring:
    """|v| relative to the tank; the scale ends at the 98th percentile of the liveliest frame."""
    looks = [
        np.nanpercentile(footage.speed(frame, world), 98)
        for frame in _spread(footage)
        for world in range(footage.worlds)
    ]
    top = _round_up(max(*looks, footage.diameter))
    factor, unit = (1.0, "m/s") if top >= 1.0 else (1000.0, "mm/s")

    def values(frame: int, world: int) -> np.ndarray:
        return factor * footage.speed(frame, world)

    return Colouring(f"speed in the tank ({unit})", 0.0, factor * top, _table("viridis"), values)


def displacement(footage: Footage) -> Colouring:
    """Distance from the place in the first frame, in mean grain diameters."""
    starts = [footage.position(0, world) for world in range(footage.worlds)]

    def values(frame: int, world: int) -> np.ndarray:
        moved = footage.position(frame, world) - starts[world]
        return np.hypot(*moved.T) / footage.diameter

    looks = [
        np.nanpercentile(values(frame, world), 98) for frame in _spread(footage) for world in range(footage.worlds)
    ]
    top = _round_up(max(*looks, 1.0))
    return Colouring("displacement (diameters)", 0.0, top, _table("plasma"), values)


def layer(footage: Footage, most: int = 8) -> Colouring:
    """Height in the first frame, in bands of a whole number of mean grain diameters."""
    floor = footage.outline[:, 1].min()
    heights = [footage.position(0, world)[:, 1] - floor for world in range(footage.worlds)]
    depth = max(np.nanmax(height) for height in heights)
    thickness = max(1, int(np.ceil(depth / footage.diameter / most)))
    band = thickness * footage.diameter
    count = max(2, int(np.ceil(depth / band)))

    def values(frame: int, world: int) -> np.ndarray:
        return np.floor(heights[world] / band) + 0.5

    ticks = {k + 0.5: str(k + 1) for k in range(count)}
    wide = "1 diameter" if thickness == 1 else f"{thickness} diameters"
    return Colouring(f"starting layer ({wide})", 0.0, count, _table("viridis", count), values, ticks)


MODES: dict[str, Callable[[Footage], Colouring]] = {
    "speed": speed,
    "displacement": displacement,
    "layer": layer,
}


def colouring(name: str, footage: Footage) -> Colouring:
    """The colouring of that name; raises LabError for an unknown one."""
    if name not in MODES:
        raise LabError(f"Unknown colour '{name}': choose one of {', '.join(MODES)}.")
    return MODES[name](footage)


def mark_colours(colours: np.ndarray) -> np.ndarray:
    """Spin marks (n, 3): light on dark grains, dark on light ones (luma of ITU-R BT.709)."""
    luma = colours @ np.array([0.2126, 0.7152, 0.0722])
    return np.where(luma[:, None] < 120.0, LIGHT, DARK)


def _spread(footage: Footage) -> np.ndarray:
    """Frames spread evenly over the film."""
    count = len(footage.time)
    return np.unique(np.linspace(0, count - 1, min(count, LOOKED_AT)).astype(int))


def _table(name: str, size: int = 256) -> np.ndarray:
    """One of matplotlib's perceptually uniform maps, (size, 3) in 0..255."""
    return 255.0 * matplotlib.colormaps[name](np.linspace(0.06, 0.98, size))[:, :3]


def _round_up(value: float) -> float:
    """The next round number."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * next(step for step in (1, 1.5, 2, 3, 4, 5, 6, 8, 10) if step >= value / power - 1e-9))
