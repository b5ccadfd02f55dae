"""Draw the outlines and starting angles of irregular grains, each repeat from its own seed."""

from itertools import accumulate

import numpy as np

from lab.base.errors import LabError
from lab.preset.schema import Preset
from solvers.grains.bed.sizes import apportion
from solvers.grains.shapes.given import Shapes
from solvers.machine.errors import BadOutline

STREAM = 2  # of the random numbers of a repeat, beside those of sizes and places and those of kinds
MOST_OUTLINES = 20_000


def draw_shapes(preset: Preset, count: int) -> Shapes | None:
    """The outlines of `count` grains in each repeat, and their angles at the start; None if all are discs.

    The outlines are in the order of `classes`. Those of a repeat do not depend on the other repeats. Raises LabError
    for an impossible outline.
    """
    if not preset.shapes:
        return None
    repeats = preset.run.repeats
    if len(classes(preset)) > MOST_OUTLINES:
        raise LabError(f"run.repeats: {repeats} repeats have more than {MOST_OUTLINES} outlines; ask for fewer draws.")
    random = [np.random.default_rng([preset.run.seed + w, STREAM]) for w in range(repeats)]
    outlines = [outline for name in preset.shapes for outline in _outlines(preset, name, random)]
    return Shapes(
        outlines=tuple(outlines),
        which=np.stack([r.permutation(_ordered(preset, count, w)) for w, r in enumerate(random)]),
        angle=np.stack([_angles(preset, count, r) for r in random]),
        contact=preset.contact.outlines,
        nodes=preset.contact.nodes,
        reach=max(shape.reach for shape in preset.shape_classes.values()),
        least_mass=min(shape.least_mass for shape in preset.shape_classes.values()),
    )


def classes(preset: Preset) -> np.ndarray:
    """The class (K,) of each outline of the scene, a number in the order of the preset's shapes.

    Class by class; within one whose phases are random, repeat by repeat.
    """
    return np.repeat(np.arange(len(preset.shapes)), _numbers(preset))


def _numbers(preset: Preset) -> list[int]:
    """How many outlines each class has, in all repeats."""
    return [shape.draws * preset.run.repeats if shape.random else 1 for shape in preset.shape_classes.values()]


def _outlines(preset: Preset, name: str, random: list[np.random.Generator]) -> list:
    shape = preset.shape_classes[name]
    try:
        return [outline for r in (random if shape.random else random[:1]) for outline in shape.outlines(r)]
    except BadOutline as error:
        raise LabError(f"shapes.{name}: among its random phases are some that cannot be: {error}") from None


def _ordered(preset: Preset, count: int, repeat: int) -> np.ndarray:
    """The outline (n,) of each grain of a repeat, class by class: each class has its share, divided equally."""
    shapes = preset.shape_classes.values()
    each = apportion([shape.share * count for shape in shapes])
    first = accumulate(_numbers(preset)[:-1], initial=0)
    own = [start + repeat * shape.draws * shape.random for start, shape in zip(first, shapes, strict=True)]
    parts = zip(own, each, shapes, strict=True)
    return np.concatenate([start + np.arange(number) % shape.draws for start, number, shape in parts])


def _angles(preset: Preset, count: int, random: np.random.Generator) -> np.ndarray:
    if preset.grains.orientation == "random":
        return random.uniform(0.0, 2.0 * np.pi, count)
    return np.full(count, preset.grains.orientation)
