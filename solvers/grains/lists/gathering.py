"""What a block of pairs sees of its grains: their values, side by side in lanes, and how they lie to each other."""

import taichi as ti

from solvers.space.axes import dot


@ti.func
def gathered(field: ti.template(), places, count: ti.template()):
    """The values of a grain field (W, stride) for `count` grains, by their indices into the whole field."""
    return ti.Vector([field[0, places[k]] for k in ti.static(range(count))])


@ti.func
def geometry(g: ti.template(), i, j, reach, count: ti.template()):
    """Normals (towards the first grains), distances (m), one over these, and overlaps (m; negative: gaps)."""
    if ti.static(g.mixed):
        # The difference of squares in 64 bits: an overlap of 1e-7 m then has full 32-bit precision. Lane by lane,
        # since real vectors cannot change their precision.
        lanes = ti.static(range(count))
        axes = ti.static(range(g.axes))
        apart = [g.nearest([g.place[a][0, i[k]] - g.place[a][0, j[k]] for a in axes]) for k in lanes]
        square = [dot(apart[k], apart[k]) for k in lanes]
        whole = [ti.cast(reach[k], ti.f64) for k in lanes]
        distance = ti.sqrt(ti.Vector([ti.cast(square[k], g.real) for k in lanes]))
        inverse = 1.0 / distance
        more = ti.Vector([ti.cast(whole[k] * whole[k] - square[k], g.real) for k in lanes])
        along = [ti.Vector([ti.cast(apart[k][a], g.real) for k in lanes]) for a in axes]
        return [along[a] * inverse for a in axes], distance, inverse, more / (reach + distance)
    else:
        apart = g.nearest(differences(g.place, i, j, count))
        distance = ti.sqrt(dot(apart, apart))
        inverse = 1.0 / distance
        return [apart[a] * inverse for a in ti.static(range(g.axes))], distance, inverse, reach - distance


@ti.func
def differences(fields: ti.template(), i, j, count: ti.template()):
    """Differences, i less j, of the values of grains along each axis for `count` pairs; one field per axis."""
    return [gathered(field, i, count) - gathered(field, j, count) for field in ti.static(fields)]
