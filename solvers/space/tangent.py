"""Kinematics of contacts across their normals: slip, force, torque and moment, in the plane and in space.

What is across a normal, or about it, is a list with an entry per axis about which a body can turn (`turns`). In the
plane that is one number: along the tangent, the normal turned counter-clockwise by 90°, or about x. In space it is a
vector with the components of all others.

That holds of what a contact does at an instant. What a spring remembers of former steps turns with the tangent by
itself in the plane. In space it has to be turned, as the normal swings and the bodies twist about it (`carried`); laws
are handed the `way` of the contact for that: its normal, by how much that has swung in the step, and the twist (rad)
about it. In the plane it is empty, `NO_WAY`.
"""

import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.machine.wide import size
from solvers.space.axes import cross, dot
from solvers.space.extremes import greater, lesser, within

SMALLEST = 1e-30  # keeps the division finite where there is nothing to cap
NO_WAY = ()  # how a contact in the plane turns: with the tangent, by itself


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
def across(vector: ti.template(), normal: ti.template()):
    """What of a rotation is across the normal, as rolling is; all of it in the plane."""
    if ti.static(len(vector) == 1):
        return vector
    else:
        along = dot(vector, normal)
        return [vector[k] - along * normal[k] for k in ti.static(range(len(vector)))]


@ti.func
def way(velocity: ti.template(), normal: ti.template(), nearness, spin_i: ti.template(), spin_j: ti.template(), dt):
    """How a contact in space has turned in a step of dt (s), as `carried` takes it.

    `velocity` (m/s) is that of the centres relative to each other and `nearness` (1/m) one over their distance; spins
    are those of both bodies (rad/s). The contact twists by the mean of their spins about the normal.
    """
    if ti.static(len(normal) == PLANE):
        return NO_WAY
    else:
        rate = dot(velocity, normal)
        swing = [dt * nearness * (velocity[k] - rate * normal[k]) for k in ti.static(range(len(normal)))]
        both = [spin_i[k] + spin_j[k] for k in ti.static(range(len(normal)))]
        return [normal, swing, 0.5 * dt * dot(both, normal)]


@ti.func
def carried(vector: ti.template(), way: ti.template()):
    """What a contact remembers, a vector S across its former normal, turned as the contact has turned in a step.

    With the new normal n, the swing θ = Δn and the twist φ about n: S ← S − (S·n) n + ½ (S·n) θ, then S ← S + φ n × S,
    then its size as before, by 1 − ε/2 + 3ε²/8 with ε the relative growth of |S|². The direction is right to second
    order in θ and φ, the size to third. (Luding 2008, Granular Matter 10, 235, projects and rescales alone, so
    that S does not twist.) In the plane the vector is returned as it is.
    """
    if ti.static(len(way) == 0):
        return vector
    else:
        n, swing, twist = way
        axes = ti.static(range(len(n)))
        off = dot(vector, n)
        flat = [vector[k] - off * n[k] + 0.5 * off * swing[k] for k in axes]
        about = cross(n, flat)
        turned = [flat[k] + twist * about[k] for k in axes]
        grown = dot(turned, turned) / greater(dot(vector, vector), SMALLEST) - 1.0
        size = 1.0 - grown * (0.5 - 0.375 * grown)
        return [turned[k] * size for k in axes]


@ti.func
def remembered(fields: ti.template(), u, block, way: ti.template()):
    """The memory of a block of contacts, a field for each component, as it stands after the step (`carried`)."""
    kept = [fields[k][u, block] for k in ti.static(range(len(fields)))]
    return carried(kept, way)


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
