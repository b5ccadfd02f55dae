"""Makes the grains of a scene: state, laws, lists, contacts and mover that fit each other."""

from dataclasses import replace

import numpy as np

from solvers.grains.contacts import Contacts
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.laws.chosen import ChosenLaws
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.lists.skin import Skin, widths
from solvers.grains.matter import GrainMatter
from solvers.grains.mover import Mover
from solvers.grains.shapes.grains import ShapedState
from solvers.grains.shapes.rules.area import Area
from solvers.grains.shapes.rules.contacts import ShapedContacts
from solvers.grains.shapes.rules.continuous import Continuous
from solvers.grains.shapes.rules.discrete import Discrete
from solvers.grains.shapes.rules.lists import ShapedNeighbours
from solvers.grains.state import GrainState
from solvers.tank.context import Context

RULES = {"continuous": Continuous, "nodes": Discrete, "area": Area}  # of contact between outlines


def make_grains(scene, context: Context) -> GrainMatter:
    """The grains of a scene (`solvers.scene.Scene`); in tanks aboard a body, their carrier is that body."""
    given, hold = scene.grains, context.parts.bodies.hold
    arrays, walls, count = context.arrays, context.walls, given.count
    units = context.units(count, len(given.fixed), arrays.under("grains"))
    load = context.load(arrays.under("grains"), units)
    may_leave = any(tank.open_edges for tank in scene.tanks)
    state = given.radius, given.density, given.fixed, units, may_leave, given.kind
    integrator = INTEGRATORS[given.integrator]()
    between = given.interfaces_of, given.kinds
    laws = ChosenLaws(arrays, units, *given.laws, *between, integrator, context.axes, given.twist_law)
    laws.wide = context.vectors if laws.fit and given.bears_vectors and not units.single else 0
    moduli = np.array([[between.young_modulus for between in world] for world in given.interfaces_of])
    discs = given.shapes is None
    soaks = scene.mixture is not None and laws.cohesive
    space = {"period": scene.solid.period if scene.solid else None, "soaks": soaks}
    grains = GrainState(arrays, context.axes, *state, **space) if discs else ShapedState(arrays, given.shapes, *state)
    together = discs and units.whole
    early = 0.5 * context.largest_multiple * scene.time_step() * scene.credible_speed()
    wide = widths(scene, context.skin, units.single, together)
    skin = Skin(arrays, grains, wide, given.longest_bridge, early, together, walls.moving)
    lists = given.farthest_reach, skin, laws, moduli, context.room
    if discs:
        neighbours = Neighbours(arrays, units, grains, walls, *lists)
        contacts = Contacts(arrays, units, grains, walls, neighbours, laws, load)
    else:
        rule = RULES[given.shapes.contact](arrays, units, walls, given.shapes, laws.wide)
        neighbours = ShapedNeighbours(arrays, units, grains, walls, *lists, rule)
        contacts = ShapedContacts(arrays, units, grains, walls, neighbours, laws, load, rule)
    if hold:
        hold.take(load)
    mover = Mover(arrays, units, grains, integrator, context.carrier, hold)
    context = replace(context, carrier=hold or context.carrier)
    return GrainMatter(scene, context, load, grains, neighbours, contacts, mover)
