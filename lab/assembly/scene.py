"""Build the solver's scene from a resolved preset: the tank, its carrier and the matters in it."""

from collections.abc import Sequence
from dataclasses import replace
from math import ceil

import numpy as np

from lab.assembly.bulk import bulk_of, points_of
from lab.assembly.collisions import known_collisions
from lab.assembly.grains import check_laden, check_softness, grain_count, grains_of, rooms_of_bodies
from lab.assembly.room import check_room
from lab.assembly.ship import make_vessel
from lab.assembly.water import (
    air_volumes_of,
    fluid_of,
    mixture_of,
    most_drops,
    particles,
    soaked_by,
    volumes_of,
    water_aboard,
)
from lab.preset.accuracy import LEVELS, check_forced
from lab.preset.schema import Preset
from lab.preset.sections.parts import parts_of
from lab.preset.sections.water.tanks import further_tanks
from solvers.fluid.timestep import longest_pace, soft_limit
from solvers.grains.bed.relaxing import relaxed_start
from solvers.grains.timestep import SLOWEST, share_to_lengthen
from solvers.machine.runtime import choose_arch
from solvers.motion.steered import Steered
from solvers.scene import Scene
from solvers.ship.vessel import Vessel

# What the solver is told of each matter beside grains, whose places are found with them
OTHERS = {"water": fluid_of, "bulk": bulk_of}
# A step twice the derived one suits closing speeds of a 32nd; four times is more than the Rayleigh time ever allows.
LONGEST_STRIDE = 2
LARGEST_POWER = (
    5  # of two: of more base steps multiples need not be powers of two (`solvers.time.sequence.CHECK_EVERY`)
)


@known_collisions()
def build(preset: Preset, hands: Sequence[Steered] | None = None) -> tuple[Scene, np.ndarray]:
    """The scene of all repeats and the grains' starting positions (W, n, 2) m; repeat w has the seed run.seed + w.

    hands: steered motions of the tanks, which replace those of the preset.

    The positions lie within `filling_outline`; listed grains that overlap too deeply to settle are moved apart. The
    step follows from the level of accuracy unless given; it divides the sampling interval of the series, so samples
    fall on steps. Raises LabError if the grains do not fit into the tank or the memory, or a given step is too long.
    """
    worlds = preset.run.repeats
    check_room(preset, grain_count(preset), most_drops(preset))
    grains, position = grains_of(preset)
    scene = Scene(
        outline=np.array(preset.tank.corners),
        matters=(*((grains,) if grains else ()), *(OTHERS[name](preset) for name in OTHERS if name in preset.matters)),
        gravity=preset.run.gravity,
        motions=[tuple(preset.motion.parts.values() if hands is None else hands)] * worlds,
        soft_start=preset.motion.soft_start,
        open_edges=preset.tank.open_edges,
        parts=parts_of(preset),
        vessels=vessels(preset) * worlds,
        axles=[preset.axle.solved] * worlds if preset.axle else (),
        thickness=preset.thickness,
        length=preset.tank.length,
        solid=preset.tank.solid,
        more_tanks=(*further_tanks(preset, preset.thickness), *rooms_of_bodies(preset)),
        mixture=mixture_of(preset),
        precision=preset.run.precision,
        schedule=preset.run.schedule,
    )
    if preset.wet:
        scene.matters = scene.holding(soaked_by(preset, scene)).matters
    check_laden(preset, scene)
    if preset.grains:
        check_softness(scene)
    scene.step = _step(preset, scene)
    if preset.grains and preset.grains.listed and preset.run.settles:  # without settling, overlaps may be intended
        position = np.tile(relaxed_start(scene, position[0]), (worlds, 1, 1))
    return scene, position


def volumes(scene: Scene) -> dict[str, np.ndarray | None]:
    """The volumes (W, n) m² of particles of water and air, and of points of bulk, as a recording has them."""
    return {"volume": volumes_of(scene), "air": air_volumes_of(scene), "bulk": points_of(scene)}


def vessels(preset: Preset) -> list[Vessel]:
    """The ship whose hold is the tank, if there is one. Raises LabError if she does not float."""
    if preset.ship is None:
        return []
    vessel = make_vessel(preset.ship, preset.sea, preset.waves, preset.run.gravity, water_aboard(preset))
    if preset.inflow:  # where it leads to a room she takes in water and goes on
        inlets = {tuple(end) for inlet in preset.inflow.values() for end in inlet.points}
        vessel = replace(vessel, sinks=True, openings=tuple(p for p in vessel.openings if tuple(p) not in inlets))
    return [vessel]


def largest_multiple(preset: Preset) -> int:
    """How many times the derived step a step may be long while grains are slow; a step that is given stays as it is."""
    return LONGEST_STRIDE if preset.grains and preset.run.step == "auto" else 1


def _base_share(scene: Scene, times: float) -> float:
    """What to take of the derived step so that it may be so many `times` as long; 1 where steps never are."""
    if times <= 1.0 or scene.responds or scene.fluid or scene.grains.integrator == "gear":
        return 1.0
    return share_to_lengthen(scene.step_limits()[0].step, scene.step_limits(SLOWEST)[0].step, times)


def _soft_multiple(preset: Preset, scene: Scene, wanted: float) -> int:
    """How many steps of the water are one while its air is soft: the power of two with the fewest steps in the run.

    wanted: the longest step (s) under stiff air.
    """
    if choose_arch(preset.run.arch, preset.run.precision, True, scene.worlds * particles(scene)) != "cpu":
        return 1  # particles that move one by one have steps of one length
    interval, early = 1.0 / preset.record.series_rate, scene.fluid.water.air.stiff_from
    longest = soft_limit(scene, LEVELS[preset.run.accuracy].longer_steps)

    def steps(multiple: int) -> float:
        a_row = ceil(interval / min(longest, multiple * wanted) - 1e-9)  # of long ones, between two rows of the series
        return a_row * (early + multiple * (preset.duration - early))

    return min((2**k for k in range(LARGEST_POWER + 1)), key=steps)


def _step(preset: Preset, scene: Scene) -> float:
    """The step (s): as given, else derived, else the sampling interval, which it divides in any case."""
    limits, run, interval = scene.step_limits(), preset.run, 1.0 / preset.record.series_rate
    wanted, longest, usual = run.step, largest_multiple(preset), scene.longest_step(LEVELS[run.accuracy].longer_steps)
    if run.step == "auto":
        share = _base_share(scene, longest)
        if scene.grains:
            scene.grains.base_share = share
        wanted = share * usual
        if scene.fluid and scene.fluid.water.air and scene.fluid.water.air.stiff_from > 0.0:
            longest = _soft_multiple(preset, scene, wanted)
            scene.matters = scene.holding(replace(scene.fluid, soft_multiple=longest)).matters
            wanted = min(wanted, soft_limit(scene, LEVELS[run.accuracy].longer_steps) / longest)
    elif limits:
        check_forced(wanted, limits, usual, run.force_step)
    # Between two rows of the series lies a whole number of the longest steps, of grains and of water.
    count = longest * max(1, ceil(interval / (longest * wanted) - 1e-9))
    of_water = ceil(count / longest_pace(scene, interval / count))
    substeps = ceil(count / of_water)
    if scene.fluid:
        scene.matters = scene.holding(replace(scene.fluid, substeps=substeps)).matters
    return interval / (of_water * substeps)
