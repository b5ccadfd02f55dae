"""Water against closed forms: rest, waves, sloshing, viscous flow, free drops, and what must be kept."""

from lab.studies.case import Case
from lab.studies.verify.water import balance, bore, drops, orifice, patch, rest, sloshing, space, vortices, waves
from lab.studies.verify.water.phases import air, bubbles

MODULES = (rest, waves, bore, sloshing, orifice, vortices, drops, patch, balance, space, air, bubbles)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)
TEXTS = {
    rest.SECTION: """Forty layers rest only since wall particles compress the water that they take power from, see
        `solvers.fluid.walls.divergence_correction`. Before, the first mode of sound in a column grew out of nothing by
        13 % a second, until the pressure swung by a good part of ρ g H: wall particles pushed with the water's
        pressure, but stood still in the balance of mass, so that force and divergence were not adjoint.""",
    waves.SECTION: """Walls that push along their faces, where there is no friction, cost this wave: before
        `solvers.fluid.walls.tangential_correction` it decayed too fast by 15.5, 7.7 and 6.2 % with 20, 40 and 60
        layers, at an order of 0.9. At a fixed ratio of h and Δx second order is not to be expected: sums over a fixed
        number of disordered neighbours have an error that does not fall with the spacing (Quinlan, Basa & Lastiwka
        2006), and Colagrossi, Souto-Iglesias, Antuono & Marrone (2013) found that viscous gravity waves converge only
        if that number grows. Between periodic sides 20 layers with h = 3 Δx decay too fast by 0.7 % instead of
        9.2 %.""",
    bore.SECTION: """Once it runs steadily, a bore of particles loses energy about as fast as the jump relations say, by
        viscosity and the diffusion of density alike. But it begins late: until it has run two depths h2 its front has
        still to overturn and takes next to nothing, and is some 3 ρ g h1³ behind a bore of shallow water, which loses
        energy from the start. With 6 layers it catches up with most of that, with 12 with none. A run beside these
        with 15 layers has 0.993 of h2, 0.993 of c and 0.933 of the loss, 3.2 ρ g h1³ of it too late: the loss falls
        with the spacing, and its limit is not known. Wall particles have no energy of their own; what they give, 4 %
        of the loss with 12 layers, is made by the scheme, and the energy lost is net of it.""",
    air.SECTION: """The wave below a fluid of half the water's density is under pressures over those of that fluid at
        rest (`solvers.fluid.phases.reduced_pressure`). Under whole pressures rows of particles slide along each other
        at 4.9 kPa, what the upper fluid's weight draws at its lid, and are held as teeth are: at 20 and 40 layers the
        rate is off by +1.3 and +6.6 %, and the decay 2.2 and 1.7 times that of theory. A drop and a bubble under
        tension need a background pressure above σ times the gradient of the phase, and forces along the line between
        particles, see the manual's page on air.""",
}
