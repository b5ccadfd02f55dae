"""A soaked bed at rest for a minute: how little it moves, and what each matter puts on the floor."""

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.scenes import G, box
from lab.studies.verify.wet.consolidation import SECTION
from lab.studies.verify.wet.laws import DENSITY
from lab.studies.verify.wet.scenes import (
    HEAVY,
    SIZE,
    SPACING,
    advance,
    evenly,
    glass,
    on_walls,
    rows,
    simulated,
    solid_area,
    wet,
)
from solvers.fluid.given import Level, Water
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.simulation import Simulation

WIDTH, HEIGHT, LEVEL, SOUND = 0.08, 0.14, 0.09, 10.0  # m, m/s
COLUMNS, LAYERS, LOOSE = 19, 15, 1.01  # grains; the bed is nearly twice as deep as the kernel's radius
# s: the bed settles, rests, and is looked at. The water's volume is set right in τ = 100 h/(δ c0) = 1.6 s; six of them.
BEGUN, LASTS, EVERY = 10.0, 60.0, 0.5
STILL = 1e-6  # m g d


def moving(run: Simulation) -> np.ndarray:
    """The kinetic energies (n,) of the grains, spin included, in m g d."""
    now = run.snapshot()
    square = (now["velocity"][0] ** 2).sum(axis=1) + 0.4 * (0.5 * SIZE * now["spin"][0]) ** 2
    return 0.5 * square / (G * SIZE)


def resting(_: bool) -> Found:
    """15 layers of beads under 30 mm of water, for a minute."""
    place = rows(COLUMNS, LAYERS, 1.0, 0.5 * SIZE)
    place[..., 0] *= LOOSE
    area = WIDTH * LEVEL - place.shape[1] * solid_area(SIZE)
    grains = Grains(np.full(place.shape[:2], 0.5 * SIZE), glass(), glass(), stiffness_scale=1e-3)
    water = Water(SPACING, SOUND, alpha=0.02, levels=(Level(0.0),))
    drops = evenly(round(area / SPACING**2), area)
    scene = wet(box(WIDTH, HEIGHT), grains, water, drops, Mixture(level=LEVEL), thickness=SIZE)
    energies, levels, pushed = [], [], np.zeros(2)
    with simulated(scene, place) as run:
        advance(run, BEGUN)
        of_water = run.water.particles.read(run.water.particles.mass)[0].sum() * SIZE
        of_grains = run.grains.mass.sum()
        begun, first = run.time, run.observe()["level_depth"][0, 0]
        while run.time < BEGUN + LASTS:
            advance(run, run.time + EVERY)
            energies.append(moving(run))
            pushed -= on_walls(run)  # since they were observed
            levels.append(run.observe()["level_depth"][0, 0])
        on_floor = pushed / (run.time - begun)
    mean, most = np.mean(energies, axis=1), np.max(energies, axis=1)
    level = max((one - first for one in levels), key=abs)
    buoyant = G * of_grains * (1.0 - DENSITY / HEAVY)
    borne = G * (of_water + of_grains * DENSITY / HEAVY)
    near = "near walls the lift of single grains is off, their sum is less so"
    lines = [
        Line.off("motion of a grain on average, at any look, of m g d", "rest", mean.max(), STILL, "a settled bed's"),
        Line.off("change of the level, of a spacing", "rest", level / SPACING, 0.1, "a tenth"),
        Line("grains on the floor, of their buoyant weight", on_floor[0] / buoyant, 1.0, "weight", 0.02, near),
        Line("water on the floor, of ρ g H on all of it", on_floor[1] / borne, 1.0, "weight", 0.02, near),
        Line("both, of the weight", on_floor.sum() / (buoyant + borne), 1.0, "weight", 1e-3, "mean over the minute"),
    ]  # fmt: skip
    note = f"""From {BEGUN:g} s after the water was laid, for a minute; grains have {np.median(mean):.1e} m g d each at
    most looks. Any single one has up to {most.max():.1e}: at {np.mean(most > STILL):.0%} of the looks one has more than
    {STILL:g}, as it finds a better place. Before, the volume of the water, which was laid in rows, is set right: for
    some seconds the level sinks, by a tenth of a spacing, and single grains have 1e-5 m g d."""
    return Found(lines, notes=[note])


CASES = (Case("wet-rest", SECTION, "A soaked bed at rest", resting, quick=False),)
