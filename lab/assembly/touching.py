"""The grains of a recording and what they touch, of which the contact forces of its frames can be found again."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol

import numpy as np

from lab.assembly.grains import grains_of
from lab.preset.schema import Preset
from lab.preset.sections.parts import parts_of
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.scene import Scene

STILL = 1e-9  # s, the step: in one of them nothing moves


class Drawn(Protocol):
    """The recorded outlines of irregular grains, and which (W, n) of them each has."""

    contours: Sequence[Contour]
    which: np.ndarray


class Recorded(Protocol):
    """What of a recording decides on its contacts; fields as in `lab.recording.Recording`."""

    radius: np.ndarray
    kind: np.ndarray
    outline: np.ndarray
    open_edges: Sequence[int]
    fixed: np.ndarray
    shapes: Drawn | None


def parts_met(preset: Preset) -> list[str]:
    """The names of the parts that grains may touch: all, or those in the room of a hull that the grains are in."""
    room = preset.grains.room
    return [name for name, part in preset.parts.items() if room is None or part.tank == room]


def touching(preset: Preset, recorded: Recorded) -> Scene:
    """The recorded grains of all repeats of a preset with walls and parts, in a tank at rest and without water."""
    given, _ = grains_of(preset)
    shapes, drawn = None, recorded.shapes
    if drawn:
        angle, contact = np.zeros(drawn.which.shape), preset.contact
        shapes = Shapes(tuple(drawn.contours), drawn.which, angle, contact.outlines, contact.nodes)
    own = {"velocity": None, "spin": None, "kind": np.asarray(recorded.kind, dtype=int) if preset.kinds else None}
    met = [part for part, name in zip(parts_of(preset), preset.parts, strict=True) if name in parts_met(preset)]
    scene = Scene(
        np.array(preset.hold.corners if preset.grains.room else recorded.outline),
        (replace(given, **own, radius=recorded.radius, fixed=recorded.fixed, shapes=shapes),),
        gravity=preset.run.gravity,
        open_edges=tuple(recorded.open_edges),
        parts=tuple(replace(part, tank=0, free=None) for part in met),
        thickness=preset.thickness,
        length=preset.tank.length,
        solid=preset.tank.solid,
    )
    return replace(scene, step=STILL)
