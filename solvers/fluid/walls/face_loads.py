"""Forces of the water on single faces of a prism: to which faces the push of a wall particle goes."""

import numpy as np
import taichi as ti

from solvers.fluid.lists.context import FluidContext
from solvers.fluid.walls.edges import beside
from solvers.fluid.walls.layers import distance
from solvers.fluid.walls.wall_forces import WallForces
from solvers.fluid.walls.wall_layers import OF_NONE, WallLayers
from solvers.machine.state import State, padded, roomy
from solvers.tank.load import Load
from solvers.tank.solids.solid import Prism
from solvers.tank.tank import Tank

USUAL = 32  # groups of wall particles for which there is room at least: a box has 26
MOST = 3  # faces that meet in a corner


@ti.data_oriented
class FaceLoads:
    """The load on each face of a prism, booked piece by piece, which together is the load on the tank.

    Where ∇p = ρ (g − a), water pushes a wall particle by F = A₁ n₁ + A₂ n₂ + A₃ n₃ − q, with the faces that it sees
    (`solvers.fluid.walls.edges.parting`). Over all wall particles behind the plane of a face, A_k − q·n_k makes up
    ∫ p dS of that face. So of a wall particle behind the planes of two or three faces, beyond an edge or a corner, each
    takes the part along its normal; one behind a single face gives all to it, also what other faces push along it. The
    moment of each part is that of the water's place.

    Limits: this is exact where faces meet at right angles. An edge of another angle, or one that points into the water,
    misses up to 0.4 Δx p a metre. Where the outline turns by less than SHARP, or more than 180 deg less that, all goes
    to the nearest face. Along a face, loads are no friction: they make the sum of all faces exact.
    """

    def __init__(
        self,
        arrays: State,
        context: FluidContext,
        walls: WallForces,
        load: Load,
        layers: WallLayers,
        slots: np.ndarray,
        scene,
    ):
        """`slots` are where the points of `layers` are among the walls of the first tank of a scene."""
        self.particles, self.lists, self.constants = context.particles, context.lists, context.constants
        self.walls, self.load, self.count = walls, load, scene.faces if len(layers.points) else 0
        if not self.count:
            return
        p, own = self.particles, arrays.under("water.faces")
        group, faces = groups_of(layers.points, scene.tanks[0], scene.solid, scene.fluid.water.reach)
        size, room = p.wall_blocks * p.lanes, roomy(len(faces), USUAL)
        of_slot = np.zeros(size, dtype=int)
        of_slot[slots] = group
        shares = [shares_of(normals_of(scene.tanks[0], scene.solid)[list(of_one)]) for of_one in faces]
        whole = np.zeros((room, MOST, p.axes, p.axes))
        whole[: len(faces)] = [padded(one, MOST) for one in shares]
        named = np.array([[*of_one, *[OF_NONE] * (MOST - len(of_one))] for of_one in faces])
        self.group = own.holding("group", of_slot, "slot", ti.i32)
        self.face = own.holding("face", padded(named, room), "group number", ti.i32)
        self.share = own.holding("share", whole.reshape(room * MOST, p.axes, p.axes), "row axis of", own.real)

    @ti.func
    def group_of(self, u, k):
        """The group of the wall particle in an entry of a unit's list of walls."""
        p, lists = self.particles, self.lists
        j = lists.beside.slots[u, k]
        row = lists.block_of(j) % p.stride - p.fluid_blocks
        return self.group[row * p.lanes + lists.lane_of(j)]

    @ti.func
    def ends(self, u, k, end):
        """Whether the entries of one group end with entry `k` of a list that ends before `end`."""
        found = True
        if k + 1 < end:
            found = self.group_of(u, k + 1) != self.group_of(u, k)
        return found

    @ti.func
    def bear(self, block: ti.template(), k, off: ti.template()):
        """Note the load on the faces of the group of entry k, whose walls push a block by `off`, over V_i."""
        p, group = self.particles, self.group_of(block.u, k)
        force = p.load(p.volume, block.b) * self.constants.get("slope")
        for n in range(MOST):
            face = self.face[group, n]
            if face != OF_NONE:
                part = [p.zeros() for _ in ti.static(range(p.axes))]
                for a in ti.static(range(p.axes)):
                    for c in ti.static(range(p.axes)):
                        part[a] += self.share[group * MOST + n, a, c] * off[c]
                for a in ti.static(range(p.axes)):
                    part[a] *= force
                self.load.note(block.u, face, self.walls.on_walls(block, part))

    @ti.func
    def book(self, u, dt):
        """Book what has been noted of a unit."""
        self.load.book_noted(u, dt)


def normals_of(tank: Tank, solid: Prism) -> np.ndarray:
    """Normals (faces, 3) out of a prism: of the edges of its outline, then of its ends."""
    ways = np.roll(tank.outline, -1, axis=0) - tank.outline
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    sides = np.column_stack([ways[:, 1], -ways[:, 0], np.zeros(len(ways))])
    return sides if solid.periodic else np.concatenate([sides, [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]])


def groups_of(points: np.ndarray, tank: Tank, solid: Prism, reach: float) -> tuple[np.ndarray, list[tuple[int, ...]]]:
    """The groups (n,) of wall particles (n, 3) m, and the faces of each group, those that they are behind.

    Sides with which the nearest one makes an edge count where a wall particle is behind their planes, too.
    """
    outline = tank.outline
    section, place = np.unique(points[:, :2], axis=0, return_inverse=True)  # each is there many times along x
    own = _nearest(section, tank)
    ways = normals_of(tank, solid)[: len(outline), :2]
    other = beside(section, own, tank, reach)
    behind = ((section - outline[other]) * ways[other]).sum(axis=1) > 0.0
    own, other, behind, outside = (one[place.ravel()] for one in (own, other, behind, ~tank.holds(section)))
    beyond = (np.abs(points[:, 2]) > 0.5 * solid.along) & (not solid.periodic)
    end = len(outline) + (points[:, 2] > 0.0)
    columns = np.stack(
        [
            np.where(outside | ~beyond, own, OF_NONE),
            np.where(outside & behind, other, OF_NONE),
            np.where(beyond, end, OF_NONE),
        ],
        axis=1,
    )
    rows, group = np.unique(np.sort(columns, axis=1), axis=0, return_inverse=True)
    return group.ravel(), [tuple(int(face) for face in row if face != OF_NONE) for row in rows]


def _nearest(section: np.ndarray, tank: Tank) -> np.ndarray:
    """The edge (n,) with a wall that is nearest to points (n, 2) m, by its first corner."""
    corners = tank.outline
    apart = np.stack([distance(section, edge) for edge in np.stack([corners, np.roll(corners, -1, axis=0)], axis=1)])
    apart[list(tank.open_edges)] = np.inf
    return apart.argmin(axis=0)


def shares_of(normals: np.ndarray) -> np.ndarray:
    """Matrices (k, 3, 3) that part a force among faces with these normals (k, 3): together they are the identity.

    Each takes the part along its normal, the first also what is square to all normals.
    """
    parts = normals[:, :, None] * np.linalg.pinv(normals.T)[:, None, :]
    parts[0] += np.eye(3) - parts.sum(axis=0)
    return parts
