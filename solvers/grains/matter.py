"""Grains as a matter: what a step asks of them."""

import numpy as np
import taichi as ti

from solvers.grains.contacts import Contacts
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.laws.chosen import ChosenLaws
from solvers.grains.mover import Mover
from solvers.grains.neighbours import Neighbours
from solvers.grains.shapes.grains import ShapedGrains
from solvers.grains.shapes.rules.area import Area
from solvers.grains.shapes.rules.contacts import ShapedContacts
from solvers.grains.shapes.rules.continuous import Continuous
from solvers.grains.shapes.rules.discrete import Discrete
from solvers.grains.shapes.rules.lists import ShapedNeighbours
from solvers.grains.state import Grains
from solvers.machine.phase import Phase
from solvers.space.axes import dot
from solvers.tank.setting import Setting

# A speed (m/s) whose 16th power is no number in 32 bits any more.
UNSEEN = 5e-3
RULES = {"continuous": Continuous, "nodes": Discrete, "area": Area}  # of contact between outlines


@ti.data_oriented
class GrainMatter:
    """Grains, discs or irregular ones: their contacts push before they move, then all move.

    A matter has `units`, the phases `before` and `after`, and lists: it says when these are `stale`, `worn` or `asked`
    for in part, and makes them anew (`sort`, `make_lists`). Where it is `paced` its steps may be longer than the
    base step, as many of those as its `pace` says. `way_a_step` (m) is how far a grain may go in one.
    """

    def __init__(self, setting: Setting, grains: Grains, neighbours: Neighbours, contacts: Contacts, mover: Mover):
        self.units, self.grains, self.neighbours = setting.units, grains, neighbours
        self.contacts, self.mover = contacts, mover
        own = setting.arrays.under("grains")
        self.unseen = UNSEEN if own.real is ti.f32 else 0.0  # speed (m/s) below which the mover's bound may miss one
        self.way_a_step = own.holding("way_a_step", np.array([setting.way_a_step]), "one", own.exact)
        self.paced = setting.stretch > 1
        self.stretch = own.holding("stretch", np.array([setting.stretch]), "one", ti.i32)
        self.before = (Phase(self.push, self.units),)
        self.after = (Phase(self.move, self.units),)

    @property
    def extent(self) -> float:
        """How far (m) from the tank's origin a grain may be."""
        return float(np.hypot.reduce(np.abs(self.neighbours.walls.bounds).max(axis=0)))

    @property
    def nearing(self) -> float:
        """How fast (m/s) parts of the tank come at grains."""
        return self.neighbours.walls.fastest

    def slack(self) -> float:
        """How far (m) two grains may near each other before the lists are no good."""
        return float(self.neighbours.skin.to_numpy()[0])

    def sort_all(self) -> None:
        """Sort the grains of all worlds into cells."""
        self.neighbours.cells.sort_all()

    @ti.func
    def push(self, u, t, kick, dt):
        """The forces of all contacts of a unit, on the grains and on the tank."""
        self.contacts.forces(u, t, dt)

    @ti.func
    def move(self, u, frame, kick, dt):
        """Move the grains of a unit; returns whether all of them are slow enough for the step."""
        speed = self.mover.move(self.grains, u, frame, kick, dt)
        if ti.static(not self.units.single):
            self.neighbours.travel[u] = self.neighbours.travel[u] + (speed + self.unseen) * dt
        return self.is_sound(speed, dt)

    @ti.func
    def is_sound(self, speed, dt):
        """Whether a speed (m/s) is one the step bears; not one that is no number."""
        return speed * dt < self.way_a_step[0]

    @ti.func
    def speed(self, u):
        """The speed (m/s) of a unit that is a single grain."""
        w, i = self.units.world(u), self.units.first(u)
        v = [field[w, i] for field in ti.static(self.grains.velocity)]
        return ti.sqrt(dot(v, v))

    @ti.func
    def way(self, u, t):
        """How far (m) any grain of a unit has gone since there are lists; huge where there are none."""
        moved = self.neighbours.travel[u]
        if moved == 0.0:  # there are lists; without, it says NEVER
            moved = self.neighbours.moved(u, t)
        return moved

    @ti.func
    def pace(self, w):
        """Base steps that a step may take."""
        return self.stretch[0]

    @ti.func
    def stale(self, u, t):
        """Whether two grains may be in reach of each other unlisted at time t (s)."""
        return self.neighbours.stale(u, t)

    @ti.func
    def worn(self, u):
        """Whether that may be so by a bound on what grains have travelled."""
        return self.neighbours.worn(u)

    @ti.func
    def asked(self, u):
        """Whether some contacts are to be searched again."""
        return self.neighbours.asked(u)

    @ti.func
    def sort(self, w):
        """Sort the grains of a world into cells."""
        self.neighbours.cells.sort_world(w)

    @ti.func
    def make_lists(self, u, t, dt, whole):
        """List the contacts of a unit anew, or seek some; False, with the old lists, where they do not fit."""
        return self.neighbours.rebuild(u, t, dt, whole)


def make_grains(scene, setting: Setting) -> GrainMatter | None:
    """The grains of a scene (`solvers.scene.Scene`); None where it has none."""
    if not scene.radius.size:
        return None
    arrays, units, walls = setting.arrays, setting.units, setting.walls
    may_leave = any(tank.open_edges for tank in scene.tanks)
    given = scene.radius, scene.density, scene.fixed, units.ghosts, may_leave, scene.kind
    integrator = INTEGRATORS[scene.integrator]()
    laws = ChosenLaws(arrays, units, *scene.laws, scene.interfaces_of, scene.kinds, integrator)
    moduli = np.array([[between.young_modulus for between in world] for world in scene.interfaces_of])
    bridges = scene.longest_bridge
    reach = 2.0 * scene.farthest_reach + max(setting.skin, bridges)
    lists = setting.skin, bridges, reach, laws, moduli, setting.room
    if scene.shapes is None:
        grains = Grains(arrays, *given)
        neighbours = Neighbours(arrays, units, grains, walls, *lists)
        contacts = Contacts(arrays, units, grains, walls, neighbours, laws, setting.load)
    else:
        rule = RULES[scene.shapes.contact](arrays, units, walls, scene.shapes)
        grains = ShapedGrains(arrays, scene.shapes, *given)
        neighbours = ShapedNeighbours(arrays, units, grains, walls, *lists, rule)
        contacts = ShapedContacts(arrays, units, grains, walls, neighbours, laws, setting.load, rule)
    return GrainMatter(
        setting, grains, neighbours, contacts, Mover(arrays, units, grains, integrator, setting.rotating)
    )
