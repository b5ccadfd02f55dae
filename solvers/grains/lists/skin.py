"""The skin of Verlet lists: how far apart pairs are listed that do not touch yet.

A wide skin lists more pairs, a thin one must be built more often. The cost of a step, with p for the share by which it
grows with the skin s (in diameters d) and b for building lists in units of a step, is 1 + p s + b u Δt/(s d), since
lists hold until two neighbours have neared each other by s d, at a speed u; in flow that is 0.6 of the speed of the
fastest grain. So the best is s = √(b/p) √(u Δt/d). (Chialvo & Debenedetti 1990, Comput. Phys. Commun. 60, 215, seek the
best skin for molecules.)
"""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.grains.state import GrainState
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import State

# Skins from and to, and up to where candidates are sought, in mean diameters; the skin over √(v Δt/d) for the fastest
# grain's speed v: where it is known how neighbours near each other, and where they may come straight at each other.
TOGETHER, APART = {PLANE: (0.05, 0.25, 1.1, 1.4), SPACE: (0.05, 0.25, 0.6, 1.4)}, (0.05, 0.3, 0.8, 2.0)
LEAST_OF_CONVEX = 0.1  # for convex outlines, whose lists cost more to build
LISTS = 7.0  # skins, where all are alike, up to which candidates are sought
# Skins that a grain, and a moving part, may go until the lists are built anew, in either case
ASTRAY, STRAIGHT = (2.0, 1.0), (0.5, 0.5)


@dataclass(frozen=True)
class Widths:
    """Skins (m) from `least` to `most`: √(`per_speed` (m s) times the speed of the fastest grain) in between.

    Candidates are sought up to gaps of `farthest` (m).
    """

    least: float
    most: float
    farthest: float
    per_speed: float = 0.0


def widths(scene, skin: float | None, single: bool, together: bool) -> Widths:
    """The skins of a scene, or only the one that is asked for (m).

    Units of a `single` grain have no candidates; `together` is whether it is known how neighbours near each other.
    """
    diameter, shapes = 2.0 * scene.grains.mean_radius, scene.grains.shapes
    if shapes or single or skin:
        least = skin or (LEAST_OF_CONVEX if shapes and shapes.convex else APART[0]) * diameter
        return Widths(least, least, least if single else LISTS * least)
    least, most, farthest, keen = TOGETHER[scene.axes] if together else APART
    return Widths(least * diameter, most * diameter, farthest * diameter, keen**2 * diameter * scene.time_step())


@ti.data_oriented
class Skin:
    """The present skin `width` (W,) m of each world, and the gaps up to which its pairs and wall contacts are listed.

    Pairs with a liquid bridge, of at most `bridges` (m), are listed however thin the skin; and all `early` (m) before,
    since a force begins in the kick in which two grains touch. Where what is known of grains is how they go `together`,
    lists are good until one has gone by `astray` skins, or where parts are `moving`, a part by `parts`.
    """

    def __init__(
        self,
        arrays: State,
        grains: GrainState,
        widths: Widths,
        bridges: float,
        early: float,
        together: bool,
        moving: bool,
    ):
        self.grains, self.widths, self.adapts = grains, widths, widths.most > widths.least
        self.together, (self.astray, self.parts) = together, ASTRAY if together else STRAIGHT
        self.beside_walls = self.astray + (self.parts if moving else 0.0)
        beyond = widths.farthest - widths.most  # candidates serve several lists
        self.farthest = max(widths.farthest, bridges + beyond) + early
        self.bridges, self.early = bridges, early
        own = arrays.under("lists")
        self.width = own.holding("skin", np.full(grains.worlds, widths.least), "world", kept=True)
        bounds = [widths.least, widths.most, widths.per_speed, bridges, early]
        self.bounds = own.holding("skins", np.array(bounds), "number")

    @property
    def most_beside(self) -> float:
        """The largest gap (m) up to which grains are listed with walls."""
        return max(self.beside_walls * self.widths.most, self.bridges) + self.early

    @ti.func
    def margin(self, w):
        """The gap (m) up to which pairs of a world are listed."""
        return ti.max(self.width[w], self.bounds[3]) + self.bounds[4]

    @ti.func
    def apart(self, w):
        """The gap (m) up to which all pairs are among the candidates when lists are built.

        Of grains that are no neighbours it is only known how far each of them has gone until these expire.
        """
        return ti.max(2.0 * self.astray * self.width[w], self.bounds[3]) + self.bounds[4]

    @ti.func
    def beside(self, w):
        """The gap (m) up to which grains are listed with walls and moving parts."""
        return ti.max(self.beside_walls * self.width[w], self.bounds[3]) + self.bounds[4]

    @ti.func
    def adapt(self, w):
        """Choose the skin of the lists to come by how fast the grains of a world are now."""
        if ti.static(self.adapts):
            wanted = ti.sqrt(self.bounds[2] * self.grains.fastest(w))
            self.width[w] = ti.max(self.bounds[0], ti.min(self.bounds[1], wanted))
