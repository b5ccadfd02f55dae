"""Forces of the water on single edges of the tank, summed over the dummies behind them."""

import numpy as np
import taichi as ti

from solvers.fluid.lists import Medium
from solvers.fluid.state import DRY
from solvers.fluid.walls.behind import OF_NONE
from solvers.fluid.walls.extrapolation import Extrapolation
from solvers.machine.state import Axis, State
from solvers.motion.poses import AT_START
from solvers.space.axes import dot, named


@ti.data_oriented
class Edges:
    """The force (y, z; N) on each edge in each world, as mean since it was last taken.

    A dummy bears minus what it does to the water (`Forces`), the drag of water that sticks excepted, and belongs to the
    nearest edge. Together the edges bear the load on the tank; each without the pressure of the background.

    Limits: a dummy beyond a corner is as near to both edges, and counts to the first of them with all of its force.
    So a side of a box lacks 0.35 Δx of the pressure at its foot, which is in the floor's sideways force: at rest 4.7 %
    of ρ g H²/2 with 15 layers, 70 %/n with n.
    """

    def __init__(
        self,
        arrays: State,
        medium: Medium,
        walls: Extrapolation,
        edges: tuple[int, ...],
        owner: np.ndarray,
        thickness: float,
    ):
        self.particles, self.lists, self.constants = medium.particles, medium.lists, medium.constants
        self.units, self.shares, self.walls = medium.units, medium.shares, walls
        self.wanted, self.thickness, p = list(edges), thickness, medium.particles
        self.count = int(owner.max(initial=0)) + 1
        if edges:
            own = arrays.under("edges")
            each = Axis("block", p.worlds * p.stride), Axis("lane", p.lanes)
            self.force = own.wide(each, *named("force", p.axes), kept=False)
            self.owner = own.holding("owner", owner, "slot", ti.i32)
            worlds = Axis("world", p.worlds)
            self.impulse = own.reals((worlds, Axis("edge", self.count)), *named("impulse", p.axes), kind=own.exact)
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
                b = w * p.stride + p.wet + slot // p.lanes
                for a in ti.static(range(p.axes)):
                    push = ti.cast(self.force[a][b, slot % p.lanes], p.exact)
                    self.impulse[a][w, edge] = self.impulse[a][w, edge] + push * during
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
