"""Kinematics of contacts across their normals: slip, force, torque and moment, in the plane and in space.

What is across a normal, or about it, is a list with an entry per axis about which a body can turn (`turns`). In the
plane that is one number: along the tangent, the normal turned counter-clockwise by 90°, or about x. In space it is a
vector with the components of all others.

That holds of what a contact does at an instant. What a spring remembers of former steps turns with the tangent by
itself in the plane. In space it has to be turned, as the normal swings and the grains twist about it; laws are handed
the `way` of the contact for that, which is None as yet: scenes are plane.
"""

import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.machine.wide import size
from solvers.space.axes import cross, dot
from solvers.space.extremes import greater, lesser, within

SMALLEST = 1e-30  # keeps the division finite where there is nothing to cap


@ti.func
def slip(velocity: ti.template(), normal: ti.template(), surfaces):
    """Slip (m/s) of a contact whose centres have a relative velocity (m/s).

    `surfaces` (m/s) is the sum of levers times spins: by it, across the normal, the surfaces move with the centres.
    """
    if ti.static(len(normal) == PLANE):
        return [velocity[1] * normal[0] - velocity[0] * normal[1] - surfaces[0]]
    else:
        rate, turned = dot(velocity, normal), cross(surfaces, normal)
        return [velocity[k] - rate * normal[k] - turned[k] for k in ti.static(range(len(normal)))]


@ti.func
def force(normal: ti.template(), pressing, shearing):
    """The force (N), one entry per axis, from its normal part `pressing` and its tangential part `shearing`."""
    if ti.static(len(normal) == PLANE):
        return [
            pressing * normal[0] - shearing[0] * normal[1],
            pressing * normal[1] + shearing[0] * normal[0],
        ]
    else:
        return [pressing * normal[k] + shearing[k] for k in ti.static(range(len(normal)))]


@ti.func
def arm(normal: ti.template(), shearing):
    """Normal × tangential force (N): what turns a body by the force's lever, a length along the normal."""
    if ti.static(len(normal) == PLANE):
        return shearing
    else:
        return cross(normal, shearing)


@ti.func
def torque(lever, turning, roll):
    """Torque (N m) of rolling `roll` and of a tangential force whose `arm` is `turning` (N), at a `lever` (m)."""
    return [roll[k] - lever * turning[k] for k in ti.static(range(len(roll)))]


@ti.func
def moment(place: ti.template(), push: ti.template()):
    """Moment (N m) about the origin of a force (N) at a place (m)."""
    if ti.static(len(place) == PLANE):
        return [place[0] * push[1] - place[1] * push[0]]
    else:
        return cross(place, push)


@ti.func
def length(vector: ti.template()):
    """Length of what is across a normal, or about it."""
    if ti.static(len(vector) == 1):
        return size(vector[0])
    else:
        return ti.sqrt(dot(vector, vector))


@ti.func
def capped(vector: ti.template(), most):
    """The vector, or if that is longer than `most`, as much of it in its direction."""
    if ti.static(len(vector) == 1):
        return [within(vector[0], most)]
    else:
        share = lesser(most / greater(length(vector), SMALLEST), 1.0)
        return [share * vector[k] for k in ti.static(range(len(vector)))]
