"""Tangential kinematics in the plane: one tangent, the normal turned counter-clockwise by 90°, and rotation about x.

So slip, friction, spin and torque are one number each. In three dimensions they have components; for spheres it is then
enough to replace these functions.
"""

import taichi as ti


@ti.func
def slip(velocity: ti.template(), normal: ti.template(), surfaces):
    """Slip (m/s) along the tangent of a contact with a relative velocity of the centres (m/s).

    `surfaces` (m/s) is the tangential velocity of the surfaces due to both spins, which is subtracted.
    """
    return velocity[1] * normal[0] - velocity[0] * normal[1] - surfaces


@ti.func
def force(normal: ti.template(), pressing, shearing):
    """The force (N), one entry per axis, from its normal part `pressing` and its tangential part `shearing`."""
    return [
        pressing * normal[0] - shearing * normal[1],
        pressing * normal[1] + shearing * normal[0],
    ]


@ti.func
def torque(lever, shearing, roll):
    """Torque (N m) of rolling `roll` and of a tangential force (N) at a `lever` (m) from a grain's centre."""
    return roll - lever * shearing


@ti.func
def moment(place: ti.template(), push: ti.template()):
    """Moment (N m) about the origin of a force (N) at a place (m)."""
    return place[0] * push[1] - place[1] * push[0]
