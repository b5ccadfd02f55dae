"""Contacts of free bodies with the walls of their tank and with other bodies."""

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.motion.contact_pairs import OF_TANK, SHEAR, Shape, Touch, pairs_of, shapes_of
from solvers.motion.contact_search import N_Y, N_Z, OTHER, OVERLAP, OWNER, P_Y, P_Z, ContactSearch
from solvers.motion.free import INERTIA, MASS, NOT_FREE, FreeBodies
from solvers.space.impact import dragged, over_the_step, pressed, stretched
from solvers.tank.load import Load
from solvers.tank.pieces import RATE, V_Y, V_Z, Y, Z

AHEAD = 0.5  # of a step by which the leapfrog's velocities are predicted
SPRING, TWICE_RATIO, SHEAR_SPRING, FRICTION = range(4)  # columns of the table of pairs: k, 2 ζ, k_t, μ
OF_OWNER, OF_OTHER, ROW = range(3)  # columns of `booked`: the pieces of a pair, and its row of `sums`
# Columns of `sums`, of normals and their levers (m) about the centre of each body of a pair
SUM_Y, SUM_Z, LEVER, LEVER_BACK = range(4)
# Columns of `memory`: the force of the tangential spring (N), and the slip of the last step (m/s)
HELD_FORCE, SLIPPED = range(2)


@ti.data_oriented
class Contacts:
    """F_n = k ξ + γ ξ̇ ≥ 0 and Coulomb friction of the corners of one solid and the edges of another.

    Where they touch `ContactSearch` says. Force and velocity are those at the corner: the spring, whose energy is k
    ξ²/2, does no other work. The laws are those of grains (`solvers.space.impact`; Cundall and Strack 1979), with the
    springs of `Touch`, and γ = 2 ζ √(k m_j), γ_t = (γ/k) k_t. As m_j is that mass which a contact accelerates if all
    contacts of both bodies push alike,

        1/m_j = n_j·Σ n_i/m + l_j Σ l_i/I,

    added up for both bodies, with the levers l of the normals n about the centre (own derivation: the row of the
    contacts' inverse mass matrix J M⁻¹ Jᵀ), but at least half of n_j²/m + l_j²/I, the restitution is the same on one
    corner and on several.

    What bodies lose to contacts is counted by their own velocities, in the tank, as that which they gain from all loads
    (`FreeBodies.work`). What of it is not kept as elastic energy is lost to dashpots and friction.

    Forces are found as a step begins, before water answers to bodies, with the velocities that the last accelerations
    give (`FreeBodies.velocity_with`). Both partners get the same load about the tank's origin, with opposite signs.
    Bodies that are held, and walls, push each other by nothing.

    Limits: all partners of a body are searched at every step, by their boxes first. Thin plates are not touched. A body
    on more than two corners at once is that much stiffer, with less exact a restitution. No particle of water gets
    between faces that lie on each other: the water above presses them together, as in a seal.
    """

    def __init__(self, arrays: State, scene, bodies: FreeBodies, dt: float):
        self.bodies, self.pieces, self.worlds, self.exact = bodies, bodies.pieces, scene.worlds, arrays.exact
        shapes = shapes_of(scene.tanks, scene.parts)
        pairs = pairs_of(shapes, scene.parts)
        own = arrays.under("contacts")
        self.search = ContactSearch(own, self.pieces, self.worlds, shapes, [(one, other) for one, other, _ in pairs])
        self.count, self.pairs = self.search.count, len(pairs)
        laws = [law_of(touch, dt) for _, _, touch in pairs]
        self.table = own.holding("pairs", np.array(laws), "pair number", own.exact)
        self.booked = own.holding("booked", np.array(_booked(pairs, bodies.first)), "pair number", ti.i32)
        world = Axis("world", self.worlds)
        memory, sums = (Axis("contact", self.count), Axis("number", 2)), (Axis("pair", self.pairs), Axis("number", 4))
        (self.memory,) = own.reals((world, *memory), "memory", kind=own.exact)
        (self.sums,) = own.reals((world, *sums), "sums", kind=own.exact, kept=False)
        # J, the work of all parts on their contacts up to the last kick; W, in it
        self.spent, self.power = own.reals((world,), "spent", "power", kind=own.exact)
        (self.elastic,) = own.reals((world,), "elastic", kind=own.exact, kept=False)  # J, when last asked for
        self.load = Load(own, Units(self.worlds, 0, 1), scene.pieces, scene.shares)
        self.phases = (Phase(self.act),)

    def forget(self) -> None:
        """Forget all contacts."""
        for field in (self.memory, self.spent, self.power):
            field.fill(0.0)
        self.load.forget()

    def account(self, time: float) -> dict[str, np.ndarray]:
        """Elastic energy (J) of the contacts of each world at `time` (s), which must be now, and their losses."""
        self.measure(time)
        elastic = self.elastic.to_numpy()
        given = self.spent.to_numpy() + self.power.to_numpy() * self.bodies.behind.to_numpy().max(axis=1)
        return {"contact_elastic": elastic, "contact_lost": given - elastic}

    @ti.kernel
    def measure(self, time: ti.f64):
        """Sum up the elastic energy of each world."""
        for w in range(self.worlds):
            self.pieces.note(w, time, 0.0)
            energy = ti.cast(0.0, self.exact)
            for c in range(self.count):
                self.search.find(w, c)
                pair, overlap = self.search.pair(c), self.search.found[w, c, OVERLAP]
                held = self.memory[w, c, HELD_FORCE]
                energy += 0.5 * self.table[pair, SPRING] * overlap * overlap
                if held != 0.0:
                    energy += 0.5 * held * held / self.table[pair, SHEAR_SPRING]
            self.elastic[w] = energy

    @ti.func
    def act(self, w, t, kick, dt):
        """Find the contacts of a world as a step begins, and book their forces."""
        self.pieces.note(w, t, dt)
        self.load.begin(w)
        for row in range(self.pairs):
            for k in ti.static(range(4)):
                self.sums[w, row, k] = 0.0
        for c in range(self.count):
            self.search.find(w, c)
            if self.search.found[w, c, OVERLAP] > 0.0:
                self.add(w, c)
        for c in range(self.count):
            if self.search.found[w, c, OVERLAP] > 0.0:
                self.push(w, c, ti.cast(dt, self.exact))
            else:
                self.memory[w, c, HELD_FORCE], self.memory[w, c, SLIPPED] = 0.0, 0.0
        self.load.book_noted(w, ti.cast(dt, self.exact))
        self.begin_account(w, ti.cast(kick, self.exact))

    @ti.func
    def inverse_masses(self, w, part):
        """1/m and 1/I of a part, zero unless it moves freely, and the centre (m) about which it does."""
        found = ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(4))])
        if part >= 0:
            i = self.bodies.loose(w, part)
            if i != NOT_FREE:
                found[0], found[1] = 1.0 / self.bodies.table[i, MASS], 1.0 / self.bodies.table[i, INERTIA]
                found[2], found[3] = self.bodies.place[0][w, i], self.bodies.place[1][w, i]
        return found

    @ti.func
    def arms(self, w, c, pair):
        """Normal, and its levers about the centres of both partners, with the sign that all contacts of these share."""
        found, of = ti.static(self.search.found, self.search.places)
        owner, other = of[pair, OWNER], of[pair, OTHER]
        sign = 1.0 if owner < other else -1.0
        n_y, n_z, p_y, p_z = sign * found[w, c, N_Y], sign * found[w, c, N_Z], found[w, c, P_Y], found[w, c, P_Z]
        one, two = self.inverse_masses(w, ti.min(owner, other)), self.inverse_masses(w, ti.max(owner, other))
        lever = (p_y - one[2]) * n_z - (p_z - one[3]) * n_y
        back = (p_y - two[2]) * n_z - (p_z - two[3]) * n_y
        return ti.Vector([n_y, n_z, lever, back, one[0] + two[0], one[1], two[1]])

    @ti.func
    def add(self, w, c):
        """Add a contact to the sums of its pair of bodies."""
        pair = self.search.pair(c)
        row, arms = self.booked[pair, ROW], self.arms(w, c, pair)
        for k in ti.static(range(4)):
            self.sums[w, row, k] = self.sums[w, row, k] + arms[k]

    @ti.func
    def inverse_mass(self, w, c, pair):
        """1/m_j (1/kg) of a contact; zero if nothing that touches here moves freely."""
        row, arms = self.booked[pair, ROW], self.arms(w, c, pair)
        alone = arms[4] + arms[5] * arms[2] * arms[2] + arms[6] * arms[3] * arms[3]
        even = arms[4] * (arms[0] * self.sums[w, row, SUM_Y] + arms[1] * self.sums[w, row, SUM_Z])
        even += arms[5] * arms[2] * self.sums[w, row, LEVER] + arms[6] * arms[3] * self.sums[w, row, LEVER_BACK]
        return ti.max(even, 0.5 * alone)

    @ti.func
    def velocity(self, w, part, y, z):
        """Velocity (m/s) of a point of a part in the tank."""
        pose = self.search.pose(w, part)
        v_y, v_z, rate = pose[V_Y], pose[V_Z], pose[RATE]
        return ti.Vector([v_y - rate * (z - pose[Z]), v_z + rate * (y - pose[Y])])

    @ti.func
    def push(self, w, c, step):
        """The force of a contact."""
        pair = self.search.pair(c)
        inverse = self.inverse_mass(w, c, pair)
        if inverse > 0.0:
            found, of = ti.static(self.search.found, self.search.places)
            n_y, n_z, y, z = found[w, c, N_Y], found[w, c, N_Z], found[w, c, P_Y], found[w, c, P_Z]
            v = self.velocity(w, of[pair, OWNER], y, z) - self.velocity(w, of[pair, OTHER], y, z)
            overlap, rate, slip = found[w, c, OVERLAP], -(v[0] * n_y + v[1] * n_z), v[1] * n_y - v[0] * n_z
            spring, shear = self.table[pair, SPRING], self.table[pair, SHEAR_SPRING]
            dashpot, before = self.table[pair, TWICE_RATIO] * ti.sqrt(spring / inverse), self.memory[w, c, HELD_FORCE]
            pushed = pressed(spring, dashpot, overlap, rate, step)
            over, cap = over_the_step(slip, self.memory[w, c, SLIPPED], AHEAD), self.table[pair, FRICTION] * pushed
            held = stretched([before], shear, overlap, rate, [slip], [over], cap, step)
            along = dragged(held, dashpot / spring * shear, [slip], cap)[0]
            self.memory[w, c, HELD_FORCE], self.memory[w, c, SLIPPED] = held[0], over
            f_y, f_z = pushed * n_y - along * n_z, pushed * n_z + along * n_y
            self.load.note(w, self.booked[pair, OF_OWNER], ti.Vector([f_y, f_z, y * f_z - z * f_y]))
            self.load.note(w, self.booked[pair, OF_OTHER], ti.Vector([-f_y, -f_z, z * f_y - y * f_z]))

    @ti.func
    def begin_account(self, w, kick):
        """Book the work of the parts that do not move freely on the contacts of a world."""
        self.power[w] = 0.0
        for k in range(self.pieces.count):
            if self.bodies.loose(w, k) == NOT_FREE:
                pose, load = self.search.pose(w, k), self.load.on_piece(w, self.bodies.first + k)
                v = self.velocity(w, k, 0.0, 0.0)
                self.spend(w, load[0] * v[0] + load[1] * v[1] + load[2] * pose[RATE], kick)

    @ti.func
    def book(self, w, i, velocity: ti.template(), kick):
        """Book the work on contacts of a body with these velocities in the tank in a `kick` (s), before it moves."""
        load = self.load.on_piece(w, self.bodies.first + self.bodies.part_of[i])
        self.spend(w, self.bodies.about_centre(w, i, load).dot(velocity), kick)

    @ti.func
    def spend(self, w, power, kick):
        """Book what a part gains from the contacts of a world."""
        self.spent[w], self.power[w] = self.spent[w] - power * kick, self.power[w] - power


def law_of(touch: Touch, dt: float) -> list[float]:
    """A row of the table of pairs, at steps of dt (s)."""
    spring = touch.spring(dt)
    return [spring, 2.0 * touch.damping_ratio, SHEAR * spring, touch.friction]


def _booked(pairs: list[tuple[Shape, Shape, Touch]], first: int) -> list[list[int]]:
    """A row of `booked` for each pair; the parts' pieces begin with the `first`."""
    known: dict[frozenset[int], int] = {}
    found = []
    for *both, _ in pairs:
        pieces = [shape.tank if shape.part == OF_TANK else first + shape.part for shape in both]
        found.append([*pieces, known.setdefault(frozenset(pieces), len(known))])
    return found
