"""What the dummies of a wall would push water along its face, taken off their push."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.lists import Medium
from solvers.machine.state import Axis, State, padded
from solvers.space.axes import dot, named

STRAIGHT = 0.02  # of 1/h: what Σ V ∇W over the dummies of a straight wall may be along its face
TINY = 1e-6  # of a smoothing length: half the step of a difference


@ti.data_oriented
class Lean:
    """∇W_iw of a dummy's own pressure p_w becomes ∇W_iw − t (t·Σ_k V_k ∇W_kw) W_iw/Σ_f V_f W_fw, t along the face.

    Summed over the water i, no dummy then pushes along its face, as a wall without friction, or the mirror image of the
    water, does not. Else those near the surface do, who see water on one side alone: they draw the line where it meets
    the wall down, by ρ g h² in all. The power of this push is the adjoint of the sliding in `Closing` (own derivation;
    for adjoint pairs see Bonet & Lok 1999, sec. 3). Without it what slides is taken from waves: a standing wave of 20
    layers decays by 4.5 % faster.

    Limits: `of_tank` where faces are straight within the reach of a dummy alone: in corners, where the push of the
    floor's and the side's dummies are one another's, it stays as it is; so it does at parts in the water, beside air,
    and in full tanks, which have no `Closing`.
    """

    def __init__(self, arrays: State, medium: Medium, straight: np.ndarray, slots: np.ndarray):
        """`straight` (n, 2) are those of `straight_along` for the points at the lanes `slots` of the walls."""
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


def straight_along(points: np.ndarray, volumes: np.ndarray, along: np.ndarray, water: Water) -> np.ndarray:
    """`along` (n, 2) of the dummies at `points` (n, 2) m, zero where the wall is not straight within their reach.

    There Σ V ∇W over all dummies has a part along the face: corners, and the brim of an open tank.
    """
    from scipy.spatial import cKDTree  # slow to import

    tree, kernel, step = cKDTree(points), KERNELS[water.kernel], TINY * water.length
    pairs = tree.sparse_distance_matrix(tree, water.reach, output_type="ndarray")
    pairs = pairs[pairs["v"] > step]
    w, other, away = pairs["i"], pairs["j"], pairs["v"]
    farther, nearer = np.minimum(away + step, water.reach), away - step
    steep = (kernel.printed(farther, water.length) - kernel.printed(nearer, water.length)) / (farther - nearer)
    part = volumes[other] * steep / away * ((points[other] - points[w]) * along[w]).sum(axis=1)
    leans = np.abs(np.bincount(w, part, len(points)))
    return along * (leans * water.length < STRAIGHT)[:, None]


def straight_of(tanks: Sequence[int], points, volumes, along, water: Water) -> np.ndarray:
    """As `straight_along`, for dummies of several `tanks` (n,), each among its own."""
    found = np.zeros_like(along)
    for tank in np.unique(tanks):
        own = (tanks == tank) & (volumes > 0.0)
        found[own] = straight_along(points[own], volumes[own], along[own], water)
    return found
