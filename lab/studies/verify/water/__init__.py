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
        8 % a second, and with 20 layers it dies with Antuono's, too. The energy comes from the walls: dummies push
        with the water's pressure, but in the balance of mass they stand still, where the water's mirror image would
        move. Such a force is not the adjoint of the divergence. The linearised equations of a column that repeats
        itself sideways tell the same: the mode grows by 14 % a second with Antuono's diffusion and 40 layers (13 % in
        a run), 10 % with 60, 8 % with 80; with mirrored velocities it dies in each, and its frequency is off by 0.2 %
        instead of 2.2 % with 40. Antuono's own diffusion never gives energy, but lets densities near the floor lag
        behind. That of Fourtakas outdoes the walls at 40 layers, where 60 s of rest in the box leave an error of 0.30 %
        of ρ g H; in the box with 60 the mode grows by 1 % a second. It is not the default since it makes the
        standing wave below, with 20 layers, decay too fast by 21 % instead of 8 %, with 40 by 8.7 % instead of 5.8 %.
        For water of many layers that rests for long, take `water.diffusion = "fourtakas"`.""",
    waves.SECTION: """The decay of the wave comes nearer to theory with each spacing, but at an order of 0.6. At a fixed
        ratio of h and Δx second order is not to be expected: sums over a fixed number of disordered neighbours have an
        error that does not fall with the spacing (Quinlan, Basa & Lastiwka 2006), and Colagrossi, Souto-Iglesias,
        Antuono & Marrone (2013) found that viscous gravity waves converge only if that number grows, the more the
        higher the Reynolds number, as vorticity that the noise makes damps them too much. The line stays.""",
    air.SECTION: """What fails is the surface where both fluids are dense or under tension. Below a fluid of half its
        density the wave decays four times too fast, and its rate is off by +0.9 and +15 % at 20 and 40 layers with the
        background pressure of presets, by −26 and −36 % without: both fluids slide along each other there, and a cause
        beyond that is not known. A drop of twelve particles over its radius has 3 % too little pressure with that
        background pressure, five times its own, and loses a third without, where its surroundings are under suction
        and tear; with six particles the pressure is right to 0.6 %. The bubble's centre agrees, but it becomes faster
        and less round with each spacing. A force that keeps particles of both fluids apart (Grenier, Antuono,
        Colagrossi, Le Touzé & Alessandrini 2009) is not among the models; whether that is why is not known. Under air,
        a thousandth as dense, nothing of this is seen.""",
}
