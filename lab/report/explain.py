"""What a preset simulates, which models it uses and what its run will cost, without running it."""

from collections.abc import Iterator
from dataclasses import replace
from math import pi

import numpy as np

from lab.assembly.room import check_room
from lab.assembly.scene import build, grain_count
from lab.measures.ship_frozen import INTERVAL
from lab.preset.accuracy import LEVELS
from lab.preset.fields import join, taken_by
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.preset.sections.shapes import ShapeClass, caution
from lab.preset.units import show
from lab.report.ship import describe
from solvers.grains.laws import COHESION
from solvers.grains.shapes.given import Shapes
from solvers.machine.runtime import available_cores, choose_arch
from solvers.simulation import Simulation
from solvers.time.schedules import choose_schedule, units_a_world

# Grain-steps a second of one core on settled beds: between a Xeon of 2.5 GHz (15e6) and newer ones (37e6 and more;
# README, "Speed"). It is used for the estimate of the run time only.
GRAIN_STEPS_PER_CORE = 20e6
OUTLINES_PER_CORE = {"continuous": 3e6, "nodes": 3e6, "area": 3e6}  # of irregular grains
# Other parts of a run, in seconds of CPU time of one core (AMD EPYC, Zen 5): to start Python, its libraries and Taichi,
# to compile the kernels when they are new, and in addition those of a ship
STARTING = 2.0
COMPILING = {"discs": 2.0, "continuous": 8.0, "nodes": 6.0, "area": 4.5}
COMPILING_SHIP = 3.0
STEP = 0.07e-6  # of a world, without its grains
SAMPLE = 0.25e-3  # to stop and observe all worlds
# For each computation of the water's forces on a ship: at least, for each pair of states of its memory, for each wave
LOOK, LOOK_PAIR, LOOK_WAVE = 0.4e-6, 1.6e-9, 0.07e-6
FROZEN = 0.37e-3  # for each interval of the ship with her cargo frozen
REPORTING, PICTURE = 2.5, 0.026  # measures and figures; a picture and its place in the video

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


def explain(loaded: LoadedPreset) -> str:
    """A page of text on a preset: scene, step and what limits it, what is compiled in, memory, expected run time."""
    preset = loaded.resolved
    check_room(preset, grain_count(preset))
    simulation = _one_bed(preset)
    scene = simulation.scene
    blocks = [
        f"{preset.title}  ({loaded.name})",
        _section("Scene", _scene(preset, scene)),
        *_ship(preset, simulation),
        _section("Accuracy", _accuracy(preset)),
        _section("Step", _step(scene)),
        _section("Compiled in", _parts(preset, simulation)),
        _section("Cost", _cost(preset, scene, simulation)),
        "Preset in full\n" + "".join(f"    {line}\n" for line in _with_sentences(loaded.given_text)),
    ]
    simulation.close()
    return "\n".join(blocks)


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
    arch = "cpu" if scene.vessels and run.arch == "auto" else choose_arch(run.arch, run.precision)
    sizes = run.repeats, scene.radius.shape[1], run.threads or available_cores()
    schedule = choose_schedule(run.schedule, arch, *sizes, bool(scene.vessels))
    units = units_a_world(schedule, *sizes)
    return Simulation(replace(scene, schedule=schedule), position, run.threads, arch=arch, units=units)


def _section(title: str, rows: list[tuple[str, str]]) -> str:
    width = max(len(name) for name, _ in rows)
    return title + "\n" + "".join(f"    {name:<{width}}  {text}\n" for name, text in rows)


def _scene(preset, scene) -> list[tuple[str, str]]:
    worlds, count = preset.run.repeats, scene.radius.shape[1]
    small, large = 2 * scene.radius.min(), 2 * scene.radius.max()
    pair, wall = scene.interfaces
    rows = [("based on", preset.based_on)] if preset.based_on else []
    rows += [("quick variant", preset.quick)] if preset.quick else []
    rows += [
        ("repeats", f"{worlds}, seeds {preset.run.seed} to {preset.run.seed + worlds - 1}"),
        ("grains", f"{count} in each, {show(small, 'm')} to {show(large, 'm')}{' in the first' * (worlds > 1)}"),
        *(("shape", _shape(name, shape)) for name, shape in preset.shape_classes.items()),
        ("bed", _bed(preset)),
        ("tank", _tank(preset, scene)),
        ("friction", f"{pair.friction:g} between grains, {wall.friction:g} on walls"),
        ("dissipative time", f"{show(pair.dissipative_time, 's')} between grains, at this stiffness"),
    ]
    motions = preset.motion.parts
    parts = [_motion(name, motion, scene.soft_start) for name, motion in motions.items()]
    rows.append(("motion", ", then ".join(parts) or "none"))
    rows.append(("duration", show(preset.duration, "s") + " after settling"))
    return rows


def _ship(preset, simulation: Simulation) -> list[str]:
    """The section on the ship; none without a ship."""
    if not simulation.carrier.answers:
        return []
    every = int(simulation.carrier.every[0]) * simulation.dt
    vessels, tanks = simulation.scene.vessels, simulation.scene.tanks
    return [_section("Ship", describe(preset.ship, vessels[0], preset.waves, tanks[0].thickness, every))]


def _shape(name: str, shape: ShapeClass) -> str:
    """One class of irregular outlines."""
    outlines = f"{len(shape.descriptors)} descriptors" if np.any(shape.descriptors) else "a disc"
    if shape.random:
        outlines += f", phases at random, {shape.draws} outlines a repeat"
    return f"{100 * shape.share:.3g} % {name}, the area of a disc of {show(shape.diameter, 'm')}: {outlines}"


def _bed(preset) -> str:
    grains, what = preset.grains, []
    what.append(
        f"listed in {grains.bed.name}" if grains.listed else f"poured, its surface {grains.surface.replace('-', ' ')}"
    )
    what.append("settled first" if preset.run.settle else "not settled")
    if preset.shapes:
        turned = grains.orientation
        what.append("turned at random" if turned == "random" else f"all turned by {show(turned, 'rad')} at the start")
    what += [f"{100 * kind.share:g} % {name}" for name, kind in preset.kinds.items()]
    return ", ".join(what)


def _tank(preset, scene) -> str:
    width, height = (show(extent, "m") for extent in preset.tank.extent)
    what = [f"{width} wide, {height} high"]
    if preset.tank.open_edges:
        what.append("open at the top")
    if len(scene.fixed):
        what.append(f"lined with {len(scene.fixed)} fixed grains")
    moving = [f"{name} ({'moving' if part.fastest() else 'still'})" for name, part in preset.parts.items()]
    if moving:
        what.append(f"with {', '.join(moving)}")
    return ", ".join(what)


def _motion(name: str, motion, soft_start: float) -> str:
    speed = motion.fastest(soft_start)
    return f"{name}, up to {show(speed, 'rad/s' if motion.coordinate == 'turn' else 'm/s')}"


def _accuracy(preset) -> list[tuple[str, str]]:
    """The level of accuracy, and the settings that follow from it unless the preset has its own."""
    level, scale = LEVELS[preset.run.accuracy], preset.stiffness_scale
    own = "; the preset's own" if scale != level.stiffness_scale else ""
    step = f"{level.longer_steps:g} times the derived one" if level.longer_steps != 1.0 else "the derived one"
    return [
        ("level", f"{preset.run.accuracy}: {level.error}"),
        ("Young's moduli", f"times {scale:g} of the material's{own}"),
        ("step", step if preset.run.step == "auto" else "the preset's own"),
    ]


def _step(scene) -> list[tuple[str, str]]:
    limits = scene.step_limits()
    return [("step", show(scene.step, "s"))] + [
        (f"limit {k + 1}", f"{show(limit.step, 's')}: {limit.reason}") for k, limit in enumerate(limits)
    ]


def _parts(preset: Preset, simulation: Simulation) -> list[tuple[str, str]]:
    scene, carrier, walls = simulation.scene, simulation.carrier, simulation.walls
    remembered = len(simulation.grains.lists.laws.memory)
    terms = "gravity"
    if carrier.moving:
        terms += ", translation"
    if carrier.rotating:
        terms += ", Euler, centrifugal and Coriolis terms"
    laws = [("normal law", scene.normal), ("tangential law", scene.tangential)]
    if scene.shapes:
        laws.insert(0, ("outlines", _outlines(preset, scene.shapes)))
    if scene.rolling != "none":
        laws.append(("rolling law", scene.rolling))
    if scene.cohesion != "none":
        laws.append(("cohesion", _cohesion(scene)))
    return [
        *laws,
        ("memory", f"{remembered} number(s) a contact"),
        ("body forces", terms),
        ("walls", f"{walls.segments} segments, {walls.corners} corners that grains can touch"),
        ("integrator", scene.integrator),
        ("numbers", PRECISIONS[scene.precision]),
        ("schedule", f"{SCHEDULES[simulation.schedule_name]}, on {simulation.arch}"),
        ("skin", f"{show(simulation.skin, 'm')} of the neighbour lists"),
    ]


def _outlines(preset: Preset, shapes: Shapes) -> str:
    rule = shapes.contact if shapes.contact == "continuous" else f"{shapes.contact}, {shapes.nodes} nodes on each"
    rough = caution(shapes.outlines, shapes.contact)
    drawn = sum(shape.draws * preset.run.repeats if shape.random else 1 for shape in preset.shape_classes.values())
    return f"{drawn} different ones, {rule}" + (f". {rough}" if rough else "")


def _cohesion(scene) -> str:
    """The law of cohesion, and its force between two mean grains."""
    law, between, radius = COHESION[scene.cohesion](), scene.interfaces[0], scene.mean_radius
    pull = law.coefficients(between)[0] * 0.5 * radius
    weight = 4.0 / 3.0 * pi * radius**3 * scene.grain[0].density * scene.gravity
    return (
        f"{scene.cohesion}: {show(pull, 'N')}, {pull / weight:.2g} times a mean grain's weight, "
        f"across gaps of up to {show(law.range(between), 'm')}"
    )


def _cost(preset, scene, simulation: Simulation) -> list[tuple[str, str]]:
    worlds, count = preset.run.repeats, scene.radius.shape[1]
    steps = preset.duration / scene.step
    frames = preset.duration * preset.record.picture_rate
    seconds = cost_in_seconds(preset, scene, simulation)
    parts = ", ".join(f"{_span(spent)} {what}" for what, spent in seconds.items() if spent >= 0.5)
    cores = min(worlds, preset.run.threads or available_cores())
    settling = f"and at most {_span(_stepping(preset.run.settle_limit, preset, scene))} to settle a new bed"
    return [
        ("grain-steps", f"{worlds * count * steps:.3g}, and those of settling"),
        ("memory", f"{worlds * simulation.arrays.bytes / 2**20:.1f} MiB"),
        ("recording", f"{frames * worlds * count * 24 / 2**20:.0f} MiB"),
        ("run time", f"about {_span(sum(seconds.values()))} on {cores} core(s): {parts}"),
        *([("", settling)] if preset.run.settle else []),
    ]


def cost_in_seconds(preset, scene, simulation: Simulation) -> dict[str, float]:
    """Seconds that a run takes, by its parts, without settling; kernels are compiled anew and all pictures painted."""
    rule = scene.shapes.contact if scene.shapes else "discs"
    duration, record = preset.duration, preset.record
    found = {
        "to start and compile": STARTING + COMPILING[rule] + (COMPILING_SHIP if simulation.carrier.answers else 0.0),
        "of steps": _stepping(duration, preset, scene) + duration * record.series_rate * SAMPLE,
    }
    if simulation.carrier.answers:
        found["of her hull and water"] = _floating(preset, simulation)
    return found | {"of figures": REPORTING, "of pictures": duration * record.picture_rate * PICTURE}


def _stepping(duration: float, preset, scene) -> float:
    """Seconds of computation for the grains' steps over a duration (s)."""
    worlds, count = scene.radius.shape
    rounds = -(-worlds // min(worlds, preset.run.threads or available_cores()))
    speed = OUTLINES_PER_CORE[scene.shapes.contact] if scene.shapes else GRAIN_STEPS_PER_CORE
    return rounds * duration / scene.step * (STEP + count / speed)


def _floating(preset, simulation: Simulation) -> float:
    """Seconds of computation for the water's forces and for the ship with her cargo frozen."""
    states, _, waves = simulation.carrier.sizes
    rounds = -(-len(simulation.scene.vessels) // simulation.threads)
    look = LOOK + LOOK_PAIR * states**2 + LOOK_WAVE * waves
    looks = preset.duration / (float(simulation.carrier.every[0]) * simulation.dt)
    return rounds * looks * look + preset.duration / INTERVAL * FROZEN


def _span(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"
