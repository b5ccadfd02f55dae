"""The validity of Verlet lists, a displacement criterion: whether grains may have come into reach of each other, or of
a wall, that are not listed.

Neighbours in a bed that flows or is swayed go together: they near each other by a third of what one must fear who knows
the fastest grain alone. So grains are compared with those in neighbouring cells, by `Boxes` round displacements. Two
that were not in such cells are farther apart; for them, and for walls, it suffices how far each has gone. It suffices,
too, for outlines, which turn, and for bands, which would wait for each other at each look: by boxes they gain nothing.
"""

from collections.abc import Iterable

import numpy as np
import taichi as ti

from solvers.grains.lists.boxes import Boxes
from solvers.grains.lists.skin import Skin
from solvers.grains.state import GrainState
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.space.axes import dot, named
from solvers.tank.walls import Walls

NEVER = 1e30  # m, a displacement that makes the lists invalid
# Of what lists bear: with less of it left they are built anew rather than looked at again, with boxes and without
LITTLE = {True: 0.15, False: 0.4}


@ti.data_oriented
class ListValidity:
    """How far grains have gone since a unit's lists were built at `built_at` (s), and how far they may.

    `displacement` (m) bounds that of all grains; once it is above the `allowed` one (m), or where parts move the time
    is past `check_at` (s), it must be looked at closer.
    """

    def __init__(self, arrays: State, units: Units, grains: GrainState, walls: Walls, skin: Skin, boxes: Boxes | None):
        self.units, self.grains, self.walls, self.skin = units, grains, walls, skin
        self.boxes, self.boxed = boxes, boxes is not None
        self.little = LITTLE[self.boxed]
        own, place = arrays.under("lists"), (Axis("world", grains.worlds), Axis("grain", grains.room))
        self.built = own.reals(place, *named("built", grains.axes), kind=own.place)
        if grains.shaped:
            (self.built_angle,) = own.reals(place, "built_angle")
        self.displacement = own.holding("travel", np.full(units.count, NEVER), "unit", kept=True)
        self.allowed = own.holding("bound", np.zeros(units.count), "unit", kept=True)
        self.built_at = own.holding("built_at", np.zeros(units.count), "unit", own.exact, kept=True)
        if walls.moving:
            self.check_at = own.holding("due", np.zeros(units.count), "unit", own.exact, kept=True)
            self.fastest = own.holding("fastest_part", np.array([walls.fastest]), "one", own.exact)

    def expire(self, worlds: Iterable[int]) -> None:
        """Have the lists of some worlds rebuilt before the next step."""
        travel, a_world = self.displacement.to_numpy(), self.units.a_world
        for w in worlds:
            travel[w * a_world : (w + 1) * a_world] = NEVER
        self.displacement.from_numpy(travel)

    @ti.func
    def begin(self, u, t):
        """Note the places of a unit's grains, whose lists have been built at time t (s)."""
        w = self.units.world(u)
        for i in range(self.units.first(u), self.units.end(u)):
            for a in ti.static(range(self.grains.axes)):
                self.built[a][w, i] = self.grains.place[a][w, i]
            if ti.static(self.grains.shaped):
                self.built_angle[w, i] = self.grains.angle[0][w, i]
        self.displacement[u], self.built_at[u] = 0.0, t
        self.look_again(u, t, 0.0, 0.0, 0.0)

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether an unlisted contact is possible at time t (s) by bounds on what grains and parts have gone."""
        found = self.displacement[u] > self.allowed[u]
        if ti.static(self.walls.moving):
            found = found or t > self.check_at[u]
        return found

    @ti.func
    def invalid(self, u, t):
        """Whether a unit's lists must be rebuilt at time t (s); if only a bound was too large, it is updated."""
        old = False
        if self.may_be_invalid(u, t):
            old = self.displacement[u] >= 0.5 * NEVER
            if not old:
                w = self.units.world(u)
                moved, nearing, gone = self.displacement[u], 0.0 * self.displacement[u], 0.0 * self.displacement[u]
                if moved > self.allowed[u]:
                    # The running sum of speeds overestimates the displacement of shaken grains; use the actual one.
                    moved, nearing = self.moves(u)
                else:
                    nearing = self.skin.width[w] - 2.0 * (self.allowed[u] - moved)
                if ti.static(self.walls.moving):
                    gone = self.walls.moved.gone(w, self.built_at[u], t)
                old = not self.look_again(u, t, moved, nearing, gone)
        return old

    @ti.func
    def look_again(self, u, t, moved, nearing, gone):
        """Set when to look again where grains have `moved`, neared each other and parts have `gone` (m) by so much.

        Returns whether that is far enough away.
        """
        skin = self.skin.width[self.units.world(u)]
        left = ti.min(self.skin.astray * skin - moved, 0.5 * (skin - nearing))
        enough = left > self.little * 0.5 * skin
        self.displacement[u], self.allowed[u] = moved, moved + left
        if ti.static(self.walls.moving):
            left = self.skin.parts * skin - gone
            enough = enough and left > self.little * self.skin.parts * skin
            self.check_at[u] = t + ti.cast(left, self.grains.exact) / self.fastest[0]
        return enough

    @ti.func
    def moves(self, u):
        """How far (m) a unit's grains have gone at most, and by how much any two neighbours may have neared."""
        moved = ti.cast(0.0, self.grains.real)
        nearing = moved
        if ti.static(self.boxed):
            moved, nearing = self.boxes.moves(self.units.world(u), self.built, 1)
        else:
            moved = self.moved(u)
            nearing = 2.0 * moved
        return moved, nearing

    @ti.func
    def moved(self, u):
        """Largest displacement (m) of a unit's grains since its lists were built."""
        w, farthest = self.units.world(u), ti.cast(0.0, self.grains.real)
        for i in range(self.units.first(u), self.units.end(u)):
            farthest = ti.max(farthest, self.way(w, i))
        return farthest

    @ti.func
    def way(self, w, i):
        """Bound on the displacement (m) of all points of a grain since the lists were built."""
        gone = [
            ti.cast(self.grains.place[a][w, i] - self.built[a][w, i], self.grains.real)
            for a in ti.static(range(self.grains.axes))
        ]
        way = ti.sqrt(dot(gone, gone))
        if ti.static(self.grains.shaped):
            way += ti.abs(self.grains.angle[0][w, i] - self.built_angle[w, i]) * self.grains.reach[w, i]
        return way
