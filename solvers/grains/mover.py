"""From forces to motion: Newton's second law in the tank's frame, for the grains of a unit."""

import taichi as ti

from solvers.grains.shapes.pose import towards
from solvers.grains.state import Grains
from solvers.machine.state import State
from solvers.machine.units import Units


@ti.data_oriented
class Mover:
    """Moves grains, in a tank that may be `rotating`."""

    def __init__(self, arrays: State, units: Units, grains: Grains, integrator, rotating: bool):
        self.units, self.grains, self.integrator, self.rotating = units, grains, integrator, rotating
        names = (f"extra.{k}" for k in range(integrator.extra))
        self.extra = arrays.under("mover").reals(grains.axes, *names)

    def rest(self) -> None:
        """Forget higher derivatives, for grains that were put somewhere or launched."""
        for field in self.extra:
            field.fill(0.0)

    @ti.func
    def move(self, g: ti.template(), u, body, kick, dt):
        """Take the grains of a unit through one step of dt (s), and clear their forces.

        `body` = (b_y, b_z, φ̇, φ̈) is the tank's motion; in its frame a grain feels b − φ̈ × r + φ̇² r − 2 φ̇ × u and
        its spin changes by −φ̈.

        Returns a bound on the speeds (m/s), their 16-norm: at most n^(1/16) times the largest (1.6 for 2000 grains),
        and NaN or huge where the state is bad. The compiler turns the loop into SIMD instructions with sums in it, but
        not with a largest value.
        """
        w = self.units.world(u)
        zero = ti.cast(0.0, g.real)
        total = zero
        for i in range(self.units.first(u), self.units.end(u)):
            force_y, force_z, torque = g.force_y[w, i], g.force_z[w, i], g.torque[w, i]
            y, z = ti.cast(g.y[w, i], g.real), ti.cast(g.z[w, i], g.real)
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
            square = self.integrator.step(g, self.extra, w, i, ay, az, turn, kick, dt)
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
        return ti.sqrt(ti.sqrt(ti.sqrt(ti.sqrt(total))))

    @ti.func
    def turn(self, g: ti.template(), u):
        """Have orientations follow angles, in a loop of its own: the compiler turns it into SIMD instructions."""
        w = self.units.world(u)
        for i in range(self.units.first(u), self.units.end(u)):
            turn = towards(g.angle[w, i])
            g.turn_y[w, i], g.turn_z[w, i] = turn[0], turn[1]
