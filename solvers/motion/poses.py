"""The tank's poses through a step, for matters that keep inertial velocities in the tank's axes."""

import taichi as ti

from solvers.machine.state import Axis, State
from solvers.motion.frame import turned

AT_START, AT_MIDDLE = range(2)  # the halves of a step by where they begin


@ti.data_oriented
class Poses:
    """Gravity, drifts and wall velocities of a step in each world; `moving` says whether the tank moves at all.

    A point at the earth's place x lies in the tank at r = R(φ)ᵀ (x − P). With the inertial velocity u in the tank's
    axes it drifts in a straight line over the earth: from a to b, τ later, r' = D (r + τ u) + e and u' = D u, with D =
    R(φ_a − φ_b) and e = R(φ_b)ᵀ (P_a − P_b). This is exact, and no fictitious force is needed.

    With `long` steps, of several of the carrier's, the pose in the middle is the mean of those at the ends, and the
    walls' velocities are the way between these over the step, to second order. It ends with the carrier's present step;
    where the motion is prescribed, its own length after it began. So is the walls' acceleration, the change of their
    velocity over the last long step: that of a single step of the carrier's has the knocks of grains.
    """

    def __init__(self, arrays: State, carrier, worlds: int, long: bool = False):
        self.carrier, self.exact, self.real, self.long = carrier, arrays.exact, arrays.real, long
        self.moving, self.rotating = carrier.moving, carrier.moving and carrier.rotating
        own, world = arrays.under("poses"), (Axis("world", worlds),)
        names = "pull_y", "pull_z", "felt_y", "felt_z", "rate", "rate_up"
        self.felt = own.reals(world, *names, kind=own.exact, kept=False)
        self.start = own.reals(world, "pose_y", "pose_z", "pose_roll", kind=own.exact, kept=False)
        halves = Axis("half", 2), Axis("number", 4)
        (self.drift,) = own.reals((*world, *halves), "drift", kind=own.exact, kept=False)
        names = "wall_y", "wall_z", "wall_rate", "start_y", "start_z", "start_rate"
        self.walls = own.reals(world, *names, kind=own.exact, kept=False)  # velocities in the middle, and at the start
        if long:
            names = "former_y", "former_z", "former_rate"
            self.former = own.reals(world, *names, kind=own.exact)  # velocities at the start of the step before
            (self.known,) = own.integers(world, "known")  # whether they are known
            (self.began,) = own.reals(world, "began", kind=own.exact, kept=False)  # s, when the step did

    def forget(self) -> None:
        """Forget the velocity of the walls in the step before."""
        if self.long:
            self.known.fill(0)

    @ti.func
    def note_start(self, w, t, dt):
        """Note what the forces at the beginning of a step of dt (s) need, at time t (s).

        The walls' acceleration is as the carrier knows it. One that responds to the load knows that of its last step.
        Only the layer of water before the walls, a smoothing length thick, feels it through the wall particles'
        pressures. If this layer were heavier than the carrier, it and the carrier would drive each other (Causin,
        Gerbeau & Nobile 2005); as it is far lighter, the delay is one of a step, in which sound crosses less than that
        layer.
        """
        gravity = self.carrier.gravity[0]
        if ti.static(self.moving):
            start = self.carrier.kinematics(w, t)
            if ti.static(self.long):
                self.began[w] = ti.cast(t, self.exact)
                for k in ti.static(range(3)):
                    if self.known[w] > 0:
                        start[6 + k] = (start[3 + k] - self.former[k][w]) / ti.cast(dt, self.exact)
                    self.former[k][w] = start[3 + k]
                self.known[w] = 1
            pull = turned(0.0, -gravity, -start[2])
            felt = turned(-start[6], -gravity - start[7], -start[2])
            self.felt[0][w], self.felt[1][w] = pull[0], pull[1]
            self.felt[2][w], self.felt[3][w] = felt[0], felt[1]
            self.felt[4][w], self.felt[5][w] = start[5], start[8]
            for k in ti.static(range(3)):
                self.start[k][w] = start[k]
            self.note_walls(w, 3, start)
        else:
            self.felt[1][w], self.felt[3][w] = -gravity, -gravity

    @ti.func
    def note_passage(self, w, t, dt):
        """Note how the tank moves through the step of dt (s) from time t (s), once its carrier has responded.

        A long one ends with the carrier's present step, whose beginning t then is.
        """
        if ti.static(self.moving):
            begin = ti.cast(t, self.exact)
            if ti.static(self.long):
                begin = self.began[w]
            found = self.carrier.passage(w, begin, dt)
            start = ti.Vector([self.start[k][w] for k in ti.static(range(3))])
            middle = ti.Vector([found[k] for k in ti.static(range(6))])
            end = ti.Vector([found[6 + k] for k in ti.static(range(3))])
            if ti.static(self.long):
                for k in ti.static(range(3)):
                    middle[k] = 0.5 * (start[k] + end[k])
                    middle[3 + k] = (end[k] - start[k]) / ti.cast(dt, self.exact)
            self.note_half(w, AT_START, start, middle)
            self.note_half(w, AT_MIDDLE, middle, end)
            self.note_walls(w, 0, middle)

    @ti.func
    def note_walls(self, w, first: ti.template(), pose: ti.template()):
        """Note the velocity and rate of roll of a pose, in the tank's axes."""
        velocity = turned(pose[3], pose[4], -pose[2])
        self.walls[first][w], self.walls[first + 1][w], self.walls[first + 2][w] = velocity[0], velocity[1], pose[5]

    @ti.func
    def of_walls(self, w, when: ti.template()):
        """The walls' velocity and rate of roll at the start of the step, or in its middle, as a list."""
        return [self.walls[3 * (1 - when) + k][w] for k in ti.static(range(3))]

    @ti.func
    def press(self, w, place: ti.template(), felt: ti.template()):
        """Add what the turning of the tank makes walls at a place (lanes of m, a list) feel, m/s²."""
        rate, up = ti.cast(self.felt[4][w], self.real), ti.cast(self.felt[5][w], self.real)
        felt[0] += up * place[1] + (rate * rate) * place[0]
        felt[1] += (rate * rate) * place[1] - up * place[0]

    @ti.func
    def drifted(self, w, part: ti.template(), place: ti.template(), where: ti.template()):
        """Places (lanes of m, a list) as the tank's axes at the end of a half step see them."""
        shift = [ti.cast(self.drift[w, part, 2 + a], where) for a in ti.static(range(2))]
        if ti.static(self.rotating):
            found = self.turned(w, part, place, where)
            return [found[a] + shift[a] for a in ti.static(range(2))]
        else:
            return [place[a] + shift[a] for a in ti.static(range(2))]

    @ti.func
    def turned(self, w, part: ti.template(), vector: ti.template(), kind: ti.template()):
        """A vector (lanes, a list) in the axes at the end of a half step."""
        cos, sin = ti.cast(self.drift[w, part, 0], kind), ti.cast(self.drift[w, part, 1], kind)
        return [cos * vector[0] - sin * vector[1], sin * vector[0] + cos * vector[1]]

    @ti.func
    def note_half(self, w, half, a: ti.template(), b: ti.template()):
        """Note the drift from pose a to pose b."""
        turn = turned(1.0, 0.0, a[2] - b[2])
        shift = turned(a[0] - b[0], a[1] - b[1], -b[2])
        self.drift[w, half, 0], self.drift[w, half, 1] = turn[0], turn[1]
        self.drift[w, half, 2], self.drift[w, half, 3] = shift[0], shift[1]
