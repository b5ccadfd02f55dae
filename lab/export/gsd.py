"""GSD, the file format of HOOMD-blue, which OVITO reads.

Source: the GSD schema "hoomd", version 1.4 (Glaser and others; gsd.readthedocs.io), written by the library gsd. Lengths
are in m. Corners of walls, parts, hull and waterline are particles of these types; bonds of the same names join them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lab.base.errors import LabError
from lab.export.columns import species, table, types_of
from solvers.machine.quantity import PLANE

if TYPE_CHECKING:
    from lab.export.stage import Stage

THIN = 0.004  # diameter of a corner over the size of all
ROOM = 1.02  # of the box over what is in it
OWN = "position", "velocity", "radius"  # what the schema has by itself; other values are logged under their names


def write_gsd(stage: Stage, rows: Sequence[int], path: Path, reach: Callable[[int], None]) -> None:
    """Write all particles, and the corners of all things, at these pictures."""
    try:
        import gsd.hoomd
    except ImportError:
        raise LabError("to gsd needs the library gsd: pip install 'cargo-shift-lab[export]'.") from None
    box = _box(stage, rows)
    with gsd.hoomd.open(path, "w") as file:
        for done, row in enumerate(rows):
            file.append(_picture(gsd.hoomd.Frame(), stage, row, box, done))
            reach(done + 1)


def _box(stage: Stage, rows: Sequence[int]) -> np.ndarray:
    """Lengths (3,) m of a box about the origin that holds everything at all times."""
    most = np.zeros(3)
    for row in rows:
        places = [stage.cloud(name, row).place for name in stage.clouds]
        for points in (*places, *(shape.points for shape in stage.shapes(row).values())):
            most = np.maximum(most, np.abs(points).max(axis=0, initial=0.0))
    return 2.0 * ROOM * most


def _picture(frame: object, stage: Stage, row: int, box: np.ndarray, number: int) -> object:
    sorts, values = table(stage, row)
    words, shapes = types_of(stage), stage.shapes(row)
    own = [words.index(word) for word in species(stage, sorts, values)]
    corners = np.concatenate([np.zeros((0, 3)), *(shape.points for shape in shapes.values())])
    count, more = len(sorts), len(corners)
    flat = stage.axes == PLANE
    frame.configuration.step = number
    frame.configuration.dimensions = 2 if flat else 3
    frame.configuration.box = [*box[:2], 0.0 if flat else box[2], 0.0, 0.0, 0.0]
    particles = frame.particles
    particles.N = count + more
    particles.types = [*words, *shapes]
    numbers = [np.full(len(shape.points), len(words) + k) for k, shape in enumerate(shapes.values())]
    particles.typeid = np.concatenate([np.array(own, dtype=int), *numbers]).astype(np.uint32)
    particles.position = np.concatenate([values["position"], corners]).astype(np.float32)
    particles.velocity = _with(values.get("velocity", np.zeros((count, 3))), more).astype(np.float32)
    thin = np.full(more, THIN * float(box.max()))
    particles.diameter = np.concatenate([2.0 * values["radius"], thin]).astype(np.float32)
    if "angle" in values and values["angle"].ndim == 1:
        particles.orientation = _quaternions(_with(np.nan_to_num(values["angle"]), more)).astype(np.float32)
    _join(frame.bonds, shapes, count)
    frame.log = {"time": np.array([stage.time[row]]), "tank_pose": stage.stance[row]}
    for name, one in values.items():
        if name not in OWN:
            blank = -1 if one.dtype.kind == "i" else np.nan
            frame.log[f"particles/{name}"] = _with(one, more, blank)
    return frame


def _with(values: np.ndarray, more: int, blank: float = 0.0) -> np.ndarray:
    """Values of particles with those of the corners behind them, which have none."""
    return np.concatenate([values, np.full((more, *values.shape[1:]), blank, dtype=values.dtype)])


def _quaternions(angle: np.ndarray) -> np.ndarray:
    """The quaternions (n, 4) of turns (n,) about the third axis: cos φ/2, 0, 0, sin φ/2."""
    nothing = np.zeros(len(angle))
    return np.column_stack([np.cos(0.5 * angle), nothing, nothing, np.sin(0.5 * angle)])


def _join(bonds: object, shapes: dict, start: int) -> None:
    """Join the corners of lines, and those about faces, by bonds."""
    pairs, kinds = [], []
    for number, shape in enumerate(shapes.values()):
        for cell in shape.cells:
            after = np.roll(cell, -1) if shape.filled else cell[1:]
            pairs.append(start + np.column_stack([cell[: len(after)], after]))
            kinds += [number] * len(after)
        start += len(shape.points)
    bonds.types = list(shapes)
    bonds.N = len(kinds)
    bonds.group = np.concatenate([np.zeros((0, 2), dtype=int), *pairs]).astype(np.uint32)
    bonds.typeid = np.array(kinds, dtype=np.uint32)
