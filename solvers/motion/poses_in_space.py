"""The tank's poses through a step in space, for matters that keep inertial velocities in the tank's axes."""

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_MIDDLE, AT_START, Poses
from solvers.motion.prescribed_in_space import AT_REST, GAIN, NUMBERS, PLACE, RATE, RISE, TURN, VELOCITY, part, seen
from solvers.space.axes import UP, cross, named

RIGID = 2 * SPACE  # freedoms of a body
SHIFT = SPACE * SPACE  # of the numbers of a drift the first of its shift, after its rotation
Y, Z, ROLL = range(3)  # of a pose in the plane, then its velocity and acceleration


@ti.data_oriented
class PosesInSpace:
    """As `Poses` in the plane: r' = D (r + τ u) + e, u' = D u, with D = R_bᵀ R_a and e = R_bᵀ (P_a − P_b).

    The tank's pose is its place P and its rotation matrix R, from its axes to the earth's. A wall at r feels
    Rᵀ(g − P̈) − ω̇ × r − ω × (ω × r), with the rate of turning ω in the tank's axes.

    Limits: the motion is prescribed, and steps are those of the carrier.
    """

    def __init__(self, arrays: State, carrier, worlds: int):
        self.carrier, self.exact, self.real = carrier, arrays.exact, arrays.real
        self.moving, self.rotating = carrier.moving, carrier.moving and carrier.rotating
        own, world = arrays.under("poses"), (Axis("world", worlds),)
        names = [name for what in ("pull", "felt", "rate", "rise") for name in named(what, SPACE)]
        self.felt = own.reals(world, *names, kind=own.exact, kept=False)
        (self.start,) = own.reals((*world, Axis("number", SHIFT + SPACE)), "pose", kind=own.exact, kept=False)
        halves = Axis("half", 2), Axis("number", SHIFT + SPACE)
        (self.drift,) = own.reals((*world, *halves), "drift", kind=own.exact, kept=False)
        names = [name for what in ("wall", "wall_rate", "start", "start_rate") for name in named(what, SPACE)]
        self.walls = own.reals(world, *names, kind=own.exact, kept=False)
        self.still = own.holding("still", np.array(AT_REST), "number", own.exact)

    def forget(self) -> None:
        """Forget nothing: no step looks back."""

    @ti.func
    def motion(self, w, time):
        """The numbers of a motion in space (`solvers.motion.prescribed_in_space`), also of one in the plane."""
        if ti.static(self.carrier.spatial):
            return self.carrier.motion(w, time)
        else:
            m = [self.still[k] for k in ti.static(range(NUMBERS))]
            pose = self.carrier.kinematics(w, time)
            cos, sin = ti.cos(pose[ROLL]), ti.sin(pose[ROLL])
            m[TURN], m[TURN + 1], m[TURN + SPACE], m[TURN + SPACE + 1] = cos, 0.0 - sin, sin, cos
            for a in ti.static((Y, Z)):
                m[PLACE + a], m[VELOCITY + a], m[GAIN + a] = pose[a], pose[SPACE + a], pose[2 * SPACE + a]
            m[RATE + SPACE - 1], m[RISE + SPACE - 1] = pose[SPACE + ROLL], pose[2 * SPACE + ROLL]
            return m

    @ti.func
    def note_start(self, w, t, dt):
        """Note what the forces at the beginning of a step need, at time t (s)."""
        gravity = self.carrier.gravity[0]
        if ti.static(self.moving):
            m = self.motion(w, t)
            pull = seen(m, [0.0 * gravity, 0.0 - gravity, 0.0 * gravity])
            felt = seen(m, [0.0 - m[GAIN], 0.0 - gravity - m[GAIN + 1], 0.0 - m[GAIN + 2]])
            rate, rise = seen(m, part(m, RATE)), seen(m, part(m, RISE))
            for a in ti.static(range(SPACE)):
                self.felt[a][w], self.felt[SPACE + a][w] = pull[a], felt[a]
                self.felt[RIGID + a][w], self.felt[RIGID + SPACE + a][w] = rate[a], rise[a]
            for k in ti.static(range(SHIFT)):
                self.start[w, k] = m[TURN + k]
            for a in ti.static(range(SPACE)):
                self.start[w, SHIFT + a] = m[PLACE + a]
            self.note_walls(w, RIGID, m)
        else:
            self.felt[UP][w], self.felt[SPACE + UP][w] = 0.0 - gravity, 0.0 - gravity

    @ti.func
    def note_passage(self, w, t, dt):
        """Note how the tank moves through the step of dt (s) from time t (s)."""
        if ti.static(self.moving):
            begin, half = ti.cast(t, self.exact), 0.5 * ti.cast(dt, self.exact)
            middle, end = self.motion(w, begin + half), self.motion(w, begin + 2.0 * half)
            start = [self.start[w, (SHIFT + k) % (SHIFT + SPACE)] for k in ti.static(range(SHIFT + SPACE))]
            self.note_half(w, AT_START, start, middle)
            self.note_half(w, AT_MIDDLE, middle, end)
            self.note_walls(w, 0, middle)

    @ti.func
    def note_walls(self, w, first: ti.template(), m: ti.template()):
        """Note the velocity and the rate of turning of a motion, in the tank's axes."""
        velocity, rate = seen(m, part(m, VELOCITY)), seen(m, part(m, RATE))
        for a in ti.static(range(SPACE)):
            self.walls[first + a][w], self.walls[first + SPACE + a][w] = velocity[a], rate[a]

    @ti.func
    def note_half(self, w, half: ti.template(), a: ti.template(), b: ti.template()):
        """Note the drift from motion a to motion b; of both the place and the matrix come first."""
        shift = seen(b, [(a[PLACE + k] - b[PLACE + k]) for k in ti.static(range(SPACE))])
        for column in ti.static(range(SPACE)):
            turned = seen(b, [a[TURN + SPACE * row + column] for row in ti.static(range(SPACE))])
            for row in ti.static(range(SPACE)):
                self.drift[w, half, SPACE * row + column] = turned[row]
            self.drift[w, half, SHIFT + column] = shift[column]

    @ti.func
    def of_walls(self, w, when: ti.template()):
        """The walls' velocity and rate of turning at the start of the step, or in its middle, as a list."""
        return [self.walls[RIGID * (1 - when) + k][w] for k in ti.static(range(RIGID))]

    @ti.func
    def press(self, w, place: ti.template(), felt: ti.template()):
        """Add what the turning of the tank makes walls at a place (lanes of m, a list) feel, m/s²."""
        rate = [ti.cast(self.felt[RIGID + a][w], self.real) for a in ti.static(range(SPACE))]
        rise = [ti.cast(self.felt[RIGID + SPACE + a][w], self.real) for a in ti.static(range(SPACE))]
        swung, gained = cross(rate, place), cross(rise, place)
        inward = cross(rate, swung)
        for a in ti.static(range(SPACE)):
            felt[a] = felt[a] - gained[a] - inward[a]

    @ti.func
    def drifted(self, w, half: ti.template(), place: ti.template(), where: ti.template()):
        """Places (lanes of m, a list) as the tank's axes at the end of a half step see them."""
        shift = [ti.cast(self.drift[w, half, SHIFT + a], where) for a in ti.static(range(SPACE))]
        if ti.static(self.rotating):
            found = self.turned(w, half, place, where)
            return [(found[a] + shift[a]) for a in ti.static(range(SPACE))]
        else:
            return [(place[a] + shift[a]) for a in ti.static(range(SPACE))]

    @ti.func
    def turned(self, w, half: ti.template(), vector: ti.template(), kind: ti.template()):
        """A vector (lanes, a list) in the axes at the end of a half step."""
        d = [ti.cast(self.drift[w, half, k], kind) for k in ti.static(range(SHIFT))]
        return [
            d[SPACE * a] * vector[0] + d[SPACE * a + 1] * vector[1] + d[SPACE * a + 2] * vector[2]
            for a in ti.static(range(SPACE))
        ]


def poses_of(arrays: State, carrier, worlds: int, long: bool, axes: int) -> Poses | PosesInSpace:
    """The poses of a tank in a scene of so many axes, with `long` steps or those of its carrier."""
    return Poses(arrays, carrier, worlds, long) if axes == PLANE else PosesInSpace(arrays, carrier, worlds)
