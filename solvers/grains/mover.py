"""From forces to motion: Newton's second law in the tank's frame, for the grains of a unit."""

import taichi as ti

from solvers.grains.shapes.pose import towards
from solvers.grains.state import GrainState
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.space.axes import cross

RATE, RISE = 2, 3  # of the tank's frame
TURNING, RISING = 3, 6  # in space: where its rate of turning begins, and that rate's own


@ti.data_oriented
class Mover:
    """Moves grains, in a tank that a `carrier` moves, or aboard a free body that the `hold` is of."""

    def __init__(self, arrays: State, units: Units, grains: GrainState, integrator, carrier, hold=None):
        self.units, self.grains, self.integrator = units, grains, integrator
        self.rotating, self.spatial = carrier.rotating, carrier.spatial
        self.hold, self.is_aboard = hold, hold is not None
        self.water, self.is_wet = None, False  # what water between the grains does to them, once it is known
        names = (f"extra.{k}" for k in range(integrator.extra * (grains.axes + grains.turns)))
        self.extra = arrays.under("mover").reals(grains.each, *names)

    def rest(self) -> None:
        """Forget higher derivatives, for grains that were put somewhere or launched."""
        for field in self.extra:
            field.fill(0.0)

    def soak(self, exchange) -> None:
        """Let water act on the grains, by an `exchange` (`solvers.mixture.exchange.Exchange`)."""
        self.water, self.is_wet = exchange, True

    @ti.func
    def move(self, g: ti.template(), u, body, kick, dt):
        """Take the grains of a unit through one step of dt (s), and clear their forces.

        `body` is the tank's motion, as `felt` takes it.

        Returns a bound on the speeds (m/s), their 16-norm: at most n^(1/16) times the largest (1.6 for 2000 grains),
        and NaN or huge where the state is bad. The compiler turns the loop into SIMD instructions with sums in it, but
        not with a largest value.
        """
        w = self.units.world(u)
        zero = ti.cast(0.0, g.real)
        total = zero
        for i in range(self.units.first(u), self.units.end(u)):
            force = [g.force[a][w, i] for a in ti.static(range(g.axes))]
            torque = [g.torque[k][w, i] for k in ti.static(range(g.turns))]
            b, spin_up = self.felt(g, w, i, body)
            if ti.static(g.may_leave):
                for a in ti.static(range(g.axes)):
                    b[a] = b[a] * g.present[w, i]
                for k in ti.static(range(g.turns)):
                    spin_up[k] = spin_up[k] * g.present[w, i]
            acceleration = [force[a] * g.inverse_mass[w, i] + b[a] for a in ti.static(range(g.axes))]
            turn = [torque[k] * g.inverse_inertia[w, i] + spin_up[k] for k in ti.static(range(g.turns))]
            if ti.static(self.is_aboard):
                gain = self.gain(g, w, i, force, kick, dt)
                for a in ti.static(range(g.axes)):
                    acceleration[a] = ti.cast(gain[a], g.real)
                turn[0] = torque[0] * g.inverse_inertia[w, i] + ti.cast(gain[2], g.real)
            if ti.static(self.is_wet and not self.is_aboard):
                self.water.act(w, i, acceleration, b, kick)
            square = self.integrator.step(g, self.extra, w, i, acceleration, turn, kick, dt)
            if ti.static(g.shaped):
                # No point of an outline is faster: (v + ω R)² is at most twice v² + ω² R².
                around = g.spin[0][w, i] * g.reach[w, i]
                square = 2.0 * (square + around * around)
            for a in ti.static(range(g.axes)):
                g.force[a][w, i] = 0.0
            for k in ti.static(range(g.turns)):
                g.torque[k][w, i] = 0.0
            fourth = square * square
            eighth = fourth * fourth
            total += eighth * eighth
        if ti.static(g.shaped):
            self.turn(g, u)
        return ti.sqrt(ti.sqrt(ti.sqrt(ti.sqrt(total))))

    @ti.func
    def felt(self, g: ti.template(), w, i, body: ti.template()):
        """What grain i feels of the tank's motion: accelerations (m/s²) along the axes, and of its spin (1/s²), lists.

        In the frame of `body` = (b_y, b_z, φ̇, φ̈) it feels b − φ̈ × r + φ̇² r − 2 φ̇ × u, with φ̇ along x: the tank moves
        in the plane and turns about x alone. Its spin s relative to the tank changes by −φ̈ − φ̇ × s; in the plane the
        last is zero.
        """
        b = [body[a] if ti.static(a < PLANE) else ti.cast(0.0, g.real) for a in ti.static(range(g.axes))]
        spin_up = [ti.cast(0.0, g.real) for _ in ti.static(range(g.turns))]
        if ti.static(self.spatial):
            self.feel_in_space(g, w, i, body, b, spin_up)
        elif ti.static(self.rotating):
            y, z = ti.cast(g.place[0][w, i], g.real), ti.cast(g.place[1][w, i], g.real)
            rate, rise = body[RATE], body[RISE]
            b[0] += rise * z + rate * (rate * y + 2.0 * g.now[1][w, i])
            b[1] += -rise * y + rate * (rate * z - 2.0 * g.now[0][w, i])
            spin_up[g.turns - 1] = -rise
            if ti.static(g.axes > PLANE):
                spin_up[0], spin_up[1] = rate * g.spin_now[1][w, i], -rate * g.spin_now[0][w, i]
        return b, spin_up

    @ti.func
    def feel_in_space(self, g: ti.template(), w, i, body: ti.template(), b: ti.template(), spin_up: ti.template()):
        """As `felt`, of a tank with all six freedoms: b − ω̇ × r − ω × (ω × r + 2 u), and −ω̇ − ω × s of the spin s.

        `body` = (b, ω, ω̇) in the tank's axes; the lists `b` and `spin_up` are filled.
        """
        place = [ti.cast(g.place[a][w, i], g.real) for a in ti.static(range(SPACE))]
        rate = [body[TURNING + a] for a in ti.static(range(SPACE))]
        rise = [body[RISING + a] for a in ti.static(range(SPACE))]
        around = cross(rate, place)
        within = cross(rate, [around[a] + 2.0 * g.now[a][w, i] for a in ti.static(range(SPACE))])
        swung = cross(rise, place)
        carried = cross(rate, [g.spin_now[a][w, i] for a in ti.static(range(SPACE))])
        for a in ti.static(range(SPACE)):
            b[a] = body[a] - swung[a] - within[a]
            spin_up[a] = -rise[a] - carried[a]

    @ti.func
    def gain(self, g: ti.template(), w, i, force: ti.template(), kick, dt):
        """How grain i, which contacts push with a `force` (N), and its spin gain in the axes of the body (`OnBody`)."""
        push = [force[a] * g.inverse_mass[w, i] for a in ti.static(range(g.axes))]
        place = [g.place[a][w, i] for a in ti.static(range(g.axes))]
        speed = [g.velocity[a][w, i] for a in ti.static(range(g.axes))]
        if ti.static(self.is_wet):
            self.water.act_aboard(w, i, place, speed, push, kick)
        return self.hold.gain(w, place, speed, push, kick, dt)

    @ti.func
    def turn(self, g: ti.template(), u):
        """Have orientations follow angles, in a loop of its own: the compiler turns it into SIMD instructions."""
        w = self.units.world(u)
        for i in range(self.units.first(u), self.units.end(u)):
            turn = towards(g.angle[0][w, i])
            g.turn_y[w, i], g.turn_z[w, i] = turn[0], turn[1]
