"""Hydrodynamic tables of whole hulls, per metre of the ship's length: by strips, or in space by Capytaine.

In space the table is of the hull's mesh up to FINEST √(g/draught), with panels along her an eighth of the shortest wave
there, and more around her, where roll asks for them (`potential.mesh`); it is extrapolated from these and half as many
around her (Richardson 1911), whose error is of second order. Above, where waves are short beside the hull and strips
are exact in the limit, damping and excitation are those of strips, and added mass is theirs less their limit at
infinite frequency plus that in space. What is left of the difference where they join falls with the fourth power of
the frequency.

Limits: roll, a small difference of large pressures, is the least exact; Haskind's relation as `cargolab hydrodynamics`
prints it tells of waves that are badly resolved, less of bilges that are.
"""

import sys
from dataclasses import fields
from math import sqrt

import numpy as np

from lab.assembly import hull_flow, ship_tables
from lab.assembly.lines.offsets import from_offsets
from lab.assembly.ship_tables import SOLVED_BY, kept
from lab.base.errors import LabError
from lab.preset.sections import ship as ships
from lab.preset.units import show
from solvers.ship.naval import form as forms
from solvers.ship.naval.form import Form, prism
from solvers.ship.potential import mesh as meshes
from solvers.ship.potential import strips as by_strips
from solvers.ship.potential.mesh import BETWEEN, hull_mesh
from solvers.ship.potential.radiation import Hydrodynamics, extrapolated
from solvers.ship.potential.strips import abeam, strips
from solvers.ship.section import Section
from solvers.ship.water import Water

FINEST = 1.2  # √(g/draught): the highest frequency that is solved in space
PANEL = 0.5  # of the draught: an eighth of the length of waves of that frequency is 0.55
MOST_PANELS = 2500.0  # of the half hull, on its bottom
FADING = 4.0  # power of the frequency with which the difference of hull and strips at the join falls
SAME = 0.02  # of breadth and depth, by which section and hull may differ
OF_STRIPS = (*SOLVED_BY, by_strips, forms)
IN_SPACE = (*OF_STRIPS, meshes, hull_flow, sys.modules[__name__])


def whole_form(given: ships.Ship) -> Form:
    """The ship's whole hull, heights from her keel. Raises LabError if her section is not that of this hull."""
    section = Section(given.corners)
    if given.offsets is None:
        return prism(section, given.length)
    columns = (np.array(given.offsets.columns[name]) for name in ships.OFFSETS)
    form = from_offsets(*columns, name=f"ship.offsets: {given.offsets.name}")
    if form.depth < given.draught:
        raise LabError(f"ship.draught: must be less than the {show(form.depth, 'm')} of the hull in ship.offsets.")
    _compare(given, section, [one for one in form.sections if one is not None])
    return form


def _compare(given: ships.Ship, section: Section, stations: list[Section]) -> None:
    """Raise LabError if the ship's section is broader or narrower afloat than her stations, or they end below its deck.

    She is drawn as her section, which has her deck's edge and her hold; without tops water would come over her sooner.
    """
    own = float(section.waterplane(given.heave, 0.0).breadth)
    hers = max(float(one.waterplane(-given.draught, 0.0).breadth) for one in stations)
    if abs(own / hers - 1.0) > SAME:
        key = "ship.breadth" if given.outline is None else "ship.outline"
        raise LabError(
            f"{key}: her section is {show(own, 'm')} wide in the waterline, the hull in ship.offsets "
            f"{show(hers, 'm')}; draw the section amidships of that hull."
        )
    deck = float(given.corners[:, 1].max()) if given.deck_height is None else given.deck_height
    top, deck = max(float(one.outline[:, 1].max()) for one in stations), deck - float(given.corners[:, 1].min())
    if top < (1.0 - SAME) * deck:
        raise LabError(
            f"ship.offsets: her stations end {show(top, 'm')} over the keel, and her section's deck is at "
            f"{show(deck, 'm')}; give rows up to the deck."
        )


def whole_table(given: ships.Ship, water: Water, frequency: np.ndarray) -> Hydrodynamics:
    """The whole hull's table (…, 6) of a preset's ship, from the cache if possible.

    Raises LabError for a hull that she cannot have, or without Capytaine; `Unavailable` as the solvers do.
    """
    form, height = whole_form(given), given.about[1] - float(given.corners[:, 1].min())
    numbers = [water.density, water.depth, water.gravity, given.draught, height, ship_tables.PANELS]
    outlines = [np.zeros((0, 2)) if one is None else one.outline for one in form.sections]
    sizes = np.array([len(one) for one in outlines], dtype=float)
    values = form.x, sizes, *outlines, np.array(numbers), frequency
    if given.hydrodynamics == "strips":
        return kept(values, OF_STRIPS, lambda: _by_strips(form, given.draught, water, frequency, height))
    return kept(values, IN_SPACE, lambda: _in_space(form, given.draught, water, frequency, height))


def hull_table_of(given: ships.Ship, water: Water, frequency: np.ndarray) -> Hydrodynamics:
    """The same for sway, heave and roll, for each metre of the ship's length."""
    return abeam(whole_table(given, water, frequency), given.length)


def _by_strips(form: Form, draught: float, water: Water, frequency: np.ndarray, height: float) -> Hydrodynamics:
    return strips(form, draught, water, frequency, height, ship_tables.PANELS)


def _in_space(form: Form, draught: float, water: Water, frequency: np.ndarray, height: float) -> Hydrodynamics:
    """By the mesh up to the highest frequency that it resolves, with strips above."""
    solved = frequency[frequency <= FINEST * sqrt(water.gravity / draught)]
    if not len(solved):
        raise LabError("ship.hydrodynamics: all waves are too short for a mesh of the hull; take strips.")
    widest = max(float(one.outline[:, 0].max()) for one in form.sections if one is not None)
    size = max(PANEL * draught, sqrt(float(np.ptp(form.x)) * widest / MOST_PANELS))
    tables = []
    for between in (BETWEEN // 2, BETWEEN):
        mesh = hull_mesh(form, draught, size, between)
        tables.append(hull_flow.Flow(mesh, height - draught, water).table(solved))
    low = extrapolated(*tables)
    if len(solved) == len(frequency):
        return low
    high = _by_strips(form, draught, water, frequency[len(solved) - 1 :], height)
    return _joined(low, high)


def _joined(low: Hydrodynamics, high: Hydrodynamics) -> Hydrodynamics:
    """A table in space and that of strips, which begins at its last frequency."""
    fading = ((low.frequency[-1] / high.frequency) ** FADING)[:, None, None]
    found = {}
    for one in fields(low):
        lower, upper = getattr(low, one.name), getattr(high, one.name)
        if one.name == "added_mass":
            upper = upper + low.infinite_added_mass - high.infinite_added_mass
        if one.name in ("added_mass", "damping"):
            upper = upper + fading * (lower[-1] - upper[0])
        found[one.name] = lower if one.name == "infinite_added_mass" else np.concatenate([lower, upper[1:]])
    return Hydrodynamics(**found)
