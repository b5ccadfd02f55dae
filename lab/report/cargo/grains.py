"""What is said of grains by `cargolab explain` and in summaries: what they are, how exact they are, their laws."""

from collections.abc import Iterator
from math import pi

import numpy as np

from lab.base.text import inline
from lab.preset.accuracy import LEVELS
from lab.preset.schema import Preset
from lab.preset.sections.shapes import ShapeClass, caution
from lab.preset.sections.solids.funnel import caution as arching
from lab.preset.units import show
from lab.recording import Recording
from lab.report.numbers import count_of
from solvers.grains.laws import COHESION
from solvers.grains.lists.skin import Skin
from solvers.grains.shapes.given import Shapes
from solvers.grains.timestep import FURTHEST, calm_speed
from solvers.scene import Scene
from solvers.simulation import Simulation

LARGE_OVERLAP = 0.05  # of a radius
Rows = list[tuple[str, str]]


def described(preset: Preset, scene: Scene) -> Rows:
    """The grains and their bed, each row a name and a text."""
    worlds, grains = preset.run.repeats, scene.grains
    small, large = 2 * grains.radius.min(), 2 * grains.radius.max()
    pair, wall = grains.interfaces
    return [
        (
            "grains",
            f"{grains.count} in {preset.grains.room or 'each'}, {show(small, 'm')} to {show(large, 'm')}"
            f"{' in the first' * (worlds > 1)}",
        ),
        *(("shape", _shape(name, shape)) for name, shape in preset.shape_classes.items()),
        ("bed", _bed(preset)),
        ("friction", f"{pair.friction:g} between grains, {wall.friction:g} on walls"),
        ("dissipative time", f"{show(pair.dissipative_time, 's')} between grains, at this stiffness"),
    ]


def laws(preset: Preset, simulation: Simulation) -> Rows:
    """What is compiled in for the grains, each row a name and a text."""
    given, remembered = simulation.scene.grains, len(simulation.grains.lists.laws.memory)
    rows = [("outlines", _outlines(preset, given.shapes))] if given.shapes else []
    rows += [("normal law", given.normal), ("tangential law", given.tangential)]
    if given.rolling != "none":
        rows.append(("rolling law", given.rolling))
    if given.cohesion != "none":
        rows.append(("cohesion", _cohesion(simulation.scene)))
    return [
        *rows,
        ("memory", f"{remembered} number(s) a contact"),
        ("integrator", given.integrator),
        *_longer_steps(simulation),
        ("skin", f"{_skin(simulation.grains.lists.skin)} of the neighbour lists"),
    ]


def _skin(skin: Skin) -> str:
    least, most = skin.widths.least, skin.widths.most
    return f"{show(least, 'm')} to {show(most, 'm')}, wide while grains are fast," if skin.adapts else show(least, "m")


def _longer_steps(simulation: Simulation) -> Rows:
    """When steps are longer than the step that is told, which the run time takes no account of."""
    moved = simulation.grains, simulation.carrier, simulation.parts
    if simulation.exchange_interval > 1 or not all(one.has_multiples for one in moved):
        return []
    calm = calm_speed(simulation.scene, float(simulation.largest_multiple))
    if not calm:
        return [("slow grains", "steps are never longer: they do not follow from the grains' speeds")]
    when = f"while no two grains may meet faster than {show(calm, 'm/s')}"
    share = simulation.scene.grains.base_share
    room = f", for which they are shortened to {share:.2f} of the derived one" if share < 1.0 else ""
    return [
        (
            "slow grains",
            f"steps are {simulation.largest_multiple} times as long {when}{room}; the run time below counts none",
        )
    ]


def accuracy(preset: Preset) -> Rows:
    """The level of accuracy, and the settings that follow from it unless the preset has its own."""
    level, scale = LEVELS[preset.run.accuracy], preset.stiffness_scale
    own = "" if scale == level.stiffness_scale else "; for grains of such different sizes"
    own = "; the preset's own" if preset.contact.stiffness_scale else own
    step = f"{level.longer_steps:g} times the derived one" if level.longer_steps != 1.0 else "the derived one"
    return [
        ("level", f"{preset.run.accuracy}: {level.error}"),
        ("Young's moduli", f"times {scale:g} of the material's{own}"),
        ("step", step if preset.run.step == "auto" else "the preset's own"),
    ]


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
    what.append("settled first" if preset.run.settles else "not settled")
    if preset.shapes:
        turned = grains.orientation
        what.append("turned at random" if turned == "random" else f"all turned by {show(turned, 'rad')} at the start")
    what += [f"{100 * kind.share:g} % {name}" for name, kind in preset.kinds.items()]
    return ", ".join(what)


def _outlines(preset: Preset, shapes: Shapes) -> str:
    rule = shapes.contact if shapes.contact == "continuous" else f"{shapes.contact}, {shapes.nodes} nodes on each"
    rough = caution(shapes.outlines, shapes.contact)
    drawn = sum(shape.draws * preset.run.repeats if shape.random else 1 for shape in preset.shape_classes.values())
    return f"{drawn} different ones, {rule}" + (f". {rough}" if rough else "")


def _cohesion(scene) -> str:
    """The law of cohesion, and its force between two mean grains."""
    grains = scene.grains
    law, between, radius = COHESION[grains.cohesion](), grains.interfaces[0], grains.mean_radius
    pull = law.coefficients(between)[0] * 0.5 * radius
    weight = 4.0 / 3.0 * pi * radius**3 * grains.grain[0].density * scene.gravity
    heavy = f"{pull / weight:.2g} times a mean grain's weight, " if weight else ""
    return f"{grains.cohesion}: {show(pull, 'N')}, {heavy}across gaps of up to {show(law.range(between), 'm')}"


def in_tank(recording: Recording) -> Iterator[str]:
    """What a summary says of the grains, a line each."""
    worlds, count = recording.radius.shape
    low, high = show(2 * recording.radius.min(), "m"), show(2 * recording.radius.max(), "m")
    size = low if low == high else f"{low} to {high}"
    yield f"{count_of(worlds, 'bed')} of {count_of(count, 'grain')}, {size} in diameter"
    shapes = recording.preset.shape_classes
    if shapes:
        parts = [f"{100 * shape.share:.3g} % {inline(name)}" for name, shape in shapes.items()]
        yield f"irregular grains, diameters those of discs of equal area: {', '.join(parts)}"


def cautions(recording: Recording) -> Iterator[str]:
    """What a reader must know about how the grains were computed."""
    scale = recording.preset.stiffness_scale
    if scale < 1:
        yield f"The grains are softer than their material: Young's moduli times {scale:g}, {_softened(recording)}."
    funnel = recording.preset.tank.funnel
    if funnel and (narrow := arching(funnel, recording.preset.diameters[1])):
        yield narrow
    rule = recording.preset.contact.outlines
    if recording.shapes and (rough := caution(recording.shapes.contours, rule)):
        yield rough
    if recording.preset.run.force_step:
        yield f"The step is forced past the derived one: at {FURTHEST:g} times that the restitution errs by up to 1 %."
    overlap = recording.series["overlap"].max(initial=0.0)
    if overlap > LARGE_OVERLAP:
        yield f"Grains overlapped by up to {100 * overlap:.1f} % of a radius."


def _softened(recording: Recording) -> str:
    """Which key of the preset makes the grains softer."""
    if recording.preset.contact.stiffness_scale:
        return "set by contact.stiffness_scale"
    return f'set by run.accuracy = "{recording.preset.run.accuracy}"'
