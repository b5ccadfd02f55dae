"""The matters and gauges of a preset, by which the tables of a recording are laid out."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

# The keys of the matters that a tank may hold; air is the second phase of water
MATTERS = ("grains", "water", "air", "bulk")
FIRST = "tank"  # the name of the first tank
INSIDE = "inside"  # the name of the one room of a hull for which none is drawn
KINDS_OF_GAUGES = "pressure", "level", "force"

G = TypeVar("G")


class Gauge(NamedTuple):
    """A gauge of what kind."""

    kind: str


@dataclass(frozen=True)
class Content:
    """What of a preset the tables of its recording follow from, under the names that a preset has for it."""

    matters: tuple[str, ...]
    material: bool
    ship: bool
    axle: bool
    gauges: dict[str, Gauge]
    bodies: tuple[str, ...]
    rooms: tuple[str, ...]
    openings: tuple[str, ...]
    inflow: tuple[str, ...]
    repeats: int
    parts: tuple[str, ...]
    axes: int
    faces: tuple[str, ...]
    wet: bool
    soaks: bool


def parted(gauges: Mapping[str, G]) -> tuple[dict[str, G], ...]:
    """The gauges of pressure, of level and of force by their names, each in the order of their numbers."""
    return tuple({name: one for name, one in gauges.items() if one.kind == kind} for kind in KINDS_OF_GAUGES)
