"""What a scene says of its irregular grains."""

from dataclasses import dataclass

import numpy as np

from solvers.shapes.contour import Contour


@dataclass(frozen=True)
class Shapes:
    """Outlines of the grains of W worlds: of grain i in world w `outlines[which[w, i]]`, `radius[w, i]` times as large.

    `outlines` are about their centroids and have the area of a disc of radius 1; a scene's radii are those of discs of
    equal area. `angle` (W, n) rad is by how much each is turned at the start, counter-clockwise. `contact` is one of
    CONTACTS; `nodes` are those of an outline for the rule that has nodes.
    """

    outlines: tuple[Contour, ...]
    which: np.ndarray
    angle: np.ndarray
    contact: str = "continuous"
    nodes: int = 120


CONTACTS = ("continuous", "nodes")
