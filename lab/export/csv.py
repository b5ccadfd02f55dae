"""Tables as CSV: the series with a row a sample, and a table for each sort of particles with a row a particle and time.

The header names each column with its unit: `position_y (m)`. Lines and faces are in tables of their corners.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

import numpy as np

from lab.base.text import cell
from lab.export.columns import columns_of
from solvers.machine.quantity import DIRECTIONS, ROTATIONS

if TYPE_CHECKING:
    from lab.export.stage import Stage

DIGITS = "%.9g"


def write_csv(stage: Stage, rows: Sequence[int], folder: Path, reach: Callable[[int], None]) -> None:
    """Write series.csv, pose.csv, a table for each sort of particles, and one for each thing, into a folder."""
    _write_series(stage, folder / "series.csv")
    shapes = stage.shapes(rows[0])
    names = ["pose", *stage.clouds, *shapes]
    files = {name: (folder / f"{name}.csv").open("w", encoding="utf-8", newline="") for name in names}
    try:
        headers = {"pose": ["time (s)", *_of_pose()]}
        headers |= {name: ["time (s)", *_of_cloud(stage, name, rows[0])] for name in stage.clouds}
        headers |= {name: ["time (s)", *_of_shape()] for name in shapes}
        for name, header in headers.items():
            csv.writer(files[name]).writerow(header)
        for done, row in enumerate(rows):
            _add(files["pose"], stage.time[row], stage.stance[row][None])
            for name in stage.clouds:
                cloud = stage.cloud(name, row)
                _add(files[name], stage.time[row], np.column_stack([cloud.place, *cloud.values.values()]))
            for name, shape in stage.shapes(row).items():
                _add_shape(files[name], stage.time[row], shape)
            reach(done + 1)
    finally:
        for file in files.values():
            file.close()


def _of_pose() -> list[str]:
    return [f"place_{axis} (m)" for axis in DIRECTIONS] + [f"turn_{axis} (rad)" for axis in DIRECTIONS]


def _of_cloud(stage: Stage, name: str, row: int) -> Iterator[str]:
    """The columns of a sort of particles, with their units."""
    units = stage.units(name)
    yield from (f"position_{axis} (m)" for axis in DIRECTIONS)
    for key, values in stage.cloud(name, row).values.items():
        unit = "" if units[key] == "1" else f" ({units[key]})"
        along = ROTATIONS if key in ("angle", "spin") else DIRECTIONS
        ends = [""] if values.ndim == 1 else [f"_{axis}" for axis in along[: values.shape[1]]]
        yield from (f"{key}{end}{unit}" for end in ends)


def _of_shape() -> list[str]:
    return ["name", "cell", "corner", *(f"position_{axis} (m)" for axis in DIRECTIONS)]


def _add(file: TextIO, time: float, numbers: np.ndarray) -> None:
    """Add lines of numbers, each behind the time (s)."""
    start = DIGITS % time
    form = ",".join([DIGITS] * numbers.shape[1])
    file.writelines(f"{start},{form % tuple(line)}\n" for line in numbers.tolist())


def _add_shape(file: TextIO, time: float, shape: object) -> None:
    writer = csv.writer(file, lineterminator="\n")
    for piece, (corners, number) in enumerate(zip(shape.cells, shape.number.tolist(), strict=True)):
        for corner, point in enumerate(shape.points[corners].tolist()):
            place = [DIGITS % x for x in point]
            writer.writerow([DIGITS % time, cell(shape.names[number]), piece, corner, *place])


def _write_series(stage: Stage, path: Path) -> None:
    """Write the series of the stage's world: a column for each component of each of its quantities."""
    series, columns = stage.recording.series, {}
    for name, quantity in series.quantities.items():
        for label, values in columns_of(stage, name, quantity):
            columns[label] = values
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([cell(label) for label in columns])
        writer.writerows([DIGITS % x for x in line] for line in np.column_stack([*columns.values()]).tolist())
