"""Bodies that are free to move in the tank, in the plane: three freedoms each, that respond to all that pushes them."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.quantity import PLANE, freedoms
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.poses import Poses
from solvers.tank.load import Load
from solvers.tank.parts import Part
from solvers.tank.pieces import COSINE, NUMBERS, RATE, SINE, V_Y, V_Z, Pieces, Y, Z
from solvers.tank.pose import AT_END, AT_MIDDLE, AT_START

MASS, INERTIA, CENTRE_Y, CENTRE_Z, RELEASE, ARM = range(6)  # columns of the table of bodies
HELD, LET_GO, LOOSE = range(3)  # a body stands in the tank, is let go in this step, or moves freely
BEYOND = 1e30  # m, a way in a step that no run bears: that of a body whose state is not a number
NOT_FREE = -1


def row_of(part: Part) -> list[float]:
    """The kernel's numbers of a free part: columns of the table of bodies."""
    free, corners = part.free, np.asarray(part.points, dtype=float)
    arm = np.linalg.norm(corners - np.array(free.centre), axis=1).max()
    return [free.mass, free.inertia, *free.centre, free.release, arm]


@ti.data_oriented
class FreeBodies:
    """m u' = F + m g, I ω' = M: rigid bodies, by leapfrog (Hairer, Lubich & Wanner 2003, Acta Numerica 12, 399).

    F and M, about the centre of mass, are the loads that all matters book on a body in this step, so that it gains what
    they lose. The velocities u and ω are inertial ones in the tank's axes, half a step behind the places, and drift as
    those of water do (`Poses`), whatever the motion of the tank. Their step is `every` base steps, as that of the
    water. Until its release a body is held: it stands in the tank where it is drawn. Then it starts with the tank's
    velocity.

    `place` (W, bodies; m, m, rad) are the centre of mass and the turn in the tank, `acceleration` the last known one
    over the earth, which the velocities are to have for the time `behind` (s) until now; `work` (J) is what all loads
    have done on each body. `of_part` has the bodies' numbers by those of the parts. The load on the k-th part is that
    on the piece `first` + k.
    """

    axes, row_of = PLANE, staticmethod(row_of)

    def __init__(self, arrays: State, pieces: Pieces, carrier, first: int, every: int = 1):
        free, self.freedoms = [k for k, part in enumerate(pieces.parts) if part.free], len(freedoms(self.axes))
        self.pieces, self.count, self.worlds, self.first = pieces, len(free), pieces.worlds, first
        self.parts, self.loads, self.exact, self.hold = free, (), arrays.exact, None
        self.carries, self.every = False, every  # `carries`: whether there are tanks aboard
        self.phases, self.opening, self.own_loads = (Phase(self.follow, every=every),) if free else (), (), ()
        if not free:
            return
        own, of_part = arrays.under("free"), np.full(pieces.count, NOT_FREE)
        of_part[free] = np.arange(self.count)
        self.of_part = own.holding("of_part", of_part, "part", ti.i32)
        self.part_of = own.holding("part_of", np.array(free), "body", ti.i32)
        self.rows = np.array([self.row_of(pieces.parts[k]) for k in free])
        self.table = own.holding("bodies", self.rows, "body number", own.exact)
        self.declare(own, each := (Axis("world", self.worlds), Axis("body", self.count)), carrier)
        self.work, self.behind = own.reals(each, "work", "behind", kind=own.exact)
        (self.state,) = own.integers(each, "state")

    def declare(self, own: State, each: tuple[Axis, ...], carrier) -> None:
        """Make the arrays of places and velocities."""
        self.of_tank = Poses(own, carrier, self.worlds)
        names = ("y", "z", "turn"), ("velocity_y", "velocity_z", "rate"), ("gain_y", "gain_z", "gain_turn")
        self.place, self.velocity, self.acceleration = (own.reals(each, *of, kind=own.exact) for of in names)

    def join(self, contacts) -> None:
        """Take the `contacts` of the bodies, which are found as a step opens."""
        self.contacts, self.own_loads = contacts, (contacts.load,)
        self.opening = tuple(replace(phase, every=self.every) for phase in contacts.phases)

    def take_aboard(self, hold) -> None:
        """Carry tanks: the `hold` (`solvers.motion.on_body.OnBody`) of one of the bodies."""
        self.hold, self.carries, self.phases = hold, True, (*self.phases, *hold.phases)

    def bear(self, loads: Sequence[Load]) -> None:
        """Respond to these loads from now on, those of all matters and of contacts."""
        self.loads = tuple(loads)

    def hold_all(self) -> None:
        """Hold all bodies where they are drawn, until their releases."""
        if self.count:
            for field in (*self.place, *self.velocity, *self.acceleration, self.work, self.behind):
                field.fill(0.0)
            self.draw()
            self.state.fill(HELD)
            self.contacts.forget()
            if self.carries:
                self.hold.forget()

    def draw(self) -> None:
        """Place all bodies where they are drawn."""
        for field, column in zip(self.place, (CENTRE_Y, CENTRE_Z), strict=False):
            field.from_numpy(np.tile(self.rows[:, column], (self.worlds, 1)))

    def account(self, pose: np.ndarray, gravity: float, time: float) -> dict[str, np.ndarray]:
        """The quantities of bodies in tanks at these poses (W, 3), at a time (s), which is now: `OF_BODIES`."""
        if not self.count:
            return {}
        place = np.stack([field.to_numpy() for field in self.place], axis=-1)
        behind, pairs = self.behind.to_numpy(), zip(self.velocity, self.acceleration, strict=True)
        velocity = np.stack([u.to_numpy() + behind * a.to_numpy() for u, a in pairs], axis=-1)
        mass, inertia, roll = self.rows[:, MASS], self.rows[:, INERTIA], pose[:, 2:]
        height = pose[:, 1:2] + np.sin(roll) * place[..., 0] + np.cos(roll) * place[..., 1]
        kinetic = 0.5 * mass * (velocity[..., :2] ** 2).sum(axis=-1) + 0.5 * inertia * velocity[..., 2] ** 2
        return {
            "body_place": place,
            "body_velocity": velocity,
            "body_energy": kinetic + mass * gravity * height,
            "body_work": self.work.to_numpy().astype(float),
            **self.contacts.account(time),
        }

    @ti.func
    def loose(self, w, k):
        """The number of the body that part k is, if it moves freely in this step of a world; else NOT_FREE."""
        i = self.of_part[k]
        if i >= 0:  # noqa: SIM102 (Taichi evaluates both sides of `and`)
            if self.state[w, i] == HELD:
                i = NOT_FREE
        return i

    @ti.func
    def note_start(self, w, t, dt):
        """Note where a world's bodies are as a step of dt (s) begins at t (s), and let go those whose time it is."""
        self.of_tank.note_start(w, t, dt)
        for i in range(self.count):
            if self.state[w, i] == HELD:  # noqa: SIM102
                if t >= self.release(i):
                    self.state[w, i] = LET_GO
                    self.start_with(w, i, self.tank_speed(w, AT_START, i))
            if self.state[w, i] == HELD:
                speed = self.tank_speed(w, AT_START, i)
                for part in ti.static((AT_START, AT_MIDDLE, AT_END)):
                    self.note_pose(w, i, part, AT_START, speed)
            else:
                self.note_pose(w, i, AT_START, AT_START, self.now(w, i))

    @ti.func
    def mass(self, i):
        """The mass (kg) of a body."""
        return self.table[i, MASS]

    @ti.func
    def release(self, i):
        """When (s) a body is let go."""
        return self.table[i, RELEASE]

    @ti.func
    def tensor(self, w, i):
        """The moments of inertia (kg m²) of a body about its centre of mass, in the tank's axes, row by row."""
        return [self.table[i, INERTIA]]

    @ti.func
    def gyration(self, w, i):
        """The moment (N m) that a body needs to go on turning as it does: none in the plane."""
        return [0.0 * self.table[i, INERTIA]]

    @ti.func
    def start_with(self, w, i, speed: ti.template()):
        """Give a body the velocity and the rate of turning that it starts with."""
        for k in ti.static(range(3)):
            self.velocity[k][w, i] = speed[k]

    @ti.func
    def now(self, w, i):
        """The velocities of a body over the earth as the step begins."""
        return self.velocity_with(w, i, self.gains(w, i))

    @ti.func
    def gains(self, w, i):
        """The last known acceleration of a body over the earth, and that of its turning."""
        return ti.Vector([self.acceleration[k][w, i] for k in ti.static(range(3))])

    @ti.func
    def velocity_with(self, w, i, a: ti.template()):
        """The velocities of a body over the earth as the step begins, if it has the accelerations a until then."""
        return ti.Vector([self.velocity[k][w, i] + self.behind[w, i] * a[k] for k in ti.static(range(3))])

    @ti.func
    def rate_over_earth(self, w, i):
        """The rate (rad/s) at which a body turns as the step begins, as a list."""
        return [self.velocity[2][w, i] + self.behind[w, i] * self.acceleration[2][w, i]]

    @ti.func
    def tank_speed(self, w, when: ti.template(), i):
        """The velocity and rate of turning of the tank's wall where a body is, at the start or in the middle."""
        v = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
        if ti.static(self.of_tank.moving):
            found, y, z = self.of_tank.of_walls(w, when), self.place[0][w, i], self.place[1][w, i]
            v[0], v[1], v[2] = found[0] - found[2] * z, found[1] + found[2] * y, found[2]
        return v

    @ti.func
    def note_pose(self, w, i, part: ti.template(), of_tank: ti.template(), u: ti.template()):
        """Note the pose of a body, as a part, with the inertial velocities u, relative to the tank's (`tank_speed`)."""
        k, at = self.part_of[i], ti.static(NUMBERS * part)
        y, z, turn = self.place[0][w, i], self.place[1][w, i], self.place[2][w, i]
        arm = turned(self.table[i, CENTRE_Y], self.table[i, CENTRE_Z], turn)  # from the drawn origin
        v = u - self.tank_speed(w, of_tank, i)
        poses = ti.static(self.pieces.poses)
        poses[w, k, at + Y], poses[w, k, at + Z] = y - arm[0], z - arm[1]
        poses[w, k, at + COSINE], poses[w, k, at + SINE] = ti.cos(turn), ti.sin(turn)
        poses[w, k, at + V_Y], poses[w, k, at + V_Z] = v[0] + v[2] * arm[1], v[1] - v[2] * arm[0]
        poses[w, k, at + RATE] = v[2]

    @ti.func
    def about_centre(self, w, i, load: ti.template()):
        """A load about the tank's origin as one about the centre of mass of a body."""
        return ti.Vector([load[0], load[1], load[2] - (self.place[0][w, i] * load[1] - self.place[1][w, i] * load[0])])

    def is_cargo(self, load: Load) -> bool:
        """Whether a load is that of what is aboard a body."""
        return self.carries and load is self.hold.load

    @ti.func
    def borne(self, w, i, load: ti.template()):
        """What a body bears of a load, on itself and on what is aboard: force, and moment about its centre of mass."""
        found = self.about_centre(w, i, load.on_piece(w, self.first + self.part_of[i]))
        if ti.static(self.is_cargo(load)):  # noqa: SIM102 (compiled only for cargo aboard)
            if i == self.hold.body:
                found += self.hold.mean(w)
        return found

    @ti.func
    def load_on(self, w, i):
        """The load of all matters on a body: force, and moment about its centre of mass, in the tank's axes."""
        load = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(self.freedoms))])
        for m in ti.static(range(len(self.loads))):
            load += self.borne(w, i, self.loads[m])
        return load

    @ti.func
    def follow(self, w, time, kick, dt):
        """Move the bodies of a world through the step of dt (s) that begins now, with the present loads."""
        t, step = ti.cast(time, self.exact), ti.cast(dt, self.exact)
        self.of_tank.note_passage(w, t, step)
        for i in range(self.count):
            if self.state[w, i] != HELD:
                self.move(w, i, ti.cast(kick, self.exact), step)
        if ti.static(self.carries):
            self.hold.taken(w)

    @ti.func
    def move(self, w, i, kick, step):
        """One leapfrog step of a body."""
        during = kick
        if self.state[w, i] == LET_GO:  # at rest, half a kick brings it to the middle of the step
            during, self.state[w, i] = 0.5 * step, LOOSE
        load, mass, pull = self.load_on(w, i), self.mass(i), [self.of_tank.felt[a][w] for a in ti.static(range(2))]
        a = ti.Vector([load[0] / mass + pull[0], load[1] / mass + pull[1], load[2] / self.table[i, INERTIA]])
        before = ti.Vector([self.velocity[k][w, i] for k in ti.static(range(3))])
        mean = before + (during - 0.5 * step) * a  # as the step begins
        self.work[w, i] = self.work[w, i] + load.dot(mean) * during
        self.contacts.book(w, i, mean - self.tank_speed(w, AT_START, i), during)
        if ti.static(self.carries):  # noqa: SIM102
            if i == self.hold.body:
                each, turn = ti.static(1.0 / self.every), self.place[2][w, i]
                self.hold.note(w, turn, before, before + during * a, each * kick, each * step)
        u = before + during * a
        y, z = self.place[0][w, i], self.place[1][w, i]
        u, a = self.drift(w, i, AT_START, u, a, 0.5 * step)
        self.note_pose(w, i, AT_MIDDLE, AT_MIDDLE, u)
        speed = u - self.tank_speed(w, AT_MIDDLE, i)
        u, a = self.drift(w, i, AT_MIDDLE, u, a, 0.5 * step)
        self.note_pose(w, i, AT_END, AT_MIDDLE, u + 0.5 * step * a)
        gone = ti.Vector([self.place[0][w, i] - y, self.place[1][w, i] - z])
        self.note_way(w, gone.norm() + ti.abs(speed[2]) * step * self.table[i, ARM])
        for k in ti.static(range(3)):
            self.velocity[k][w, i], self.acceleration[k][w, i] = u[k], a[k]
        self.behind[w, i] = 0.5 * step

    @ti.func
    def note_way(self, w, way):
        """Note how far (m) any point of a body goes in this step."""
        if not way < BEYOND:
            way = BEYOND
        self.pieces.way[w] = ti.max(self.pieces.way[w], ti.cast(way, self.pieces.real))

    @ti.func
    def drift(self, w, i, half: ti.template(), u: ti.template(), a: ti.template(), dt):
        """Move a body with the velocities u for half a step of dt (s); u and a in the tank's axes at its end."""
        place = [self.place[k][w, i] + dt * u[k] for k in ti.static(range(3))]
        after, gain = u, a
        if ti.static(self.of_tank.moving):
            cos, sin = self.of_tank.drift[w, half, 0], self.of_tank.drift[w, half, 1]
            seen = self.of_tank.drifted(w, half, place, self.exact)
            place[0], place[1], place[2] = seen[0], seen[1], place[2] + ti.atan2(sin, cos)
            after = ti.Vector([cos * u[0] - sin * u[1], sin * u[0] + cos * u[1], u[2]])
            gain = ti.Vector([cos * a[0] - sin * a[1], sin * a[0] + cos * a[1], a[2]])
        for k in ti.static(range(3)):
            self.place[k][w, i] = place[k]
        return after, gain
