"""A scene's data on its irregular grains."""

from dataclasses import dataclass

import numpy as np

from solvers.grains.shapes.contour import Contour


@dataclass(frozen=True)
class Shapes:
    """Outlines of the grains of W worlds: grain i in world w has `outlines[which[w, i]]` scaled by `radius[w, i]`.

    `outlines` are about their centroids and have the area of a disc of radius 1; a scene's radii are those of discs of
    equal area. `angle` (W, n) rad are the angles at the start, counter-clockwise. `contact` is one of CONTACTS; `nodes`
    is the number per outline for rules that use nodes. `reach` and `least_mass` are bounds on the outlines' bounding
    radius and least mass; by default they follow from the outlines. Give them if a world must not depend on the others.
    """

    outlines: tuple[Contour, ...]
    which: np.ndarray
    angle: np.ndarray
    contact: str = "continuous"
    nodes: int = 120
    reach: float | None = None
    least_mass: float | None = None

    def __post_init__(self):
        if self.reach is None:
            object.__setattr__(self, "reach", max(outline.bounding_radius for outline in self.outlines))
        if self.least_mass is None:
            object.__setattr__(self, "least_mass", min(outline.least_mass for outline in self.outlines))

    @property
    def alike(self) -> tuple:
        """What worlds that share a launch must agree in."""
        return self.outlines, self.contact, self.nodes

    @property
    def convex(self) -> bool:
        """Whether all outlines are convex."""
        return all(outline.convex for outline in self.outlines)


CONTACTS = ("continuous", "nodes", "area")
