"""A carrier that is told how to move: the tank follows prescribed motions, whatever its load."""

from collections.abc import Callable, Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import State
from solvers.motion.frame import turned
from solvers.motion.steered import Steered

ANY = 2**30


def _centre(motion) -> tuple[float, float]:
    """The earth point (m) a motion turns about; the origin for one that does not turn."""
    return motion.centre if motion.coordinate == "turn" else (0.0, 0.0)


@ti.data_oriented
class Prescribed:
    """Prescribed motion of the tank in each of W worlds: motions applied one after the other.

    `motions[w]` are the motions of world w, the same kinds in the same order in every world. The first is innermost:
    a tilt followed by a sway is a tilting table on a swaying deck.
    """

    answers = False  # to the load of the cargo
    phases = ()  # what it does in a step before the cargo moves
    paced = True  # it bears steps of any length

    def __init__(self, arrays: State, motions: Sequence[Sequence], soft_start: float, gravity: float):
        self.exact, self.real = arrays.exact, arrays.real
        self.kinds = tuple(motions[0])
        rows = [[[*_centre(m), *m.parameters(soft_start)] for m in world] for world in motions]
        sizes = [len(p) for p in rows[0]]
        self.first = tuple(int(k) for k in np.cumsum([0, *sizes])[:-1])
        self.rotating = any(m.coordinate == "turn" for m in self.kinds)
        self.moving = bool(self.kinds)
        own = arrays.under("motion")
        self.gravity = own.holding("gravity", np.array([gravity]), "one", own.exact)
        table = np.array([[value for p in row for value in p] for row in rows]).reshape(len(rows), -1)
        table = table if table.size else np.zeros((len(rows), 1))
        self.table = own.holding("motions", table, "world number", own.exact, kept=self.steered)

    @property
    def steered(self) -> bool:
        """Whether a hand moves the tank."""
        return any(isinstance(motion, Steered) for motion in self.kinds)

    def begin(self, cargo: Callable[[], Sequence]) -> None:
        """Nothing: it is told when to begin."""

    def account(self) -> dict[str, np.ndarray]:
        """What it has to tell of each world beside its motion: nothing."""
        return {}

    def steer(self, time: float, pieces: Sequence[np.ndarray]) -> None:
        """Have each motion follow its polynomial (6,) from a time (s) on, in every world; all must be steered."""
        table = self.table.to_numpy()
        for first, coefficients in zip(self.first, pieces, strict=True):
            table[:, first + 2] = time
            table[:, first + 3 : first + 3 + len(coefficients)] = coefficients
        self.table.from_numpy(table)

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
    def frame(self, w, t):
        """What all cargo feels per unit mass in the tank's frame: (b_y, b_z, φ̇, φ̈) with b = R(−φ)(g − P̈)."""
        zero = ti.cast(0.0, self.exact)
        force = ti.Vector([zero, -self.gravity[0], zero, zero])
        if ti.static(self.moving):
            s = self.kinematics(w, t)
            b = turned(-s[6], -self.gravity[0] - s[7], -s[2])
            force = ti.Vector([b[0], b[1], s[5], s[8]])
        return ti.cast(force, self.real)

    @ti.func
    def pace(self, w):
        """Base steps that a step may take: any number."""
        return ANY

    @ti.func
    def goes_on(self, w):
        """Whether the world is to go on: always."""
        return True
