"""The tank's frame: its axes, and the rotation of vectors.

Sign convention of the whole lab: looking forward from astern, y is to starboard (right), z up, x towards the viewer.
The roll angle φ about x is positive counter-clockwise in the picture (port side down). The tank's frame has its origin
at the middle of the tank's floor; its point r lies in the earth frame at P + R(φ) r, with P = 0, φ = 0 at rest.
"""

import taichi as ti


@ti.func
def turned(y, z, phi):
    """The vector (y, z) turned by φ (rad), counter-clockwise in the picture."""
    c, s = ti.cos(phi), ti.sin(phi)
    return ti.Vector([c * y - s * z, s * y + c * z])
