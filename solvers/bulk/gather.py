"""From nodes back to points: their velocities, places, volumes and stresses."""

import numpy as np
import taichi as ti

from solvers.bulk.given import BAND, EVENED, Bulk
from solvers.bulk.laws import LAWS
from solvers.bulk.nodes import HAS, MAY, NODE, OLD_Y, OLD_Z, V_Y, V_Z, Nodes
from solvers.bulk.order import Order
from solvers.bulk.spread import WIDE, Spread
from solvers.bulk.state import ALONG_Y, ALONG_Z, SHEAR, Points
from solvers.bulk.weights import weights
from solvers.machine.state import Axis, State
from solvers.machine.units import Units

FASTEST = 0.5  # of the speed of sound: the highest speed of a point
DEEP = 1.5  # cells below the surface a point knows the density from all sides: so far reach the nodes that carry it


@ti.data_oriented
class Gather:
    """Moves the points with the nodes, and lets their stresses follow.

    A point takes the nodes' change of velocity over, and keeps what its own differs from the nodes' old one (Fei et al.
    2021, AFLIP). That difference fades at the rate √(g/h), in about the time in which grains fall by a cell. Points
    that took the nodes' velocity itself would lose the difference in every step: a viscosity of the order h²/Δt, which
    holds a bed the more the shorter the steps.

    A point is elastic (Jaumann's rate) below yield, else its shear stress returns to what the `law` holds at its
    pressure, which no plastic strain changes; looser than at rest it is free of stress (Dunatunga & Kamrin 2015).
    Where the grid knows more density than the point's own volume says, by more than a BAND, the volume follows at the
    rate EVENED, and where it knows less, too, if the point is DEEP: the grid is half empty at the surface. The sum of
    many small errors of the velocity gradient would else be room that is lost, or won.

    A bed that `softens` holds, after the plastic shear strain γ,

        μ = μ_s + (μ_start − μ_s) exp(−γ/γ_s)

    since grains must first ride up on each other. It does not heal at rest. (Source: ours, softening that is
    exponential in the strain.)
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        points: Points,
        order: Order,
        spread: Spread,
        nodes: Nodes,
        bulk: Bulk,
        gravity: float,
    ):
        self.units, self.points, self.order, self.spread, self.nodes = units, points, order, spread, nodes
        self.rows, self.exact, self.law = bulk.grid.rows, arrays.exact, LAWS[bulk.material.law]()
        m = bulk.material
        self.softens = m.softens
        own = arrays.under("bulk.gather")
        numbers = [
            m.shear_modulus,
            m.friction,
            m.fast_friction,
            m.alpha,
            FASTEST * m.sound_speed,
            nodes.thickness,
            1.0 + m.density * gravity * DEEP * bulk.grid.smallest / m.bulk_modulus,
            m.start_friction - m.friction,
            m.softening,
            (gravity / bulk.grid.smallest) ** 0.5,
        ]
        self.numbers = own.holding("numbers", np.array(numbers), "number")
        (self.fastest,) = own.reals((units.axis,), "fastest", kept=False)
        (self.lost,) = own.reals((units.axis, Axis("way", 3)), "lost", kind=own.exact)

    @ti.func
    def move(self, u, frame, kick, dt):
        """Move the points of a unit's columns; returns whether all of them are slow enough."""
        w = self.units.world(u)
        zero = ti.cast(0.0, self.points.real)
        most, total, lost = zero, zero, ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for c in range(self.units.first(u), self.units.end(u)):
            for k in range(self.order.first[w, c], self.order.first[w, c + 1]):
                i = self.order.listed[w, k]
                over, square = self.follow(w, c, i, kick, dt)
                most, total = ti.max(most, square), total + square
                spent = self.strain(w, i, over, kick, dt)
                for way in ti.static(range(3)):
                    lost[way] += ti.cast(spent[way], self.exact)
        for way in ti.static(range(3)):
            self.lost[u, way] = self.lost[u, way] + ti.cast(self.numbers[5], self.exact) * lost[way]
        self.fastest[u] = ti.sqrt(most)
        if not total < 1e30:  # the largest value may pass over what is no number, a sum does not
            self.fastest[u] = total
        return self.fastest[u] < self.numbers[4]

    @ti.func
    def follow(self, w, c, i, kick, dt):
        """Move a point with its nodes; returns how much denser (share) they know it to be, and its speed squared."""
        p, tank = self.points, self.order.of(i)
        zero = ti.cast(0.0, p.real)
        _, far_y = self.order.cells(w, i, 0)
        row, far_z = self.order.cells(w, i, 1)
        along, up = weights(far_y), weights(far_z)
        v_y, v_z, yy, yz, zy, zz, has, may = zero, zero, zero, zero, zero, zero, zero, zero
        old_y, old_z = zero, zero
        for a in ti.static(range(WIDE)):
            first = ((c + a) * self.rows + row) * NODE
            sum_y, sum_z, tilt_y, tilt_z = zero, zero, zero, zero
            for b in ti.static(range(WIDE)):
                slot = first + NODE * b
                of_y, of_z = up[b] * self.nodes.node[w, slot + V_Y], up[b] * self.nodes.node[w, slot + V_Z]
                sum_y, sum_z = sum_y + of_y, sum_z + of_z
                tilt_y, tilt_z = tilt_y + (b - far_z) * of_y, tilt_z + (b - far_z) * of_z
                old_y += along[a] * (up[b] * self.nodes.node[w, slot + OLD_Y])
                old_z += along[a] * (up[b] * self.nodes.node[w, slot + OLD_Z])
                has += along[a] * (up[b] * self.nodes.node[w, slot + HAS])
                may += along[a] * (up[b] * self.nodes.node[w, slot + MAY])
            v_y, v_z = v_y + along[a] * sum_y, v_z + along[a] * sum_z
            yy, zy = yy + (along[a] * (a - far_y)) * sum_y, zy + (along[a] * (a - far_y)) * sum_z
            yz, zz = yz + along[a] * tilt_y, zz + along[a] * tilt_z
        over = zero
        if may > 0.0:
            over = has * p.volume[w, i] / (p.mass[w, i] * may) - 1.0
        finer = [4.0 * ti.cast(self.order.table[tank, 2 + a], p.real) for a in ti.static(range(2))]
        left = ti.max(zero, 1.0 - kick * self.numbers[9])
        p.velocity[0][w, i] = v_y + left * (p.velocity[0][w, i] - old_y)
        p.velocity[1][w, i] = v_z + left * (p.velocity[1][w, i] - old_z)
        p.gradient[0][w, i], p.gradient[1][w, i] = finer[0] * yy, finer[1] * yz
        p.gradient[2][w, i], p.gradient[3][w, i] = finer[0] * zy, finer[1] * zz
        p.place[0][w, i] = p.place[0][w, i] + dt * v_y
        p.place[1][w, i] = p.place[1][w, i] + dt * v_z
        return over, v_y * v_y + v_z * v_z

    @ti.func
    def strain(self, w, i, over, kick, dt):
        """Let volume and stress of a point follow its velocity gradient; returns the energies (J/m) that it loses."""
        p = self.points
        yy, yz, zy, zz = p.gradient[0][w, i], p.gradient[1][w, i], p.gradient[2][w, i], p.gradient[3][w, i]
        zero, shear, friction = ti.cast(0.0, p.real), self.numbers[0], self.numbers[1]
        if ti.static(self.softens):
            friction += self.numbers[7] * ti.exp(-p.strain[w, i] / self.numbers[8])
        opening = yy + zz
        third, spin = opening / 3.0, 0.5 * (yz - zy)
        volume = p.volume[w, i] * (1.0 + dt * opening)
        astray = ti.max(over - BAND, zero)
        if p.free[w, i] > p.volume[w, i] * self.numbers[6]:
            astray = over - ti.max(-BAND, ti.min(BAND, over))
        smaller = volume * dt * EVENED * astray
        p.volume[w, i] = volume - smaller
        s_yy, s_zz, s_yz = p.deviator[ALONG_Y][w, i], p.deviator[ALONG_Z][w, i], p.deviator[SHEAR][w, i]
        t_yy = s_yy + dt * (2.0 * shear * (yy - third) + 2.0 * spin * s_yz)
        t_zz = s_zz + dt * (2.0 * shear * (zz - third) - 2.0 * spin * s_yz)
        t_yz = s_yz + dt * (shear * (yz + zy) + spin * (s_zz - s_yy))
        t_xx = t_yy + t_zz
        tried = ti.sqrt(0.5 * (t_yy * t_yy + t_zz * t_zz + t_xx * t_xx) + t_yz * t_yz)
        pressure = self.spread.pressure(w, i)
        yielded, opened = zero, zero
        left, use = ti.cast(1.0, p.real), zero
        if pressure > 0.0:
            use = tried / (friction * pressure)
            if use > 1.0:
                held = self.law.held(tried, pressure, friction, self.numbers[2], self.numbers[3])
                left, use = held / tried, held / (friction * pressure)
                plastic = (tried - held) / shear
                yielded = p.volume[w, i] * held * plastic
                p.strain[w, i] = p.strain[w, i] + plastic
        else:
            s_xx = s_yy + s_zz
            stood = 0.5 * (s_yy * s_yy + s_zz * s_zz + s_xx * s_xx) + s_yz * s_yz
            left, opened = zero, p.volume[w, i] * stood / (2.0 * shear)
        p.use[w, i] = use
        p.deviator[ALONG_Y][w, i], p.deviator[ALONG_Z][w, i] = left * t_yy, left * t_zz
        p.deviator[SHEAR][w, i] = left * t_yz
        return ti.Vector([yielded, opened, -pressure * smaller])
