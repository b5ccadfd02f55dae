"""The contact laws of a scene, with their coefficients in every world."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.grains.integrators.verlet import Verlet
from solvers.grains.laws.splitting import NETWORK
from solvers.machine.quantity import PLANE
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.machine.wide import enter, entry
from solvers.space.axes import dot, named_turns, turns
from solvers.space.extremes import greater

PAIR, WALL = 0, 1  # rows of the interfaces if all grains are of one kind
NEAR = 0.01  # of an overlap: step of the difference quotient of its energy


@ti.data_oriented
class ChosenLaws:
    """Normal, tangential, rolling and cohesion laws of grain–grain (PAIR) and grain–wall (WALL) contacts.

    `interfaces[w]` are those of world w: kinds a and b of grains in row a·K + b, kind a and a wall in row K² + a, with
    K `kinds`. Contacts come in blocks of lanes (`ContactList`), and a law returns a vector of lanes for a block. With
    one kind of grains a law's coefficients are numbers, with several they are vectors of lanes. Laws know the
    `integrator`: the step that `prepare` gets is divided by its `damping`, which keeps dampers stable under it.

    `fit`: whether all laws can be compiled for real vectors (`solvers.machine.wide`); `wide`: lanes, or 0.
    """

    wide = 0

    def __init__(
        self,
        arrays: State,
        units: Units,
        normal,
        tangential,
        rolling,
        cohesion,
        interfaces,
        kinds=1,
        integrator=Verlet,
        axes=PLANE,
        twisting=None,
    ):
        self.units, self.kinds, self.damping = units, kinds, integrator.damping
        self.normal, self.tangential, self.rolling, self.cohesion = normal, tangential, rolling, cohesion
        self.twisting, self.twists = twisting, twisting is not None and twisting.resists
        self.cohesive = cohesion.pulls
        used = {"normal": normal, "tangential": tangential, "rolling": rolling}
        used |= ({"cohesion": cohesion} if self.cohesive else {}) | ({"twisting": twisting} if self.twists else {})
        laws, self.numbers = tuple(used.values()), {name: number for number, name in enumerate(used)}
        for law in laws:
            law.integrator, law.network = integrator, NETWORK[axes]
        self.laws = laws
        self.fit = all(getattr(law, "wide", False) for law in laws)
        own = arrays.under("laws")
        self.tables = [
            own.holding(name, self.tabulate(law, interfaces), "world row coefficient") for name, law in used.items()
        ]
        self.constants = tuple(name for law in laws for name in law.constants)
        self.counts = tuple(len(law.constants) for law in laws)
        self.vectors = {name: named_turns(name, axes) for law in laws for name in getattr(law, "tangents", ())}
        self.remembered = tuple(name for law in laws for name in law.memory)
        kept = [(law, name, array) for law in laws for name in law.memory for array in self.vectors.get(name, (name,))]
        self.memory = tuple(array for *_, array in kept)
        # A vector changes its sign if the first and the second grain are swapped. In the plane the tangent does, too.
        self.odd = [name in self.vectors and (law is rolling or turns(axes) > 1) for law, name, _ in kept]

    def by_name(self, arrays: Sequence) -> dict[str, object]:
        """The arrays of `memory` under the names by which laws know them: one, or the list of a vector's."""
        left = iter(arrays)
        return {
            name: [next(left) for _ in self.vectors[name]] if name in self.vectors else next(left)
            for name in self.remembered
        }

    def learn(self, interfaces) -> None:
        """Take the coefficients of other interfaces; constants follow when the contact lists are next rebuilt."""
        for law, table in zip(self.laws, self.tables, strict=True):
            table.from_numpy(self.tabulate(law, interfaces))

    @staticmethod
    def tabulate(law, interfaces) -> np.ndarray:
        """Coefficients (W, rows, number) of a law; a single zero for a law without any."""
        return np.array([[law.coefficients(between) or [0.0] for between in world] for world in interfaces])

    @ti.func
    def pair_row(self, g: ti.template(), w, i, j):
        """The row of the interface between grains i and j."""
        row = PAIR
        if ti.static(self.kinds > 1):
            row = g.kind[w, i] * self.kinds + g.kind[w, j]
        return row

    @ti.func
    def wall_row(self, g: ti.template(), w, i):
        """The row of the interface between grain i and a wall."""
        row = WALL
        if ti.static(self.kinds > 1):
            row = self.kinds * self.kinds + g.kind[w, i]
        return row

    @ti.func
    def coefficients(self, which: ti.template(), u, kind: ti.template(), contacts: ti.template(), block):
        """The coefficients of one law for a block of contacts in the world of unit u."""
        table = ti.static(self.tables[which])
        w = self.units.world(u)
        if ti.static(self.kinds == 1):
            return [table[w, kind, k] for k in ti.static(range(table.shape[2]))]
        else:
            rows = contacts.row[u, block]
            lanes = ti.static(range(contacts.lanes))
            return [ti.Vector([table[w, rows[n], k] for n in lanes]) for k in ti.static(range(table.shape[2]))]

    @ti.func
    def coefficients_of_one(self, which: ti.template(), u, kind: ti.template(), contacts: ti.template(), block, lane):
        """The coefficients of one law for one contact."""
        table = ti.static(self.tables[which])
        row = kind
        if ti.static(self.kinds > 1):
            row = entry(contacts.row, u, block, lane)
        return [table[self.units.world(u), row, k] for k in ti.static(range(table.shape[2]))]

    @ti.func
    def prepare(self, kind: ti.template(), contacts: ti.template(), u, block, lane, mass, radius, dt):
        """Compute the laws' constants of a newly listed contact, m_eff in kg, R_eff in m, Δt in s."""
        for which in ti.static(range(len(self.laws))):
            first = ti.static(sum(self.counts[:which]))
            self.prepare_law(self.laws[which], which, first, kind, contacts, u, block, lane, mass, radius, dt)

    @ti.func
    def prepare_law(
        self,
        law: ti.template(),
        which: ti.template(),
        first: ti.template(),
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        lane,
        mass,
        radius,
        dt,
    ):
        """Compute one law's constants, which are stored from number `first` on."""
        if ti.static(self.counts[which] > 0):
            c = self.coefficients_of_one(which, u, kind, contacts, block, lane)
            values = law.prepare(c, entry(contacts.stiffness, u, block, lane), mass, radius, dt / self.damping)
            for k in ti.static(range(self.counts[which])):
                enter(contacts.constants[first + k], u, block, lane, values[k])

    @ti.func
    def forces(
        self,
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        approach,
        rate,
        slip,
        turning,
        way: ti.template(),
        dt,
    ):
        """Normal and tangential forces (N) and rolling torques (N m) of a block of contacts; memory is updated.

        `approach` is the overlap in m (negative: a gap), its `rate` the closing speed and `slip` the tangential one in
        m/s, `turning` ω_i − ω_j (ω_i at a wall) in rad/s, `way` as the laws take it. The torque acts on the first
        grain, and its opposite on the second.
        """
        pressing = self.normal_force(kind, contacts, u, block, approach, rate, dt)
        overlap = greater(approach, 0.0)
        shearing, torque = self.tangential_force(
            kind, contacts, u, block, overlap, rate, pressing, slip, turning, way, dt
        )
        return pressing, shearing, torque

    @ti.func
    def normal_force(self, kind: ti.template(), contacts: ti.template(), u, block, approach, rate, dt):
        """Normal forces (N) of a block of contacts; their memory is updated."""
        overlap = greater(approach, 0.0)
        coefficients = self.coefficients(0, u, kind, contacts, block)
        return self.normal.force(coefficients, contacts, u, block, approach, overlap, ti.sqrt(overlap), rate, dt)

    @ti.func
    def tangential_force(
        self,
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        overlap,
        rate,
        pressing,
        slip,
        turning,
        way: ti.template(),
        dt,
    ):
        """Tangential forces (N) and rolling torques (N m) under normal forces `pressing` (N)."""
        tangential_c = self.coefficients(1, u, kind, contacts, block)
        rolling_c = self.coefficients(2, u, kind, contacts, block)
        root = ti.sqrt(overlap)
        shearing = self.tangential.force(tangential_c, contacts, u, block, root, rate, pressing, slip, way, dt)
        torque = self.rolling.torque(rolling_c, contacts, u, block, pressing, turning, way, dt)
        return shearing, torque

    @ti.func
    def resisted(
        self,
        kind: ti.template(),
        contacts: ti.template(),
        u,
        block,
        approach,
        pressing,
        turning: ti.template(),
        normal: ti.template(),
        roll: ti.template(),
        dt,
    ):
        """Torques (N m) of a block of contacts against rolling, `roll`, and twisting, if anything resists that.

        `turning` is ω_i − ω_j (rad/s), `pressing` F_n (N).
        """
        if ti.static(not self.twists):
            return roll
        else:
            coefficients = self.coefficients(self.numbers["twisting"], u, kind, contacts, block)
            root, rate = ti.sqrt(greater(approach, 0.0)), dot(turning, normal)
            twist = self.twisting.torque(coefficients, contacts, u, block, root, pressing, rate, dt)
            return [roll[k] + twist * normal[k] for k in ti.static(range(len(normal)))]

    @ti.func
    def cohesive_force(self, contacts: ti.template(), u, block, approach, rate, dt):
        """Cohesive forces (N) of a block of contacts with overlap `approach` (m; negative: a gap) and its rate (m/s).

        Memory is updated. To be called only if the scene is `cohesive`.
        """
        return self.cohesion.pull(contacts, u, block, approach, rate, dt)

    @ti.func
    def energy(self, kind: ti.template(), contacts: ti.template(), u, p, overlap):
        """Elastic energy (J) of contact p, whose overlap must be positive."""
        block, lane, root = p // contacts.lanes, p % contacts.lanes, ti.sqrt(overlap)
        pressed = self.pressed_energy(contacts, u, p, overlap)
        tangential_c = self.coefficients_of_one(1, u, kind, contacts, block, lane)
        sheared = self.tangential.energy(tangential_c, contacts, u, block, lane, root)
        stored = pressed + sheared + self.rolling.energy(contacts, u, block, lane)
        if ti.static(self.twists):
            twisting_c = self.coefficients_of_one(self.numbers["twisting"], u, kind, contacts, block, lane)
            stored += self.twisting.energy(twisting_c, contacts, u, block, lane, root)
        return stored

    @ti.func
    def pressed_energy(self, contacts: ti.template(), u, p, overlap):
        """Elastic energy (J) of the normal force of contact p."""
        return self.normal.energy(contacts, u, p // contacts.lanes, p % contacts.lanes, overlap, ti.sqrt(overlap))

    @ti.func
    def elastic(self, contacts: ti.template(), u, p, overlap):
        """Elastic normal force ∂U/∂ξ (N) of contact p, zero without overlap; memory is not changed.

        A central difference with a step of NEAR times the overlap: for Hertz's U ~ ξ^(5/2) its error is 1.3e-5.
        """
        force = 0.0 * overlap
        if overlap > 0.0:
            step = NEAR * overlap
            rise = self.pressed_energy(contacts, u, p, overlap + step)
            force = (rise - self.pressed_energy(contacts, u, p, overlap - step)) / (2.0 * step)
        return force

    @ti.func
    def bridge_energy(self, contacts: ti.template(), u, p, approach):
        """Energy (J) of the liquid bridge of contact p; to be called only if the scene is `cohesive`."""
        return self.cohesion.energy(contacts, u, p // contacts.lanes, p % contacts.lanes, approach)
