"""Forces of the water on single edges of the tank, summed over the wall particles behind them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.fluid.given import Water
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import WALLS
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.layers import SHARP, edge_of
from solvers.fluid.walls.wall_layers import OF_NONE, WallLayers, covered
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
from solvers.tank.tank import Tank

FINE = 8  # points over a smoothing length, by which integrals over faces and over water are taken
TABLE = 33  # depths at which what a plane face shows is known
ZONE = 0.75  # smoothing lengths from a corner within which wall particles bear what few others lack
MOST = 3.0  # times as much more they may bear: behind a thin fin hardly any stand
FEW = 1e-3  # of a kernel: wall particles at a corner that see less have no weight to part


@ti.data_oriented
class Edges:
    """The force (y, z; N) on each edge in each world, as mean since it was last taken.

    A wall particle bears minus what it does to the water (`Forces`), the drag of water that sticks excepted, and
    belongs to the nearest edge. Near a corner it bears the pressure on two faces, and gives part of it to the other
    edge (`parting`). Together the edges bear the load on the tank; each without the pressure of the background. Along a
    face they bear what makes the load of all exact: it is no friction.

    Limits: where the outline turns by less than SHARP, or more than 180 deg less that, each wall particle gives all to
    its nearest edge. Where water at a corner does not move with the tank, parts of second order, ρ a h², are not
    parted.
    """

    def __init__(
        self,
        arrays: State,
        context: FluidContext,
        walls: Extrapolation,
        layers: WallLayers,
        slots: np.ndarray,
        tanks: Sequence[Tank],
        number: int,
        water: Water,
    ):
        """The `edges` of one of the `tanks`; `slots` are where the points of `layers` are among the walls."""
        tank = tanks[number]
        self.particles, self.lists, self.constants = context.particles, context.lists, context.constants
        self.units, self.ranges, self.walls = context.units, context.ranges, walls
        self.wanted, self.thickness, p = list(water.edges), tank.thickness, context.particles
        if water.edges:
            own = arrays.under("edges")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.force = own.wide(each, *named("force", p.axes), kept=False)
            self.weight = own.wide(each, *named("weight", p.axes), kept=False)
            size, here = p.wall_blocks * p.lanes, (layers.tanks == number) & (layers.edges != OF_NONE)
            owner, other = np.full(size, OF_NONE), np.full(size, OF_NONE)
            given, at = np.zeros((size, 2, 4)), slots[here]
            parted = parting(layers.points[here], layers.volumes[here], tank, water, water.edges)
            owner[at], other[at] = layers.edges[here], parted.other
            given[at] = np.concatenate([parted.of_force, parted.of_weight], axis=2)
            self.owner = own.holding("owner", owner, "slot", ti.i32)
            self.other = own.holding("other", other, "slot", ti.i32)
            self.given = own.holding("given", given, "slot axis of", own.exact)
            worlds = Axis("world", p.worlds)
            count = Axis("edge", int(owner.max(initial=0)) + 1)
            self.impulse = own.reals((worlds, count), *named("impulse", p.axes), kind=own.exact)
            (self.elapsed,) = own.reals((worlds,), "elapsed", kind=own.exact)

    def forget(self) -> None:
        """Begin the means anew."""
        if self.wanted:
            for field in (*self.impulse, self.elapsed):
                field.fill(0.0)

    @ti.func
    def bear(self, u, t, kick, dt):
        """The forces on a unit's wall particles."""
        first, end = self.ranges.walls(u)
        for b in range(first, end):
            self.bear_block(u, b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1])

    @ti.func
    def bear_block(self, u, b, begin, end):
        """The forces on a block of wall particles from the entries `begin` to `end` of its list."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        pressure, volume, firm = p.load(p.pressure, b), p.load(p.volume, b), p.load(p.firm, b)
        force = [p.zeros() for _ in ti.static(range(p.axes))]
        felt = self.walls.felt(self.units.world(u), b)
        for k in range(begin, end):
            j = lists.facing.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * c.get("shrink"), 0.0)
            weight, itself = c.kernel.slope(t), p.volume[jb, lane] * lists.visible(b, j, apart, AT_START)
            gas = p.gas_at(jb, lane)
            push = c.clipped(p.pressure[jb, lane], gas)
            if ti.static(c.pressed):
                push = push - 2.0 * c.get("background")
            along = pressure + push
            spring = c.hardness(square, firm, gas)
            if ti.static(c.two):
                along = (1.0 - gas) * pressure + gas * p.pressure[jb, lane] + push
                spring *= 1.0 + gas * p.deviation[jb, lane]
                along += (gas * (1.0 + p.deviation[jb, lane]) * c.get("air_density")) * dot(felt, apart)
            along = itself * (along * weight + spring)
            for a in ti.static(range(p.axes)):
                force[a] += along * apart[a]
            if ti.static(self.walls.tangential.acts):
                by_wall = pressure * (itself * c.kernel.value(t))
                for a in ti.static(range(p.axes)):
                    force[a] += by_wall * p.load(self.walls.tangential.correction[a], b)
        for a in ti.static(range(p.axes)):
            p.store(self.force[a], b, (volume * c.get("slope")) * force[a])
            p.store(self.weight[a], b, self.seen(b, volume) * felt[a])

    @ti.func
    def seen(self, b, volume):
        """The mass (kg/m) of what a block of wall particles sees, V_w Σ ρ_f V_f W."""
        p, c = self.particles, self.constants
        density = c.get("density") * p.ones()
        if ti.static(c.two):
            density += (1.0 - p.load(p.share, b)) * (c.get("air_density") - c.get("density"))
        return density * volume * p.load(p.eigenvalue, b)

    @ti.func
    def add(self, w, t, kick, dt):
        """Add the forces on a world's wall particles to the impulses of their edges."""
        p, during = self.particles, ti.cast(dt, self.particles.exact)
        for slot in range(p.sizes[WALLS] * p.lanes):
            edge = self.owner[slot]
            if edge != OF_NONE:
                b, other = w * p.stride + p.fluid_blocks + slot // p.lanes, self.other[slot]
                lane = slot % p.lanes
                push = [ti.cast(self.force[a][b, lane], p.exact) * during for a in ti.static(range(p.axes))]
                weight = [ti.cast(self.weight[a][b, lane], p.exact) * during for a in ti.static(range(p.axes))]
                for a in ti.static(range(p.axes)):
                    self.impulse[a][w, edge] = self.impulse[a][w, edge] + push[a]
                if other != OF_NONE:
                    for a in ti.static(range(p.axes)):
                        given = dot([self.given[slot, a, n] for n in ti.static(range(p.axes))], push)
                        given += dot([self.given[slot, a, p.axes + n] for n in ti.static(range(p.axes))], weight)
                        self.impulse[a][w, edge] = self.impulse[a][w, edge] - given
                        self.impulse[a][w, other] = self.impulse[a][w, other] + given
        self.elapsed[w] = self.elapsed[w] + during

    def read_and_reset(self) -> dict[str, np.ndarray]:
        """The mean forces (W, edges, 2) N since they were last taken; they begin anew from here."""
        worlds = self.particles.worlds
        if not self.wanted:
            return {"edge_force": np.zeros((worlds, 0, self.particles.axes))}
        impulse = np.stack([field.to_numpy() for field in self.impulse], axis=-1)[:, self.wanted]
        elapsed = self.elapsed.to_numpy()
        self.forget()
        return {"edge_force": self.thickness * impulse / np.where(elapsed > 0.0, elapsed, 1.0)[:, None, None]}


@dataclass(frozen=True, eq=False)
class Parting:
    """To which `other` edge (n,) wall particles near corners give, and what: `of_force` (n, 2, 2) of the force F on
    them, and `of_weight` (n, 2, 2) of the weight q = ρ V_w γ_w (g − a) of the water that they see, γ_w = Σ V_f W_fw."""

    other: np.ndarray
    of_force: np.ndarray
    of_weight: np.ndarray


def parting(points: np.ndarray, volumes: np.ndarray, tank: Tank, water: Water, edges: Sequence[int]) -> Parting:
    """What walls' `points` (n, 2) m, of `volumes` (n,) m², give to another edge at the corners of some `edges`.

    Where ∇p = ρ (g − a), as in water at rest, water pushes a wall particle by

        F = A_1 n_1 + A_2 n_2 − q,  A_k = V_w ∫ (p + p_w) W dS

    over the face k, n_k its outward normal (by the divergence theorem). A_1 and A_2 follow from F + q wherever n_1 and
    n_2 differ in direction. Over all wall particles behind the line of a straight face, A_k makes up ∫ p dS and
    (n_k·q), since half of each kernel is there, and half of it the more squeezed. So an edge bears, of each wall
    particle behind its line,

        N_k = b_w A_k − c_w n_k·q,

    b_w = 1 but where few wall particles are behind a line, as at a corner that points into the water: there they bear
    as much more as the line lacks (`_more`). c_w = γ(d)/γ_w for wall particles before whose foot there is a face, with
    γ(d) of a plane face at their depth d, and 0 beyond its end. What is left of F is parted into vectors along both
    faces, square to what each bears as pressure. So the parts of both make up F. Own derivation.
    """
    outline, (_, along, normal) = tank.outline, _frame(tank.outline)
    own, count = edge_of(points, outline), len(outline)
    other = beside(points, own, tank, water.reach)
    found = Parting(other, np.zeros((len(points), 2, 2)), np.zeros((len(points), 2, 2)))
    for second in {(edge + end) % count for edge in edges for end in (0, 1)}:
        pair = np.array([(second - 1) % count, second])
        at = np.flatnonzero(((own == pair[0]) & (other == pair[1])) | ((own == pair[1]) & (other == pair[0])))
        if not len(at):
            continue
        ways = along[pair] * np.array([[-1.0], [1.0]])  # away from the corner
        off = points - outline[second]
        foot, depth = off @ ways.T, off @ normal[pair].T
        behind = depth > 0.0
        bears = behind[at] * (1.0 + np.stack([_more(foot, depth, volumes, k, water) for k in (0, 1)], axis=1)[at])
        sees = _sees(off[at], tank, outline[second], water)
        weighs = (behind & (foot > 0.0))[at] * _plane(depth[at], water) / np.maximum(sees, FEW)[:, None]
        found.of_force[at], found.of_weight[at] = _given(
            along[pair], normal[pair], bears, weighs, np.equal(own[at], pair[1]).astype(int)
        )
    return found


def _frame(outline: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Lengths (m,) m of the edges of a polygon, unit vectors (m, 2) along them, and their outward normals."""
    ways = np.roll(outline, -1, axis=0) - outline
    lengths = np.linalg.norm(ways, axis=1)
    along = ways / lengths[:, None]
    return lengths, along, np.stack([along[:, 1], -along[:, 0]], axis=1)


def beside(points: np.ndarray, own: np.ndarray, tank: Tank, reach: float) -> np.ndarray:
    """The other edge (n,) that points see behind a corner near them, whose `own` edges (n,) these are; or OF_NONE."""
    outline, (lengths, along, normal) = tank.outline, _frame(tank.outline)
    other, count = np.full(len(points), OF_NONE), len(outline)
    for k, (apart, mine) in enumerate(zip(points[:, None] - outline, own, strict=True)):
        off = np.clip((apart * along).sum(axis=1), 0.0, lengths)[:, None] * along - apart
        after = (mine + 1) % count
        near = after if np.hypot(*apart[after]) < np.hypot(*apart[mine]) else (mine - 1) % count
        turns = abs(along[mine] @ normal[near]) >= np.sin(SHARP)
        if turns and near not in tank.open_edges and np.hypot(*off[near]) <= reach:
            other[k] = near
    return other


def _given(
    along: np.ndarray, normal: np.ndarray, bears: np.ndarray, weighs: np.ndarray, own: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Of points at a corner of two edges the matrices (n, 2, 2) of a `Parting`; `own` (n,) is 0 or 1, their edge.

    Of both edges unit vectors along and outwards (2, 2), and b_w and c_w of each wall particle (n, 2), 0 where it is
    not behind the edge's line.
    """
    by_force = bears[..., None] * np.linalg.inv(normal.T)  # N_k of F, and of q
    by_weight = by_force - weighs[..., None] * normal
    each, other = np.arange(len(own)), 1 - own
    slope = along[other] / (along[other] * normal[own]).sum(axis=1)[:, None]
    turned = (normal[0] @ normal[1]) * slope
    given = []
    for part, whole in ((by_force, normal[own]), (by_weight, np.zeros((len(own), 2)))):
        left = whole - part[each, own]
        given.append(
            (normal[other] - turned)[..., None] * part[each, other][:, None] + slope[..., None] * left[:, None]
        )
    return given[0], given[1]


def _more(foot: np.ndarray, depth: np.ndarray, volumes: np.ndarray, k: int, water: Water) -> np.ndarray:
    """b_w − 1 (n,): by how much more wall particles within ZONE of the end of an edge bear, to make up for what it
    lacks.

    Points of a face see half of a kernel in an unbounded wall. `foot` and `depth` (n, 2) m of wall particles are along
    both edges from the corner, and behind their lines; k is the edge.
    """
    step = water.length / FINE
    ways = (np.arange(round(water.reach / step)) + 0.5) * step
    seen, zone = depth[:, k] > 0.0, (depth[:, k] > 0.0) & (foot[:, k] > 0.0) & (foot[:, k] < ZONE * water.length)
    face = np.stack([ways, 0.0 * ways], axis=1)
    placed = np.stack([foot[:, k], depth[:, k]], axis=1)
    lack = (0.5 - covered(face, placed[seen], volumes[seen], water)).sum()
    has = covered(face, placed[zone], volumes[zone], water).sum()
    return zone * min(lack / has, MOST) if has > 0.0 else 0.0 * foot[:, k]


def _sees(off: np.ndarray, tank: Tank, corner: np.ndarray, water: Water) -> np.ndarray:
    """γ_w (n,) of wall particles `off` (n, 2) m a corner of a tank that is full of water."""
    lattice = _lattice(water, 2.0 * water.reach)
    return covered(off, lattice, np.where(tank.holds(lattice + corner), (water.length / FINE) ** 2, 0.0), water)


def _plane(depth: np.ndarray, water: Water) -> np.ndarray:
    """γ (of any shape) of wall particles at depths (m) behind a plane face; of others, 0."""
    lattice = _lattice(water, water.reach)
    wet = lattice[lattice[:, 1] > 0.0]
    known = np.linspace(0.0, water.reach, TABLE)
    share = covered(np.stack([0.0 * known, -known], axis=1), wet, np.full(len(wet), (water.length / FINE) ** 2), water)
    return np.interp(depth, known, share, right=0.0)


def _lattice(water: Water, half: float) -> np.ndarray:
    """Points (n, 2) m of a square lattice so far (m) to all sides, FINE of them over a smoothing length."""
    step = water.length / FINE
    line = (np.arange(-round(half / step), round(half / step)) + 0.5) * step
    return np.stack(np.meshgrid(line, line), axis=-1).reshape(-1, 2)
