"""Quadratic B-splines, with which nodes carry points."""

import taichi as ti


@ti.func
def weights(far):
    """The weights of three nodes for a point `far` (cells, 0.5 to 1.5) from the first one.

    Source: quadratic B-splines (Steffen, Kirby & Berzins 2008).
    """
    return [0.5 * (1.5 - far) * (1.5 - far), 0.75 - (far - 1.0) * (far - 1.0), 0.5 * (far - 0.5) * (far - 0.5)]
