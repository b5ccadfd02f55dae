"""Contacts carried along on the osculating circles of the outlines."""

from math import inf

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.rules.rest import HOLDS, OVERLAP, Rest
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.machine.wide import minus, size
from solvers.space.extremes import greater, lesser

CURVED_I, CURVED_J = HOLDS + 1, HOLDS + 2  # elements of a rule's contact: radii of curvature (m)
OFF, LONGEST = 1e-7, 0.02  # of R0: error of an overlap after a slide, and the longest slide
TINY = 1e-30
TOGETHER = 0.05  # rad: largest sum of the rotations of the two grains


@ti.data_oriented
class Osculating(Rest):
    """Replaces both outlines by their osculating circles, so that contacts are those of discs fixed to the grains.

    This holds until a contact has slid too far along the outlines. After a slide s the error of its overlap is κ' s³/6,
    with κ the curvature (local canonical form, do Carmo 1976, section 1-6); `slides` (classes,) m, for grains of radius
    1, are limits that keep it small. Grains that were apart may move by their gap.
    """

    said = (*Rest.said, "curved_i", "curved_j")
    elements = (*Rest.elements, CURVED_I, CURVED_J)

    def __init__(self, arrays: State, units: Units, outlines: list[Contour], most: float = inf, wide: int = 0):
        super().__init__(arrays, units, False, wide)
        slides = np.array([min(most, slide_of(outline)) for outline in outlines])
        self.slides = arrays.holding("rest.slides", slides, "outline")

    @ti.func
    def carried(self, names: ti.template(), pairs: ti.template(), u, block, moves: ti.template()):
        """Contacts as they are after these moves, and how far (m) they have slid on both outlines.

        Computed in components along and across the old normal, from the grains' centres.
        """
        was, ny, nz, py, pz = self.heard(names, pairs, u, block)
        overlap = greater(was, 0.0)
        curved_i, curved_j = pairs.was_curved_i[u, block], pairs.was_curved_j[u, block]
        far_y, far_z = py + pairs.apart_y[u, block], pz + pairs.apart_z[u, block]
        half = 0.5 * overlap
        # The centres of curvature, and their displacements as the grains turn.
        n_i, t_i = py * ny + pz * nz + (curved_i - half), pz * ny - py * nz
        n_j, t_j = far_y * ny + far_z * nz - (curved_j - half), far_z * ny - far_y * nz
        sine_i, lost_i = turn_by(moves[2])
        sine_j, lost_j = turn_by(moves[3])
        to_n, to_t = minus(sine_i * t_i) - lost_i * n_i, sine_i * n_i - lost_i * t_i
        un = moves[0] * ny + moves[1] * nz + to_n + sine_j * t_j + lost_j * n_j
        ut = moves[1] * ny - moves[0] * nz + to_t - sine_j * n_j + lost_j * t_j
        # x is the tangent of the angle by which the line through both centres of curvature has turned.
        apart = curved_i + curved_j - overlap + un
        x = ut / ti.select(was > 0.0, apart, 1.0 + 0.0 * apart)
        square = x * x
        now = overlap - un - 0.5 * ut * x * (1.0 - 0.25 * square)
        cosine = 1.0 - square * (0.5 - 0.375 * square)
        sine, back = cosine * x, curved_i - 0.5 * now
        own_n, own_t = n_i + to_n - back * cosine, t_i + to_t - back * sine
        now = ti.select(was > 0.0, now, was)
        slid = size(curved_i * (x - moves[2])) + size(curved_j * (x - moves[3]))
        py, pz = own_n * ny - own_t * nz, own_n * nz + own_t * ny
        return now, cosine * ny - sine * nz, cosine * nz + sine * ny, py, pz, slid

    @ti.func
    def far(self, pairs: ti.template(), u, block, way, slid, angle_i, angle_j):
        """Slide (m) of a contact, or displacement (m) of grains that were apart."""
        slid = ti.select(size(angle_i) + size(angle_j) < TOGETHER, slid, 1.0 + 0.0 * slid)
        return ti.select(pairs.was_overlap[u, block] > 0.0, slid, way)

    @ti.func
    def still(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p, c, d):
        """How far (m) a contact may slide, or grains that are apart move, until the rule must be evaluated again."""
        still = ti.select(c[OVERLAP] > 0.0, self.slide(g, w, i, j), -c[OVERLAP])
        return ti.select(c[HOLDS] == 1.0, still, 0.0 * still)

    @ti.func
    def slide(self, g: ti.template(), w, i, j):
        """How far (m) a contact of two grains may slide."""
        return lesser(self.slides[g.shape[w, i]] * g.radius[w, i], self.slides[g.shape[w, j]] * g.radius[w, j])

    @ti.func
    def passed(self, g: ti.template(), w, i, j, dt):
        """How far (m) a contact has slid since the last evaluation."""
        return self.slide(g, w, i, j)


@ti.func
def turn_by(angle):
    """Sine and 1 − cosine of a small angle (rad)."""
    square = angle * angle
    return angle * (1.0 - square * (1.0 / 6.0)), square * (0.5 - square * (1.0 / 24.0))


def slide_of(outline: Contour) -> float:
    """How far (m) a contact may slide on an outline until its osculating circle's error κ' s³/6 is OFF times R0."""
    changes = max(outline.sharpest_change, TINY / outline.radius**2)
    return min(LONGEST * outline.radius, (6.0 * OFF * outline.radius / changes) ** (1.0 / 3.0))
