"""Neighbour lists: Verlet lists with a skin, built from candidates, that carry the contact history.

A unit lists its pairs in the order of their first grains, so its forces are summed in one order on any number of
threads. A pair within a unit is listed once, i < j (half-list); a pair across two units is listed in both.
"""

from collections.abc import Iterable

import numpy as np
import taichi as ti

from solvers.grains.laws.chosen import PAIR, WALL, ChosenLaws
from solvers.grains.lists.boxes import Boxes
from solvers.grains.lists.candidates import BESIDE, Candidates
from solvers.grains.lists.contact_list import ContactList
from solvers.grains.lists.skin import Skin
from solvers.grains.lists.validity import NEVER, ListValidity
from solvers.grains.state import GrainState
from solvers.machine.quantity import PLANE, SPACE
from solvers.machine.state import State
from solvers.machine.units import Units
from solvers.space.axes import dot
from solvers.space.cells import Cells
from solvers.tank.walls import Walls

LANES = 8  # pairs a pass of the force loop: two AVX2 registers of 64-bit numbers, a fifth faster than one
# Initial capacity of a unit's lists of pairs and of wall contacts: (contacts per grain, and more), in the plane and in
# space. A unit of a single grain lists all of its neighbours (full list).
ROOM = {
    PLANE: {False: ((4, 16), (2, 16)), True: ((0, 12), (0, 4))},
    SPACE: {False: ((6, 24), (1, 96)), True: ((0, 24), (0, 6))},
}
# Pairs of a unit with others, in columns or layers of its surface, by the share of its grains that lie there
ACROSS = {PLANE: (8, 1.0 / 2.0), SPACE: (12, 2.0 / 3.0)}


@ti.data_oriented
class Neighbours:
    """The two contact lists of every unit, and when they are rebuilt.

    Pairs are listed that may touch before the next rebuild, when two have neared each other by the `skin`
    (`ListValidity`).
    """

    lanes = LANES
    pair_fleeting, wall_fleeting = (), ()  # memories of contacts that last until the next rebuild

    def __init__(
        self,
        arrays: State,
        units: Units,
        grains: GrainState,
        walls: Walls,
        reach: float,
        skin: Skin,
        laws: ChosenLaws,
        modulus: np.ndarray,
        room: int,
        rule=None,
    ):
        self.units, self.grains, self.walls, self.skin, self.laws = units, grains, walls, skin, laws
        (pairs, more_pairs), (contacts, more_contacts) = ROOM[grains.axes][units.single]
        times, power = ACROSS[grains.axes]
        across = 0 if units.whole or units.single else times * int(units.room**power)  # pairs with other units
        lanes = 1 if units.single else laws.wide or self.lanes
        pairs, contacts = pairs * units.size + across + more_pairs, contacts * units.size + more_contacts
        more_pairs, more_contacts = (rule.pair_memory, rule.wall_memory) if rule else ((), ())
        fleeting, more_fleeting = self.pair_fleeting, self.wall_fleeting
        of_all, of_walls = 2 * (grains.worlds * grains.stride,), (grains.stride, walls.features)
        self.pairs = ContactList(
            arrays.under("pairs"), units, room * pairs, lanes, grains.stride, laws, of_all, more_pairs, fleeting
        )
        self.contacts = ContactList(
            arrays.under("contacts"), units, room * contacts, 1, 0, laws, of_walls, more_contacts, more_fleeting
        )
        own = arrays.under("lists")
        self.modulus = own.holding("modulus", 4.0 / 3.0 * modulus, "world row")  # k = (4/3) E* √R_eff of each interface
        self.walled = not units.single and not walls.moving  # whether candidates know the walls
        bounds = walls.bounds_of_grains
        self.cells = Cells(arrays, grains, *bounds, 2.0 * reach + skin.farthest, grains.periodic)
        boxes = Boxes(arrays, grains, self.cells) if skin.together else None
        self.sorted = units.single and walls.smooth  # whether features are looked for here by cells
        self.nearby = walls.nearby(own, reach + max(BESIDE * skin.farthest, skin.most_beside)) if walls.smooth else None
        if not units.single:
            self.candidates = Candidates(
                arrays, units, grains, walls, skin.farthest, room, across, boxes, reach, self.nearby
            )
        self.validity = ListValidity(arrays, units, grains, walls, skin, boxes)

    def forget(self) -> None:
        """Empty the lists with all contact history, after grains were placed somewhere else."""
        self.pairs.forget()
        self.contacts.forget()
        self.expire()

    def expire(self, worlds: Iterable[int] | None = None) -> None:
        """Have the lists of some worlds, or of all, rebuilt before the next step.

        Others keep theirs: when lists are built decides on how long steps are, and on how sums are rounded.
        """
        worlds = range(self.units.worlds) if worlds is None else worlds
        self.validity.expire(worlds)
        if not self.units.single:
            self.candidates.forget(worlds)

    @ti.func
    def sort(self, w):
        """Sort a world's grains into cells, where candidates must be sought anew before its lists are rebuilt."""
        anew = True
        self.skin.adapt(w)
        if ti.static(not self.units.single):
            anew = self.candidates.renew(w, self.skin.apart(w))
        elif ti.static(self.grains.periodic):
            for i in range(self.units.moving()):
                self.grains.fold(w, i)
        if anew:
            self.cells.sort_world(w)

    @ti.func
    def may_be_invalid(self, u, t):
        """Whether an unlisted contact is possible at time t (s) by bounds on what grains and parts have gone."""
        return self.validity.may_be_invalid(u, t)

    @ti.func
    def invalid(self, u, t):
        """Whether a unit's lists must be rebuilt at time t (s)."""
        return self.validity.invalid(u, t)

    @ti.func
    def list_pairs(self, g: ti.template(), c: ti.template(), u, dt) -> ti.i32:
        """List the pairs of a unit; returns their number, also if it exceeds the capacity."""
        w, ghost, found = self.units.world(u), self.units.ghost(u), 0
        start, end = self.units.first(u), self.units.end(u)
        for i in range(start, end):
            self.pairs.first[u, i - start] = found
            if ti.static(self.units.single):
                lower, upper = c.box(w, i)
                for n in range(c.rows(lower, upper)):
                    row = c.row(lower, upper, n)
                    for k in range(c.first[w, row + lower[0]], c.first[w, row + upper[0] + 1]):
                        j = c.sorted[w, k]
                        if j != i and self.near(g, w, i, j):
                            found = self.list_pair(g, u, found, i, j, ghost, dt)
            else:
                for k in range(self.candidates.first[u, i - start], self.candidates.first[u, i - start + 1]):
                    j = self.candidates.mate[u, k]
                    if self.near(g, w, i, j):
                        found = self.list_pair(g, u, found, i, j, j if start <= j < end else ghost, dt)
        for k in range(end - start, self.units.size + 1):
            self.pairs.first[u, k] = found
        return found

    @ti.func
    def near(self, g: ti.template(), w, i, j):
        """Whether two grains are near enough to be listed."""
        apart = g.between(w, i, j)
        far = g.reach[w, i] + self.skin.margin(w) + g.reach[w, j]
        return dot(apart, apart) < far * far

    @ti.func
    def list_pair(self, g: ti.template(), u, found, i, j, target, dt):
        """List the contact of two neighbouring grains; returns the new number of contacts."""
        if found < self.pairs.capacity:
            self.write_pair(g, u, found, i, j, target, True, dt)
        return found + 1

    @ti.func
    def write_pair(self, g: ti.template(), u, p, i, j, target, recalled: ti.template(), dt):
        """Write contact p of grains i and j, with its old memory if `recalled`."""
        w = self.units.world(u)
        radius, touch = g.radius[w, i], g.radius[w, i] + g.radius[w, j]
        effective = radius * g.radius[w, j] / touch
        mass = 1.0 / (g.inverse_mass[w, i] + g.inverse_mass[w, j])
        row = self.laws.pair_row(g, w, i, j)
        stiffness = self.modulus[w, row] * ti.sqrt(effective)
        if ti.static(recalled):
            self.pairs.add(u, p, i, j, target, row, stiffness, touch, radius / touch)
        else:
            self.pairs.add_new(u, p, i, j, target, row, stiffness, touch, radius / touch)
        self.laws.prepare(PAIR, self.pairs, u, p // self.pairs.lanes, p % self.pairs.lanes, mass, effective, dt)

    @ti.func
    def list_contacts(self, u, t, dt) -> ti.i32:
        """List the contacts of grains near walls; returns their number, also if it exceeds the capacity."""
        w, start, end, found = self.units.world(u), self.units.first(u), self.units.end(u), 0
        shift = self.walls.shift(w, t)
        for i in range(start, end):
            self.contacts.first[u, i - start] = found
            reach, begin, last = self.grains.reach[w, i] + self.skin.beside(w), 0, self.walls.features
            if ti.static(self.walled):
                begin, last = self.candidates.wall_first[u, i - start], self.candidates.wall_first[u, i - start + 1]
            elif ti.static(self.sorted):
                cell = self.nearby.cell(*self.grains.at(w, i))
                begin, last = self.nearby.first[cell], self.nearby.first[cell + 1]
            for k in range(begin, last):
                feature = k
                if ti.static(self.walled):
                    feature = self.candidates.feature[u, k]
                elif ti.static(self.sorted):
                    feature = self.nearby.listed[k]
                # A contact may begin when a grain slides past a segment's end, so grains beyond it are listed too.
                if self.walls.near(feature, shift, reach, *self.grains.at(w, i)):
                    found = self.list_contact(self.grains, u, found, i, feature, shift, dt)
        for k in range(end - start, self.units.size + 1):
            self.contacts.first[u, k] = found
        return found

    @ti.func
    def list_contact(self, g: ti.template(), u, found, i, feature, shift: ti.template(), dt):
        """List the contact of a grain with a nearby wall; returns the new number of contacts."""
        if found < self.contacts.capacity:
            self.write_contact(g, u, found, i, feature, True, dt)
        return found + 1

    @ti.func
    def write_contact(self, g: ti.template(), u, p, i, feature, recalled: ti.template(), dt):
        """Write contact p of grain i with a wall, with its old memory if `recalled`."""
        w = self.units.world(u)
        radius, mass = g.radius[w, i], 1.0 / g.inverse_mass[w, i]
        row = self.laws.wall_row(g, w, i)
        stiffness = self.modulus[w, row] * ti.sqrt(radius)
        if ti.static(recalled):
            self.contacts.add(u, p, i, feature, feature, row, stiffness, radius, 1.0)
        else:
            self.contacts.add_new(u, p, i, feature, feature, row, stiffness, radius, 1.0)
        self.laws.prepare(WALL, self.contacts, u, p, 0, mass, radius, dt)

    @ti.func
    def asked(self, u):
        """Whether some contacts of a unit must be searched for again although its lists are valid."""
        return False

    @ti.func
    def rebuild(self, u, t, dt, whole):
        """Rebuild a unit's lists at time t (s) after the cell sort, or with `whole` false only contacts asked for.

        Returns False, with the old lists in place, if the contacts exceed the capacity.
        """
        fits = True
        if whole:
            fits = self.list_all(u, t, dt)
        if fits:
            fits = self.seek(u, t, whole)
        return fits

    @ti.func
    def seek(self, u, t, whole):
        """Nothing to seek for discs: each listed pair has exactly one contact."""
        return True

    @ti.func
    def list_all(self, u, t, dt):
        """Rebuild both neighbour lists; returns False, with the old lists in place, if they do not fit."""
        known = True
        if ti.static(not self.units.single):
            known = self.candidates.found(self.grains, self.cells, u, t)
        self.pairs.set_aside(u)
        self.contacts.set_aside(u)
        pairs, contacts = 0, 0
        if known:
            pairs, contacts = self.list_pairs(self.grains, self.cells, u, dt), self.list_contacts(u, t, dt)
        fits = known and pairs <= self.pairs.capacity and contacts <= self.contacts.capacity
        if fits:
            self.pairs.length[u], self.contacts.length[u] = pairs, contacts
            self.pairs.pad(u)
            self.validity.begin(u, t)
        else:
            self.put_back(u)
        return fits

    @ti.func
    def put_back(self, u):
        """Undo `list_all` after it exceeded the capacity; the lists will be rebuilt with more room.

        The laws' constants are lost, but no force is computed before the rebuild.
        """
        self.pairs.put_back(u)
        self.contacts.put_back(u)
        self.validity.displacement[u] = NEVER
