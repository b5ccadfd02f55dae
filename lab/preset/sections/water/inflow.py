"""Openings of a ship by which water enters a room of hers, as a preset gives them, and their checks."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Protocol

import numpy as np

from lab.base.errors import LabError
from lab.preset.kept.content import FIRST
from lab.preset.outline import TOUCHING, depth_inside
from lab.preset.sections.ship import Ship
from lab.preset.sections.tank import FurtherTank, Tank
from lab.preset.sections.water.section import Water
from lab.preset.units import show
from solvers.fluid.inflow import inlet as solved
from solvers.machine.marks import Doc, Interval, Unit

ENTERS = "sph", "level"  # models of water that may enter or leave

Ends = Annotated[tuple[tuple[float, float], ...], Unit("m")]
Length = Annotated[float, Unit("m"), Interval(gt=0, le=1e3)]


@dataclass(frozen=True)
class Inlet:
    """An opening in the hull of a ship, such as a hatch or a port, that leads to a room, which water enters by it.

    The flow is Q = C_d ∫ √(2 g Δh) dA where it is under water. The room is [tank] or one of [tanks]; it may be
    empty at the start, or hold grains, between which the water then flows.
    """

    points: Annotated[Ends, Doc("Its two ends in the hull's axes, y and z each.")]
    room: Annotated[str, Doc('The room that it leads to: "tank", or the name of one of [tanks].')] = FIRST
    length: Annotated[Length | None, Doc("Its length along the ship; without it that of the room.")] = None
    discharge: Annotated[float, Interval(gt=0, le=1), Doc("Discharge coefficient C_d.")] = 0.6


class Tanked(Protocol):
    """The sections of a preset that its tanks and openings follow from."""

    tank: Tank
    tanks: dict[str, FurtherTank]
    ship: Ship | None
    water: Water | None
    grains: object | None
    bulk: object | None
    inflow: dict[str, Inlet]


def rooms_with_inflow(preset: Tanked) -> set[int]:
    """The numbers of the tanks that water may enter."""
    names = [FIRST, *preset.tanks]
    return {names.index(inlet.room) for inlet in preset.inflow.values() if inlet.room in names}


def inlets_of(preset: Tanked) -> tuple[solved.Inlet, ...]:
    """The openings as the solver takes them."""
    found, names = [], [FIRST, *preset.tanks]
    for inlet in preset.inflow.values():
        number = names.index(inlet.room)
        along = _length_of_room(preset, number)
        ends = tuple(tuple(float(x) for x in np.subtract(end, preset.ship.hold)) for end in inlet.points)
        found.append(solved.Inlet(ends, number, along, (inlet.length or along) / along, inlet.discharge))
    return tuple(found)


def _length_of_room(preset: Tanked, number: int) -> float:
    """The length (m) of a tank along the ship."""
    return [preset.tank, *preset.tanks.values()][number].length or preset.ship.length or 1.0


def check_inflow(preset: Tanked) -> None:
    """Raise LabError, one sentence, for an opening that cannot be."""
    if not preset.inflow:
        return
    if preset.ship is None:
        raise LabError("inflow: openings are those of a ship; add a table [ship], or leave them out.")
    if preset.water is not None and preset.water.model not in ENTERS:
        raise LabError(
            f'inflow: "{preset.water.model}" water keeps its volume; take water.model = "sph", particles, or "level".'
        )
    for name, inlet in preset.inflow.items():
        for key, fault in _faults(preset, inlet):
            raise LabError(f"inflow.{name}.{key}: {fault}.")


def _faults(preset: Tanked, inlet: Inlet) -> Iterator[tuple[str, str]]:
    """The keys at fault of an opening, and why."""
    if len(inlet.points) != 2:
        yield "points", f"an opening has two ends (got {len(inlet.points)})"
    one, two = inlet.points
    if one == two:
        yield "points", "its two ends are the same point; an opening needs a width"
    names = [FIRST, *preset.tanks]
    if inlet.room not in names:
        yield "room", f'there is no tank "{inlet.room}"; take {" or ".join(names)}'
    corners = preset.ship.corners
    slack, waterline = TOUCHING * float(np.ptp(corners, axis=0).max()), corners[:, 1].min() + preset.ship.draught
    for y, z in inlet.points:
        place = f"[{show(y, 'm')}, {show(z, 'm')}]"
        if depth_inside(np.array([y, z]), corners) < -slack:
            yield "points", f"{place} is outside of the hull; lay it on her outline or within"
        if z <= waterline:
            yield "points", f"{place} is under water at rest; it must be above {show(float(waterline), 'm')}"
    along = _length_of_room(preset, names.index(inlet.room))
    if inlet.length is not None and inlet.length > along:
        yield "length", f"it is longer than the room, {show(along, 'm')}; make it shorter"
