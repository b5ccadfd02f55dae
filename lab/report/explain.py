"""What a preset simulates, which models it uses and what its run will cost, without running it."""

import tomllib
from collections.abc import Iterator
from dataclasses import replace

from lab.assembly.grains import grain_count
from lab.assembly.room import check_room
from lab.assembly.scene import build, largest_multiple
from lab.assembly.water import most_drops, particles, updates
from lab.base.memory import memory_of
from lab.measures.ship_frozen import step_of
from lab.preset.fields import join, taken_by
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.preset.units import show
from lab.report import free, water
from lab.report.cargo import bulk, coarse, grains
from lab.report.ship import describe
from lab.report.wet import bed
from solvers.bulk.given import Bulk
from solvers.fluid.timestep import steps_of_water
from solvers.machine.runtime import available_cores, choose_arch
from solvers.motion.frame import is_turn
from solvers.motion.history import Recorded
from solvers.simulation import Simulation
from solvers.time.schedules import choose_schedule, units_a_world

# Grain-steps a second of one core on settled beds: between a Xeon of 2.5 GHz (15e6) and newer ones (37e6 and more;
# README, "Speed"). It is used for the estimate of the run time only.
GRAIN_STEPS_PER_CORE = {2: 20e6, 3: 6e6}  # by the scene's axes
OUTLINES_PER_CORE = {"continuous": 3e6, "nodes": 3e6, "area": 3e6}  # of irregular grains
DROP_STEPS_PER_CORE = 1.1e6  # particle-steps of water a second of one core
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
LARGE = 500.0  # MiB, of a recording
REPORTING, PICTURE = 2.5, {2: 0.026, 3: 0.07}  # measures and figures; a picture and its place in the video

PRECISIONS = {
    "f64": "64-bit floats",
    "f32": "32-bit floats",
    "mixed": "64-bit places and times, 32-bit forces and velocities",
}
SCHEDULES = {
    "per-world": "per world: a serial time loop in each, worlds in parallel",
    "per-band": "per band: each world cut into bands of grains, a core a band, in step",
    "per-grain": "per grain: all grains in parallel, a launch a step",
}
KEYS_WIDTH = 34  # characters of a key and its value, before its sentence

Sections = list[tuple[str, list[tuple[str, str]]]]


def explain(loaded: LoadedPreset) -> str:
    """A page of text on a preset: scene, step and what limits it, what is compiled in, memory, expected run time."""
    blocks = [
        f"{loaded.resolved.title}  ({loaded.name})",
        *(_section(title, rows) for title, rows in sections(loaded)),
        "Preset in full\n" + "".join(f"    {line}\n" for line in _with_sentences(loaded.given_text)),
    ]
    return "\n".join(blocks)


def as_objects(loaded: LoadedPreset) -> dict[str, object]:
    """The same as JSON has it: each section's rows by their names, and the preset's keys as they were given."""
    rows = {title: dict(rows) for title, rows in sections(loaded)}
    return {
        "name": loaded.name,
        "title": loaded.resolved.title,
        "sections": rows,
        "preset": tomllib.loads(loaded.given_text),
    }


def sections(loaded: LoadedPreset) -> Sections:
    """What is said of a preset: titles, and rows of a name and a text."""
    preset = loaded.resolved
    check_room(preset, grain_count(preset), most_drops(preset))
    simulation = _one_bed(preset)
    scene = simulation.scene
    accuracy = grains.accuracy(preset) if preset.grains else []
    found = [
        ("Scene", _scene(preset, scene)),
        ("Wet bed", bed.described(preset, scene)),
        ("Bulk", bulk.described(preset, scene)),
        ("Ship", _ship(preset, simulation)),
        ("Coarse grains", coarse.described(preset) if preset.grains else []),
        ("Axle", free.described(preset) if preset.axle else []),
        ("Bodies", free.bodies(preset, scene)),
        ("Accuracy", accuracy),
        ("Accuracy of the water" if accuracy else "Accuracy", water.accuracy(preset) if preset.water else []),
        ("Step", _step(simulation)),
        ("Compiled in", _parts(preset, simulation)),
        ("Cost", _cost(preset, scene, simulation)),
    ]
    simulation.close()
    return [(title, rows) for title, rows in found if rows]


def _with_sentences(given: str) -> Iterator[str]:
    """The lines of a preset's text, each key of a section with its sentence from the schema."""
    section = ""
    for line in given.strip().splitlines():
        if line.startswith("["):
            section = line.strip("[]")
        taken = taken_by(Preset, join(section, line.partition(" = ")[0])) if section else None
        yield f"{line:<{KEYS_WIDTH}} # {taken.doc}" if taken and taken.doc else line


def _one_bed(preset: Preset) -> Simulation:
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


def _section(title: str, rows: list[tuple[str, str]]) -> str:
    width = max(len(name) for name, _ in rows)
    return title + "\n" + "".join(f"    {name:<{width}}  {text}\n" for name, text in rows)


def _scene(preset, scene) -> list[tuple[str, str]]:
    worlds = preset.run.repeats
    rows = [("based on", preset.based_on)] if preset.based_on else []
    rows += [("quick variant", preset.quick)] if preset.quick else []
    rows += [
        ("repeats", f"{worlds}, seeds {preset.run.seed} to {preset.run.seed + worlds - 1}"),
        ("tank", _tank(preset, scene)),
        *(grains.described(preset, scene) if preset.grains else []),
        *(water.described(preset, scene) if preset.water else []),
    ]
    motions = preset.motion.parts
    parts = [_motion(name, motion, scene.soft_start) for name, motion in motions.items()]
    rows.append(("motion", ", then ".join(parts) or ("as it rolls about its axle" if preset.axle else "none")))
    for name, part in preset.parts.items():
        moves = [_motion(move, motion, 0.0) for move, motion in part.moves.items()]
        rows += [(f"motion of {name}", ", then ".join(moves))] * bool(moves)
    rows.append(("duration", show(preset.duration, "s") + " after settling" * bool(preset.grains)))
    return rows


def _ship(preset, simulation: Simulation) -> list[tuple[str, str]]:
    """The rows on the ship; none without a ship."""
    if not preset.ship:
        return []
    every = int(simulation.carrier.every[0]) * simulation.dt
    slab = (preset.thickness, preset.a_metre) if preset.matters else None
    return describe(preset, simulation.scene.vessels[0], slab, every)


def _tank(preset, scene) -> str:
    width, height = (show(extent, "m") for extent in preset.tank.extent)
    what = [f"{width} wide, {height} high", *preset.tank.in_space]
    if preset.tank.open_edges:
        what.append("open at the top")
    lining = scene.grains.fixed if scene.grains else ()
    if len(lining):
        what.append(f"lined with {len(lining)} fixed grains")
    moving = [f"{name} ({_moves(part)})" for name, part in preset.parts.items()]
    if moving:
        what.append(f"with {', '.join(moving)}")
    return ", ".join(what)


def _motion(name: str, motion, soft_start: float) -> str:
    turns = is_turn(motion.coordinate)
    words = f"{name}, up to {show(motion.fastest(soft_start), 'rad/s' if turns else 'm/s')}"
    if isinstance(motion, Recorded):
        words += f" and {motion.hardest():.3g} {'rad' if turns else 'm'}/s²"
    return words


def _step(simulation: Simulation) -> list[tuple[str, str]]:
    scene = simulation.scene
    limits = [f"{show(limit.step, 's')}: {limit.reason}" for limit in scene.step_limits()]
    limits = limits or ["the interval between samples: the tank's motion is exact at any time"]
    substeps = scene.fluid.substeps if scene.fluid else 1
    of_water = [("of the water", f"{show(substeps * scene.step, 's')}, {substeps} steps in one")] * (substeps > 1)
    if scene.fluid and scene.fluid.water.softened is not scene.fluid.water:
        of_water = [("while the air is soft", water.soft_step(scene, simulation.largest_multiple))]
    return [("step", show(scene.step, "s")), *of_water, *((f"limit {k + 1}", limit) for k, limit in enumerate(limits))]


def _parts(preset: Preset, simulation: Simulation) -> list[tuple[str, str]]:
    scene, carrier, walls = simulation.scene, simulation.carrier, simulation.walls
    terms = "gravity" if scene.gravity else "none"
    if scene.fluid and scene.fluid.water.pull:
        terms = "pull to a point"
    if carrier.moving:
        terms += ", translation"
    if carrier.rotating:
        terms += ", Euler, centrifugal and Coriolis terms"
    return [
        *(grains.laws(preset, simulation) if preset.grains else []),
        *(water.models(scene) if preset.water else []),
        ("body forces", terms),
        ("walls", f"{walls.said} that cargo can touch"),
        ("numbers", PRECISIONS[scene.precision]),
        ("schedule", f"{SCHEDULES[simulation.schedule_name]}, on {simulation.arch}"),
    ]


def _cost(preset, scene, simulation: Simulation) -> list[tuple[str, str]]:
    worlds, count, what = preset.run.repeats, particles(scene), "grain" if preset.grains else "particle"
    base = round(preset.duration / scene.step)
    steps = _steps(scene, preset.duration)
    frames = preset.duration * preset.record.picture_rate
    seconds = cost_in_seconds(preset, scene, simulation)
    parts = ", ".join(f"{_span(spent)} {what}" for what, spent in seconds.items() if spent >= 0.5)
    cores = min(worlds, preset.run.threads or available_cores())
    settling = f"and at most {_span(_stepping(preset.run.settle_limit, preset, scene))} to settle a new bed"
    return [
        *(
            [(f"{what}-steps", f"{updates(scene, base):.3g}{', and those of settling' * bool(preset.grains)}")]
            * bool(count)
        ),
        *([("steps", f"{steps:.3g}")] if not preset.grains else []),
        ("memory", memory_of(simulation, worlds, count, what)),
        ("recording", _size(frames * worlds * count * 24 * (scene.axes - 1) / 2**20)),
        ("run time", f"about {_span(sum(seconds.values()))} on {cores} core(s): {parts}"),
        *([("", settling)] if preset.run.settles and preset.grains else []),
    ]


def _size(kept: float) -> str:
    """The size of a recording (MiB); of a large one, what would make it smaller."""
    pictures = "; nearly all of it pictures, of which a lower record.picture_rate keeps fewer" if kept > LARGE else ""
    return f"{kept:.0f} MiB{pictures}"


def cost_in_seconds(preset, scene, simulation: Simulation) -> dict[str, float]:
    """Seconds that a run takes, by its parts, without settling; kernels are compiled anew and all pictures painted."""
    of_grains = scene.grains.shapes.contact if scene.grains and scene.grains.shapes else "discs"
    rule = of_grains if not scene.fluid else "both" if scene.grains else "water"
    more = COMPILING_SHIP * bool(preset.ship) + COMPILING_SPHERES * (scene.axes > 2)
    duration, record = preset.duration, preset.record
    found = {
        "to start and compile": STARTING + COMPILING[rule] + more,
        "of steps": _stepping(duration, preset, scene) + duration * record.series_rate * SAMPLE,
    }
    if preset.ship:
        found["of her hull and water"] = _floating(preset, simulation)
    return found | {"of figures": REPORTING, "of pictures": duration * record.picture_rate * PICTURE[scene.axes]}


def _steps(scene, duration: float) -> float:
    """How many steps a duration (s) takes, long ones of soft air counted as one."""
    steps = duration / scene.step
    return steps_of_water(scene, round(steps)) if scene.fluid and scene.fluid.soft_multiple > 1 else steps


def _stepping(duration: float, preset, scene) -> float:
    """Seconds of computation for the steps of grains or water over a duration (s)."""
    rounds = -(-scene.worlds // min(scene.worlds, preset.run.threads or available_cores()))
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
    rounds = -(-len(simulation.scene.vessels) // simulation.threads)
    look = LOOK + LOOK_PAIR * states**2 + LOOK_WAVE * waves
    looks = preset.duration / (float(simulation.carrier.every[0]) * simulation.dt)
    return rounds * looks * look + preset.duration / step_of(simulation.scene.vessels[0]) * FROZEN


def _span(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


def _moves(part) -> str:
    """How a part moves, in a word."""
    return "floating" if part.floats else "moving" if part.fastest() else "still"
