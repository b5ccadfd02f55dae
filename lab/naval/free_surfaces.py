"""The free surfaces of the water in a ship's tanks: what they take off her metacentric height.

A small heel moves the water of a tank as it does the sea around a hull: its centre goes aside by φ i/v, i the second
moment of its free surface about that surface's own middle line and v its volume. That heels her by ρ g i φ, as if G lay
higher by ρ i/Δ (2008 IS Code, part B 3.1, which is of tanks with level surfaces). For a rectangle i = b³ l/12.

Surfaces of water that communicates below them have one middle line together, ∫y² dy − (∫y dy)²/∫dy; those of separate
puddles have one each. Water no higher than a bed of grains has none: it seeps through the pores. Water over the bed
has that of its whole surface, as long as it covers the bed.
"""

from dataclasses import dataclass

import numpy as np

from lab.preset.schema import Preset
from lab.preset.sections.tank import Tank
from lab.preset.sections.water.tanks import outline_of
from solvers.ship.vessel import Vessel

TOUCH = 1e-9  # of the tank's size: so far below its level the surface is cut, so that corners do not lie in it


@dataclass(frozen=True)
class FreeSurface:
    """The free surface in one tank: its breadth and length (m), second moment of area (m⁴), moment (kg m)."""

    tank: str
    breadth: float
    length: float
    second_moment: float
    moment: float


def free_surfaces(preset: Preset) -> list[FreeSurface]:
    """Of all tanks of a preset with water that does not fill them, as large as in the preset."""
    if preset.water is None:
        return []
    names, tanks = ["tank", *(f"tanks.{name}" for name in preset.tanks)], [preset.tank, *preset.tanks.values()]
    return [
        _surface(names[pool.number], tanks[pool.number], _outline(preset, pool.number), pool.level, preset)
        for pool in preset.pools
        if pool.number or not (preset.water.full or _in_pores(preset))
    ]


def taken_by_surfaces(preset: Preset, vessel: Vessel) -> float:
    """By how much (m) the free surfaces of a ship's tanks lower her GM, Σ ρ i/Δ."""
    moment = sum(surface.moment for surface in free_surfaces(preset))
    return moment / (vessel.ship.body.mass * (preset.ship.length or 1.0))


def _in_pores(preset: Preset) -> bool:
    """Whether the water of the first tank stands no higher than the bed of grains there."""
    return preset.wet and preset.grains.depth is not None and (preset.water.depth or 0.0) <= preset.grains.depth


def _outline(preset: Preset, number: int) -> np.ndarray:
    """The outline (m, 2) m of the tank of this number."""
    if not number:
        return np.array(preset.tank.corners)
    return outline_of(preset, list(preset.tanks.values())[number - 1])


def _surface(name: str, tank: Tank, outline: np.ndarray, level: float, preset: Preset) -> FreeSurface:
    length = tank.length or preset.ship.length or 1.0
    breadth, moment = surface_moment(outline, level)
    return FreeSurface(name, breadth, length, moment * length, preset.water.density * moment * length)


def surface_moment(outline: np.ndarray, level: float) -> tuple[float, float]:
    """Breadth (m) of the free surface at a level (m) in an outline (m, 2), and its second moment (m³) a metre."""
    pieces, pool = _pieces(outline, level)
    breadth, moment = 0.0, 0.0
    for one in set(pool):
        ends = pieces[[number == one for number in pool]]
        wide, first, second = (float((ends[:, 1] ** n - ends[:, 0] ** n).sum()) / n for n in (1, 2, 3))
        breadth, moment = breadth + wide, moment + second - first**2 / wide
    return breadth, moment


def _pieces(outline: np.ndarray, level: float) -> tuple[np.ndarray, list[int]]:
    """The pieces (k, 2) m of the surface, and for each the number of the pool that it is of.

    The walls between two ends of pieces that lie below the surface bound one pool, which those pieces share.
    """
    depth = level - TOUCH * np.ptp(outline, axis=0).max() - outline[:, 1]
    ends, walls, below = [], [], None
    first = int(np.argmin(depth))  # a corner above the surface: the walk along the outline begins dry
    for k in np.roll(np.arange(len(outline)), -first):
        one, other = k, (k + 1) % len(outline)
        if (depth[one] > 0.0) == (depth[other] > 0.0):
            continue
        share = depth[one] / (depth[one] - depth[other])
        ends.append(float(outline[one, 0] + share * (outline[other, 0] - outline[one, 0])))
        if depth[one] > 0.0:
            walls.append((below, len(ends) - 1))
        below = len(ends) - 1
    order = np.argsort(ends)
    piece_of = {int(end): k // 2 for k, end in enumerate(order)}
    pool = list(range(len(ends) // 2))
    for a, b in walls:
        kept, gone = pool[piece_of[a]], pool[piece_of[b]]
        pool = [kept if number == gone else number for number in pool]
    return np.sort(ends).reshape(-1, 2), pool
