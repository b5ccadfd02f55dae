"""How far outlines reach in each direction: what tells that two grains are apart without seeking their contacts."""

from math import pi

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.machine.state import State
from solvers.space.extremes import greater

CELLS, SAMPLES = 512, 2048  # directions of a table, and points of an outline
TRIED = 32  # directions of half a turn in which two grains are looked at


@ti.data_oriented
class Support:
    """An upper bound h of the reach x · d of an outline's points in a direction d, by cells of d's angle.

    Two grains are at least r · d − h_i(−d) − h_j(d) apart, with r from the centre of j to that of i, whatever d
    (Gottschalk, Lin and Manocha 1996: separating axes). A table is of a grain of radius 1. It allows for the points
    between the samples and for the directions within a cell, 0.8 % of the bounding radius in all.
    """

    def __init__(self, arrays: State, outlines: list[Contour]):
        own, angle = arrays.under("support"), pi / TRIED * np.arange(TRIED)
        self.most = own.holding("most", np.array([reaches(outline) for outline in outlines]), "outline cell")
        self.directions = own.holding("directions", np.stack([np.cos(angle), np.sin(angle)], axis=1), "tried axis")

    @ti.func
    def gap(self, g: ti.template(), w, i, j):
        """A lower bound (m) of the gap of two grains, from the best of some directions; negative: none is known."""
        apart, best = g.apart(w, i, j), -g.reach[w, i]
        for k in range(TRIED):
            along = apart[0] * self.directions[k, 0] + apart[1] * self.directions[k, 1]
            angle = k * ti.static(pi / TRIED) + ti.select(along < 0.0, pi, 0.0)  # from j to i
            own = g.radius[w, i] * self.most[g.shape[w, i], self.cell(angle + pi - g.angle[0][w, i])]
            other = g.radius[w, j] * self.most[g.shape[w, j], self.cell(angle - g.angle[0][w, j])]
            best = greater(ti.abs(along) - own - other, best)
        return best

    @ti.func
    def cell(self, angle):
        """The cell of a direction (rad) in the frame of a grain."""
        return ti.cast(ti.floor(angle * ti.static(CELLS / (2.0 * pi))), ti.i32) & (CELLS - 1)


def reaches(outline: Contour) -> np.ndarray:
    """h (CELLS,) of an outline, m."""
    points = outline.points(2.0 * pi / SAMPLES * np.arange(SAMPLES))
    angle = 2.0 * pi / CELLS * (np.arange(CELLS) + 0.5)
    reach = (points @ np.stack([np.cos(angle), np.sin(angle)])).max(axis=0)
    between = 0.5 * np.linalg.norm(points - np.roll(points, 1, axis=0), axis=1).max()
    return reach + 1.1 * between + pi / CELLS * outline.bounding_radius
