"""The tank's frame: its axes, and the rotation of vectors.

Sign convention of the whole lab: looking forward from astern, y is to starboard (right), z up, x towards the viewer.
The roll angle φ about x is positive counter-clockwise in the picture (port side down). The tank's frame has its origin
at the middle of the tank's floor; its point r lies in the earth frame at P + R(φ) r, with P = 0, φ = 0 at rest. In
space the pitch θ about y is positive bow up, the yaw ψ about z bow to port, and surge along x astern.
"""

import taichi as ti

AXIS = {"y": 0, "z": 1, "x": 2}  # along which a motion's coordinate goes, in the order of all arrays
TURNING = {"turn": 2, "pitch": 0, "yaw": 1}  # the axis about which one turns
OF_SPACE = "x", "pitch", "yaw"  # coordinates that the plane does not have


def is_turn(coordinate: str) -> bool:
    """Whether a motion of this coordinate turns the tank."""
    return coordinate in TURNING


@ti.func
def turned(y, z, phi):
    """The vector (y, z) turned by φ (rad), counter-clockwise in the picture."""
    c, s = ti.cos(phi), ti.sin(phi)
    return ti.Vector([c * y - s * z, s * y + c * z])
