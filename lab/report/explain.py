"""What a preset simulates, which models it uses and what its run will cost, without running it."""

import tomllib
from collections.abc import Iterator
from math import pi

from lab.assembly.grains import grain_count
from lab.assembly.room import check_room
from lab.assembly.water import most_drops
from lab.preset.fields import join, taken_by
from lab.preset.find import LoadedPreset
from lab.preset.schema import Preset
from lab.preset.sections.solids.funnel import caution, in_words
from lab.preset.units import show
from lab.report import cost, free, water
from lab.report.cargo import bulk, coarse, grains, sources
from lab.report.ship import describe
from lab.report.wet import bed
from solvers.motion.frame import is_turn
from solvers.motion.history import Recorded
from solvers.motion.sampled import Sampled
from solvers.simulation import Simulation

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
    simulation = cost.one_bed(preset)
    scene = simulation.scene
    accuracy = grains.accuracy(preset) if preset.grains else []
    found = [
        ("Scene", _scene(preset, scene)),
        ("Wet bed", bed.described(preset, scene)),
        ("Bulk", bulk.described(preset, scene)),
        ("Ship", _ship(preset, simulation)),
        ("Cargo", sources.described(preset)),
        ("Coarse grains", coarse.described(preset) if preset.grains else []),
        ("Axle", free.described(preset) if preset.axle else []),
        ("Bodies", free.bodies(preset, scene)),
        ("Accuracy", accuracy),
        ("Accuracy of the water" if accuracy else "Accuracy", water.accuracy(preset) if preset.water else []),
        ("Step", _step(simulation)),
        ("Compiled in", _parts(preset, simulation)),
        ("Cost", cost.described(preset, scene, simulation)),
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
        *_funnel(preset),
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


def _funnel(preset) -> list[tuple[str, str]]:
    """The rows on the tank's funnel; none without one."""
    funnel, warned = preset.tank.funnel, None
    if funnel is None:
        return []
    if preset.grains:
        warned = caution(funnel, preset.diameters[1])
    return [("funnel", in_words(funnel, preset.tank.corners)), *([("warning", warned)] if warned else [])]


def _motion(name: str, motion, soft_start: float) -> str:
    turns = is_turn(motion.coordinate)
    words = f"{name}, up to {show(motion.fastest(soft_start), 'rad/s' if turns else 'm/s')}"
    if isinstance(motion, Recorded):
        words += f" and {motion.hardest():.3g} {'rad' if turns else 'm'}/s²"
    if isinstance(motion, Sampled):
        unit = "deg" if turns else "mm"
        away = motion.place_error * (180.0 / pi if turns else 1e3)
        words += (
            f" (a function in {len(motion.time)} samples, off by up to {away:.1g} {unit}, and by "
            f"{100.0 * motion.acceleration_error:.1g} % of its acceleration)"
        )
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


def _moves(part) -> str:
    """How a part moves, in a word."""
    return "floating" if part.floats else "moving" if part.fastest() else "still"
