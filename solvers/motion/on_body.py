"""A free body as the carrier of tanks aboard it: rooms of a hull that floats, with cargo in them."""

import numpy as np
import taichi as ti

from solvers.machine.errors import Unavailable
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.free import CENTRE_Y, CENTRE_Z, HELD, LOOSE, FreeBodies

LAG, BEFORE_Y, BEFORE_Z, BEFORE, AFTER_Y, AFTER_Z, AFTER, KEPT, TURNED, COSINE, SINE, PULL_Y, PULL_Z = range(13)
THEN_COSINE, THEN_SINE, NOW_COSINE, NOW_SINE = range(13, 17)  # the body's turn, half a step before and now
NUMBERS = 17


@ti.data_oriented
class OnBody:
    """The carrier of what is in tanks aboard a free body: they stand in the body's axes as drawn, in which grains move.

    A point that is drawn at r is at O + R(θ) r in the tank in which the body is, which stands still. Over the earth
    grains have the velocity u = V + v + ω × r in the body's axes, V that of O, which only contacts and gravity change:
    with v half a step behind r, as the body's V and ω are,

        D (V + v + ω × r)_(n−½) + Δt R(−θ_(n+½)) (R(θ_n) F/m + g) = (V + v + ω × r)_(n+½),

    with r_(n±½) = r_n ± ½ Δt v_(n±½) and D, the turn of the axes in the step, is solved for the new v (own derivation:
    leapfrog over the earth, told in the body's axes). The body takes the load of the instant, before its cargo moves.
    So the momentum of both is kept to rounding, and moment of momentum and energy to second order. While the body is
    held, its tanks are at rest.

    Beside water a step of the body is `every` base steps long, of the grains one (impulses of the slow one, Tuckerman,
    Berne & Martyna 1992, but here the fast ones are summed). In the body's step from t_n, in which V and ω stand still,
    it takes the impulse of its cargo since the step before, and as that is of the time L = (every − 1) Δt/2 before t_n,

        J_n = Σ Δt F(t_k) + L (F(t_n) − F(t_(n−1))),    t_(n−1) < t_k ≤ t_n,

    of the second order; on springs that stand still it is that of leapfrog, every Δt F(t_n), as V is constant between.
    The second term does not add up: what body and grains have together, and what is `gathered`, less L F(t_n), is kept
    to rounding.

    `pieces` bear the load of the cargo: the walls of these tanks, the parts in them, and fixed grains. Their loads are
    in the body's axes, about the drawn origin. `noted` (W, numbers) is what grains need of the body in a step: how long
    (s) before its beginning its velocities are of that time; V and ω before and after the step's kick; D; R(θ_n −
    θ_(n+½)); R(−θ_(n+½)) g; where grains are `wet`, R(θ_(n−½)) and R(θ_n), too. `gathered` (N s, N m s) is the cargo's
    impulse that the body has not taken yet, over `span` (s), with `former` the load as its last step began; `done`
    counts the grains' steps in a step of the body.
    """

    moving, spatial = True, False

    def __init__(self, arrays: State, scene, bodies: FreeBodies, carrier):
        self.bodies, self.gravity, self.exact, self.every = bodies, carrier.gravity, arrays.exact, bodies.every
        self.wet = scene.mixture is not None  # whether water of the tank of the body acts on the cargo
        aboard = scene.tanks[scene.hold].aboard
        holds = [k for k, tank in enumerate(scene.tanks) if tank.aboard == aboard]
        inner = [bodies.first + k for k, part in enumerate(scene.parts) if part.tank in holds]
        self.body = bodies.parts.index(aboard)
        self.pieces = (*holds, *inner, *range(bodies.first + len(scene.parts), scene.pieces))
        self.of_pieces = np.isin(np.arange(scene.pieces), self.pieces)
        own, each = arrays.under("hold"), (Axis("world", scene.worlds), Axis("number", NUMBERS))
        (self.noted,) = own.reals(each, "noted", kind=own.exact, kept=False)
        impulse = each[0], Axis("freedom", 3)
        self.gathered, self.former = own.reals(impulse, "gathered", "former", kind=own.exact)
        (self.span,) = own.reals(each[:1], "span", kind=own.exact)
        (self.done,) = own.integers(each[:1], "done", kept=False)  # 0 whenever a run can be looked at
        self.gathering = (Phase(self.gather),)  # once the cargo's load is known
        self.phases = (Phase(self.go_on),) if self.every > 1 else ()  # once the body has moved

    def take(self, load) -> None:
        """Take the `load` of the cargo."""
        self.load = load

    def forget(self) -> None:
        """Forget what the cargo has pushed."""
        for field in (self.gathered, self.former, self.span, self.done):
            field.fill(0)

    @ti.func
    def turn_now(self, w, dt):
        """The turn of the body as a base step of dt (s) begins; its place is that at the end of its own step."""
        turn = self.bodies.place[2][w, self.body]
        if ti.static(self.every > 1):  # noqa: SIM102
            if self.done[w] > 0:
                turn -= (self.every - self.done[w]) * dt * self.bodies.velocity[2][w, self.body]
        return turn

    @ti.func
    def gather(self, w, t, kick, dt):
        """Gather the present load of the cargo of a world, over a kick (s) of a base step of dt (s)."""
        during, step = ti.cast(kick, self.exact), ti.cast(dt, self.exact)
        load = self.present(w, self.turn_now(w, step))
        for k in ti.static(range(3)):
            self.gathered[w, k] = self.gathered[w, k] + during * load[k]
        self.span[w] = self.span[w] + during
        if ti.static(self.every > 1):  # noqa: SIM102
            if self.done[w] == 0:
                lag = 0.5 * (self.every - 1) * step
                for k in ti.static(range(3)):
                    if self.bodies.state[w, self.body] == LOOSE:
                        self.gathered[w, k] = self.gathered[w, k] + lag * (load[k] - self.former[w, k])
                    self.former[w, k] = load[k]

    @ti.func
    def mean(self, w):
        """The load of the cargo on the body in its present step: force, and moment about its centre of mass."""
        return ti.Vector([self.gathered[w, k] / self.span[w] for k in ti.static(range(3))])

    @ti.func
    def taken(self, w):
        """The body has taken what was gathered."""
        for k in ti.static(range(3)):
            self.gathered[w, k] = 0.0
        self.span[w] = 0.0

    @ti.func
    def go_on(self, w, t, kick, dt):
        """Note the body for a base step within its own step, and count these."""
        if self.done[w] > 0 and self.bodies.state[w, self.body] != HELD:
            step = ti.cast(dt, self.exact)
            u = ti.Vector([self.bodies.velocity[k][w, self.body] for k in ti.static(range(3))])
            self.note(w, self.turn_now(w, step), u, u, step, step)
        self.done[w] = (self.done[w] + 1) % self.every

    @ti.func
    def note(self, w, turn, before: ti.template(), after: ti.template(), kick, dt):
        """Note the velocities of the body before and after the kick (s) of a base step of dt (s), and its turn then."""
        half = 0.5 * dt
        lag = kick - half
        self.noted[w, LAG] = lag
        self.note_velocity(w, BEFORE_Y, turn - lag * before[2], before)
        later = turn + half * after[2]
        self.note_velocity(w, AFTER_Y, later, after)
        through, rest = turned(1.0, 0.0, turn - lag * before[2] - later), turned(1.0, 0.0, turn - later)
        self.noted[w, KEPT], self.noted[w, TURNED] = through[0], through[1]
        self.noted[w, COSINE], self.noted[w, SINE] = rest[0], rest[1]
        pull = turned(0.0, -self.gravity[0], -later)
        self.noted[w, PULL_Y], self.noted[w, PULL_Z] = pull[0], pull[1]
        if ti.static(self.wet):
            self.note_axes(w, turn - lag * before[2], turn)

    @ti.func
    def note_axes(self, w, then, now):
        """Note the turns of the body at the time of the grains' velocities, and at that of their places."""
        before, at = turned(1.0, 0.0, then), turned(1.0, 0.0, now)
        self.noted[w, THEN_COSINE], self.noted[w, THEN_SINE] = before[0], before[1]
        self.noted[w, NOW_COSINE], self.noted[w, NOW_SINE] = at[0], at[1]

    @ti.func
    def note_held(self, w):
        """Note for a step of the body that it stands as drawn, if it is held."""
        if self.bodies.state[w, self.body] == HELD:
            zero = ti.cast(0.0, self.exact)
            for k in ti.static((LAG, BEFORE_Y, BEFORE_Z, BEFORE)):
                self.noted[w, k] = zero
            self.note_axes(w, zero, zero)

    @ti.func
    def over_earth(self, w, place: ti.template(), speed: ti.template()):
        """The velocity (m/s) over the earth, in the axes of the tank of the body, that a `speed` of a grain means."""
        n = ti.static(self.noted)
        y, z = ti.cast(place[0], self.exact), ti.cast(place[1], self.exact)
        v_y, v_z = ti.cast(speed[0], self.exact), ti.cast(speed[1], self.exact)
        u_y = n[w, BEFORE_Y] + v_y - n[w, BEFORE] * (z - n[w, LAG] * v_z)
        u_z = n[w, BEFORE_Z] + v_z + n[w, BEFORE] * (y - n[w, LAG] * v_y)
        cos, sin = n[w, THEN_COSINE], n[w, THEN_SINE]
        return ti.Vector([cos * u_y - sin * u_z, sin * u_y + cos * u_z])

    @ti.func
    def into_tank(self, w, y, z):
        """A vector of now, told in the body's axes, in those of the tank of the body."""
        cos, sin = self.noted[w, NOW_COSINE], self.noted[w, NOW_SINE]
        return ti.Vector([cos * y - sin * z, sin * y + cos * z])

    @ti.func
    def into_body(self, w, y, z):
        """The reverse of `into_tank`."""
        cos, sin = self.noted[w, NOW_COSINE], self.noted[w, NOW_SINE]
        return ti.Vector([cos * y + sin * z, cos * z - sin * y])

    @ti.func
    def led(self, w, y, z, kick, dt):
        """By what the velocity of a grain in the body's axes changes as that over the earth does by (y, z) m/s.

        A step of the body of dt (s) begins, and the velocities are those of some time before: v − τ ω × v changes, with
        the arm that the grain had then.
        """
        lag, turn = (kick - 0.5 * dt) / self.every, self.bodies.place[2][w, self.body]
        back = ti.cast(0.0, self.exact)
        if self.bodies.state[w, self.body] != HELD:
            back = lag * self.bodies.velocity[2][w, self.body]
        found = turned(y, z, back - turn)
        less = 1.0 / (1.0 + back * back)
        return ti.Vector([less * (found[0] - back * found[1]), less * (found[1] + back * found[0])])

    @ti.func
    def note_velocity(self, w, first: ti.template(), turn, u: ti.template()):
        """Note the velocity of the drawn origin at a turn, in the body's axes, and the rate."""
        v = turned(u[0], u[1], -turn)
        y, z = self.bodies.table[self.body, CENTRE_Y], self.bodies.table[self.body, CENTRE_Z]
        self.noted[w, first], self.noted[w, first + 1] = v[0] + u[2] * z, v[1] - u[2] * y
        self.noted[w, first + 2] = u[2]

    @ti.func
    def gain(self, w, place: ti.template(), speed: ti.template(), push: ti.template(), kick, dt):
        """How a grain is accelerated in the body's axes (m/s²), and its spin by these axes (1/s²).

        It is at a `place` (m) as the step of dt (s) begins and had a `speed` (m/s) before; contacts accelerate it by
        `push` (m/s²). All are lists.
        """
        n = ti.static(self.noted)
        during, zero = ti.cast(kick, self.exact), ti.cast(0.0, self.exact)
        y, z = ti.cast(place[0], self.exact), ti.cast(place[1], self.exact)
        v_y, v_z = ti.cast(speed[0], self.exact), ti.cast(speed[1], self.exact)
        a_y, a_z = ti.cast(push[0], self.exact), ti.cast(push[1], self.exact)
        found = ti.Vector([a_y, a_z - self.gravity[0], zero])
        if self.bodies.state[w, self.body] != HELD:
            before, rate, lag = n[w, BEFORE], n[w, AFTER], n[w, LAG]
            u_y = n[w, BEFORE_Y] + v_y - before * (z - lag * v_z)
            u_z = n[w, BEFORE_Z] + v_z + before * (y - lag * v_y)
            g_y = n[w, COSINE] * a_y - n[w, SINE] * a_z + n[w, PULL_Y]
            g_z = n[w, SINE] * a_y + n[w, COSINE] * a_z + n[w, PULL_Z]
            w_y = n[w, KEPT] * u_y - n[w, TURNED] * u_z + during * g_y - n[w, AFTER_Y] + rate * z
            w_z = n[w, TURNED] * u_y + n[w, KEPT] * u_z + during * g_z - n[w, AFTER_Z] - rate * y
            swing = 0.5 * ti.cast(dt, self.exact) * rate  # of v + swing × v = w
            less = 1.0 / (1.0 + swing * swing)
            found[0] = (less * (w_y + swing * w_z) - v_y) / during
            found[1] = (less * (w_z - swing * w_y) - v_z) / during
            found[2] = (before - rate) / during
        return found

    @ti.func
    def present(self, w, turn):
        """The present load of the cargo on the body: force in the axes of its tank, moment about its centre of mass."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for piece in ti.static(self.pieces):
            found += self.load.on_piece(w, piece)
        y, z = self.bodies.table[self.body, CENTRE_Y], self.bodies.table[self.body, CENTRE_Z]
        force = turned(found[0], found[1], turn)
        return ti.Vector([force[0], force[1], found[2] - (y * found[1] - z * found[0])])

    @ti.func
    def origin(self, turn):
        """The drawn origin from the centre of mass (m), at a turn."""
        return turned(0.0 - self.bodies.table[self.body, CENTRE_Y], 0.0 - self.bodies.table[self.body, CENTRE_Z], turn)

    @ti.func
    def last(self, w):
        """The body's last known accelerations."""
        return ti.Vector([self.bodies.acceleration[k][w, self.body] for k in ti.static(range(3))])

    @ti.func
    def kinematics(self, w, time):
        """Pose (Y, Z, θ) of the drawn origin now, its velocity and its acceleration in the earth frame.

        The acceleration is that of the last step: the present one follows from a load that may depend on it.
        """
        turn, a = self.bodies.place[2][w, self.body], self.last(w)
        arm, u = self.origin(turn), self.bodies.velocity_with(w, self.body, a)
        y, z, square = self.bodies.place[0][w, self.body], self.bodies.place[1][w, self.body], u[2] * u[2]
        up = ti.Vector([a[0] - a[2] * arm[1] - square * arm[0], a[1] + a[2] * arm[0] - square * arm[1]])
        y, z = y + arm[0], z + arm[1]
        return ti.Vector([y, z, turn, u[0] - u[2] * arm[1], u[1] + u[2] * arm[0], u[2], up[0], up[1], a[2]])


def check_aboard(scene) -> None:
    """Raise Unavailable if a scene (`solvers.scene.Scene`) has tanks aboard parts that cannot carry them."""
    inside = [k for k, tank in enumerate(scene.tanks) if tank.aboard is not None]
    if not inside:
        return
    aboard = {scene.tanks[k].aboard for k in inside}
    if len(aboard) > 1 or not scene.grains:
        raise Unavailable("tanks aboard a body hold grains, and all are aboard the same one")
    (number,) = aboard
    part = scene.parts[number] if number in range(len(scene.parts)) else None
    if part is None or not part.free:
        raise Unavailable(f"a tank is aboard part {number}, which does not float free: give it a mass and inertia")
    if scene.vessels or scene.axles or any(scene.motions):
        raise Unavailable(
            "a tank aboard a free body needs all other tanks at rest: take out their motions, ship or axle"
        )
    if (
        any(scene.fills[k] for k in inside)
        or part.tank in inside
        or any(other.free and other.tank in inside for other in scene.parts)
    ):
        raise Unavailable("a tank aboard a free body holds grains alone: put water and free bodies into another tank")
    if scene.grains.integrator != "verlet":
        raise Unavailable('grains aboard a free body move by run.integrator = "verlet" alone')
    if any(scene.tanks[k].open_edges for k in inside):
        raise Unavailable("a tank aboard a free body must be closed: take out its open edges")
    if any(tank.thickness != scene.tanks[0].thickness for tank in scene.tanks):
        raise Unavailable("a tank aboard a free body must be as thick as the tank in which the body is")
