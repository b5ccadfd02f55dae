"""The beds of bulk of a preset: one in each of its tanks."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from lab.preset.kept.content import FIRST
from lab.preset.sections.bulk.section import Bulk
from lab.preset.sections.ship import Ship
from lab.preset.sections.tank import FurtherTank, Tank
from lab.preset.sections.water.tanks import outline_of
from solvers.tank.outline import cut_off, moments


class Filled(Protocol):
    """The sections of a preset that its beds of bulk follow from."""

    tank: Tank
    tanks: Mapping[str, FurtherTank]
    ship: Ship | None
    bulk: Bulk | None


@dataclass(frozen=True, eq=False)
class Bed:
    """The bed in the tank of a `name`, `along` (m) long, 1 if the ship has no length.

    `corners` of the tank and those of what is `filled` of it are (m, 2) m, in the first tank's axes.
    """

    name: str
    corners: np.ndarray
    filled: np.ndarray
    along: float

    @property
    def area(self) -> float:
        """The area (m²) that it fills."""
        return float(moments(self.filled)[0])

    @property
    def high(self) -> float:
        """How deep (m) it is."""
        return float(np.ptp(self.filled[:, 1]))


def beds_of(preset: Filled) -> tuple[Bed, ...]:
    """The beds of a preset with bulk, those of [tank] and then of [tanks]."""
    corners, whole = np.array(preset.tank.corners), (preset.ship and preset.ship.length) or 1.0
    found = [Bed(FIRST, corners, preset.bulk.filled(corners), preset.tank.length or whole)]
    for name, tank in preset.tanks.items():
        outline = outline_of(preset, tank)
        found.append(Bed(name, outline, cut_off(outline, tank.depth), tank.length or whole))
    return tuple(found)


def over_first(beds: tuple[Bed, ...]) -> float:
    """What a ship carries of the bulk in all tanks, over what she would if all were as long as the first."""
    return sum(bed.area * bed.along for bed in beds) / (beds[0].along * sum(bed.area for bed in beds))


def width_of(beds: tuple[Bed, ...]) -> float:
    """How far (m) the tanks of beds reach across, all in one."""
    return float(np.ptp(np.concatenate([bed.corners for bed in beds])[:, 0]))


def slices(beds: tuple[Bed, ...], volume: np.ndarray) -> tuple[slice, ...]:
    """The numbers of the points of each bed; volume (n,) m² of all: theirs add up to its area."""
    areas = np.cumsum([bed.area for bed in beds])
    ends = np.searchsorted(np.cumsum(volume), areas * (1.0 - 1e-9)) + 1
    return tuple(slice(int(a), int(b)) for a, b in zip([0, *ends[:-1]], ends, strict=True))
