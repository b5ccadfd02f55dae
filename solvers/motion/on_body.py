"""A free body as the carrier of tanks aboard it: rooms of a hull that floats, with cargo in them."""

import numpy as np
import taichi as ti

from solvers.machine.errors import Unavailable
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.free import CENTRE_Y, CENTRE_Z, HELD, FreeBodies


@ti.data_oriented
class OnBody:
    """The carrier of what is in tanks aboard a free body, with the interface of `Prescribed`.

    Its frame is the body's axes as drawn, with the drawn origin: a point that is drawn at p is at O + R(θ) p in the
    tank in which the body is, which stands still. While the body is held, the frame is at rest.

    The body takes the load of the instant, before the cargo moves, so that neither lags behind the other. What the
    cargo feels in a step are turn and rate as it begins, and the acceleration by which the body reaches its velocities
    in the cargo's `kick`, as on an axle (`OnAxle`): what one gains the other loses.

    `pieces` bear the load of the cargo: the walls of these tanks, the parts in them, and fixed grains. Their loads are
    in the frame's axes, about its origin.
    """

    rotating = moving = responds = True
    has_multiples = False  # leapfrog needs steps of one length

    def __init__(self, arrays: State, scene, bodies: FreeBodies, carrier):
        self.bodies, self.gravity, self.exact, self.real = bodies, carrier.gravity, arrays.exact, arrays.real
        aboard = scene.tanks[0].aboard
        self.body, holds = bodies.parts.index(aboard), [k for k, tank in enumerate(scene.tanks) if tank.aboard == aboard]
        inner = [bodies.first + k for k, part in enumerate(scene.parts) if part.tank in holds]
        self.pieces = (*holds, *inner, *range(bodies.first + len(scene.parts), scene.pieces))
        self.of_pieces = np.isin(np.arange(scene.pieces), self.pieces)
        own, world = arrays.under("hold"), Axis("world", scene.worlds)
        names = "turn", "rate", "gain_y", "gain_z", "gain_turn"
        self.felt = own.reals((world,), *names, kind=own.exact, kept=False)

    @ti.func
    def note(self, w, turn, rate, gain: ti.template(), kick):
        """Note what the cargo feels of a step: turn and rate as it begins, and the `gain` in velocities in a `kick`."""
        self.felt[0][w], self.felt[1][w] = turn, rate
        for k in ti.static(range(3)):
            self.felt[2 + k][w] = gain[k] / kick

    @ti.func
    def load_from(self, w, load: ti.template()):
        """A load of what is aboard on the body: force in the axes of its tank, moment about its centre of mass."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        for piece in ti.static(self.pieces):
            found += load.on_piece(w, piece)
        y, z = self.bodies.table[self.body, CENTRE_Y], self.bodies.table[self.body, CENTRE_Z]
        force = turned(found[0], found[1], self.bodies.place[2][w, self.body])
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
    def frame(self, w, t):
        """The frame for the cargo: (b_y, b_z, ω, ω'), with the body force per mass b = R(−θ)(g − Ö)."""
        zero = ti.cast(0.0, self.exact)
        b, rate, rise = ti.Vector([zero, -self.gravity[0]]), zero, zero
        if self.bodies.state[w, self.body] != HELD:
            turn, gain_y, gain_z = self.felt[0][w], self.felt[2][w], self.felt[3][w]
            rate, rise = self.felt[1][w], self.felt[4][w]
            arm, square = self.origin(turn), rate * rate
            up_y, up_z = gain_y - rise * arm[1] - square * arm[0], gain_z + rise * arm[0] - square * arm[1]
            b = turned(-up_y, -self.gravity[0] - up_z, -turn)
        return ti.Vector([ti.cast(value, self.real) for value in ti.static([b[0], b[1], rate, rise])])

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
    first, *others = scene.tanks
    aboard = {tank.aboard for tank in scene.tanks} - {None}
    if not aboard:
        return
    part = scene.parts[first.aboard] if first.aboard in range(len(scene.parts)) else None
    outside = [tank for tank in others if tank.aboard is None]
    inside = [k for k, tank in enumerate(scene.tanks) if tank.aboard is not None]
    if aboard != {first.aboard} or not scene.grains:
        raise Unavailable("tanks aboard a body hold grains, all are aboard the same one, and the first tank is one of them")
    if part is None or not part.free:
        raise Unavailable(f"the tank is aboard part {first.aboard}, which does not float free: give it a mass and inertia")
    if scene.vessels or scene.axles or any(scene.motions):
        raise Unavailable("a tank aboard a free body needs all other tanks at rest: take out their motions, ship or axle")
    if any(scene.fills[k] for k in inside) or part.tank in inside or any(
        other.free and other.tank in inside for other in scene.parts
    ):
        raise Unavailable("a tank aboard a free body holds grains alone: put water and free bodies into another tank")
    if any(scene.tanks[k].open_edges for k in inside):
        raise Unavailable("a tank aboard a free body must be closed: take out its open edges")
    if any(tank.thickness != first.thickness for tank in (*others, *outside)):
        raise Unavailable("a tank aboard a free body must be as thick as the tank in which the body is")
