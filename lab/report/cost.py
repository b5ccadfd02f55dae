"""What a run costs: steps, memory, and seconds of one core for each of its parts."""

from dataclasses import dataclass, replace

from lab.assembly.grains import grain_count
from lab.assembly.room import check_room
from lab.assembly.scene import build, largest_multiple
from lab.assembly.water import most_drops, particles, updates
from lab.base.memory import memory_of
from lab.measures.ship_frozen import step_of
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.report.cargo import bulk
from solvers.bulk.given import Bulk
from solvers.fluid.timestep import steps_of_water
from solvers.machine.runtime import available_cores, choose_arch
from solvers.simulation import Simulation
from solvers.time.compiled import taken
from solvers.time.schedules import choose_schedule, units_a_world

# Grain-steps a second of one core on settled beds: between a Xeon of 2.5 GHz (15e6) and newer ones (37e6 and more;
# README, "Speed"). It is used for the estimate of the run time only.
GRAIN_STEPS_PER_CORE = {2: 20e6, 3: 6e6}  # by the scene's axes
OUTLINES_PER_CORE = {"continuous": 3e6, "nodes": 3e6, "area": 3e6}  # of irregular grains
DROP_STEPS_PER_CORE = 1.1e6  # particle-steps of water a second of one core
KEPT = 0.4  # of the time of compiling: to trace kernels that are kept, and to make them code of the processor
# Other parts of a run, in seconds of CPU time of one core (AMD EPYC, Zen 5): to start Python, its libraries and Taichi,
# to compile the kernels when they are new, and in addition those of a ship
STARTING = 2.0
COMPILING = {"both": 90.0, "water": 25.0, "discs": 2.0, "continuous": 8.0, "nodes": 6.0, "area": 4.5}
COMPILING_SHIP, COMPILING_SPHERES = 3.0, 23.0
STEP = 0.07e-6  # of a world, without its grains
SAMPLE = 0.25e-3  # to stop and observe all worlds
# For each computation of the water's forces on a ship: at least, for each pair of states of its memory, for each wave
LOOK, LOOK_PAIR, LOOK_WAVE = 0.4e-6, 1.6e-9, 0.07e-6
FROZEN = 0.37e-3  # for each interval of the ship with her cargo frozen
REPORTING, PICTURE = 2.5, {2: 0.026, 3: 0.07}  # measures and figures; a picture and its place in the video
LARGE = 500.0  # MiB, of a recording


@dataclass(frozen=True)
class Cost:
    """What a run costs: `particles` of all its beds, `step` (s), `steps`, `memory` of arrays and size of the
    `recording` (MiB), `seconds` by part, `settling` (s) at most for a new bed, and the `cores` it uses.

    The seconds are estimates for one core of an AMD EPYC (Zen 5), with a film. Compiling takes what it took on this
    machine for such a scene, or for one of the same matters, if there was any.
    """

    particles: int
    step: float
    steps: float
    memory: float
    recording: float
    seconds: dict[str, float]
    settling: float
    cores: int

    @property
    def total(self) -> float:
        """Seconds in all, without settling."""
        return sum(self.seconds.values())

    def __str__(self) -> str:
        settling = f", and at most {_span(self.settling)} to settle a new bed" if self.settling else ""
        return f"about {_span(self.total)} on {self.cores} core(s){settling}; {self.particles} particles"


def cost(loaded: LoadedPreset) -> Cost:
    """What a run of a preset costs. Raises LabError if it cannot be run."""
    preset = loaded.resolved
    check_room(preset, grain_count(preset), most_drops(preset))
    simulation = one_bed(preset)
    scene, worlds = simulation.scene, preset.run.repeats
    try:
        return Cost(
            particles=worlds * particles(scene),
            step=scene.step,
            steps=_steps(scene, preset.duration),
            memory=worlds * simulation.arrays.bytes / 2**20,
            recording=_recorded(preset, scene),
            seconds=cost_in_seconds(preset, scene, simulation),
            settling=_settling(preset, scene) if preset.run.settles and preset.grains else 0.0,
            cores=_cores(preset),
        )
    finally:
        simulation.close()


def one_bed(preset: Preset) -> Simulation:
    """A simulation of the first bed alone, with the units of work it has among all beds; the others are alike."""
    run = preset.run
    scene, position = build(replace(preset, run=replace(run, repeats=1)))
    asked = run.arch, run.precision, scene.particles > 0, run.repeats * particles(scene)
    arch = "cpu" if scene.responds and run.arch == "auto" else choose_arch(*asked)
    sizes = run.repeats, particles(scene), run.threads or available_cores()
    schedule = choose_schedule(run.schedule, arch, *sizes, scene.responds)
    units = units_a_world(schedule, *sizes)
    placed = replace(scene, schedule=schedule), position, run.threads
    return Simulation(*placed, arch=arch, units=units, largest_multiple=largest_multiple(preset))


def described(preset, scene, simulation: Simulation) -> list[tuple[str, str]]:
    """The rows of `explain` on the cost."""
    worlds, count, what = preset.run.repeats, particles(scene), "grain" if preset.grains else "particle"
    base = round(preset.duration / scene.step)
    seconds = cost_in_seconds(preset, scene, simulation)
    parts = ", ".join(f"{_span(spent)} {what}" for what, spent in seconds.items() if spent >= 0.5)
    settling = f"and at most {_span(_settling(preset, scene))} to settle a new bed"
    return [
        *(
            [(f"{what}-steps", f"{worlds * updates(scene, base):.3g}{', and those of settling' * bool(preset.grains)}")]
            * bool(count)
        ),
        *([("steps", f"{_steps(scene, preset.duration):.3g}")] if not preset.grains else []),
        ("kernels", _kernels(preset, simulation)),
        ("memory", memory_of(simulation, worlds, count, what)),
        ("recording", _size(_recorded(preset, scene))),
        ("run time", f"about {_span(sum(seconds.values()))} on {_cores(preset)} core(s): {parts}"),
        *([("", settling)] if preset.run.settles and preset.grains else []),
    ]


def _recorded(preset, scene) -> float:
    """The size of the recording (MiB)."""
    frames = preset.duration * preset.record.picture_rate
    return frames * preset.run.repeats * particles(scene) * 24 * (scene.axes - 1) / 2**20


def _settling(preset, scene) -> float:
    """Seconds that settling takes at most."""
    return _stepping(preset.run.settle_limit, preset, scene)


def _cores(preset) -> int:
    return min(preset.run.repeats, preset.run.threads or available_cores())


def _size(kept: float) -> str:
    """The size of a recording (MiB); of a large one, what would make it smaller."""
    pictures = "; nearly all of it pictures, of which a lower record.picture_rate keeps fewer" if kept > LARGE else ""
    return f"{kept:.0f} MiB{pictures}"


def cost_in_seconds(preset, scene, simulation: Simulation) -> dict[str, float]:
    """Seconds that a run takes, by its parts, without settling; all pictures are painted."""
    duration, record = preset.duration, preset.record
    found = {
        "to start and compile": STARTING + _compiling(preset, scene, simulation),
        "of steps": _stepping(duration, preset, scene) + duration * record.series_rate * SAMPLE,
    }
    if preset.ship:
        found["of her hull and water"] = _floating(preset, simulation)
    return found | {"of figures": REPORTING, "of pictures": duration * record.picture_rate * PICTURE[scene.axes]}


def _compiling(preset, scene, simulation: Simulation) -> float:
    """Seconds to compile the kernels, or to read them where they are kept."""
    kept, seconds = taken(simulation, preset.run.repeats)
    if seconds is None:
        of_grains = scene.grains.shapes.contact if scene.grains and scene.grains.shapes else "discs"
        rule = of_grains if not scene.fluid else "both" if scene.grains else "water"
        seconds = COMPILING[rule] + COMPILING_SHIP * bool(preset.ship) + COMPILING_SPHERES * (scene.axes > 2)
    return KEPT * seconds if kept else seconds


def _kernels(preset, simulation: Simulation) -> str:
    """Whether the kernels must be compiled, and what that takes."""
    kept, seconds = taken(simulation, preset.run.repeats)
    if kept:
        return f"kept from an earlier run of this kind, where they took {_span(seconds)} to compile"
    like = f", about {_span(seconds)} as for like scenes on this machine" if seconds is not None else ""
    return f"to be compiled{like}; they are kept, also for other sizes and materials"


def _steps(scene, duration: float) -> float:
    """How many steps a duration (s) takes, long ones of soft air counted as one."""
    steps = duration / scene.step
    return steps_of_water(scene, round(steps)) if scene.fluid and scene.fluid.soft_multiple > 1 else steps


def _stepping(duration: float, preset, scene) -> float:
    """Seconds of computation for the steps of grains or water over a duration (s)."""
    rounds = -(-preset.run.repeats // _cores(preset))
    a_step = STEP
    if scene.grains:
        shapes = scene.grains.shapes
        a_step += scene.grains.count / (
            OUTLINES_PER_CORE[shapes.contact] if shapes else GRAIN_STEPS_PER_CORE[scene.axes]
        )
    if scene.fluid:
        a_step += scene.fluid.moved / scene.fluid.substeps / DROP_STEPS_PER_CORE
    a_step += scene.of(Bulk).count / bulk.POINT_STEPS_PER_CORE if scene.of(Bulk) else 0.0
    return rounds * _steps(scene, duration) * a_step


def _floating(preset, simulation: Simulation) -> float:
    """Seconds of computation for the water's forces and for the ship with her cargo frozen."""
    states, _, waves = simulation.carrier.sizes
    rounds = -(-preset.run.repeats // _cores(preset))
    look = LOOK + LOOK_PAIR * states**2 + LOOK_WAVE * waves
    looks = preset.duration / (float(simulation.carrier.every[0]) * simulation.dt)
    frozen = preset.run.repeats * preset.duration / step_of(simulation.scene.vessels[0]) * FROZEN
    return rounds * looks * look + frozen


def _span(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
