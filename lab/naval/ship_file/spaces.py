"""Tanks and holds of a ship file as compartments, checked to be inside of the hull."""

import re
from collections.abc import Iterator
from itertools import combinations

import numpy as np

from lab.naval.compartments import SLACK, half_breadth
from lab.naval.flooding.overlap import shared_area
from lab.naval.ship_file.keys import LengthKeys, SpaceKeys
from lab.naval.ship_file.reading import Source
from solvers.machine.errors import Unavailable
from solvers.ship.naval.compartments.compartment import Compartment, Length
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

Drawn = tuple[LengthKeys, np.ndarray]  # a length and its outline (n, 2) m
SHARED = 0.01  # of a space: so much two of them may overlap, as roughly drawn ones do
PORT, STARBOARD = "-p", "-s"  # ends of the names of a pair of spaces


def spaces(table: str, given: dict[str, SpaceKeys], form: Form, source: Source) -> dict[str, Compartment]:
    """The compartments of a table of a ship file by name, a pair of spaces as NAME-p and NAME-s. Raises LabError."""
    found: dict[str, Compartment] = {}
    for name, keys in given.items():
        key = f"{table}.{name}"
        for end, outlines in _sides(keys, key, source):
            if name + end in found:
                raise source.error(key, f"there is another space {name + end}; give one of them another name.")
            found[name + end] = _compartment(outlines, keys, key, form, source)
    return found


def members(name: str, known: dict[str, Compartment]) -> list[str]:
    """The names of the spaces that a name in a condition means: itself, or both of a pair."""
    return [one for one in (name, name + PORT, name + STARBOARD) if one in known]


def _sides(keys: SpaceKeys, key: str, source: Source) -> Iterator[tuple[str, list[Drawn]]]:
    """The spaces that a table describes: the end of the name, and its lengths with outlines counter-clockwise."""
    drawn = [(one, _outline(one, where, source)) for where, one in _lengths(keys, key, source)]
    if keys.side == "as-drawn":
        yield "", drawn
        return
    for _, outline in drawn:
        if outline[:, 0].min() < 0.0:
            raise source.error(
                f"{key}.side", f"{keys.side} is of a section with y of at least 0; draw it to starboard."
            )
    mirrored = [(one, _mirror(outline)) for one, outline in drawn]
    if keys.side == "port":
        yield "", mirrored
    elif keys.side == "pair":
        yield PORT, mirrored
        yield STARBOARD, drawn
    else:
        yield "", [pair for one, outline in drawn for pair in _both(one, outline)]


def _both(one: LengthKeys, outline: np.ndarray) -> list[Drawn]:
    """A length on both sides: one outline where an edge lies in the middle plane, else two that communicate."""
    middle = np.flatnonzero((outline[:, 0] == 0.0) & (np.roll(outline[:, 0], -1) == 0.0))
    if len(middle) != 1:
        return [(one, outline), (one, _mirror(outline))]
    half = np.roll(outline, -int(middle[0]) - 1, axis=0)  # begins and ends in the middle plane
    return [(one, np.concatenate([half, _mirror(half)[1:-1]]))]


def _lengths(keys: SpaceKeys, key: str, source: Source) -> list[tuple[str, LengthKeys]]:
    """The lengths of a space with their keys, from aft to forward."""
    single = keys.aft, keys.forward, keys.section
    if keys.lengths:
        if any(one is not None for one in single):
            raise source.error(
                f"{key}.lengths", "each length has its own aft, forward and section; leave the others out."
            )
        found = [(f"{key}.lengths[{k}]", one) for k, one in enumerate(keys.lengths)]
    else:
        missing = [name for name, one in zip(("aft", "forward", "section"), single, strict=True) if one is None]
        if missing:
            raise source.error(key, f"has no {missing[0]}; give aft, forward and section, or lengths.")
        found = [(key, LengthKeys(*single))]
    end = -np.inf
    for where, one in found:
        if not one.aft < one.forward:
            raise source.error(f"{where}.forward", f"{one.forward:g} m must be forward of aft, {one.aft:g} m.")
        if one.aft < end - ROUNDING * abs(end):
            raise source.error(f"{where}.aft", f"{one.aft:g} m lies in the length before, which ends at {end:g} m.")
        end = one.forward
    return found


def _outline(keys: LengthKeys, where: str, source: Source) -> np.ndarray:
    """The corners (n, 2) m of a section, counter-clockwise. Raises LabError for one that is no simple polygon."""
    corners = np.array(keys.section, dtype=float).reshape(-1, 2)
    if len(corners) < 3:
        raise source.error(f"{where}.section", "needs at least three corners [y, z].")
    y, z = corners.T
    if y @ np.roll(z, -1) - z @ np.roll(y, -1) < 0.0:
        corners = corners[::-1]
    try:
        return Section(corners).outline
    except Unavailable as error:
        said = re.sub(r"^the hull's outline ", "", str(error))
        raise source.error(f"{where}.section", f"its outline {said}") from None


def _mirror(outline: np.ndarray) -> np.ndarray:
    """The mirror image of an outline, counter-clockwise again."""
    return outline[::-1] * [-1.0, 1.0]


def _compartment(drawn: list[Drawn], keys: SpaceKeys, key: str, form: Form, source: Source) -> Compartment:
    """The compartment of lengths with outlines. Raises LabError where one stands out of the hull."""
    lengths = [Length(Section(outline), one.aft, one.forward) for one, outline in drawn]
    for (one, _), length in zip(drawn, lengths, strict=True):
        where = f"{key}.lengths[{keys.lengths.index(one)}]" if keys.lengths else key
        _check_inside(length, form, where, source)
    return Compartment(lengths, keys.permeability)


def _check_inside(length: Length, form: Form, key: str, source: Source) -> None:
    """Raise LabError for a length that stands out of the hull; above her deck, as in a coaming, of its breadth."""
    if length.aft < form.x[0] - SLACK * form.depth or length.forward > form.x[-1] + SLACK * form.depth:
        ends = f"{form.x[0]:g} to {form.x[-1]:g} m"
        raise source.error(key, f"stands out of the hull, whose stations reach from {ends}; shorten it.")
    between = form.x[(form.x > length.aft) & (form.x < length.forward)]
    deck = form.base + form.depth
    for x in (length.aft, *between, length.forward):
        for y, z in length.section.outline:
            room = half_breadth(form, float(x), min(float(z), deck))
            if abs(y) > room + SLACK * form.depth:
                raise source.error(
                    key,
                    f"stands out of the hull at x {x:g}, y {y:g}, z {z:g} m, where her half-breadth is {room:.4g} m; "
                    "make it smaller.",
                )


def check_apart(found: dict[str, Compartment], source: Source) -> None:
    """Raise LabError for two spaces, by their dotted keys, that share more than SHARED of the smaller one's volume."""
    for (one, first), (other, second) in combinations(found.items(), 2):
        shared = sum(_shared(a, b) for a in first.lengths for b in second.lengths)
        if shared > SHARED * min(first.stations.area, second.stations.area):
            key = other if source.has(other) else other[: -len(PORT)]  # one of a pair
            raise source.error(key, f"shares {shared:.4g} m3 with {one}; make one of them smaller.")


def _shared(one: Length, other: Length) -> float:
    """Volume (m³) that two lengths share."""
    along = min(one.forward, other.forward) - max(one.aft, other.aft)
    return along * shared_area(one.section.outline, other.section.outline) if along > 0.0 else 0.0


def unknown(known: dict[str, Compartment], what: str) -> str:
    """The sentence on a name that no space has."""
    names = ", ".join(known) or "none"
    return f"there is no {what} of that name; the {what}s are {names}."
