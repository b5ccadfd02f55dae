"""Contact forces: overlaps and slips of listed contacts, and the laws of the scene on them."""

import taichi as ti

from solvers.laws.chosen import PAIR, WALL, ChosenLaws
from solvers.neighbours import LANES


@ti.data_oriented
class Contacts:
    """What the listed contacts do to the grains, by the chosen laws.

    The tangent is the normal turned counter-clockwise by 90°. The levers of two grains reach to where their undeformed
    outlines cross, R_i − ξ R_j/(R_i + R_j) to first order, and add up to the distance of the centres: angular momentum
    is exact. (Spandonidis 2016, eq. 4.7, takes whole radii.) A wall's takes half the overlap.
    """

    def __init__(self, laws: ChosenLaws):
        self.laws = laws

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), w, dt):
        """Forces between the grains g, a block of LANES pairs at a time.

        Straight-line arithmetic on short vectors: the compiler turns it into SIMD instructions, and pairs that do not
        touch come out with zero overlap, force and memory. Gathering and scattering grains stays scalar.
        """
        for block in range(pairs.blocks(w)):
            i, j = pairs.grain[w, block], pairs.mate[w, block]
            dy, dz = lanes(g.y, w, i) - lanes(g.y, w, j), lanes(g.z, w, i) - lanes(g.z, w, j)
            reach, share = pairs.reach[w, block], pairs.share[w, block]
            distance = ti.sqrt(dy * dy + dz * dz)
            inverse = 1.0 / distance
            ny, nz = dy * inverse, dz * inverse
            overlap = ti.max(reach - distance, 0.0)
            uy = lanes(g.now_y, w, i) - lanes(g.now_y, w, j)
            uz = lanes(g.now_z, w, i) - lanes(g.now_z, w, j)
            lever_i = share * (reach + overlap) - overlap
            lever_j = distance - lever_i
            rate = -(uy * ny + uz * nz)
            turning = lever_i * lanes(g.spin_now, w, i) + lever_j * lanes(g.spin_now, w, j)
            slip = uz * ny - uy * nz - turning
            fn, ft = self.laws.forces(PAIR, pairs, w, block, overlap, rate, slip, dt)
            fy, fz = fn * ny - ft * nz, fn * nz + ft * ny
            turn_i, turn_j = -lever_i * ft, -lever_j * ft
            for k in ti.static(range(LANES)):
                g.push(w, i[k], fy[k], fz[k], turn_i[k])
                g.push(w, j[k], -fy[k], -fz[k], turn_j[k])

    @ti.func
    def wall_forces(self, g: ti.template(), walls: ti.template(), contacts: ti.template(), w, dt):
        """Forces of the walls on the grains g."""
        for p in range(contacts.length[w]):
            i = contacts.grain[w, p][0]
            gap = walls.gap(contacts.mate[w, p][0], g.y[w, i], g.z[w, i])
            ny, nz, radius = gap[1], gap[2], g.radius[w, i]
            overlap = 0.0
            if 0.0 < gap[0] < radius:
                overlap = radius - gap[0]
            uy, uz = g.now_y[w, i], g.now_z[w, i]
            lever = radius - 0.5 * overlap
            rate = -(uy * ny + uz * nz)
            slip = uz * ny - uy * nz - lever * g.spin_now[w, i]
            fn, ft = self.laws.forces(
                WALL, contacts, w, p, ti.Vector([overlap]), ti.Vector([rate]), ti.Vector([slip]), dt
            )
            fy, fz = fn[0] * ny - ft[0] * nz, fn[0] * nz + ft[0] * ny
            g.push(w, i, fy, fz, -lever * ft[0])

    @ti.func
    def census(self, g: ti.template(), walls: ti.template(), lists: ti.template(), w):
        """Number of touching contacts, largest overlap in radii of the smaller grain, elastic energy (J)."""
        touching, deepest, energy = 0.0, 0.0, 0.0
        for p in range(lists.pairs.length[w]):
            i, j = lists.pairs.first_of(w, p), lists.pairs.second_of(w, p)
            dy, dz = g.y[w, i] - g.y[w, j], g.z[w, i] - g.z[w, j]
            overlap = g.radius[w, i] + g.radius[w, j] - ti.sqrt(dy * dy + dz * dz)
            if overlap > 0.0:
                touching += 1.0
                deepest = ti.max(deepest, overlap / ti.min(g.radius[w, i], g.radius[w, j]))
                energy += self.laws.energy(PAIR, lists.pairs, w, p, overlap)
        for p in range(lists.contacts.length[w]):
            i = lists.contacts.first_of(w, p)
            gap = walls.gap(lists.contacts.second_of(w, p), g.y[w, i], g.z[w, i])
            overlap = g.radius[w, i] - gap[0]
            if 0.0 < gap[0] < g.radius[w, i]:
                touching += 1.0
                deepest = ti.max(deepest, overlap / g.radius[w, i])
                energy += self.laws.energy(WALL, lists.contacts, w, p, overlap)
        return ti.Vector([touching, deepest, energy])


@ti.func
def lanes(field: ti.template(), w, index):
    """The values of a grain field for LANES grains."""
    return ti.Vector([field[w, index[k]] for k in ti.static(range(LANES))])
