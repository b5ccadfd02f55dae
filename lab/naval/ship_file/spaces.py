"""Tanks and holds of a ship file as compartments, checked to be inside of the hull."""

import re
from collections.abc import Iterator, Sequence
from itertools import combinations
from typing import NamedTuple

import numpy as np

from lab.naval.compartments import SLACK, half_breadth
from lab.naval.flooding.overlap import shared_area
from lab.naval.ship_file.keys import LengthKeys, SpaceKeys
from lab.naval.ship_file.reading import Source
from solvers.machine.errors import Unavailable
from solvers.ship.naval.compartments.compartment import Compartment, Length
from solvers.ship.naval.form import Form
from solvers.ship.section import ROUNDING, Section

STRIPS = 6  # of a length that narrows, two slabs each
SHARED = 0.01  # of a space: so much two of them may overlap, as roughly drawn ones do
PORT, STARBOARD = "-p", "-s"  # ends of the names of a pair of spaces


class _Drawn(NamedTuple):
    """A length: its key, its ends x (m), its outline (n, 2) m."""

    where: str
    aft: float
    forward: float
    outline: np.ndarray


def spaces(table: str, given: dict[str, SpaceKeys], form: Form, source: Source) -> dict[str, Compartment]:
    """The compartments of a table of a ship file by name, a pair of spaces as NAME-p and NAME-s. Raises LabError."""
    found: dict[str, Compartment] = {}
    for name, keys in given.items():
        key = f"{table}.{name}"
        for end, outlines in _sides(keys, key, source):
            if name + end in found:
                raise source.error(key, f"there is another space {name + end}; give one of them another name.")
            found[name + end] = _compartment(outlines, keys, form, source)
    return found


def members(name: str, known: dict[str, Compartment]) -> list[str]:
    """The names of the spaces that a name in a condition means: itself, or both of a pair."""
    return [name] if name in known else [one for one in (name + PORT, name + STARBOARD) if one in known]


def _sides(keys: SpaceKeys, key: str, source: Source) -> Iterator[tuple[str, list[_Drawn]]]:
    """The spaces that a table describes: the end of the name, and its lengths with outlines counter-clockwise."""
    drawn = [slab for where, one in _lengths(keys, key, source) for slab in _slabs(one, where, source)]
    if keys.side == "as-drawn":
        yield "", drawn
        return
    if any(one.outline[:, 0].min() < 0.0 for one in drawn):
        raise source.error(f"{key}.side", f"{keys.side} is of a section with y of at least 0; draw it to starboard.")
    mirrored = [one._replace(outline=_mirror(one.outline)) for one in drawn]
    if keys.side == "port":
        yield "", mirrored
    elif keys.side == "pair":
        yield PORT, mirrored
        yield STARBOARD, drawn
    else:
        yield "", [one._replace(outline=outline) for one in drawn for outline in _both(one.outline)]


def _both(outline: np.ndarray) -> list[np.ndarray]:
    """A section on both sides: one outline where an edge lies in the middle plane, else two that communicate."""
    middle = np.flatnonzero((outline[:, 0] == 0.0) & (np.roll(outline[:, 0], -1) == 0.0))
    if len(middle) != 1:
        return [outline, _mirror(outline)]
    half = np.roll(outline, -int(middle[0]) - 1, axis=0)  # begins and ends in the middle plane
    return [np.concatenate([half, _mirror(half)[1:-1]])]


def _lengths(keys: SpaceKeys, key: str, source: Source) -> list[tuple[str, LengthKeys]]:
    """The lengths of a space with their keys, from aft to forward."""
    single = keys.aft, keys.forward, keys.section, keys.forward_section
    if keys.lengths:
        if any(one is not None for one in single):
            raise source.error(
                f"{key}.lengths", "each length has its own aft, forward and section; leave the others out."
            )
        found = [(f"{key}.lengths[{k}]", one) for k, one in enumerate(keys.lengths)]
    else:
        missing = [name for name, one in zip(("aft", "forward", "section"), single[:3], strict=True) if one is None]
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


def _slabs(keys: LengthKeys, where: str, source: Source) -> list[_Drawn]:
    """A length as it is, or where it narrows as slabs, whose sections are those at Gauss's two points of each strip.

    So its volume is exact, as areas go with the square of the place.
    """
    aft = _corners(keys.section, f"{where}.section", source)
    if keys.forward_section is None:
        return [_Drawn(where, keys.aft, keys.forward, _outline(aft, f"{where}.section", source))]
    fore = _corners(keys.forward_section, f"{where}.forward_section", source)
    if len(fore) != len(aft):
        raise source.error(
            f"{where}.forward_section", f"has {len(fore)} corners, and section has {len(aft)}; give as many."
        )
    edges = np.linspace(0.0, 1.0, 2 * STRIPS + 1)
    offs = np.tile([1.0 - 1.0 / np.sqrt(3.0), 1.0 / np.sqrt(3.0)], STRIPS)  # of a slab: where its Gauss point is
    places = edges[:-1] + offs * np.diff(edges)
    ends, key = keys.aft + edges * (keys.forward - keys.aft), f"{where}.forward_section"
    outlines = [_outline(aft + share * (fore - aft), key, source) for share in places]
    return [_Drawn(where, *slab) for slab in zip(ends[:-1].tolist(), ends[1:].tolist(), outlines, strict=True)]


def _corners(given: Sequence[tuple[float, float]], where: str, source: Source) -> np.ndarray:
    """The corners (n, 2) m of a section."""
    corners = np.array(given, dtype=float).reshape(-1, 2)
    if len(corners) < 3:
        raise source.error(where, "needs at least three corners [y, z].")
    return corners


def _outline(corners: np.ndarray, where: str, source: Source) -> np.ndarray:
    """The corners (n, 2) m counter-clockwise. Raises LabError for those of no simple polygon."""
    y, z = corners.T
    if y @ np.roll(z, -1) - z @ np.roll(y, -1) < 0.0:
        corners = corners[::-1]
    try:
        return Section(corners).outline
    except Unavailable as error:
        said = re.sub(r"^the hull's outline ", "", str(error))
        raise source.error(where, f"its outline {said}") from None


def _mirror(outline: np.ndarray) -> np.ndarray:
    """The mirror image of an outline, counter-clockwise again."""
    return outline[::-1] * [-1.0, 1.0]


def _compartment(drawn: list[_Drawn], keys: SpaceKeys, form: Form, source: Source) -> Compartment:
    """The compartment of lengths with outlines. Raises LabError where one stands out of the hull."""
    lengths = []
    for one in drawn:
        with source.told(one.where):
            lengths.append(Length(Section(one.outline), one.aft, one.forward))
        _check_inside(lengths[-1], form, one.where, source)
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
