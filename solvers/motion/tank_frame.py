"""The tank frame of a ship: how a tank moves with her, as the matters in it feel it."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, Scope
from solvers.motion.frame import turned

APART = 16  # row length of arrays that are written for each ship at each step
MIDDLE = 9  # first entry of the pose and velocity in the middle of the step in a row of `tank`
PASSAGE = (*range(MIDDLE, MIDDLE + 6), 0, 1, 2)  # entries of these, and of the pose at the end


def apart(rows: Sequence[Sequence[float]]) -> np.ndarray:
    """Rows (W, k) padded to length APART, so that no two worlds write to one cache line."""
    values = np.array(rows, dtype=float)
    return np.pad(values, ((0, 0), (0, APART - values.shape[1])))


@ti.data_oriented
class TankFrame:
    """The tank's origin at `places` (W, 2) m from each ship's axis P, in the hull's axes.

    `felt` is the frame that grains feel; `tank` the motion of the tank's origin at the end of the last step, and with
    `wet`, for matters that keep inertial velocities, also in the middle of the step.
    """

    def __init__(self, own: Scope, places: np.ndarray, gravity: float, wet: bool):
        self.exact, self.wet = own.exact, wet
        self.place = own.holding("hold", places, "world direction", own.exact, kept=True)
        still = apart([[0.0, -gravity, 0.0, 0.0]] * len(places))
        self.felt = own.holding("felt", still, "world number", own.exact, kept=True)
        row = Axis("world", len(places)), Axis("number", APART)
        # Where it stands while matters settle, before the ship floats: water notices every jump of the tank
        standing = apart([[*place, *[0.0] * 7] for place in places])
        self.tank = own.holding("tank", standing, "world number", own.exact, kept=True)
        self.of_tank, self.of_ship = own.reals(row, "added_to_tank", "added_to_ship", kind=own.exact, kept=False)

    @ti.func
    def arm(self, w, roll):
        """The tank's origin from P (m), in the earth's axes."""
        return turned(self.place[w, 0], self.place[w, 1], roll)

    @ti.func
    def transform_added_mass(self, w, roll, rate, force):
        """Transform the added mass that matters have for the tank, `of_tank`, into that about P, `of_ship`.

        Both are matrices (3, 3) row by row, the first about the tank's origin in its axes, the second in the earth's.
        Returns the load `force` about P with their reaction to the rotation alone. Written out in numbers:
        matrices may be real vectors here, which cannot be transposed.
        """
        c, s, arm, square = ti.cos(roll), ti.sin(roll), self.arm(w, roll), rate * rate
        # From accelerations of P to those of the tank's origin
        way = [c, s, s * arm[0] - c * arm[1], 0.0 - s, c, c * arm[0] + s * arm[1], 0.0 * c, 0.0 * c, 1.0 + 0.0 * c]
        for i in ti.static(range(3)):
            for j in ti.static(range(3)):
                total = 0.0 * c
                for m in ti.static(range(3)):
                    for n in ti.static(range(3)):
                        total += way[3 * m + i] * self.of_tank[w, 3 * m + n] * way[3 * n + j]
                self.of_ship[w, 3 * i + j] = total
        found = force
        for i in ti.static(range(3)):
            for m in ti.static(range(3)):
                turned_by = self.of_tank[w, 3 * m] * self.place[w, 0] + self.of_tank[w, 3 * m + 1] * self.place[w, 1]
                found[i] = found[i] + square * way[3 * m + i] * turned_by
        return found

    @ti.func
    def reaction(self, w, acceleration):
        """What matters push against an acceleration of P (m/s², rad/s²), by their added mass `of_ship`."""
        found = acceleration
        for i in ti.static(range(3)):
            pushed = self.of_ship[w, 3 * i] * acceleration[0] + self.of_ship[w, 3 * i + 1] * acceleration[1]
            found[i] = pushed + self.of_ship[w, 3 * i + 2] * acceleration[2]
        return found

    @ti.func
    def feel(self, w, gravity, pose, velocity, acceleration, share):
        """Set the frame that the grains feel, with `share` of the ship's acceleration."""
        a = self.carried(w, pose[2], velocity[2], acceleration)
        b = turned(-share * a[0], -gravity - share * a[1], -pose[2])
        self.felt[w, 0], self.felt[w, 1] = b[0], b[1]
        self.felt[w, 2], self.felt[w, 3] = velocity[2], share * acceleration[2]

    @ti.func
    def carried(self, w, roll, rate, acceleration):
        """Acceleration of the tank's origin: that of P and that of the rotation about P."""
        arm = self.arm(w, roll)
        return ti.Vector(
            [
                acceleration[0] - acceleration[2] * arm[1] - rate * rate * arm[0],
                acceleration[1] + acceleration[2] * arm[0] - rate * rate * arm[1],
            ]
        )

    @ti.func
    def note(self, w, pose, velocity, acceleration):
        """Note the motion of the tank's origin from that of P."""
        a = self.carried(w, pose[2], velocity[2], acceleration)
        self.note_at(w, 0, pose, velocity)
        self.tank[w, 6], self.tank[w, 7], self.tank[w, 8] = a[0], a[1], acceleration[2]

    @ti.func
    def note_middle(self, w, pose, velocity):
        """Note the motion of the tank's origin in the middle of the step, from that of P."""
        if ti.static(self.wet):
            self.note_at(w, MIDDLE, pose, velocity)

    @ti.func
    def note_at(self, w, first: ti.template(), pose, velocity):
        """Note pose and velocity of the tank's origin from those of P, from column `first` on."""
        arm = self.arm(w, pose[2])
        place = pose[0] + arm[0], pose[1] + arm[1], pose[2]
        speed = velocity[0] - velocity[2] * arm[1], velocity[1] + velocity[2] * arm[0], velocity[2]
        for k in ti.static(range(3)):
            self.tank[w, first + k], self.tank[w, first + 3 + k] = place[k], speed[k]

    @ti.func
    def kinematics(self, w):
        """Pose (Y, Z, φ) of the tank's origin now, its velocity and its acceleration in the earth frame."""
        return ti.Vector([self.tank[w, k] for k in ti.static(range(9))])

    @ti.func
    def passage(self, w):
        """Pose and velocity in the middle of the step, and the pose at its end."""
        return ti.Vector([self.tank[w, k] for k in ti.static(PASSAGE)])
