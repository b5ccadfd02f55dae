"""What the dummies of a wall would push water along its face, taken off their push."""

import numpy as np
import taichi as ti

from solvers.fluid.given import Water
from solvers.fluid.lists import Medium
from solvers.machine.state import Axis, State, padded
from solvers.space.axes import dot, named

FAR = 1.5  # kernels' reaches from a corner: there no dummy sees water that another wall ends


@ti.data_oriented
class Lean:
    """∇W_iw of a dummy's own pressure p_w becomes ∇W_iw − t (t·Σ_k V_k ∇W_kw) W_iw/Σ_f V_f W_fw, t along the face.

    Summed over the water i, no dummy then pushes along its face, as a wall without friction, or the mirror image of the
    water, does not. Else those near the surface do, who see water on one side alone: they draw the line where it meets
    the wall down, by ρ g h² in all. The power of this push is the adjoint of the sliding in `Closing` (own derivation;
    for adjoint pairs see Bonet & Lok 1999, sec. 3). Without it what slides is taken from waves: a standing wave of 20
    layers decays by 4.5 % faster.

    Limits: only away from corners (FAR). There the water leans because another wall ends it, and the pushes of both
    walls bear each other; with part of them taken off, the pressure of 40 layers at rest between chamfers was off by
    2 % of ρ g H. So a surface within 1.5 reaches of a corner, a wall of short edges, parts in the water, water beside
    air and full tanks, which have no `Closing`, are as they were.
    """

    def __init__(self, arrays: State, medium: Medium, straight: np.ndarray, slots: np.ndarray):
        """`straight` (n, 2) are those of `straight_of` for the points at the lanes `slots` of the walls."""
        self.particles, self.constants = p, c = medium.particles, medium.constants
        self.acts = p.dry > 0 and not (c.full or c.two)
        if self.acts:
            rows = np.zeros((p.walls * p.lanes, 2))
            rows[slots] = straight
            own, each = arrays.under("water.lean"), (Axis("block", p.worlds * p.stride), Axis("lane", p.lanes))
            self.along = [
                own.holding(name, padded(rows[:, a].reshape(-1, p.lanes), p.dry), "row lane")
                for a, name in enumerate(named("along", p.axes))
            ]
            self.lean = own.wide(each, *named("lean", p.axes), kept=False)

    @ti.func
    def note(self, b, seen, steep: ti.template()):
        """Store t (t·Σ V (−W'/r)(r_f − r_w))/Σ V W of a block of dummies, from Σ V W `seen` and that sum, `steep`."""
        p = self.particles
        along = [p.load(self.along[a], b % p.stride - p.wet) for a in ti.static(range(p.axes))]
        leans = dot(along, steep) / ti.max(seen, 1e-30)
        for a in ti.static(range(p.axes)):
            p.store(self.lean[a], b, leans * along[a])

    @ti.func
    def given(self, jb, lane, value, axis: ti.template()):
        """What is to be taken from (−W'/r)(r_i − r_w) along an axis, for particles at which W is `value`."""
        return value * self.lean[axis][jb, lane]


def straight_of(points: np.ndarray, along: np.ndarray, corners: np.ndarray, water: Water) -> np.ndarray:
    """`along` (n, 2) of the dummies at `points` (n, 2) m, zero near the `corners` (m, 2) m of their tank's outline."""
    away = np.linalg.norm(points[:, None] - corners, axis=2).min(axis=1)
    return along * (away > FAR * water.reach)[:, None]
