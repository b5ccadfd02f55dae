"""Openings through which the air of a tank comes and goes."""

import taichi as ti

from solvers.fluid.given import Air
from solvers.fluid.lists.context import FluidContext
from solvers.fluid.state import UNUSED
from solvers.machine.state import Axis, State

MOST = 0.5  # of what would even the pressures out, in a step


@ti.data_oriented
class OutflowVent:
    """dM/dt = −C_d A √(2 ρ |p|) sgn p, C_d = 0.6: flow through openings of an area A (Bernoulli; Torricelli's law).

    M is the mass of the air, p its mean pressure over that outside, ρ its mean density. All particles of air share in
    it alike, so that an opening has no place and makes no draught.

    Limits: slow flow, Mach 0.3; water does not come out. Units: M kg/m, A m² a metre of thickness, p Pa.
    """

    def __init__(self, arrays: State, context: FluidContext, air: Air | None):
        self.units, self.particles, self.ranges = context.units, context.particles, context.ranges
        self.constants, self.acts = context.constants, air is not None and air.vent > 0.0
        if self.acts:
            own = arrays.under("water.vent")
            sums = "pressed", "room", "mass"
            self.pressed, self.room, self.mass = own.reals((context.units.axis,), *sums, kind=own.exact, kept=False)
            (self.gain,) = own.reals((Axis("world", self.particles.worlds),), "gain", kind=own.exact, kept=False)

    @ti.func
    def sum(self, u, t, kick, dt):
        """Sum up the pressures, volumes and masses of a unit's air."""
        p = self.particles
        zero = ti.cast(0.0, p.exact)
        pressed, room, mass = zero, zero, zero
        first, end = self.ranges.fluid(u)
        for b in range(first, end):
            for lane in range(p.lanes):
                if p.number[b, lane] != UNUSED and p.gas[b, lane] > 0.5:
                    volume = ti.cast(p.volume[b, lane], p.exact)
                    pressed += volume * (p.pressure[b, lane] - self.constants.get("background"))
                    room += volume
                    mass += p.mass[b, lane]
        self.pressed[u], self.room[u], self.mass[u] = pressed, room, mass

    @ti.func
    def flow(self, w, t, kick, dt):
        """What share of its air a world gains in a step."""
        c, zero = self.constants, ti.cast(0.0, self.particles.exact)
        pressed, room, mass = zero, zero, zero
        for u in range(w * self.units.a_world, (w + 1) * self.units.a_world):
            pressed, room, mass = pressed + self.pressed[u], room + self.room[u], mass + self.mass[u]
        over = pressed / room
        gain = c.get("vent") * ti.sqrt(2.0 * ti.abs(over) * mass / room) * dt / mass
        gain = ti.min(gain, MOST * ti.abs(over) / c.get("air_stiffness"))
        self.gain[w] = ti.select(over > 0.0, 0.0 - gain, gain)

    @ti.func
    def pass_through(self, w, b, gas: ti.template(), s: ti.template()):
        """Give a block of particles its share of the gain; returns their density deviations."""
        p = self.particles
        share = 1.0 + gas * ti.cast(self.gain[w], p.real)
        p.store(p.mass, b, p.load(p.mass, b) * share)
        return (1.0 + s) * share - 1.0
