"""Drops in air and bubbles in water that particles do not resolve: the pressure that the other phase has about them."""

import taichi as ti

from solvers.fluid.phases.adiabatic import GAMMA
from solvers.fluid.state import Particles
from solvers.fluid.terms.term import Sums, Term
from solvers.machine.state import Axis, State

FAINT = 0.02  # of full coverage by the other phase: what sees less of it has none about it
GONE = 9.0  # density deviation of a bubble of which nothing is left: a tenth of its volume
LIGHT = 0.1  # of the water's density: a fluid that is heavier may hang below its lid, by suction
ALONE = 0.5  # F of air without walls below which it is such a bubble: four spacings across


@ti.data_oriented
class Dispersed(Term):
    """p_i → Σ V_j p_j W / Σ V_j W over the other phase j, at the rate c/h, where the own phase is broken.

    A drop or a bubble below the spacing has no pressure of its own: that of both phases relaxes to one, as soon as
    sound crosses it (Baer & Nunziato 1986; Saurel & Abgrall 1999, who relax at once). Broken is what `VoidIndicator`
    says of the own phase alone. Without, drops in air keep the density that followed from how water came near: a drop
    over a pool counts as pressed from 2 h on, hovers on air that it cannot press out, and in time drops fill the air.

    Air that is trapped keeps the pressure of its own density; that of bubbles made equal to the water's would make
    energy from nothing. It holds no more than ρ_a c² (`Adiabatic`): in deeper water a bubble is squeezed without bound,
    a little each time that water moves about it. So a bubble (F < ALONE, walls not counted) is squeezed to GONE at
    most, or to the density at which p_a ((ρ/ρ_a)^1.4 − 1) is the water's pressure (own derivation).

    Nor does air lighter than LIGHT bear more suction than the background's pressure: beyond that particles
    attract each other, and a void that a few are to fill throws them about (Monaghan 2000). A bubble that is drawn out
    further relaxes to the density that bears it, where its elastic energy with the background's is least: the water
    does not feel more, and a particle along a wall was drawn out to −49 kPa among water of 0.7 kPa, whose energy came
    from nothing. `rest` is the density deviation s with the pressure of the other phase. Water that touches no air is
    in a void, and bears nothing.

    Limits: drops and bubbles of up to four spacings; not with tension, whose drops are to be resolved, nor cohesion.

    Units: p Pa, c m/s, h m, ρ kg/m³.
    """

    def __init__(self, arrays: State, sums: Sums, particles: Particles, constants):
        self.particles, self.constants = particles, constants
        self.acts = constants.two and not (constants.full or constants.tense or constants.coheres)
        if self.acts:
            each = Axis("block", particles.worlds * particles.stride), Axis("lane", particles.lanes)
            (self.rest,) = arrays.under("water").wide(each, "rest", kept=False)
            self.seen, self.pressed, self.beside = sums.room(), sums.room(), sums.room()

    @ti.func
    def add(self, block: ti.template(), pair: ti.template(), sums: ti.template()):
        """Add what a neighbour of the other phase gives to Σ V W, Σ V p W and the trace of it."""
        p, beside = self.particles, pair.other * pair.other
        seen = beside * p.volume[pair.jb, pair.lane] * self.constants.kernel.value(pair.t)
        sums[self.seen] += seen
        sums[self.pressed] += seen * p.pressure[pair.jb, pair.lane]
        sums[self.beside] += beside * (pair.weight * pair.square)

    @ti.func
    def trace(self, sums: ti.template()):
        """Σ V (−W'/r) r² over the other phase."""
        return sums[self.beside]

    @ti.func
    def borne(self, pressure):
        """The pressure (Pa) of a particle of air with the background's, as far as it bears suction."""
        found = pressure + self.constants.get("background")
        if ti.static(self.acts):
            found = ti.max(found, self.constants.get("least"))
        return found

    @ti.func
    def end(self, block: ti.template(), sums: ti.template()):
        """Store `rest` of a block."""
        p, c, b = self.particles, self.constants, block.b
        touched = sums[self.seen] * c.get("value") > FAINT
        over = sums[self.pressed] / ti.max(sums[self.seen], 1e-30) - c.get("background")
        of_water = ti.max(over * (1.0 / c.get("stiffness")), c.get("thinnest"))
        p.store(self.rest, b, ti.select(touched, of_water, p.ones() * c.get("thinnest")))
        for lane in range(p.lanes):
            if p.gas[b, lane] > 0.5:
                held = ti.max(over[lane] / c.get("air_stiffness"), 1.0)
                self.rest[b, lane] = ti.min(ti.pow(1.0 + GAMMA * held, 1.0 / GAMMA) - 1.0, GONE)

    @ti.func
    def off(self, b, s, after, loose, share):
        """What density deviations `s`, which are `after` a step, are to lose: water a share, air what is too much.

        Air that is stretched beyond what it bears gets a share of what it lacks to that.
        """
        rest, gas = self.particles.load(self.rest, b), self.particles.load(self.particles.gas, b)
        squeezed, thinnest = ti.max(after - ti.max(rest, s), 0.0), self.constants.get("air_thinnest")
        stretched = ti.min(after - thinnest, 0.0)
        return (1.0 - gas) * share * (after - rest) + gas * (loose * squeezed + share * stretched)
