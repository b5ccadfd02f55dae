"""The tank's frame: its axes, and vectors turned into them.

Sign convention of the whole lab: looking forward from astern, y to starboard (right), z up, x towards the viewer; the
roll angle φ about x is counter-clockwise positive in the picture (port side down). The tank's frame has its origin at
the middle of the tank's floor; a point r of it lies in the earth frame at P + R(φ) r, and P = 0, φ = 0 at rest.
"""

import taichi as ti


@ti.func
def turned(y, z, phi):
    """The vector (y, z) turned by φ, counter-clockwise in the picture."""
    c, s = ti.cos(phi), ti.sin(phi)
    return ti.Vector([c * y - s * z, s * y + c * z])
