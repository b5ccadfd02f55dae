"""What is across a normal, in the plane: one tangent, the normal turned counter-clockwise by 90°, and turning about x.

So slip, friction, spin and torque are one number each. In space they have components of their own, and what replaces
these functions is all that the contacts of spheres need for it.
"""

import taichi as ti


@ti.func
def slip(velocity: ti.template(), normal: ti.template(), surfaces):
    """Slip (m/s) along the tangent of two that pass each other at a velocity (m/s), where their spins turn surfaces.

    `surfaces` (m/s) is how fast both spins together take the surfaces along the tangent, the other way.
    """
    return velocity[1] * normal[0] - velocity[0] * normal[1] - surfaces


@ti.func
def force(normal: ti.template(), pressing, shearing):
    """The force (N) of a part along the normal and one along the tangent, a list with an entry an axis."""
    return [
        pressing * normal[0] - shearing * normal[1],
        pressing * normal[1] + shearing * normal[0],
    ]


@ti.func
def torque(lever, shearing, roll):
    """Torque (N m) of a tangential force (N) at so far (m) from a centre against the normal, and of rolling."""
    return roll - lever * shearing


@ti.func
def moment(place: ti.template(), push: ti.template()):
    """Moment (N m) about the origin of a force (N) at a place (m)."""
    return place[0] * push[1] - place[1] * push[0]
