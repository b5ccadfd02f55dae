"""How parts move: the move of one along an axis, as a motion, and what carries each of them."""

from dataclasses import dataclass

import taichi as ti

from solvers.machine.quantity import PLANE
from solvers.machine.state import State
from solvers.motion.contacts import Contacts
from solvers.motion.contacts_in_space import ContactsInSpace
from solvers.motion.free import FreeBodies
from solvers.motion.free_in_space import FreeBodiesInSpace
from solvers.motion.on_body import OnBody, check_aboard
from solvers.motion.prescribed import Prescribed
from solvers.tank.parts import Part, travel
from solvers.tank.pieces import Pieces
from solvers.tank.pieces_in_space import PiecesInSpace


@ti.func
def moved(table: ti.template(), w, first, t):
    """Displacement, velocity and acceleration at time t: those of `travel`, times the way in the first column."""
    way = table[w, first]
    ramp, total, rate = table[w, first + 2], table[w, first + 3], table[w, first + 4]
    done = travel(table, w, first + 1, t)
    passed, gain = t - table[w, first + 1], ti.zero(t)
    if 0.0 < passed < ramp:
        gain = rate / ramp
    if total - ramp < passed < total:
        gain = -rate / ramp
    return ti.Vector([way * done[0], way * done[1], way * gain])


@dataclass(frozen=True)
class Moved:
    """The move of a `part` along its `axis`, 0 for y and 1 for z."""

    part: Part
    axis: int

    state = staticmethod(moved)

    @property
    def coordinate(self) -> str:
        """The coordinate that moves."""
        return "yz"[self.axis]

    def parameters(self, soft_start: float) -> list[float]:
        """The kernel's table: the way (m), then start, time to speed up, time under way (s) and top rate (1/s)."""
        return [self.part.move[self.axis], *self.part.parameters()[:4]]


def motions_of(part: Part) -> tuple:
    """All motions of a part: its move along each axis, then the others that a body has."""
    moves = tuple(Moved(part, axis) for axis in range(2) if part.move[axis])
    return (*moves, *part.motions)


def make_pieces(arrays: State, scene, carrier, dt: float) -> Pieces:
    """The parts of a `solvers.scene.Scene` as pieces, in tanks that a carrier moves in steps of dt (s).

    Only one that is driven has a carrier of its own; those that are free have `FreeBodies`.
    """
    moves = [[motions_of(part)] * scene.worlds for part in scene.parts]
    carriers = [
        Prescribed(arrays.under(f"parts.{k}"), each, 0.0, 0.0) if each[0] else None for k, each in enumerate(moves)
    ]
    kind = PiecesInSpace if scene.axes > PLANE and scene.fluid else Pieces  # spheres meet parts of the plane, drawn out
    pieces = kind(arrays, scene.parts, carriers, scene.worlds)
    pieces.join(make_bodies(arrays, pieces, carrier, scene, dt))
    return pieces


def make_bodies(arrays: State, pieces: Pieces, carrier, scene, dt: float) -> FreeBodies:
    """The free bodies among the pieces of a scene (`solvers.scene.Scene`) with steps of dt (s), and their contacts.

    Raises Unavailable.
    """
    check_aboard(scene)
    every = scene.fluid.substeps if scene.fluid else 1
    kinds = (FreeBodies, Contacts) if pieces.axes == PLANE else (FreeBodiesInSpace, ContactsInSpace)
    bodies = kinds[0](arrays, pieces, carrier, scene.wall_pieces, every)
    if bodies.count:
        bodies.join(kinds[1](arrays, scene, bodies, every * dt))
    if scene.hold:
        bodies.take_aboard(OnBody(arrays, scene, bodies, carrier))
    return bodies
