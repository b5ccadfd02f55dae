"""Viscous roll damping of a preset's ship: by her keys, or by Ikeda's components from her section and bilge keels."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections import ship as ships
from solvers.ship.damping.components import FITTED, WAVES, Particulars, Slice, components, linear_quadratic
from solvers.ship.damping.keels import Keels
from solvers.ship.motion import RollDamping
from solvers.ship.section import Immersible, Section
from solvers.ship.water import Water

DRY = 1e-3  # of the draught: a smaller section counts as dry


def make_damping(given: ships.Ship, hull: Immersible, water: Water, frequency: float, inertia: float) -> RollDamping:
    """Of a ship with a natural frequency of roll (rad/s) and an inertia (kg m), both per metre of her length."""
    if given.viscous_damping == "ikeda":
        return by_components(given, hull, water, frequency)
    if given.linear_damping is not None:
        return RollDamping(given.linear_damping, given.quadratic_damping * inertia)
    return RollDamping(2.0 * given.damping * frequency * inertia, given.quadratic_damping * inertia)


def by_components(given: ships.Ship, hull: Immersible, water: Water, frequency: float) -> RollDamping:
    """Friction, eddies and bilge keels per metre of her, about her centre of gravity, as linear and quadratic terms.

    Laid through amplitudes of 2.5 to 25 deg. The waves that she makes are not in it. Raises LabError for a section
    without a form that the formulas have.
    """
    slices = [one for one in (_slice(outline, share, given) for outline, share in hull.outlines) if one]
    if not slices:
        raise LabError("ship.viscous_damping: nothing of her is under water.")
    widest = max(slices, key=lambda one: one.area)
    volume = sum(one.length * one.area for one in slices)
    keels = given.bilge_keels and Keels(given.bilge_keels.breadth, given.bilge_keels.length / given.length)
    full = min(widest.area / (widest.breadth * widest.draught), 1.0)
    block = volume / (widest.breadth * given.draught)
    axis = given.gravity_height - float(given.corners[:, 1].min())
    ship = Particulars(1.0, widest.breadth, given.draught, block, full, axis, keels, None, water.density, water.gravity)
    parts = components(ship, frequency, FITTED, slices, waves=0.0)
    if not parts[:, :WAVES].all():
        raise LabError('ship.viscous_damping: no Lewis form is like her sections; give damping as numbers ("given").')
    linear, quadratic, _ = linear_quadratic(frequency, FITTED, parts.sum(axis=1))
    return RollDamping(linear, quadratic)


def _slice(outline: np.ndarray, share: float, given: ships.Ship) -> Slice | None:
    """A section's part under water, with its share of a metre of her; None if it is dry."""
    section = Section(outline)
    deep = -given.heave - float(outline[:, 1].min())
    breadth = float(section.waterplane(given.heave, 0.0).breadth)
    area = float(section.immersion(given.heave, 0.0).area)
    small = DRY * given.draught
    return Slice(share, breadth, deep, area) if min(deep, breadth, area / given.draught) > small else None
