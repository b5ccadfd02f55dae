"""Contacts of free bodies in space with the walls of their tank."""

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.quantity import SPACE
from solvers.machine.state import Axis, State
from solvers.machine.units import Units
from solvers.motion.contact_pairs import Touch
from solvers.motion.contacts import AHEAD, law_of
from solvers.motion.free import NOT_FREE
from solvers.motion.free_in_space import INVERSE, FreeBodiesInSpace
from solvers.space.axes import cross, dot, joined
from solvers.space.impact import dragged, over_the_step, pressed, stretched
from solvers.tank.load import Load
from solvers.tank.pose import AT_START, rotated
from solvers.tank.shapes import SphereShape

SPRING, TWICE_RATIO, SHEAR_SPRING, FRICTION = range(4)  # columns of the table of bodies: k, 2 ζ, k_t, μ
NORMAL, OFFSET, PIECE = 0, SPACE, SPACE + 1  # columns of the table of faces: inward normal n, n·r (m) of it, its piece
MIDDLE, RADIUS, BODY = 0, SPACE, SPACE + 1  # columns of the table of nodes: as drawn (m), m, the body
HELD, SLIPPED, TOLD = 0, SPACE, 2 * SPACE  # columns of `memory`: force of the tangential spring (N), slip (m/s)
SUM, LEVER = 0, SPACE  # columns of `sums`: of normals, and of their levers (m) about the centre of mass


@ti.data_oriented
class ContactsInSpace:
    """F_n = k ξ + γ ξ̇ ≥ 0 and Coulomb friction of the corners of bodies, or of spheres, on the faces of their tank.

    Laws, springs and the mass of a contact are those of `Contacts` in the plane, with 1/m_j = n_j·Σ n_i/m + l_j·I⁻¹ Σ
    l_i. A face is the plane through it: what a node is behind it by, it overlaps. Tangential springs do not turn, for
    faces stand still in the tank's axes.

    Limits: bodies do not touch each other, nor parts that do not float; only tanks whose outline is convex; edges of
    bodies touch nothing between their corners.
    """

    def __init__(self, arrays: State, scene, bodies: FreeBodiesInSpace, dt: float):
        self.bodies, self.pieces, self.worlds, self.exact = bodies, bodies.pieces, scene.worlds, arrays.exact
        own, parts = arrays.under("contacts"), [scene.parts[k] for k in bodies.parts]
        faces, nodes = faces_of(scene), np.concatenate([nodes_of(i, part) for i, part in enumerate(parts)])
        self.faces, self.nodes = len(faces), len(nodes)
        self.table = own.holding(
            "laws", np.array([law_of(Touch(p, None), dt) for p in parts]), "body number", own.exact
        )
        self.walls = own.holding("walls", faces, "wall number", own.exact)
        self.corners = own.holding("corners", nodes, "corner number", own.exact)
        world, each = Axis("world", self.worlds), Axis("contact", self.nodes * self.faces)  # face by face of a corner
        (self.memory,) = own.reals((world, each, Axis("number", TOLD)), "memory", kind=own.exact)
        sums = Axis("body", bodies.count), Axis("number", 2 * SPACE)
        (self.sums,) = own.reals((world, *sums), "sums", kind=own.exact, kept=False)
        self.spent, self.power = own.reals((world,), "spent", "power", kind=own.exact)
        (self.elastic,) = own.reals((world,), "elastic", kind=own.exact, kept=False)
        self.load = Load(own, Units(self.worlds, 0, 1), scene.pieces, scene.shares, axes=SPACE)
        self.phases = (Phase(self.act),)

    def forget(self) -> None:
        """Forget all contacts."""
        for field in (self.memory, self.spent, self.power):
            field.fill(0.0)
        self.load.forget()

    def account(self, time: float) -> dict[str, np.ndarray]:
        """Elastic energy (J) of the contacts of each world at `time` (s), which must be now, and their losses."""
        self.measure()
        elastic = self.elastic.to_numpy()
        given = self.spent.to_numpy() + self.power.to_numpy() * self.bodies.behind.to_numpy().max(axis=1)
        return {"contact_elastic": elastic, "contact_lost": given - elastic}

    @ti.kernel
    def measure(self):
        """Sum up the elastic energy of each world."""
        for w in range(self.worlds):
            energy = ti.cast(0.0, self.exact)
            for c in range(self.nodes):
                i = ti.cast(self.corners[c, BODY], ti.i32)
                at = self.place(w, i, c)
                for f in range(self.faces):
                    overlap, held = ti.max(self.overlap(c, f, at), 0.0), self.held(w, c, f)
                    energy += 0.5 * self.table[i, SPRING] * overlap * overlap
                    energy += 0.5 * dot(held, held) / ti.max(self.table[i, SHEAR_SPRING], 1e-300)
            self.elastic[w] = energy

    @ti.func
    def place(self, w, i, c):
        """Where (m) a corner, or the middle of a sphere, is in the tank, as a list."""
        from_centre = [self.corners[c, MIDDLE + a] for a in ti.static(range(SPACE))]
        arm = rotated(self.bodies.attitude(w, i), from_centre)
        return [self.bodies.place[a][w, i] + arm[a] for a in ti.static(range(SPACE))]

    @ti.func
    def normal(self, f):
        """The inward normal of a face, as a list."""
        return [self.walls[f, NORMAL + a] for a in ti.static(range(SPACE))]

    @ti.func
    def overlap(self, c, f, at: ti.template()):
        """By how much (m) a corner at a place is behind a face."""
        return self.corners[c, RADIUS] + self.walls[f, OFFSET] - dot(self.normal(f), at)

    @ti.func
    def held(self, w, c, f):
        """The force (N) of the tangential spring of a contact, as a list."""
        return [self.memory[w, c * self.faces + f, HELD + a] for a in ti.static(range(SPACE))]

    @ti.func
    def lever(self, w, i, c, f, at: ti.template()):
        """(r − c) × n (m) of a contact, with r on the sphere about `at`, and the centre of mass c."""
        n = self.normal(f)
        arm = [at[a] - self.corners[c, RADIUS] * n[a] - self.bodies.place[a][w, i] for a in ti.static(range(SPACE))]
        return cross(arm, n)

    @ti.func
    def act(self, w, t, kick, dt):
        """Find the contacts of a world as a step begins, and book their forces."""
        self.pieces.note(w, t, dt)
        self.load.begin(w)
        for i in range(self.bodies.count):
            for k in ti.static(range(2 * SPACE)):
                self.sums[w, i, k] = 0.0
        for c in range(self.nodes):
            i = ti.cast(self.corners[c, BODY], ti.i32)
            at = self.place(w, i, c)
            for f in range(self.faces):
                if self.overlap(c, f, at) > 0.0:
                    n, lever = self.normal(f), self.lever(w, i, c, f, at)
                    for a in ti.static(range(SPACE)):
                        self.sums[w, i, SUM + a] = self.sums[w, i, SUM + a] + n[a]
                        self.sums[w, i, LEVER + a] = self.sums[w, i, LEVER + a] + lever[a]
        for c in range(self.nodes):
            i = ti.cast(self.corners[c, BODY], ti.i32)
            at = self.place(w, i, c)
            for f in range(self.faces):
                if self.overlap(c, f, at) > 0.0 and self.bodies.loose(w, self.bodies.part_of[i]) != NOT_FREE:
                    self.push(w, i, c, f, at, ti.cast(dt, self.exact))
                else:
                    for k in ti.static(range(TOLD)):
                        self.memory[w, c * self.faces + f, k] = 0.0
        self.load.book_noted(w, ti.cast(dt, self.exact))
        self.power[w] = 0.0

    @ti.func
    def inverse_mass(self, w, i, c, f, at: ti.template()):
        """1/m_j (1/kg) of a contact."""
        n, lever = self.normal(f), self.lever(w, i, c, f, at)
        rotation, light = self.bodies.attitude(w, i), 1.0 / self.bodies.mass(i)
        swung = self.bodies.through(rotation, i, INVERSE, lever)
        alone = light + dot(lever, swung)
        even = light * dot(n, [self.sums[w, i, SUM + a] for a in ti.static(range(SPACE))])
        even += dot(swung, [self.sums[w, i, LEVER + a] for a in ti.static(range(SPACE))])
        return ti.max(even, 0.5 * alone)

    @ti.func
    def push(self, w, i, c, f, at: ti.template(), step):
        """The force of a contact."""
        n, part, inverse = self.normal(f), self.bodies.part_of[i], self.inverse_mass(w, i, c, f, at)
        touched = [at[a] - self.corners[c, RADIUS] * n[a] for a in ti.static(range(SPACE))]
        origin, speed = self.pieces.pose.origin(w, part, AT_START), self.pieces.pose.velocity(w, part, AT_START)
        arm = [touched[a] - origin[a] for a in ti.static(range(SPACE))]
        swung = cross(self.pieces.pose.rate(w, part, AT_START), arm)
        v = [speed[a] + swung[a] for a in ti.static(range(SPACE))]
        away = dot(v, n)
        slip = [v[a] - away * n[a] for a in ti.static(range(SPACE))]
        overlap, spring, shear = self.overlap(c, f, at), self.table[i, SPRING], self.table[i, SHEAR_SPRING]
        dashpot = self.table[i, TWICE_RATIO] * ti.sqrt(spring / inverse)
        pushed = pressed(spring, dashpot, overlap, 0.0 - away, step)
        over = [
            over_the_step(slip[a], self.memory[w, c * self.faces + f, SLIPPED + a], AHEAD)
            for a in ti.static(range(SPACE))
        ]
        cap = self.table[i, FRICTION] * pushed
        held = stretched(self.held(w, c, f), shear, overlap, 0.0 - away, slip, over, cap, step)
        along = dragged(held, dashpot / spring * shear, slip, cap)
        force = [pushed * n[a] + along[a] for a in ti.static(range(SPACE))]
        moment = cross(touched, force)
        for a in ti.static(range(SPACE)):
            self.memory[w, c * self.faces + f, HELD + a], self.memory[w, c * self.faces + f, SLIPPED + a] = (
                held[a],
                over[a],
            )
        load = joined(force, moment)
        self.load.note(w, self.bodies.first + part, load)
        self.load.note(w, ti.cast(self.walls[f, PIECE], ti.i32), 0.0 - load)

    @ti.func
    def book(self, w, i, velocity: ti.template(), kick):
        """Book the work on contacts of a body with these velocities in the tank in a `kick` (s), before it moves."""
        load = self.load.on_piece(w, self.bodies.first + self.bodies.part_of[i])
        power = self.bodies.about_centre(w, i, load).dot(velocity)
        self.spent[w], self.power[w] = self.spent[w] - power * kick, self.power[w] - power


def faces_of(scene) -> np.ndarray:
    """The faces of the tank of a scene (`solvers.scene.Scene`): a row of the table of faces each."""
    outline, solid = scene.tanks[0].outline, scene.solid
    way = np.roll(outline, -1, axis=0) - outline
    inwards = np.column_stack([-way[:, 1], way[:, 0]]) / np.hypot(*way.T)[:, None]
    rows = [
        [*normal, 0.0, normal @ corner]
        for k, (normal, corner) in enumerate(zip(inwards, outline, strict=True))
        if k not in scene.tanks[0].open_edges
    ]
    if not solid.periodic:
        rows += [[0.0, 0.0, -sign, -0.5 * solid.along] for sign in (-1.0, 1.0)]
    walls = [k for k in range(len(outline)) if k not in scene.tanks[0].open_edges]
    pieces = [*walls, len(outline), len(outline) + 1] if scene.faces else [0] * len(rows)
    return np.column_stack([rows, pieces[: len(rows)]])


def nodes_of(body: int, part) -> np.ndarray:
    """The corners of a part, or the middle of a sphere, from its centre of mass: a row of the table of nodes each."""
    shape, centre = part.shape, np.array(part.free.centre)
    if isinstance(shape, SphereShape):
        places, radius = shape.centroid[None], shape.radius
    else:
        ends = shape.middle + 0.5 * shape.along * np.array([-1.0, 1.0])
        places = np.concatenate([np.column_stack([shape.polygon, np.full(len(shape.polygon), x)]) for x in ends])
        radius = 0.0
    return np.column_stack([places - centre, np.full(len(places), radius), np.full(len(places), body)])
