"""Bodies that are free to move in a tank in space, with six freedoms."""

import numpy as np
import taichi as ti

from solvers.machine.quantity import SPACE
from solvers.machine.state import Axis, State
from solvers.motion.free import LET_GO, LOOSE, FreeBodies
from solvers.motion.poses_in_space import SHIFT, PosesInSpace
from solvers.space.axes import UP, cross, dot, joined, named
from solvers.space.turning import WHOLE, angles_of, drawn_by, matrix_of, product, quaternion_of, step_of
from solvers.tank.parts import Part
from solvers.tank.pieces_in_space import NUMBERS, ORIGIN, RATE, ROTATION, VELOCITY
from solvers.tank.pose import AT_END, AT_MIDDLE, AT_START, rotated, turned_back

MASS, CENTRE, RELEASE, ARM, INERTIA = 0, 1, 4, 5, 6  # columns of the table of bodies, firsts of vectors and matrices
INVERSE = INERTIA + SPACE * SPACE  # of the moments of inertia
TURN = SPACE  # of the numbers of a place the first of the quaternion, of a velocity that of the angular momentum
ROUNDS = 4  # of the implicit half of a turn; each gains as many digits as a step turns a body by less than a radian


def row_in_space(part: Part) -> list[float]:
    """The kernel's numbers of a free part: columns of the table of bodies."""
    free, tensor = part.free, np.array(part.free.inertia)
    arm = part.shape.farthest(np.array(free.centre))
    return [free.mass, *free.centre, free.release, arm, *tensor.ravel(), *np.linalg.inv(tensor).ravel()]


@ti.data_oriented
class FreeBodiesInSpace(FreeBodies):
    """m u' = F + m g, L' = M, q' = ω q/2 with ω = R(q) I⁻¹ R(q)ᵀ L: rigid bodies, by leapfrog.

    As `FreeBodies` in the plane; L is the angular momentum about the centre of mass, over the earth in the tank's axes,
    and q the unit quaternion of the turn in the tank. L is kept half a step behind the places, as u is. A half step
    turns q by the rate ω at its end, found implicitly, and the next by that at its beginning, which is the same: q'' =
    exp(½Δt ω) exp(½Δt ω) q with ω in the middle of the step. That is symmetric in time and of second order, and keeps L
    to rounding (Hairer, Lubich & Wanner 2006, Geometric Numerical Integration, VII.5, for such splittings).

    `place` (W, bodies; m, 1) are the centre of mass and q, `velocity` u and L, `acceleration` u' and L'.

    Limits: no tank is aboard.
    """

    axes, row_of = SPACE, staticmethod(row_in_space)

    def declare(self, own: State, each: tuple[Axis, ...], carrier) -> None:
        """Make the arrays of places and velocities."""
        self.of_tank = PosesInSpace(own, carrier, self.worlds)
        turns = tuple(f"quaternion_{k}" for k in range(WHOLE))
        self.place = own.reals(each, *named("place", SPACE), *turns, kind=own.exact)
        self.velocity = own.reals(each, *named("velocity", SPACE), *named("spin", SPACE), kind=own.exact)
        self.acceleration = own.reals(each, *named("gain", SPACE), *named("moment", SPACE), kind=own.exact)

    def draw(self) -> None:
        """Place all bodies where they are drawn."""
        for a in range(SPACE):
            self.place[a].from_numpy(np.tile(self.rows[:, CENTRE + a], (self.worlds, 1)))
        self.place[TURN].fill(1.0)

    def account(self, pose: np.ndarray, gravity: float, time: float) -> dict[str, np.ndarray]:
        """The quantities of bodies in tanks at these poses (W, 6), at a time (s), which is now: `OF_BODIES`."""
        if not self.count:
            return {}
        read = [np.stack([field.to_numpy() for field in of], axis=-1) for of in (self.place, self.velocity)]
        place, velocity = read[0], read[1] + self.behind.to_numpy()[..., None] * self._accelerations()
        turn = drawn_by(place[..., TURN:])
        inverse = self.rows[:, INVERSE : INVERSE + SPACE * SPACE].reshape(-1, SPACE, SPACE)
        spin = velocity[..., SPACE:]
        rate = np.einsum("wnij,njk,wnlk,wnl->wni", turn, inverse, turn, spin)
        up = self._up(pose)
        height = pose[:, UP, None] + (place[..., :SPACE] * up[:, None]).sum(axis=-1)
        mass, kinetic = self.rows[:, MASS], 0.5 * (rate * spin).sum(axis=-1)
        kinetic += 0.5 * mass * (velocity[..., :SPACE] ** 2).sum(axis=-1)
        return {
            "body_place": np.concatenate([place[..., :SPACE], angles_of(turn)], axis=-1),
            "body_velocity": np.concatenate([velocity[..., :SPACE], rate], axis=-1),
            "body_energy": kinetic + mass * gravity * height,
            "body_work": self.work.to_numpy().astype(float),
            **self.contacts.account(time),
        }

    def _accelerations(self) -> np.ndarray:
        return np.stack([field.to_numpy() for field in self.acceleration], axis=-1)

    @staticmethod
    def _up(pose: np.ndarray) -> np.ndarray:
        """The direction upwards (W, 3) in the axes of tanks at poses (W, 6), whose angles are pitch, yaw and roll."""
        pitch, _, roll = np.moveaxis(pose[:, SPACE:], 1, 0)
        return np.stack([np.cos(pitch) * np.sin(roll), np.cos(pitch) * np.cos(roll), -np.sin(pitch)], axis=1)

    @ti.func
    def release(self, i):
        """When (s) a body is let go."""
        return self.table[i, RELEASE]

    @ti.func
    def attitude(self, w, i):
        """The rotation matrix of a body in the tank, row by row."""
        return matrix_of([self.place[TURN + k][w, i] for k in ti.static(range(WHOLE))])

    @ti.func
    def through(self, rotation: ti.template(), i, first: ti.template(), v: ti.template()):
        """R T Rᵀ v of a vector, T that of a body's tensors whose columns begin with the `first`."""
        drawn = turned_back(rotation, v)
        tensor = [self.table[i, first + k] for k in ti.static(range(SPACE * SPACE))]
        return rotated(rotation, rotated(tensor, drawn))

    @ti.func
    def tensor(self, w, i):
        """The moments of inertia (kg m²) of a body about its centre of mass, in the tank's axes, row by row."""
        rotation, one = self.attitude(w, i), ti.cast(1.0, self.exact)
        units = [[one * float(a == b) for b in ti.static(range(SPACE))] for a in ti.static(range(SPACE))]
        columns = [self.through(rotation, i, INERTIA, units[a]) for a in ti.static(range(SPACE))]
        return [columns[k // SPACE][k % SPACE] for k in ti.static(range(SPACE * SPACE))]  # it is symmetric

    @ti.func
    def spin(self, w, i):
        """The angular momentum (N m s) of a body now, as long after its velocities as they are behind."""
        after = self.behind[w, i]
        return [
            self.velocity[SPACE + a][w, i] + after * self.acceleration[SPACE + a][w, i] for a in ti.static(range(SPACE))
        ]

    @ti.func
    def now(self, w, i):
        """The velocities of a body over the earth, and its rates of turning, now."""
        speed = [
            self.velocity[a][w, i] + self.behind[w, i] * self.acceleration[a][w, i] for a in ti.static(range(SPACE))
        ]
        return joined(speed, self.rate_over_earth(w, i))

    @ti.func
    def gyration(self, w, i):
        """ω × I ω (N m): the moment that a body needs to go on turning as it does."""
        return cross(self.rate_over_earth(w, i), self.spin(w, i))

    @ti.func
    def start_with(self, w, i, speed: ti.template()):
        """Give a body the velocity and the rate of turning that it starts with."""
        rate = [speed[SPACE + a] for a in ti.static(range(SPACE))]
        spin = self.through(self.attitude(w, i), i, INERTIA, rate)
        for a in ti.static(range(SPACE)):
            self.velocity[a][w, i], self.velocity[SPACE + a][w, i] = speed[a], spin[a]

    @ti.func
    def gains(self, w, i):
        """The last known acceleration of a body over the earth, and that of its turning, I⁻¹ (M − ω × I ω)."""
        turning = self.gyration(w, i)
        left = [self.acceleration[SPACE + a][w, i] - turning[a] for a in ti.static(range(SPACE))]
        rise = self.through(self.attitude(w, i), i, INVERSE, left)
        return joined([self.acceleration[a][w, i] for a in ti.static(range(SPACE))], rise)

    @ti.func
    def velocity_with(self, w, i, a: ti.template()):
        """The velocities of a body over the earth as the step begins, if it has the accelerations a until then."""
        rotation, turning = self.attitude(w, i), self.gyration(w, i)
        risen = self.through(rotation, i, INERTIA, [a[SPACE + n] for n in ti.static(range(SPACE))])
        after = self.behind[w, i]
        spin = [self.velocity[SPACE + n][w, i] + after * (risen[n] + turning[n]) for n in ti.static(range(SPACE))]
        rate = self.through(rotation, i, INVERSE, spin)
        speed = [self.velocity[n][w, i] + after * a[n] for n in ti.static(range(SPACE))]
        return joined(speed, rate)

    @ti.func
    def rate_over_earth(self, w, i):
        """The rate (rad/s) at which a body turns now, as a list."""
        return self.through(self.attitude(w, i), i, INVERSE, self.spin(w, i))

    @ti.func
    def where(self, w, i):
        """The centre of mass (m) of a body in the tank, as a list."""
        return [self.place[a][w, i] for a in ti.static(range(SPACE))]

    @ti.func
    def tank_speed(self, w, when: ti.template(), i):
        """The velocity and rate of turning of the tank's wall where a body is, at the start or in the middle."""
        v = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(2 * SPACE))])
        if ti.static(self.of_tank.moving):
            found = self.of_tank.of_walls(w, when)
            swung = cross([found[SPACE + a] for a in ti.static(range(SPACE))], self.where(w, i))
            for a in ti.static(range(SPACE)):
                v[a], v[SPACE + a] = found[a] + swung[a], found[SPACE + a]
        return v

    @ti.func
    def note_pose(self, w, i, part: ti.template(), of_tank: ti.template(), u: ti.template()):
        """Note the pose of a body, as a part, with the inertial velocities u, relative to the tank's (`tank_speed`)."""
        k = self.part_of[i]
        rotation = self.attitude(w, i)
        arm = rotated(rotation, [self.table[i, CENTRE + a] for a in ti.static(range(SPACE))])  # from the drawn origin
        v = u - self.tank_speed(w, of_tank, i)
        swung = cross([v[SPACE + a] for a in ti.static(range(SPACE))], arm)
        poses = ti.static(self.pieces.poses)
        for a in ti.static(range(SPACE)):
            poses[w, k, NUMBERS * part + ORIGIN + a] = self.place[a][w, i] - arm[a]
            poses[w, k, NUMBERS * part + VELOCITY + a] = v[a] - swung[a]
            poses[w, k, NUMBERS * part + RATE + a] = v[SPACE + a]
        for n in ti.static(range(SPACE * SPACE)):
            poses[w, k, NUMBERS * part + ROTATION + n] = rotation[n]

    @ti.func
    def about_centre(self, w, i, load: ti.template()):
        """A load about the tank's origin as one about the centre of mass of a body."""
        swung = cross(self.where(w, i), [load[a] for a in ti.static(range(SPACE))])
        force = [load[a] for a in ti.static(range(SPACE))]
        return joined(force, [load[SPACE + a] - swung[a] for a in ti.static(range(SPACE))])

    @ti.func
    def move(self, w, i, kick, step):
        """One leapfrog step of a body."""
        during = kick
        if self.state[w, i] == LET_GO:  # at rest, half a kick brings it to the middle of the step
            during, self.state[w, i] = 0.5 * step, LOOSE
        load, before = self.load_on(w, i), self.where(w, i)
        for a in ti.static(range(SPACE)):
            self.acceleration[a][w, i] = load[a] / self.mass(i) + self.of_tank.felt[a][w]
            self.acceleration[SPACE + a][w, i] = load[SPACE + a]
        mean = self.now(w, i)
        self.work[w, i] = self.work[w, i] + load.dot(mean) * during
        self.contacts.book(w, i, mean - self.tank_speed(w, AT_START, i), during)
        for k in ti.static(range(2 * SPACE)):
            self.velocity[k][w, i] = self.velocity[k][w, i] + during * self.acceleration[k][w, i]
        self.behind[w, i] = 0.0
        self.turn_half(w, i, ROUNDS, 0.5 * step)
        self.drift(w, i, AT_START, 0.5 * step)
        self.note_pose(w, i, AT_MIDDLE, AT_MIDDLE, self.now(w, i))
        self.turn_half(w, i, 1, 0.5 * step)
        self.drift(w, i, AT_MIDDLE, 0.5 * step)
        self.behind[w, i] = 0.5 * step
        self.note_pose(w, i, AT_END, AT_MIDDLE, self.now(w, i))
        gone = [self.place[a][w, i] - before[a] for a in ti.static(range(SPACE))]
        rate = [self.pieces.poses[w, self.part_of[i], NUMBERS * AT_MIDDLE + RATE + a] for a in ti.static(range(SPACE))]
        self.note_way(w, ti.sqrt(dot(gone, gone)) + ti.sqrt(dot(rate, rate)) * step * self.table[i, ARM])

    @ti.func
    def turn_half(self, w, i, rounds: ti.template(), dt):
        """Turn a body for half a step of dt (s), by its rate at the end, found in `rounds`, or by that now."""
        begin = [self.place[TURN + k][w, i] for k in ti.static(range(WHOLE))]
        spin = [self.velocity[SPACE + a][w, i] for a in ti.static(range(SPACE))]
        for _ in ti.static(range(rounds)):
            now = product(step_of(self.through(self.attitude(w, i), i, INVERSE, spin), dt), begin)
            for k in ti.static(range(WHOLE)):
                self.place[TURN + k][w, i] = now[k]

    @ti.func
    def drift(self, w, i, half: ti.template(), dt):
        """Move a body with its velocity for half a step of dt (s); all its vectors in the tank's axes at its end."""
        place = [self.place[a][w, i] + dt * self.velocity[a][w, i] for a in ti.static(range(SPACE))]
        for a in ti.static(range(SPACE)):
            self.place[a][w, i] = place[a]
        if ti.static(self.of_tank.moving):
            seen = self.of_tank.drifted(w, half, place, self.exact)
            for a in ti.static(range(SPACE)):
                self.place[a][w, i] = seen[a]
            if ti.static(self.of_tank.rotating):
                self.turn_all(w, i, half)

    @ti.func
    def turn_all(self, w, i, half: ti.template()):
        """Turn what is known of a body into the tank's axes at the end of a half step."""
        for field in ti.static((self.velocity, self.acceleration)):
            for first in ti.static((0, SPACE)):
                found = self.of_tank.turned(
                    w, half, [field[first + a][w, i] for a in ti.static(range(SPACE))], self.exact
                )
                for a in ti.static(range(SPACE)):
                    field[first + a][w, i] = found[a]
        turn = [self.of_tank.drift[w, half, k] for k in ti.static(range(SHIFT))]
        now = product(quaternion_of(turn), [self.place[TURN + k][w, i] for k in ti.static(range(WHOLE))])
        for k in ti.static(range(WHOLE)):
            self.place[TURN + k][w, i] = now[k]
