"""Contact forces of discs: kinematics of the listed contacts, and the forces of the scene's laws."""

from itertools import chain

import taichi as ti

from solvers.grains.laws.chosen import PAIR, WALL, ChosenLaws
from solvers.grains.lists.gathering import differences, gathered, geometry
from solvers.grains.lists.neighbours import Neighbours
from solvers.grains.lists.smooth import hand_on
from solvers.grains.state import FAR, GrainState
from solvers.machine.quantity import PLANE
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.machine.wide import minus
from solvers.space import tangent
from solvers.space.axes import dot, named, named_turns
from solvers.space.extremes import greater
from solvers.tank.load import Load
from solvers.tank.walls import Walls

# Distance between the vectors of different units, so that no two threads write to one cache line.
GIVEN_APART = 2


@ti.data_oriented
class Contacts:
    """Forces of the listed contacts on the grains, by the chosen laws.

    Tangential kinematics are in `solvers.space.tangent`. The levers of two grains reach to where their undeformed
    outlines cross, R_i − ξ R_j/(R_i + R_j) to first order. They add up to the distance of the centres, so angular
    momentum is conserved exactly. (Spandonidis 2016, eq. 4.7, takes whole radii.) At a wall the lever is R − ξ/2.
    """

    def __init__(
        self,
        arrays: State,
        units: Units,
        grains: GrainState,
        walls: Walls,
        lists: Neighbours,
        laws: ChosenLaws,
        load: Load,
    ):
        self.units, self.grains, self.walls, self.lists, self.laws = units, grains, walls, lists, laws
        self.load, self.lined = load, grains.count > grains.mobile
        self.lining = load.pieces - 1  # the piece of the fixed grains, if there are any
        # Forces (N) along the axes of a block of pairs, and torques (N m) on the first and second grains. They are
        # never read: writing them to adjacent memory is what makes the compiler vectorise the block.
        turns = (named_turns(f"turn_{grain}", grains.axes) for grain in "ij")
        names = *named("force", grains.axes), *chain(*turns)
        rows = Axis("unit", GIVEN_APART * units.count), lists.pairs.lane
        self.given = arrays.under("given").vectors(rows, *names, kept=False)

    @ti.func
    def forces(self, u, t, dt):
        """Add up the forces on the grains of a unit at time t (s)."""
        self.pair_forces(self.grains, self.lists.pairs, u, dt)
        self.wall_forces(self.grains, self.lists.contacts, u, t, dt)

    @ti.func
    def pair_forces(self, g: ti.template(), pairs: ti.template(), u, dt):
        """Forces between the grains g, a block of pairs at a time.

        The arithmetic on short vectors has no branches, so the compiler vectorises it (SIMD); pairs that do not
        touch within the kick come out with zero force and memory. Gathering and scattering of grains stays scalar.
        """
        load = self.nothing()
        turns = ti.static(range(g.turns))
        for block in range(pairs.blocks(u)):
            i, j = pairs.grain[u, block], pairs.mate[u, block]
            reach, share = pairs.reach[u, block], pairs.share[u, block]
            normal, distance, inverse, approach = geometry(g, i, j, reach, pairs.lanes)
            velocity = differences(g.now, i, j, pairs.lanes)
            spin_i = [gathered(field, i, pairs.lanes) for field in ti.static(g.spin_now)]
            spin_j = [gathered(field, j, pairs.lanes) for field in ti.static(g.spin_now)]
            lever_i = share * (reach + approach) - approach  # a gap, too, is shared, whichever grain is listed first
            lever_j = distance - lever_i
            rate = minus(dot(velocity, normal))
            surfaces = [lever_i * spin_i[k] + lever_j * spin_j[k] for k in turns]
            slip = tangent.slip(velocity, normal, surfaces)
            turned = [spin_i[k] - spin_j[k] for k in turns]
            turning = tangent.across(turned, normal)
            way = tangent.way(velocity, normal, inverse, spin_i, spin_j, dt)
            fn, ft, rolling = self.laws.forces(PAIR, pairs, u, block, approach, rate, slip, turning, way, dt)
            roll = self.laws.resisted(PAIR, pairs, u, block, approach, fn, turned, normal, rolling, dt)
            if ti.static(self.laws.cohesive):
                pull = self.laws.cohesive_force(pairs, u, block, approach, rate, dt)
                if ti.static(g.soaks):
                    pull = pull * gathered(g.dry, i, pairs.lanes) * gathered(g.dry, j, pairs.lanes)
                fn = fn - pull
            force, arm, back = tangent.force(normal, fn, ft), tangent.arm(normal, ft), [minus(roll[k]) for k in turns]
            turn_i, turn_j = tangent.torque(lever_i, arm, roll), tangent.torque(lever_j, arm, back)
            self.push_both(g, pairs, u, block, i, force, [turn_i, turn_j])
            if ti.static(self.lined):
                load += self.on_lining(g, pairs, u, i, j, force, turn_i)
        if ti.static(self.lined):
            self.load.book(u, self.lining, load, dt)

    @ti.func
    def push_both(self, g: ti.template(), pairs: ti.template(), u, block, i, force: ti.template(), turn):
        """Apply forces (N) to grains i, the reactions to their mates, and the two torques (N m) of `turn` to both."""
        if ti.static(not self.units.single and not pairs.wide):
            at = GIVEN_APART * u
            for a in ti.static(range(g.axes)):
                self.given[a][at] = force[a]
            for n in ti.static(range(g.turns)):
                self.given[g.axes + n][at], self.given[g.axes + g.turns + n][at] = turn[0][n], turn[1][n]
        # Read as a whole, before the loop: read lane by lane, Taichi ends the process where vectors are not real.
        target = pairs.target[u, block] if ti.static(not self.units.single) else i
        for k in ti.static(halves_in_turn(pairs.lanes)):
            g.push(0, i[k], [one[k] for one in ti.static(force)], [one[k] for one in ti.static(turn[0])])
            if ti.static(not self.units.single):
                g.push(0, target[k], [-one[k] for one in ti.static(force)], [one[k] for one in ti.static(turn[1])])

    @ti.func
    def on_lining(self, g: ti.template(), pairs: ti.template(), u, i, j, force: ti.template(), turn):
        """Load of a block of pairs on its fixed grains; `force` (N) and `turn` (N m) are those on grains i."""
        start = self.units.world(u) * pairs.stride
        lanes = ti.static(range(pairs.lanes))
        off, on = ti.cast(0.0, g.real), ti.cast(-1.0, g.real)
        fixed = ti.Vector([ti.select(j[k] - start >= self.units.moving(), on, off) for k in lanes])
        place = [ti.Vector([ti.cast(g.place[a][0, i[k]], g.real) for k in lanes]) for a in ti.static(range(g.axes))]
        about = tangent.moment(place, force)
        moment = [fixed * (about[k] + turn[k]) for k in ti.static(range(g.turns))]
        along = [(fixed * force[a]).sum() for a in ti.static(range(g.axes))]
        return ti.Vector(along + [moment[k].sum() for k in ti.static(range(g.turns))])

    @ti.func
    def nothing(self):
        """A zero load."""
        entries = ti.static(range(self.grains.axes + self.grains.turns))
        return ti.Vector([ti.cast(0.0, self.grains.real) for _ in entries])

    @ti.func
    def push_off(self, g: ti.template(), w, i, u, feature, force: ti.template(), torque, load: ti.template()):
        """Apply a wall's force (N) and torque (N m) to grain i, and the reaction to the wall.

        The reaction is added to `load` if the tank is a single piece; else it is noted for the wall's piece.
        """
        g.push(w, i, force, torque)
        place = [ti.cast(g.place[a][w, i], g.real) for a in ti.static(range(g.axes))]
        about = tangent.moment(place, force)
        moment = [about[k] + torque[k] for k in ti.static(range(g.turns))]
        back = ti.Vector([-one for one in ti.static(force)] + [-one for one in ti.static(moment)])
        if ti.static(self.walls.pieces == 1):
            load += back
        elif is_some(force):
            self.load.note(u, self.walls.piece(feature), back)

    @ti.func
    def book_walls(self, u, load: ti.template(), dt):
        """Book the load of a unit's wall contacts, once per step."""
        if ti.static(self.walls.pieces == 1):
            self.load.book(u, 0, load, dt)
        else:
            self.load.book_noted(u, dt)

    @ti.func
    def wall_forces(self, g: ti.template(), contacts: ti.template(), u, t, dt):
        """Forces of the walls on the grains g."""
        w, load = self.units.world(u), self.nothing()
        turns = ti.static(range(g.turns))
        shift = self.walls.shift(w, t)
        if ti.static(self.walls.smooth):
            hand_on(self.units, self.walls, g, contacts, u, shift)
        for p in range(contacts.length[u]):
            i, feature = contacts.grain[u, p][0], contacts.mate[u, p][0]
            gap, radius = self.walls.gap(feature, shift, *g.at(w, i)), g.radius[w, i]
            normal = [ti.cast(gap[1 + a], g.real) for a in ti.static(range(g.axes))]
            approach = ti.cast(-FAR, g.real)
            if gap[0] > 0.0:
                approach = ti.cast(radius - gap[0], g.real)
            overlap = greater(approach, 0.0)
            lever = radius - 0.5 * overlap
            moved = self.walls.velocity(
                feature, shift, *[g.place[a][w, i] - lever * normal[a] for a in ti.static(range(g.axes))]
            )
            velocity = [g.now[a][w, i] - moved[a] for a in ti.static(range(g.axes))]
            rate = -dot(velocity, normal)
            spin = [field[w, i] for field in ti.static(g.spin_now)]
            slip = tangent.slip(velocity, normal, [lever * spin[k] for k in turns])
            slips = [ti.Vector([slip[k]]) for k in turns]
            turned = self.walls.rate(feature, shift)
            relative = [spin[k] - turned[k] for k in turns]
            rolling = tangent.across(relative, normal)
            turning = [ti.Vector([rolling[k]]) for k in turns]
            way = self.way_on_wall(normal, spin, turned, dt)
            met = ti.Vector([approach]), ti.Vector([rate])
            fn, ft, against = self.laws.forces(WALL, contacts, u, p, *met, slips, turning, way, dt)
            spun, facing = [ti.Vector([one]) for one in relative], [ti.Vector([one]) for one in normal]
            roll = self.laws.resisted(WALL, contacts, u, p, met[0], fn, spun, facing, against, dt)
            if ti.static(self.laws.cohesive):
                pull = self.laws.cohesive_force(contacts, u, p, ti.Vector([approach]), ti.Vector([rate]), dt)
                if ti.static(g.soaks):
                    pull = pull * g.dry[w, i]
                fn = fn - pull
            shear = [ft[k][0] for k in turns]
            torque = tangent.torque(lever, tangent.arm(normal, shear), [roll[k][0] for k in turns])
            self.push_off(g, w, i, u, feature, tangent.force(normal, fn[0], shear), torque, load)
        self.book_walls(u, load, dt)

    @ti.func
    def way_on_wall(self, normal: ti.template(), spin: ti.template(), turned: ti.template(), dt):
        """How a contact with a wall has turned, as `tangent.carried` takes it, a lane wide.

        The normal of a flat wall swings with the wall alone; that of an edge or a round one also with the grain. Either
        is small in a step, and what is remembered is laid across the new normal with its size kept.
        """
        if ti.static(self.grains.axes == PLANE):
            return tangent.NO_WAY
        else:
            axes = ti.static(range(self.grains.axes))
            none = ti.Vector([0.0 * normal[0]])
            along = [ti.Vector([normal[a]]) for a in axes]
            both = [ti.Vector([spin[a] + turned[a]]) for a in axes]
            return [along, [none for _ in axes], 0.5 * dt * dot(both, along)]

    @ti.func
    def pair_press(self, g: ti.template(), pairs: ti.template(), w, i, j, u, p):
        """Place (m) of contact p of grains i and j, its elastic force (N) on i, overlap (m); memory is not changed."""
        apart = ti.Vector(g.between(w, i, j))
        overlap = ti.cast(g.radius[w, i] + g.radius[w, j] - apart.norm(), g.real)
        return self.press_along(g, pairs, w, i, u, p, overlap, apart / apart.norm())

    @ti.func
    def wall_press(self, g: ti.template(), contacts: ti.template(), w, i, feature, shift: ti.template(), u, p):
        """Place (m) of contact p of a grain with a wall, its elastic force (N) on the grain, overlap (m)."""
        gap = self.walls.gap(feature, shift, *g.at(w, i))
        overlap = ti.select(gap[0] > 0.0, ti.cast(g.radius[w, i] - gap[0], g.real), ti.cast(0.0, g.real))
        return self.press_along(g, contacts, w, i, u, p, overlap, ti.Vector([gap[1 + a] for a in range(g.axes)]))

    @ti.func
    def press_along(self, g: ti.template(), contacts: ti.template(), w, i, u, p, overlap, n):
        """Place (m), elastic force (N), then overlap (m), of contact p with the normal n towards grain i."""
        force, back = self.laws.elastic(contacts, u, p, overlap), g.radius[w, i] - 0.5 * overlap
        place = [g.place[a][w, i] - back * n[a] for a in ti.static(range(g.axes))]
        return ti.Vector(place + [force * n[a] for a in ti.static(range(g.axes))] + [overlap])

    @ti.func
    def diagnostics(self, g: ti.template(), pairs: ti.template(), contacts: ti.template(), u, t):
        """Number of touching contacts of a unit, largest overlap in radii of the smaller grain, and energy (J).

        The energy is elastic energy plus that of liquid bridges. A pair across two units counts half in each.
        """
        w, start, end = self.units.world(u), self.units.first(u), self.units.end(u)
        zero = ti.cast(0.0, g.exact)
        touching, deepest, energy = zero, zero, zero
        for p in range(pairs.length[u]):
            i, j = pairs.first_of(u, p), pairs.second_of(u, p)
            apart = g.between(w, i, j)
            overlap = ti.cast(g.radius[w, i] + g.radius[w, j] - ti.sqrt(dot(apart, apart)), g.real)
            if overlap > 0.0:
                part = ti.select(start <= j < end or j >= self.units.moving(), 1.0, 0.5)
                touching += part
                deepest = ti.max(deepest, overlap / ti.min(g.radius[w, i], g.radius[w, j]))
                energy += part * self.laws.energy(PAIR, pairs, u, p, overlap)
            if ti.static(self.laws.cohesive):
                share = ti.select(start <= j < end or j >= self.units.moving(), 1.0, 0.5)
                if ti.static(g.soaks):
                    share *= g.dry[w, i] * g.dry[w, j]
                energy += share * self.laws.bridge_energy(pairs, u, p, overlap)
        shift = self.walls.shift(w, t)
        for p in range(contacts.length[u]):
            i = contacts.first_of(u, p)
            gap = self.walls.gap(contacts.second_of(u, p), shift, *g.at(w, i))
            if 0.0 < gap[0] < g.radius[w, i]:
                overlap = ti.cast(g.radius[w, i] - gap[0], g.real)
                touching += 1.0
                deepest = ti.max(deepest, overlap / g.radius[w, i])
                energy += self.laws.energy(WALL, contacts, u, p, overlap)
            if ti.static(self.laws.cohesive):  # noqa: SIM102 (compiled only for wet grains)
                if gap[0] > 0.0:
                    approach = ti.cast(g.radius[w, i] - gap[0], g.real)
                    share = ti.cast(1.0, g.real)
                    if ti.static(g.soaks):
                        share = g.dry[w, i]
                    energy += share * self.laws.bridge_energy(contacts, u, p, approach)
        return ti.Vector([touching, deepest, energy])


def halves_in_turn(lanes: int) -> list[int]:
    """The lanes of a block, one of either half in turn.

    Pairs that follow each other in a list have grains in common, and a sum cannot go on before the last is stored: with
    others between, a step takes a tenth less.
    """
    half = -(-lanes // 2)
    return sorted(range(lanes), key=lambda lane: (lane % half, lane))


@ti.func
def is_some(force: ti.template()):
    """Whether a force, a list with one entry per axis, is not zero."""
    some = force[0] != 0.0
    for a in ti.static(range(1, len(force))):
        some = some or force[a] != 0.0
    return some
