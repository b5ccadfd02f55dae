"""Water against closed forms: rest, waves, sloshing, viscous flow, free drops, and what must be kept."""

from lab.studies.case import Case
from lab.studies.verify.water import air, balance, bubbles, drops, patch, rest, sloshing, vortices, waves

MODULES = (rest, waves, sloshing, vortices, drops, patch, balance, air, bubbles)
CASES: tuple[Case, ...] = tuple(case for module in MODULES for case in module.CASES)
TEXTS = {
    rest.SECTION: """Forty layers in the box and in the chamfered tank fail: after some ten seconds a wave of sound, the
        first mode of the column, grows out of nothing, by 13 % a second, until the pressure swings by a good part of
        ρ g H. Loads and levels, means over many of its periods of 70 ms, stay right. It grows at half the step and
        with twice the viscosity as well; with the diffusion of Fourtakas and with none the same mode dies, by 14 and
        8 % a second, and with 20 layers it dies with Antuono's, too. So that diffusion feeds it, or has the walls feed
        it; how is not understood. For water of many layers that rests for long, take
        `water.diffusion = "fourtakas"`.""",
    waves.SECTION: """The decay of the wave comes nearer to theory with each spacing, but at an order of 0.6. At a fixed
        ratio of h and Δx second order is not to be expected: sums over a fixed number of disordered neighbours have an
        error that does not fall with the spacing (Quinlan, Basa & Lastiwka 2006), and Colagrossi, Souto-Iglesias,
        Antuono & Marrone (2013) found that viscous gravity waves converge only if that number grows, the more the
        higher the Reynolds number, as vorticity that the noise makes damps them too much. The line stays.""",
}
