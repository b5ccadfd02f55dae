"""VTKHDF, the file format of VTK and ParaView: a file of points, lines or faces a thing, over time.

Source: Kitware, "VTKHDF File Format" (version 2.0 of the format: PolyData with the group Steps). Cells are written once
for all times; values that do not change from one time to the next are written once, too.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import h5py
import numpy as np

if TYPE_CHECKING:
    from lab.export.stage import Stage
    from lab.export.things import Shape

VERSION = 2, 0
KINDS = "Vertices", "Lines", "Polygons", "Strips"
CHUNK = 8192  # rows
SHORT = {"f": "<f4", "i": "<i4", "u": "<i4"}  # how numbers are stored, by their kind


def write_vtkhdf(stage: Stage, rows: Sequence[int], folder: Path, reach: Callable[[int], None]) -> None:
    """Write a file for each sort of particles, for the tank, the parts, the hull and the waterline into a folder."""
    names = [*stage.clouds, *stage.shapes(rows[0])]
    files = {name: PolyFile(folder / f"{name}.vtkhdf") for name in names}
    try:
        for done, row in enumerate(rows):
            time, pose = float(stage.time[row]), stage.stance[row]
            for name in stage.clouds:
                cloud = stage.cloud(name, row)
                files[name].add(time, pose, cloud.place, _vertices(len(cloud.place)), cloud.values, {})
            for name, shape in stage.shapes(row).items():
                files[name].add(time, pose, shape.points, _joined(shape), {}, {"number": shape.number})
            reach(done + 1)
    finally:
        for file in files.values():
            file.close()


def _vertices(count: int) -> tuple[str, np.ndarray, np.ndarray]:
    """Each point is a cell."""
    return "Vertices", np.ones(count, dtype=int), np.arange(count)


def _joined(shape: Shape) -> tuple[str, np.ndarray, np.ndarray]:
    """The lines or faces of a shape."""
    sizes = np.array([len(cell) for cell in shape.cells], dtype=int)
    return "Polygons" if shape.filled else "Lines", sizes, np.concatenate([np.zeros(0, dtype=int), *shape.cells])


class PolyFile:
    """A VTKHDF file of PolyData that grows by a time at a time; `close` makes it whole."""

    def __init__(self, path: Path) -> None:
        self._file = h5py.File(path, "w")
        self._root = self._file.create_group("VTKHDF")
        self._root.attrs["Version"] = np.array(VERSION, dtype="<i8")
        self._root.attrs["Type"] = np.bytes_("PolyData")
        self._count, self._places = 0, 0
        self._last: dict[str, tuple[np.ndarray, int]] = {}  # of values by name: the last ones, and where they are
        self._cells: tuple[str, np.ndarray, np.ndarray] = ("Vertices", np.zeros(0, dtype=int), np.zeros(0, dtype=int))
        self._rows: dict[str, list] = {}  # a row a time of what is small, by name

    def add(
        self,
        time: float,
        pose: np.ndarray,
        points: np.ndarray,
        cells: tuple[str, np.ndarray, np.ndarray],
        of_points: Mapping[str, np.ndarray],
        of_cells: Mapping[str, np.ndarray],
    ) -> None:
        """Add a time (s): pose (6,) of the tank, points (n, 3) m, cells, and values of both by name.

        cells: one of KINDS, how many corners each cell has, and the points that they join, one cell after the other.
        The cells of a time may be the first ones of another time's, but must not be others.
        """
        kind, sizes, joined = cells
        if len(sizes) > len(self._cells[1]) or not self._count:
            self._cells = cells
        for name in KINDS:
            own = name == kind
            self._row(f"{name}/NumberOfCells", len(sizes) if own else 0)
            self._row(f"{name}/NumberOfConnectivityIds", len(joined) if own else 0)
        self._row("NumberOfPoints", len(points))
        steps = {"Values": time, "PartOffsets": self._count, "NumberOfParts": 1, "PointOffsets": self._places}
        nothing = np.zeros(len(KINDS), dtype=int)
        steps |= {"CellOffsets": nothing, "ConnectivityIdOffsets": nothing, "FieldDataSizes/pose": (len(pose), 1)}
        for name, value in steps.items():
            self._row(f"Steps/{name}", value)
        self._put("Points", points, "<f4")
        for place, values in {"PointData": of_points, "CellData": of_cells, "FieldData": {"pose": pose[None]}}.items():
            for name, one in values.items():
                self._add_values(place, name, one)
        self._places += len(points)
        self._count += 1

    def close(self) -> None:
        """Write the cells and what is small, and close the file."""
        kind, sizes, joined = self._cells
        for name in KINDS:
            own = name == kind
            self._root[f"{name}/Offsets"] = np.cumsum([0, *(sizes if own else ())], dtype="<i8")
            self._root[f"{name}/Connectivity"] = np.asarray(joined if own else (), dtype="<i8")
        for name, rows in self._rows.items():
            self._root[name] = np.array(rows, dtype="<f8" if name == "Steps/Values" else "<i8")
        self._root.require_group("Steps").attrs["NSteps"] = self._count
        self._file.close()

    def _add_values(self, place: str, name: str, values: np.ndarray) -> None:
        """Add values of a time, unless they are those of the time before."""
        full = f"{place}/{name}"
        before, offset = self._last.get(full, (None, 0))
        if before is None or not np.array_equal(before, values):
            offset = len(self._root[full]) if full in self._root else 0
            self._put(full, values, SHORT[np.asarray(values).dtype.kind])
            self._last[full] = np.array(values), offset
        self._row(f"Steps/{place}Offsets/{name}", offset)

    def _row(self, name: str, value: object) -> None:
        self._rows.setdefault(name, []).append(value)

    def _put(self, name: str, values: np.ndarray, kind: str) -> None:
        """Add values to the end of a data set."""
        values = np.asarray(values, dtype=kind)
        if name not in self._root:
            rows, shape = max(1, min(CHUNK, len(values))), values.shape[1:]
            self._root.create_dataset(name, (0, *shape), kind, maxshape=(None, *shape), chunks=(rows, *shape))
        data = self._root[name]
        data.resize(len(data) + len(values), axis=0)
        data[len(data) - len(values) :] = values
