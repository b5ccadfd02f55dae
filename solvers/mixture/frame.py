"""Where the grains of a mixture are: in the axes of the tank of the water, or in those of a hull that floats in it."""

import numpy as np
import taichi as ti

from solvers.fluid.bodies.hulls import Hulls
from solvers.fluid.bodies.solids import rooms_of
from solvers.grains.state import GrainState
from solvers.machine.errors import Unavailable
from solvers.machine.state import Axis, State
from solvers.motion.on_body import OnBody
from solvers.space.axes import named
from solvers.tank.pieces import COSINE, RATE, SINE, V_Y, V_Z, Pieces, Y, Z


class InTank:
    """Grains that are told in the axes of the water's tank."""

    aboard = False

    def __init__(self, grains: GrainState):
        self.grains, self.place = grains, grains.place
        self.axes, self.worlds, self.units = grains.axes, grains.worlds, grains.units
        self.count, self.room = grains.count, grains.room
        self.may_leave, self.present = grains.may_leave, grains.present if grains.may_leave else None


@ti.data_oriented
class OnHull:
    """Grains in a room of a hull, in the axes of the tank in which she floats: r = O + R(θ) r', at t_n.

    t_n is when a step of the water begins. In the axes of the tank water pushes a grain and drags it, with the velocity
    V + ω × R r' + R v' that it has there. The force goes back into the hull's axes by the turn that she has in each
    step of the grains, as their weight does (`OnBody`). So what the grains gain over the earth the water loses, to
    rounding, and nothing of it is booked on the hull: the exchange has no wall in it. Grains push her by their
    contacts.

    A particle of water and a grain meet with the share χ + (1 − χ) T: χ says whether the water is in the grains' room,
    T whether the line between both leads through an opening (`Hulls`), as that of two particles of water does.

    `place` (W, n) m are the grains' places in the tank. The room holds the grains back in its openings, too, as a
    grating does.
    """

    aboard = True

    def __init__(self, arrays: State, scene, grains: GrainState, hold: OnBody, hulls: Hulls, pieces: Pieces):
        self.grains, self.hold, self.hulls, self.pieces = grains, hold, hulls, pieces
        self.part, self.room = hold.bodies.parts[hold.body], room_of(scene)
        self.axes, self.worlds, self.units = grains.axes, grains.worlds, grains.units
        self.count, self.room = grains.count, grains.room
        self.may_leave, self.where = False, arrays.place  # the tank aboard is closed
        own, each = arrays.under("mixture"), (Axis("world", grains.worlds), Axis("place", grains.room))
        self.place = own.reals(each, *named("carried", grains.axes), kind=own.place, kept=False)

    @ti.func
    def note(self, w, t, kick, dt):
        """Note where the grains of a world are in the tank as a step of the water begins, and what is open then."""
        if ti.static(self.hulls.openings > 0):
            self.hulls.note(w, t)
        self.hold.note_held(w)
        pose, k = ti.static(self.pieces.poses, self.part)
        cos, sin, o_y, o_z = pose[w, k, COSINE], pose[w, k, SINE], pose[w, k, Y], pose[w, k, Z]
        for i in range(self.units.all()):
            y = ti.cast(self.grains.place[0][w, i], self.hold.exact)
            z = ti.cast(self.grains.place[1][w, i], self.hold.exact)
            self.place[0][w, i] = ti.cast(o_y + cos * y - sin * z, self.where)
            self.place[1][w, i] = ti.cast(o_z + sin * y + cos * z, self.where)

    @ti.func
    def now(self, w, i):
        """The velocity (m/s) of a grain in the tank as the step begins."""
        pose, k = ti.static(self.pieces.poses, self.part)
        g = self.grains
        cos, sin, rate = pose[w, k, COSINE], pose[w, k, SINE], pose[w, k, RATE]
        arm_y, arm_z = self.place[0][w, i] - pose[w, k, Y], self.place[1][w, i] - pose[w, k, Z]
        v_y, v_z = g.now[0][w, i], g.now[1][w, i]
        u_y = pose[w, k, V_Y] - rate * arm_z + cos * v_y - sin * v_z
        u_z = pose[w, k, V_Z] + rate * arm_y + sin * v_y + cos * v_z
        return [ti.cast(u_y, g.real), ti.cast(u_z, g.real)]

    @ti.func
    def share(self, w, b, place: ti.template(), apart: ti.template()):
        """With which share a grain at a `place` (m) meets each particle of a block b, which is `apart` (m) from it."""
        p = self.hulls.particles
        share = p.load(self.hulls.within[self.room], b)
        if ti.static(self.hulls.openings > 0):
            hidden = 1.0 - share
            if hidden.sum() > 0.0:
                for n in ti.static(range(self.hulls.openings)):
                    hidden *= 1.0 - self.hulls.through(n, w, place, apart, p.zeros(), p.ones())
                share = 1.0 - hidden
        return share

    @ti.func
    def share_of_one(self, w, b, lane, place: ti.template(), apart: ti.template()):
        """As `share`, of the particle in one lane."""
        p = self.hulls.particles
        share = self.hulls.within[self.room][b, lane]
        if ti.static(self.hulls.openings > 0):
            hidden = 1.0 - share
            if hidden > 0.0:
                for n in ti.static(range(self.hulls.openings)):
                    hidden *= 1.0 - self.hulls.through(n, w, place, apart, ti.cast(0.0, p.real), ti.cast(1.0, p.real))
                share = 1.0 - hidden
        return share


def room_of(scene) -> int:
    """Which of all rooms, from 0 on, the grains of a scene (`solvers.scene.Scene`) are in. Raises Unavailable."""
    tank, held = scene.tanks[scene.hold], [one for one in scene.tanks if one.aboard is not None]
    if len(scene.grains.fixed):
        raise Unavailable("grains that get wet in a hull lie on smooth walls: take out the fixed grains")
    if len(held) > 1:
        raise Unavailable("grains that get wet in a hull are all in one of her rooms: take out the other tanks aboard")
    for number, corners in rooms_of(scene.parts, tank.aboard):
        if corners.shape == tank.outline.shape and np.allclose(corners, tank.outline):
            return number - 1
    raise Unavailable("grains that get wet in a hull are in a room of hers: let the tank aboard have a room's corners")
