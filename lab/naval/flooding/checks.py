"""What cannot be in a case of flooding: rooms outside of the hull or in each other, openings that lead nowhere."""

from itertools import combinations

import numpy as np

from lab.base.errors import LabError
from lab.naval.compartments import half_breadth
from lab.naval.flooding.case import OpeningKeys
from lab.naval.flooding.overlap import shared_area
from solvers.ship.flooding.openings import SEA
from solvers.ship.flooding.rooms import Room
from solvers.ship.naval.form import Form

SLACK = 1e-6  # of an area, or of the hull's size: so much may be in two rooms, or stand out, by rounding


def check_rooms(rooms: list[Room], form: Form, prism: bool) -> None:
    """Raise LabError for a room that stands out of the hull, or two that share a volume."""
    for room in rooms:
        key = f"rooms.{room.name}"
        if room.aft < form.x[0] - SLACK or room.forward > form.x[-1] + SLACK:
            ends = f"{form.x[0]:.4g} to {form.x[-1]:.4g} m"
            raise LabError(f"{key}.along: stands out of the hull, which reaches from x {ends}; shorten the room.")
        (_check_in_prism if prism else _check_in_lines)(room, form, key)
    for one, other in combinations(rooms, 2):
        along = min(one.forward, other.forward) - max(one.aft, other.aft)
        if along <= SLACK * (form.x[-1] - form.x[0]):
            continue
        shared, least = shared_area(one.outline, other.outline), min(_area(one.outline), _area(other.outline))
        if shared > SLACK * least:
            raise LabError(
                f"rooms.{other.name}: shares {shared * along:.3g} m3 with rooms.{one.name}; make one of them smaller."
            )


def check_opening(name: str, keys: OpeningKeys, corners: np.ndarray, rooms: list[Room], form: Form) -> None:
    """Raise LabError for an opening between what is not there, or where its rooms or the hull are not."""
    key, names = f"openings.{name}", [SEA, *(room.name for room in rooms)]
    for one in keys.between:
        if one not in names:
            raise LabError(f"{key}.between: there is no room {one}; name two of {', '.join(names)}.")
    if keys.between[0] == keys.between[1]:
        raise LabError(f"{key}.between: leads from {keys.between[0]} to itself; name two rooms, or a room and sea.")
    middle = corners.mean(axis=0)
    slack = SLACK * (form.x[-1] - form.x[0])
    place = ", ".join(f"{one:.4g}" for one in middle)
    if not form.x[0] - slack <= middle[0] <= form.x[-1] + slack or not _in_hull(corners, form):
        raise LabError(f"{key}.at: the opening is outside of the hull at {place} m; move it to her side or inside.")
    ends = [room for room in rooms if room.name in keys.between]
    if not any(_is_at(middle, room, form) for room in ends):
        names = " or ".join(room.name for room in ends)
        low, high = (
            np.array([ends[0].aft, *ends[0].outline.min(axis=0)]),
            [ends[0].forward, *ends[0].outline.max(axis=0)],
        )
        spans = ", ".join(f"{axis} {a:.4g} to {b:.4g}" for axis, a, b in zip("xyz", low, high, strict=True))
        raise LabError(f"{key}.at: at {place} m there is no {names}; {ends[0].name} is at {spans} m: move the opening.")


def _is_at(middle: np.ndarray, room: Room, form: Form) -> bool:
    """Whether an opening is at a room that it leads to; a wall may be between, a tenth of the depth thick."""
    low = np.array([room.aft, *room.outline.min(axis=0)])
    high = np.array([room.forward, *room.outline.max(axis=0)])
    wall = 0.1 * form.depth
    return bool((middle >= low - wall).all() and (middle <= high + wall).all())


def _check_in_prism(room: Room, form: Form, key: str) -> None:
    section = next(one for one in form.sections if one is not None)
    out = _area(room.outline) - shared_area(room.outline, section.outline)
    if out > SLACK * _area(room.outline):
        raise LabError(f"{key}: {out:.3g} m2 of its section stand out of the hull's; make the room smaller.")


def _check_in_lines(room: Room, form: Form, key: str) -> None:
    between = form.x[(form.x > room.aft) & (form.x < room.forward)]
    for x in (room.aft, *between, room.forward):
        for y, z in room.outline:
            half = half_breadth(form, float(x), float(z))
            if abs(y) > half + SLACK * form.depth:
                raise LabError(
                    f"{key}: stands out of the hull at x {x:.4g}, y {y:.4g}, z {z:.4g} m, where her half-breadth is "
                    f"{half:.4g} m; make the room smaller."
                )


def _in_hull(corners: np.ndarray, form: Form) -> bool:
    """Whether the corners (k, 3) m of an opening are within the hull's greatest breadth and its height."""
    outlines = np.concatenate([one.outline for one in form.sections if one is not None])
    low, high = outlines.min(axis=0), outlines.max(axis=0)
    slack = SLACK * form.depth
    return bool((corners[:, 1:] >= low - slack).all() and (corners[:, 1:] <= high + slack).all())


def _area(outline: np.ndarray) -> float:
    y, z = outline.T
    return 0.5 * abs(float(y @ np.roll(z, -1) - z @ np.roll(y, -1)))
