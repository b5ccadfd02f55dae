"""Pieces in space, among water: where bodies are that stand still, move in the plane, or float."""

import numpy as np
import taichi as ti

from solvers.machine.quantity import SPACE
from solvers.space.turning import angles_of
from solvers.tank.parts import Part
from solvers.tank.pieces import Pieces
from solvers.tank.pose import AT_START, numbers

ORIGIN, VELOCITY, ROTATION, RATE = 0, SPACE, 2 * SPACE, 2 * SPACE + SPACE * SPACE  # firsts of the numbers of a pose
NUMBERS = numbers(SPACE)
Y, Z, X = range(SPACE)
STANDS = [0.0] * ROTATION + np.eye(SPACE).ravel().tolist() + [0.0] * SPACE


@ti.data_oriented
class PiecesInSpace(Pieces):
    """As `Pieces` in the plane; what is prescribed of them are sway, heave and roll, about x.

    Limits: no grains look for them, so that there are no poses at any time but those of a step.
    """

    axes = SPACE

    @staticmethod
    def arm(part: Part) -> float:
        """How far (m) any point of a part is from the drawn origin."""
        return part.shape.farthest(np.zeros(SPACE))

    @ti.func
    def note(self, w, t, dt):
        """Note how the pieces of a world move in the step of dt (s) from time t (s)."""
        half, farthest = 0.5 * ti.cast(dt, self.exact), ti.cast(0.0, self.exact)
        for k in ti.static(range(self.count)):
            for when in range(3):
                first = NUMBERS * when
                for n in ti.static(range(NUMBERS)):
                    self.poses[w, k, first + n] = STANDS[n]
                if ti.static(self.driven[k]):
                    s = self.carriers[k].kinematics(w, t + when * half)
                    cos, sin = ti.cos(s[2]), ti.sin(s[2])
                    for a in ti.static((Y, Z)):
                        self.poses[w, k, first + ORIGIN + a] = s[a]
                        self.poses[w, k, first + VELOCITY + a] = s[3 + a]
                        self.poses[w, k, first + ROTATION + (SPACE + 1) * a] = cos
                    self.poses[w, k, first + ROTATION + Z] = 0.0 - sin
                    self.poses[w, k, first + ROTATION + SPACE] = sin
                    self.poses[w, k, first + RATE + X] = s[5]
                    fast = ti.sqrt(s[3] * s[3] + s[4] * s[4]) + ti.abs(s[5]) * self.arms[k]
                    farthest = ti.max(farthest, fast * 2.0 * half)
                    if when == AT_START:
                        self.pull[Y][w, k], self.pull[Z][w, k], self.pull[SPACE + X][w, k] = s[6], s[7], s[8]
        if ti.static(self.count > 0):
            self.way[w] = ti.cast(farthest, self.real)
        if ti.static(self.floats):
            self.bodies.note_start(w, t, dt)

    def placed(self, time: float, axes: int) -> dict[str, np.ndarray]:
        """Where the pieces are in the tank at a time (s): displacements (W, pieces, 3) m of the origin, and roll.

        If some float, pitch and yaw (W, pieces, 2) as well (`solvers.space.turning.angles_of`).
        """
        shape = self.worlds, self.count
        place, angles = np.zeros((*shape, SPACE)), np.zeros((*shape, SPACE))
        if self.count:
            self.note_at(time)
            poses = self.poses.to_numpy()
            place = poses[..., ORIGIN:VELOCITY]
            angles = angles_of(poses[..., ROTATION:RATE].reshape(*shape, SPACE, SPACE))
        further = {"part_pitch_yaw": angles[..., :X]} if self.floats else {}
        return {"part": place, "part_turn": angles[..., X]} | further
