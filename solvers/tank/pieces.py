"""The pieces that stand in a world's tanks, such as plates, gates and bodies: where they are, for all matters."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State
from solvers.space.axes import named
from solvers.tank.parts import Part
from solvers.tank.pose import AT_START, PoseReader, numbers

Y, Z, V_Y, V_Z, COSINE, SINE, RATE = range(7)  # a pose in the tank: origin (m), its velocity, turn, its rate (rad/s)
NUMBERS = numbers(PLANE)


@ti.data_oriented
class Pieces:
    """Rigid pieces, each moved in the tank's frame by a carrier of its own, or None: it stands where it is drawn.

    Those that are free have their poses from the `bodies` (`solvers.motion.free`); grains, which
    look at any time, meet none of them.

    At a pose (O, θ) a point that is drawn at p is at O + R(θ) p and moves at V + ω × R(θ) p. Matters that look at any
    time ask for the poses `at` it; `poses` (W, pieces, 21) are those of a step, `pull` the acceleration of the origin
    and of the turn (W, pieces) as it begins, `way` (W,) how far (m) any corner goes in it, once it is noted (`note`).
    `pose` reads them.
    """

    axes = PLANE

    def __init__(self, arrays: State, parts: Sequence[Part], carriers: Sequence, worlds: int):
        self.parts, self.count, self.worlds = tuple(parts), len(parts), worlds
        self.carriers, self.real, self.exact = tuple(carriers), arrays.real, arrays.exact
        self.free = [part.free is not None for part in parts]
        self.driven = [carrier is not None for carrier in carriers]
        self.moves = [free or driven for free, driven in zip(self.free, self.driven, strict=True)]
        turning = (carrier is not None and carrier.rotating for carrier in carriers)
        self.turns = [free or turns for free, turns in zip(self.free, turning, strict=True)]
        self.floats = any(self.free)
        self.bodies, self.opening, self.phases, self.has_multiples = None, (), (), not self.floats
        self.moving, self.turning = any(self.moves), any(self.turns)
        self.fastest = max((part.fastest() for part in parts), default=0.0)  # m/s
        self.size = NUMBERS if self.turning else COSINE  # of a pose, as `at` tells it
        if parts:
            self._declare(arrays.under("pieces"))

    def _declare(self, own: State) -> None:
        """Make the arrays."""
        each, axes = (Axis("world", self.worlds), Axis("part", self.count)), self.axes
        poses = Axis("number", 3 * numbers(axes))
        (self.poses,) = own.reals((*each, poses), "poses", kind=own.exact, kept=False)
        names = *named("pull", axes), *(named("pull_turn", axes) if axes > PLANE else ("pull_turn",))
        self.pull = own.reals(each, *names, kind=own.exact, kept=False)
        (self.way,) = own.reals(each[:1], "way", kept=False)
        self.pose = PoseReader(self.poses, axes)
        farthest = np.array([self.arm(part) for part in self.parts])
        self.arms = own.holding("arms", farthest, "part", own.exact)
        if axes == PLANE:
            self._declare_corners(own)

    def _declare_corners(self, own: State) -> None:
        """Make the arrays of the drawn corners, of which `gone` tells how far they go."""
        corners = [np.asarray(part.points, dtype=float) for part in self.parts]
        self.corners = [len(points) for points in corners]
        if self.turning:
            drawn = np.array([points[np.minimum(np.arange(max(self.corners)), len(points) - 1)] for points in corners])
            self.drawn = own.holding("drawn", drawn, "part corner direction", own.exact)

    @staticmethod
    def arm(part: Part) -> float:
        """How far (m) any point of a part is from the drawn origin."""
        return float(np.hypot(*np.asarray(part.points, dtype=float).T).max())

    def join(self, bodies) -> None:
        """Take the free `bodies` among the pieces, which touch as a step opens, and move once its loads are known."""
        self.bodies, self.opening, self.phases = bodies, bodies.opening, bodies.phases

    @ti.func
    def at(self, w, t):
        """The poses of all pieces at time t (s), one after the other, `size` numbers each."""
        found = ti.Vector([ti.cast(0.0, self.real) for _ in ti.static(range(max(1, self.size * self.count)))])
        for k in ti.static(range(self.count)):
            first = ti.static(self.size * k)
            if ti.static(self.turning):
                found[first + COSINE] = 1.0
            if ti.static(self.driven[k]):
                s = self.carriers[k].kinematics(w, t)
                found[first + Y], found[first + Z] = ti.cast(s[0], self.real), ti.cast(s[1], self.real)
                found[first + V_Y], found[first + V_Z] = ti.cast(s[3], self.real), ti.cast(s[4], self.real)
                if ti.static(self.turns[k]):
                    found[first + COSINE] = ti.cast(ti.cos(s[2]), self.real)
                    found[first + SINE] = ti.cast(ti.sin(s[2]), self.real)
                    found[first + RATE] = ti.cast(s[5], self.real)
        return found

    @ti.func
    def gone(self, w, since, t):
        """Largest displacement (m) of any point of a piece between two times: that of a corner."""
        before, now = self.at(w, since), self.at(w, t)
        farthest = ti.cast(0.0, self.real)
        for k in ti.static(range(self.count)):
            first = ti.static(self.size * k)
            dy, dz = now[first + Y] - before[first + Y], now[first + Z] - before[first + Z]
            if ti.static(self.turns[k]):
                cos = now[first + COSINE] - before[first + COSINE]
                sin = now[first + SINE] - before[first + SINE]
                for corner in range(ti.static(self.corners[k])):
                    y = ti.cast(self.drawn[k, corner, 0], self.real)
                    z = ti.cast(self.drawn[k, corner, 1], self.real)
                    gone_y, gone_z = dy + cos * y - sin * z, dz + sin * y + cos * z
                    farthest = ti.max(farthest, ti.sqrt(gone_y * gone_y + gone_z * gone_z))
            else:
                farthest = ti.max(farthest, ti.sqrt(dy * dy + dz * dz))
        return farthest

    @ti.func
    def note(self, w, t, dt):
        """Note how the pieces of a world move in the step of dt (s) from time t (s)."""
        half, farthest = 0.5 * ti.cast(dt, self.exact), ti.cast(0.0, self.exact)
        for k in ti.static(range(self.count)):
            for part in range(3):
                first = NUMBERS * part
                self.poses[w, k, first + COSINE] = 1.0
                if ti.static(self.driven[k]):
                    s = self.carriers[k].kinematics(w, t + part * half)
                    self.poses[w, k, first + Y], self.poses[w, k, first + Z] = s[0], s[1]
                    self.poses[w, k, first + COSINE], self.poses[w, k, first + SINE] = ti.cos(s[2]), ti.sin(s[2])
                    self.poses[w, k, first + V_Y], self.poses[w, k, first + V_Z] = s[3], s[4]
                    self.poses[w, k, first + RATE] = s[5]
                    fast = ti.sqrt(s[3] * s[3] + s[4] * s[4]) + ti.abs(s[5]) * self.arms[k]
                    farthest = ti.max(farthest, fast * 2.0 * half)
                    if part == AT_START:
                        self.pull[0][w, k], self.pull[1][w, k], self.pull[2][w, k] = s[6], s[7], s[8]
        if ti.static(self.count > 0):
            self.way[w] = ti.cast(farthest, self.real)
        if ti.static(self.floats):
            self.bodies.note_start(w, t, dt)

    @ti.kernel
    def note_at(self, time: ti.f64):
        """Note where the pieces of all worlds are at a time (s)."""
        for w in range(self.worlds):
            self.note(w, time, 0.0)

    def placed(self, time: float, axes: int) -> dict[str, np.ndarray]:
        """Where the pieces are in the tank at a time (s): displacements (W, pieces, axes) m of the origin, and turns.

        Pieces in the plane may stand in a scene of more axes.
        """
        place, turn = np.zeros((self.worlds, self.count, axes)), np.zeros((self.worlds, self.count))
        if self.count:
            self.note_at(time)
            poses = self.poses.to_numpy()
            place[..., :PLANE], turn = poses[..., [Y, Z]], np.arctan2(poses[..., SINE], poses[..., COSINE])
        return {"part": place, "part_turn": turn}
