"""From forces to motion: Newton's second law in the tank's frame, for the grains of a unit."""

import taichi as ti

from solvers.grains.shapes.pose import towards
from solvers.grains.state import Grains
from solvers.machine.state import Axis, State
from solvers.machine.units import APART, Units


@ti.data_oriented
class Mover:
    """Moves grains and keeps account of the force on the tank.

    Forces between grains cancel in the sum over all, so what is left of the sum of all contact forces is what walls,
    fixed grains and parts do to the cargo: `load[u]` adds up its impulse (N s) and its moment about the tank's
    origin (N m s), with the sign of the cargo on the tank.
    """

    def __init__(self, arrays: State, units: Units, grains: Grains, integrator, rotating: bool, weighed: bool = False):
        self.units, self.grains, self.integrator, self.rotating = units, grains, integrator, rotating
        own = arrays.under("mover")
        self.weighed = weighed  # before every move, by `weigh`
        if weighed:
            apart = Axis("unit", APART * units.count)
            self.weights = own.reals((apart,), "weight_y", "weight_z", "weight_moment", kind=own.exact, kept=False)
        self.extra = own.reals(grains.axes, *(f"extra.{k}" for k in range(integrator.extra)))
        loads = own.reals((units.axis,), "load_y", "load_z", "load_moment", kind=own.exact)
        self.load_y, self.load_z, self.load_moment = loads

    def rest(self) -> None:
        """Forget higher derivatives and the load, for grains that were put somewhere or launched."""
        for field in (*self.extra, self.load_y, self.load_z, self.load_moment):
            field.fill(0.0)

    @ti.func
    def weigh(self, g: ti.template(), u, dt):
        """Note a unit's force (N) on the tank and its moment (N m), before the move; adds up their impulse."""
        w = self.units.world(u)
        load_y, load_z, moment = ti.cast(0.0, g.real), ti.cast(0.0, g.real), ti.cast(0.0, g.real)
        for i in range(self.units.first(u), self.units.end(u)):
            force_y, force_z = g.force_y[w, i], g.force_z[w, i]
            load_y -= force_y
            load_z -= force_z
            moment -= ti.cast(g.y[w, i], g.real) * force_z - ti.cast(g.z[w, i], g.real) * force_y + g.torque[w, i]
        self.add_up(u, load_y, load_z, moment, dt)
        self.weights[0][APART * u], self.weights[1][APART * u], self.weights[2][APART * u] = load_y, load_z, moment

    @ti.func
    def weight(self, u):
        """What `weigh` has noted."""
        return ti.Vector([self.weights[k][APART * u] for k in ti.static(range(3))])

    @ti.func
    def add_up(self, u, load_y, load_z, moment, dt):
        self.load_y[u] = self.load_y[u] + load_y * dt
        self.load_z[u] = self.load_z[u] + load_z * dt
        self.load_moment[u] = self.load_moment[u] + moment * dt

    @ti.func
    def move(self, g: ti.template(), u, body, first, dt):
        """Take the grains of a unit through one step of dt (s), and clear their forces.

        `body` = (b_y, b_z, φ̇, φ̈) is the tank's motion; in its frame a grain feels b − φ̈ × r + φ̇² r − 2 φ̇ × u and
        its spin changes by −φ̈.

        Returns a bound on the speeds (m/s), their 16-norm: at most n^(1/16) times the largest (1.6 for 2000 grains),
        and NaN or huge where the state is bad. The compiler turns the loop into SIMD instructions with sums in it, but
        not with a largest value.
        """
        w = self.units.world(u)
        zero = ti.cast(0.0, g.real)
        total, load_y, load_z, moment = zero, zero, zero, zero
        for i in range(self.units.first(u), self.units.end(u)):
            force_y, force_z, torque = g.force_y[w, i], g.force_z[w, i], g.torque[w, i]
            y, z = ti.cast(g.y[w, i], g.real), ti.cast(g.z[w, i], g.real)
            if ti.static(not self.weighed):
                load_y -= force_y
                load_z -= force_z
                moment -= y * force_z - z * force_y + torque
            by, bz, spin_up = body[0], body[1], zero
            if ti.static(self.rotating):
                rate = body[2]
                by += body[3] * z + rate * (rate * y + 2.0 * g.now_z[w, i])
                bz += -body[3] * y + rate * (rate * z - 2.0 * g.now_y[w, i])
                spin_up = -body[3]
            if ti.static(g.may_leave):
                by, bz, spin_up = by * g.present[w, i], bz * g.present[w, i], spin_up * g.present[w, i]
            ay = force_y * g.inverse_mass[w, i] + by
            az = force_z * g.inverse_mass[w, i] + bz
            turn = torque * g.inverse_inertia[w, i] + spin_up
            square = self.integrator.step(g, self.extra, w, i, ay, az, turn, first, dt)
            if ti.static(g.shaped):
                # No point of an outline is faster: (v + ω R)² is at most twice v² + ω² R².
                around = g.spin[w, i] * g.reach[w, i]
                square = 2.0 * (square + around * around)
            g.force_y[w, i], g.force_z[w, i], g.torque[w, i] = 0.0, 0.0, 0.0
            fourth = square * square
            eighth = fourth * fourth
            total += eighth * eighth
        if ti.static(g.shaped):
            self.turn(g, u)
        if ti.static(not self.weighed):
            self.add_up(u, load_y, load_z, moment, dt)
        return ti.sqrt(ti.sqrt(ti.sqrt(ti.sqrt(total))))

    @ti.func
    def turn(self, g: ti.template(), u):
        """Have orientations follow angles, in a loop of its own: the compiler turns it into SIMD instructions."""
        w = self.units.world(u)
        for i in range(self.units.first(u), self.units.end(u)):
            turn = towards(g.angle[w, i])
            g.turn_y[w, i], g.turn_z[w, i] = turn[0], turn[1]
