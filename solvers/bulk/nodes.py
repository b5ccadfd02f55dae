"""The motion of the nodes: what the tank's motion and its walls do to them, and what they do to the walls."""

import numpy as np
import taichi as ti

from solvers.bulk.given import Bulk
from solvers.bulk.grid import FREE, MOST
from solvers.bulk.order import Order
from solvers.bulk.spread import ALONG, MASS, PUSHED_ALONG, PUSHED_UP, SLOTS, UP, WIDE, Spread
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.motion.frame import turned
from solvers.tank.load import Load

# Of a node: its velocity (m/s), its mass (kg/m), the volume (m²) inside its tank, and the velocity before the step
V_Y, V_Z, HAS, MAY, OLD_Y, OLD_Z = range(6)
NODE = 6  # numbers of a node


@ti.data_oriented
class Nodes:
    """Velocities of nodes relative to the tank, whose walls hold them: no way through, and Coulomb friction along.

    A wall takes the velocity into it, an impulse per mass J, and of that along it at most μ_w J. Where the carrier
    responds to the load, `react` finds the walls' load at the beginning of a step with the last acceleration of the
    tank, and `kick` moves the nodes once the present one is known; else `react` does both.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        spread: Spread,
        order: Order,
        bulk: Bulk,
        load: Load,
        carrier,
        thickness: float,
    ):
        grid = bulk.grid
        self.units, self.spread, self.order, self.load, self.carrier = units, spread, order, load, carrier
        self.rows, self.real, self.exact, self.twice = grid.rows, arrays.real, arrays.exact, carrier.responds
        self.thickness = thickness
        own = arrays.under("bulk.nodes")
        numbers = np.array([bulk.material.wall_friction, thickness])
        self.numbers = own.holding("numbers", numbers, "number")
        self.kept = own.holding("tank", grid.kept, "column", ti.i32)
        length = np.arange(grid.columns) - grid.first[grid.kept]
        at = grid.origin[grid.kept, 0] + length * grid.spacing[grid.kept, 0]
        heights = np.column_stack([grid.origin[grid.kept, 1], grid.spacing[grid.kept, 1]])
        self.places = own.holding("places", np.column_stack([at, heights]), "column number")
        count = (np.abs(grid.walls).max(axis=-1) > 0.0).sum(axis=-1)
        self.walls = own.holding("walls", count.reshape(-1), "node", ti.i32)
        self.normal = own.holding("normal", grid.walls.reshape(-1), "number")
        share = np.where(grid.share > FREE * np.prod(grid.spacing[grid.kept], axis=1)[:, None], grid.share, 0.0)
        self.share = own.holding("share", share.reshape(-1), "node")
        world = Axis("world", bulk.worlds)
        length = grid.columns * grid.rows * NODE
        (self.node,) = own.reals((world, Axis("slot", length)), "node", kept=False)
        # What walls have taken since the start (J), and what nodes have gained of kinetic energy (J/m)
        self.lost, self.gained = own.reals((units.axis,), "lost", "gained", kind=own.exact)

    @ti.func
    def sum_strips(self, w, c, row):
        """What a node gathers from the strips of three columns of points, in one order; all zero without mass."""
        total = ti.Vector([ti.cast(0.0, self.real) for _ in ti.static(range(SLOTS))])
        for k in ti.static(range(WIDE)):
            if c >= k:
                slot = (((c - k) * WIDE + k) * self.rows + row) * SLOTS
                if self.spread.strips[w, slot + MASS] > 0.0:
                    for q in ti.static(range(SLOTS)):
                        total[q] += self.spread.strips[w, slot + q]
        return total

    @ti.func
    def felt(self, w, t):
        """The frame of the tank (b_y, b_z, φ̇, φ̈), of one that responds with its last acceleration."""
        frame = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(4))])
        if ti.static(self.twice):
            s = self.carrier.kinematics(w, t)
            b = turned(-s[6], -self.carrier.gravity[0] - s[7], -s[2])
            frame = ti.Vector([b[0], b[1], s[5], s[8]])
        else:
            found = self.carrier.frame(w, t)
            frame = ti.Vector([ti.cast(found[k], self.exact) for k in ti.static(range(4))])
        return frame

    @ti.func
    def react(self, u, t, kick, dt):
        """The load of a unit's nodes on the walls; of a tank that does not respond, their velocities, too."""
        self.load.begin(u)
        self.move(u, self.felt(self.units.world(u), t), kick, dt, True)

    @ti.func
    def kick(self, u, frame, kick, dt):
        """The velocities of a unit's nodes in the middle of the step; returns that all is well."""
        self.move(u, frame, kick, dt, False)
        return True

    @ti.func
    def move(self, u, frame: ti.template(), kick, dt, books: ti.template()):
        """Give the nodes of a unit the velocities after the step, and with `books` book the walls' reaction."""
        w = self.units.world(u)
        c = self.units.first(u)
        while c < self.units.end(u):  # those of one tank after the other
            tank, last = self.kept[c], self.units.end(u)
            load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
            lost, gained = ti.cast(0.0, self.exact), ti.cast(0.0, self.exact)
            while c < last and self.kept[c] == tank:
                for row in range(self.rows):
                    push, taken, gain = self.move_node(w, c, row, frame, kick)
                    for k in ti.static(range(3)):
                        load[k] += ti.cast(push[k], self.exact)
                    lost, gained = lost + ti.cast(taken, self.exact), gained + ti.cast(gain, self.exact)
                c += 1
            if ti.static(books):
                self.load.book(u, tank, (self.numbers[1] / kick) * load, dt)
            if ti.static(books != self.twice):
                self.lost[u] = self.lost[u] + self.numbers[1] * lost
                self.gained[u] = self.gained[u] + gained

    @ti.func
    def move_node(self, w, c, row, frame: ti.template(), kick):
        """Velocity of a node after the step; returns its impulse on the walls and the moment, the energy that
        walls take (impulse times mean velocity), and its gain of kinetic energy.

        In the tank's frame (b, φ̇, φ̈) it feels b − φ̈ × r + φ̇² r − 2 φ̇ × u; the last turns the velocity (Cayley).
        """
        zero = ti.cast(0.0, self.real)
        push, taken, gain = ti.Vector([zero, zero, zero]), zero, zero
        total, slot = self.sum_strips(w, c, row), c * self.rows + row
        v_y, v_z, old_y, old_z = zero, zero, zero, zero
        if total[MASS] > 0.0:
            y, z = self.places[c, 0], self.places[c, 1] + row * self.places[c, 2]
            b_y, b_z = ti.cast(frame[0], self.real), ti.cast(frame[1], self.real)
            if ti.static(self.carrier.rotating):
                rate, rise = ti.cast(frame[2], self.real), ti.cast(frame[3], self.real)
                b_y += rise * z + rate * rate * y
                b_z += rate * rate * z - rise * y
            old_y, old_z = total[ALONG] / total[MASS], total[UP] / total[MASS]
            u_y = old_y + total[PUSHED_ALONG] / total[MASS] + kick * b_y
            u_z = old_z + total[PUSHED_UP] / total[MASS] + kick * b_z
            v_y, v_z = u_y, u_z
            if ti.static(self.carrier.rotating):
                half = kick * ti.cast(frame[2], self.real)
                share = 1.0 / (1.0 + half * half)
                v_y = share * ((1.0 - half * half) * u_y + 2.0 * half * u_z)
                v_z = share * ((1.0 - half * half) * u_z - 2.0 * half * u_y)
            if self.walls[slot] > 0:
                free_y, free_z = v_y, v_z
                for k in range(self.walls[slot]):
                    n_y, n_z = self.normal[(slot * MOST + k) * 2], self.normal[(slot * MOST + k) * 2 + 1]
                    into = -(v_y * n_y + v_z * n_z)
                    if into > 0.0:
                        v_y, v_z = v_y + into * n_y, v_z + into * n_z
                        fast = ti.sqrt(v_y * v_y + v_z * v_z)
                        slower = ti.max(0.0, 1.0 - self.numbers[0] * into / ti.max(fast, 1e-20))
                        v_y, v_z = slower * v_y, slower * v_z
                push_y, push_z = total[MASS] * (free_y - v_y), total[MASS] * (free_z - v_z)
                push = ti.Vector([push_y, push_z, y * push_z - z * push_y])
                taken = 0.5 * (push_y * (old_y + v_y) + push_z * (old_z + v_z))
            gain = 0.5 * total[MASS] * (v_y * v_y + v_z * v_z - old_y * old_y - old_z * old_z)
        self.node[w, NODE * slot + V_Y], self.node[w, NODE * slot + V_Z] = v_y, v_z
        self.node[w, NODE * slot + HAS], self.node[w, NODE * slot + MAY] = total[MASS], self.share[slot]
        self.node[w, NODE * slot + OLD_Y], self.node[w, NODE * slot + OLD_Z] = old_y, old_z
        return push, taken, gain
