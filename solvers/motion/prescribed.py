"""A carrier with prescribed motions, which do not depend on the load."""

from collections.abc import Callable, Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State, roomy
from solvers.motion.frame import is_turn, turned
from solvers.motion.steered import Steered

ANY = 2**30
FEW = 16  # numbers of a motion that is a formula; a record has many


def _roomy(numbers: list[float]) -> list[float]:
    """The numbers of a motion; of a record with zeros after them, so that many records share compiled kernels."""
    return numbers + [0.0] * (roomy(len(numbers), 256) - len(numbers) if len(numbers) > FEW else 0)


@ti.data_oriented
class Driven:
    """What prescribed motions have in the plane and in space: W worlds, each with motions applied one after the other.

    `motions[w]` are the motions of world w, the same kinds in the same order in every world. The first is innermost:
    a tilt followed by a sway is a tilting table on a swaying deck.
    """

    responds = False  # the motion does not respond to the cargo's load
    phases = ()  # it has no phases in a step
    has_multiples = True  # steps may have any length
    spatial = False  # the tank moves in the plane
    numbers = 4  # of a frame

    def __init__(self, arrays: State, motions: Sequence[Sequence], soft_start: float, gravity: float):
        self.exact, self.real = arrays.exact, arrays.real
        self.kinds = tuple(motions[0])
        rows = [[_roomy([*self.centre(m), *m.parameters(soft_start)]) for m in world] for world in motions]
        sizes = [len(p) for p in rows[0]]
        self.first = tuple(int(k) for k in np.cumsum([0, *sizes])[:-1])
        self.rotating = any(is_turn(m.coordinate) for m in self.kinds)
        self.moving = bool(self.kinds)
        own = arrays.under("motion")
        self.gravity = own.holding("gravity", np.array([gravity]), "one", own.exact)
        table = np.array([[value for p in row for value in p] for row in rows]).reshape(len(rows), -1)
        table = table if table.size else np.zeros((len(rows), 1))
        self.table = own.holding("motions", table, "world number", own.exact, kept=self.steered)

    @staticmethod
    def centre(motion) -> Sequence[float]:
        """The point (m) in the earth frame about which a motion turns; the origin if it does not turn."""
        return motion.centre if is_turn(motion.coordinate) else (0.0, 0.0)

    @property
    def steered(self) -> bool:
        """Whether the tank is moved interactively."""
        return any(isinstance(motion, Steered) for motion in self.kinds)

    def bear(self, loads: Sequence) -> None:
        """Do nothing: the motions do not depend on the loads."""

    def begin(self, cargo: Callable[[], Sequence]) -> None:
        """Do nothing: the motions start with the clock."""

    def account(self, rows: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Further output of each world: none."""
        return {}

    def steer(self, time: float, pieces: Sequence[np.ndarray]) -> None:
        """Let each motion follow its polynomial (6,) from `time` (s) on, in every world; all must be `Steered`."""
        table = self.table.to_numpy()
        for first, coefficients in zip(self.first, pieces, strict=True):
            table[:, first + 2] = time
            table[:, first + 3 : first + 3 + len(coefficients)] = coefficients
        self.table.from_numpy(table)

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of the base step: no limit."""
        return ANY

    @ti.func
    def goes_on(self, w):
        """Whether the world goes on: always."""
        return True


@ti.data_oriented
class Prescribed(Driven):
    """Prescribed motion of the tank in the plane."""

    @ti.func
    def kinematics(self, w, time):
        """Pose (Y, Z, φ) of the frame's origin at a time (s), its velocity and its acceleration in the earth frame.

        Composition of motions by relative kinematics: turning by θ about the earth point c takes p to c + R(p − c), v
        to Rv + θ̇ × (p' − c) and a to Ra + 2 θ̇ × Rv + θ̈ × (p' − c) − θ̇²(p' − c).
        """
        t, zero = ti.cast(time, self.exact), ti.cast(0.0, self.exact)
        p, v, a = ti.Vector([zero, zero]), ti.Vector([zero, zero]), ti.Vector([zero, zero])
        turn = ti.Vector([zero, zero, zero])
        for k in ti.static(range(len(self.kinds))):
            first = self.first[k]
            q = self.kinds[k].state(self.table, w, first + 2, t)
            if ti.static(self.kinds[k].coordinate == "turn"):
                cy, cz = self.table[w, first], self.table[w, first + 1]
                arm = turned(p[0] - cy, p[1] - cz, q[0])
                carried = turned(v[0], v[1], q[0])
                pulled = turned(a[0], a[1], q[0])
                p = ti.Vector([cy + arm[0], cz + arm[1]])
                v = carried + q[1] * ti.Vector([-arm[1], arm[0]])
                a = (
                    pulled
                    + 2.0 * q[1] * ti.Vector([-carried[1], carried[0]])
                    + q[2] * ti.Vector([-arm[1], arm[0]])
                    - q[1] * q[1] * arm
                )
                turn += q
            elif ti.static(self.kinds[k].coordinate == "y"):
                p += ti.Vector([q[0], 0.0])
                v += ti.Vector([q[1], 0.0])
                a += ti.Vector([q[2], 0.0])
            else:
                p += ti.Vector([0.0, q[0]])
                v += ti.Vector([0.0, q[1]])
                a += ti.Vector([0.0, q[2]])
        return ti.Vector([p[0], p[1], turn[0], v[0], v[1], turn[1], a[0], a[1], turn[2]])

    @ti.func
    def passage(self, w, t, dt):
        """Pose and velocity in the middle of the step of dt (s) that begins at t (s), and the pose at its end."""
        half = 0.5 * ti.cast(dt, self.exact)
        middle, end = self.kinematics(w, t + half), self.kinematics(w, t + 2.0 * half)
        both = [middle[0], middle[1], middle[2], middle[3], middle[4], middle[5], end[0], end[1], end[2]]
        return ti.Vector(both)

    @ti.func
    def frame(self, w, t):
        """The tank's frame for the cargo: (b_y, b_z, φ̇, φ̈), with the body force per mass b = R(−φ)(g − P̈)."""
        zero = ti.cast(0.0, self.exact)
        force = ti.Vector([zero, -self.gravity[0], zero, zero])
        if ti.static(self.moving):
            s = self.kinematics(w, t)
            b = turned(-s[6], -self.gravity[0] - s[7], -s[2])
            force = ti.Vector([b[0], b[1], s[5], s[8]])
        return ti.Vector([ti.cast(force[k], self.real) for k in ti.static(range(4))])  # whole ones are not for `wide`
