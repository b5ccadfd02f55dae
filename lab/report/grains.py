"""The rows of `cargolab explain` on grains: what they are, how exactly they are computed, their laws."""

from math import pi

import numpy as np

from lab.preset.accuracy import LEVELS
from lab.preset.schema import Preset
from lab.preset.sections.shapes import ShapeClass, caution
from lab.preset.units import show
from solvers.grains.laws import COHESION
from solvers.grains.shapes.given import Shapes
from solvers.scene import Scene
from solvers.simulation import Simulation

Rows = list[tuple[str, str]]


def described(preset: Preset, scene: Scene) -> Rows:
    """The grains and their bed, each row a name and a text."""
    worlds, count = preset.run.repeats, scene.radius.shape[1]
    small, large = 2 * scene.radius.min(), 2 * scene.radius.max()
    pair, wall = scene.interfaces
    return [
        ("grains", f"{count} in each, {show(small, 'm')} to {show(large, 'm')}{' in the first' * (worlds > 1)}"),
        *(("shape", _shape(name, shape)) for name, shape in preset.shape_classes.items()),
        ("bed", _bed(preset)),
        ("friction", f"{pair.friction:g} between grains, {wall.friction:g} on walls"),
        ("dissipative time", f"{show(pair.dissipative_time, 's')} between grains, at this stiffness"),
    ]


def laws(preset: Preset, simulation: Simulation) -> Rows:
    """What is compiled in for the grains, each row a name and a text."""
    scene, remembered = simulation.scene, len(simulation.grains.lists.laws.memory)
    rows = [("outlines", _outlines(preset, scene.shapes))] if scene.shapes else []
    rows += [("normal law", scene.normal), ("tangential law", scene.tangential)]
    if scene.rolling != "none":
        rows.append(("rolling law", scene.rolling))
    if scene.cohesion != "none":
        rows.append(("cohesion", _cohesion(scene)))
    return [
        *rows,
        ("memory", f"{remembered} number(s) a contact"),
        ("integrator", scene.integrator),
        ("skin", f"{show(simulation.skin, 'm')} of the neighbour lists"),
    ]


def accuracy(preset: Preset) -> Rows:
    """The level of accuracy, and the settings that follow from it unless the preset has its own."""
    level, scale = LEVELS[preset.run.accuracy], preset.stiffness_scale
    own = "; the preset's own" if scale != level.stiffness_scale else ""
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
    what.append("settled first" if preset.run.settle else "not settled")
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
    law, between, radius = COHESION[scene.cohesion](), scene.interfaces[0], scene.mean_radius
    pull = law.coefficients(between)[0] * 0.5 * radius
    weight = 4.0 / 3.0 * pi * radius**3 * scene.grain[0].density * scene.gravity
    return (
        f"{scene.cohesion}: {show(pull, 'N')}, {pull / weight:.2g} times a mean grain's weight, "
        f"across gaps of up to {show(law.range(between), 'm')}"
    )
