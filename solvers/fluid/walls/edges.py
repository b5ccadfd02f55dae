"""Forces of the water on single edges of the tank, summed over the dummies behind them."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.fluid.lists import Medium
from solvers.fluid.state import DRY
from solvers.fluid.walls.behind import OF_NONE, Behind
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.fluid.walls.layers import SHARP, edge_of
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named
from solvers.tank.tank import Tank


@ti.data_oriented
class Edges:
    """The force (y, z; N) on each edge in each world, as mean since it was last taken.

    A dummy bears minus what it does to the water (`Forces`), the drag of water that sticks excepted, and belongs to the
    nearest edge. Near a corner it bears the pressure on two faces, and gives part of it to the other edge (`corner`).
    Together the edges bear the load on the tank; each without the pressure of the background.

    Limits: beside a corner that points into the water an edge lacks 0.25 to 0.35 Δx of the pressure there, since too
    few dummies stand behind it. Where the outline turns by less than SHARP, or more than 180 deg less that, each dummy
    gives all to its nearest edge.
    """

    def __init__(
        self,
        arrays: State,
        medium: Medium,
        walls: Extrapolation,
        edges: tuple[int, ...],
        behind: Behind,
        slots: np.ndarray,
        tanks: Sequence[Tank],
        number: int,
    ):
        """The `edges` of one of the `tanks`; `slots` are where the points of `behind` are among the walls."""
        tank = tanks[number]
        self.particles, self.lists, self.constants = medium.particles, medium.lists, medium.constants
        self.units, self.shares, self.walls = medium.units, medium.shares, walls
        self.wanted, self.thickness, p = list(edges), tank.thickness, medium.particles
        if edges:
            own = arrays.under("edges")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.force = own.wide(each, *named("force", p.axes), kept=False)
            size, here = p.dry * p.lanes, (behind.tanks == number) & (behind.edges != OF_NONE)
            owner, other, shares = np.full(size, OF_NONE), np.full(size, OF_NONE), np.zeros((size, 2, 2))
            at, reach = slots[here], medium.lists.bodies.reach
            owner[at], (other[at], shares[at]) = behind.edges[here], corner(behind.points[here], tank, reach)
            self.owner = own.holding("owner", owner, "slot", ti.i32)
            self.other = own.holding("other", other, "slot", ti.i32)
            self.given = own.holding("given", shares, "slot axis of", own.exact)
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
        """The forces on a unit's dummies."""
        first, end = self.shares.dry(u)
        for b in range(first, end):
            self.bear_block(u, b, self.lists.facing.first[u, b - first], self.lists.facing.first[u, b - first + 1])

    @ti.func
    def bear_block(self, u, b, begin, end):
        """The forces on a block of dummies from the entries `begin` to `end` of its list."""
        p, c, lists = self.particles, self.constants, self.lists
        origin = [p.place[a][b, 0] for a in ti.static(range(p.axes))]
        own = [p.offset(b, origin[a], a) for a in ti.static(range(p.axes))]
        pressure, volume, firm = p.load(p.pressure, b), p.load(p.volume, b), p.load(p.firm, b)
        force, felt = [p.zeros() for _ in ti.static(range(p.axes))], [p.zeros() for _ in ti.static(range(p.axes))]
        if ti.static(c.two):
            found = self.walls.felt(self.units.world(u), b)
            for a in ti.static(range(p.axes)):
                felt[a] += found[a]
        for k in range(begin, end):
            j = lists.facing.slots[u, k]
            jb, lane = lists.block_of(j), lists.lane_of(j)
            apart = lists.apart(own, origin, j)
            square = dot(apart, apart)
            t = ti.max(1.0 - ti.sqrt(square) * c.get("shrink"), 0.0)
            weight, itself = c.kernel.slope(t), p.volume[jb, lane] * lists.sees(b, j, apart, AT_START)
            gas = p.gas_at(jb, lane)
            push = c.clipped(p.pressure[jb, lane], gas)
            if ti.static(c.pressed):
                push = push - 2.0 * c.get("background")
            along = pressure + push
            spring = c.hardness(square, firm, gas)
            if ti.static(c.two):
                along = (1.0 - gas) * pressure + gas * p.pressure[jb, lane] + push
                spring *= 1.0 + gas * p.excess[jb, lane]
                along += (gas * (1.0 + p.excess[jb, lane]) * c.get("air_density")) * dot(felt, apart)
            along = itself * (along * weight + spring)
            for a in ti.static(range(p.axes)):
                force[a] += along * apart[a]
            if ti.static(self.walls.lean.acts):
                by_wall = pressure * (itself * c.kernel.value(t))
                for a in ti.static(range(p.axes)):
                    force[a] += by_wall * p.load(self.walls.lean.lean[a], b)
        for a in ti.static(range(p.axes)):
            p.store(self.force[a], b, (volume * c.get("slope")) * force[a])

    @ti.func
    def add(self, w, t, kick, dt):
        """Add the forces on a world's dummies to the impulses of their edges."""
        p, during = self.particles, ti.cast(dt, self.particles.exact)
        for slot in range(p.sizes[DRY] * p.lanes):
            edge = self.owner[slot]
            if edge != OF_NONE:
                b, other = w * p.stride + p.wet + slot // p.lanes, self.other[slot]
                push = [ti.cast(self.force[a][b, slot % p.lanes], p.exact) * during for a in ti.static(range(p.axes))]
                for a in ti.static(range(p.axes)):
                    self.impulse[a][w, edge] = self.impulse[a][w, edge] + push[a]
                if other != OF_NONE:
                    for a in ti.static(range(p.axes)):
                        given = dot([self.given[slot, a, n] for n in ti.static(range(p.axes))], push)
                        self.impulse[a][w, edge] = self.impulse[a][w, edge] - given
                        self.impulse[a][w, other] = self.impulse[a][w, other] + given
        self.elapsed[w] = self.elapsed[w] + during

    def take(self) -> dict[str, np.ndarray]:
        """The mean forces (W, edges, 2) N since they were last taken; they begin anew from here."""
        worlds = self.particles.worlds
        if not self.wanted:
            return {"edge_force": np.zeros((worlds, 0, 2))}
        impulse = np.stack([field.to_numpy() for field in self.impulse], axis=-1)[:, self.wanted]
        elapsed = self.elapsed.to_numpy()
        self.forget()
        return {"edge_force": self.thickness * impulse / np.where(elapsed > 0.0, elapsed, 1.0)[:, None, None]}


def corner(points: np.ndarray, tank: Tank, reach: float) -> tuple[np.ndarray, np.ndarray]:
    """To which other edge (n,) dummies at `points` (n, 2) m behind a tank's wall give, and shares (n, 2, 2) of a force.

    Under a pressure p that is everywhere the same, water pushes a dummy by F = A_1 n_1 + A_2 n_2, A_k = 2 p V ∫ W dS
    over the face k and n_k its outward normal (by the divergence theorem). Summed over the dummies behind the line of a
    face, A_k is p times its length, since half of each kernel is there. So of a dummy that is behind the lines of both
    faces each edge gets its part along its normal. Of one that is behind one line alone, the other face's part
    counts for neither: it is parted into vectors along both faces, square to what each bears as pressure. A_1 and A_2
    follow from F wherever n_1 and n_2 differ in direction. Own derivation. The parts of both make up F.
    """
    outline = tank.outline
    ways = np.roll(outline, -1, axis=0) - outline
    lengths, count = np.linalg.norm(ways, axis=1), len(outline)
    along = ways / lengths[:, None]
    normal = np.stack([along[:, 1], -along[:, 0]], axis=1)
    other, shares = np.full(len(points), OF_NONE), np.zeros((len(points), 2, 2))
    for k, (apart, own) in enumerate(zip(points[:, None] - outline, edge_of(points, outline), strict=True)):
        off = np.clip((apart * along).sum(axis=1), 0.0, lengths)[:, None] * along - apart
        next_one = (own + 1) % count
        at_end = np.hypot(*apart[next_one]) < np.hypot(*apart[own])
        near = next_one if at_end else (own - 1) % count
        sine = abs(along[own] @ normal[near])
        if sine < np.sin(SHARP) or near in tank.open_edges or np.hypot(*off[near]) > reach:
            continue
        other[k], shares[k] = near, _given(along[[own, near]], normal[[own, near]], apart[[own, near]])
    return other, shares


def _given(along: np.ndarray, normal: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """The matrix (2, 2) by which a dummy's force gives the second of two edges its part, see `corner`.

    Of both, rows (2, 2): unit vectors along and outwards, and how far (m) the dummy is from a corner of each.
    """
    to_parts = np.linalg.inv(normal.T)  # rows: from the force, A_1 and A_2
    own, other = (apart * normal).sum(axis=1) > 0.0
    slope = along[1] / (along[1] @ normal[0])
    given = np.outer(normal[1] if other else (normal[0] @ normal[1]) * slope, to_parts[1])
    return given if own else given + np.outer(slope, to_parts[0])
