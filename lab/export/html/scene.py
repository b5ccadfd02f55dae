"""What the player shows of a stage: places over time, walls, poses, and what colours may show."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from lab.export.html.codec import COARSE, quantised, turned
from lab.paint.scene.ship import silhouette
from lab.paint.space.stance import carried, rotation
from solvers.machine.quantity import PLANE

if TYPE_CHECKING:
    from lab.export.stage import Stage
    from lab.export.things import Shape

MOST_RAW = 60_000_000  # bytes of numbers before they are packed
USUAL_RANGE = 0.5, 99.5  # percentiles between which a colour runs
SAMPLED, MANY = 60, 400  # pictures that are looked at for a box; points of which the farthest may be left out
CORNERS = 40  # of an irregular outline
SHARP = 0.95  # cosine between faces, below which the edge between them is drawn
PLAIN = {"id", "kind", "radius", "volume", "angle", "spin", "velocity"}  # no colours


class Film:
    """The pictures of a stage that a page holds, read once; `rows`: their numbers."""

    def __init__(self, stage: Stage, rows: Sequence[int], reach: Callable[[int], None]) -> None:
        self.stage, self.rows, self.axes = stage, list(rows), stage.axes
        self.clouds: dict[str, dict[str, np.ndarray]] = {name: {} for name in stage.clouds}
        self.shapes: dict[str, list[Shape]] = {}
        kept: dict[str, dict[str, list[np.ndarray]]] = {name: {} for name in stage.clouds}
        for done, row in enumerate(self.rows):
            for name in stage.clouds:
                for key, values in self._read(name, row).items():
                    kept[name].setdefault(key, []).append(values)
            for name, shape in stage.shapes(row).items():
                self.shapes.setdefault(name, []).append(shape)
            reach(done + 1)
        for name, values in kept.items():
            self.clouds[name] = {key: np.stack(one) for key, one in values.items()}

    def _read(self, name: str, row: int) -> dict[str, np.ndarray]:
        """Places, speeds, angles and scalars of all particles of a sort, NaN for those that are not there."""
        cloud, count = self.stage.cloud(name, row), self.stage.count(name)
        found = {"place": cloud.place[:, : self.axes]}
        for key, values in cloud.values.items():
            if key == "velocity":
                found["speed"] = np.linalg.norm(values, axis=1)
            elif values.ndim == 1 and (key not in PLAIN or (key == "angle" and self.axes == PLANE)):
                found[key] = values
        there = cloud.values["id"]
        if len(there) == count:
            return {key: one.astype(np.float32) for key, one in found.items()}
        whole = {key: np.full((count, *one.shape[1:]), np.nan, dtype=np.float32) for key, one in found.items()}
        for key, one in found.items():
            whole[key][there] = one
        return whole

    def scene(self, stride: int) -> dict:
        """What the player needs of each so many of these pictures."""
        stage, picked = self.stage, slice(None, None, stride)
        stance = stage.stance[self.rows[picked]]
        pose = [[*one[:3], *rotation(one[3:]).ravel()] for one in stance]
        shapes = [self._shape(name, shapes[picked]) for name, shapes in self.shapes.items()]
        if (house := _house(stage)) is not None:
            shapes.append({"name": "house", "filled": True, "cells": [list(range(len(house)))], "edges": []})
            shapes[-1]["place"] = quantised(np.repeat(house[None], len(stance), axis=0))
        return {
            "axes": self.axes,
            "time": [float(f"{t:.7g}") for t in stage.time[self.rows[picked]]],
            "pose": [[float(f"{x:.7g}") for x in one] for one in pose],
            "clouds": [self._cloud(name, picked) for name in self.clouds],
            "shapes": shapes,
            "box": self._box(stance, picked),
        }

    def _cloud(self, name: str, picked: slice) -> dict:
        values = self.clouds[name]
        given = self.stage.given(name)
        found = {"name": name, "place": quantised(values["place"][picked]), "colours": [], "outlines": []}
        found["radius"] = quantised(given["radius"][None])
        if "kind" in given:
            found["kind"], found["kinds"] = given["kind"].tolist(), self.stage.kinds
        units = self.stage.units(name) | {"speed": "m/s"}
        for key, one in values.items():
            if key == "angle":
                found["angle"] = turned(one[picked])
            elif key != "place":
                low, high = np.nanpercentile(one, USUAL_RANGE) if np.isfinite(one).any() else (0.0, 0.0)
                low = 0.0 if key == "speed" else low
                shown = quantised(one[picked], COARSE, (np.float64(low), np.float64(high)))
                found["colours"].append({"name": key, "unit": units[key], "ends": [float(low), float(high)]} | shown)
        if name == "grains" and self.stage.recording.shapes is not None:
            found |= self._outlines()
        return found

    def _outlines(self) -> dict:
        """The outlines of irregular grains about their centroids, of a disc of radius 1, and which one each has."""
        shapes, angle = self.stage.recording.shapes, 2.0 * np.pi * np.arange(CORNERS) / CORNERS
        used, which = np.unique(shapes.which[self.stage.world], return_inverse=True)
        outlines = [np.round(shapes.contours[k].points(angle), 4).tolist() for k in used]
        return {"outlines": outlines, "which": which.tolist()}

    def _shape(self, name: str, shapes: Sequence[Shape]) -> dict:
        places = np.stack([shape.points[:, : self.axes] for shape in shapes]).astype(float)
        first = shapes[0]
        cells = [cell.tolist() for cell in first.cells]
        edges = sharp_edges(first) if first.filled and self.axes > PLANE else []
        return {"name": name, "filled": first.filled, "cells": cells, "edges": edges, "place": quantised(places)}

    def _box(self, stance: np.ndarray, picked: slice) -> dict[str, list[list[float]]]:
        """Lower and upper corner (m) of all but the sea and the few particles that are far off, in both frames."""
        shapes = {name: one[picked] for name, one in self.shapes.items() if name != "waterline"}
        ends: dict[str, list[np.ndarray]] = {"tank": [], "earth": []}
        for k in range(0, len(stance), max(1, len(stance) // SAMPLED)):
            walls = [shape[k].points for shape in shapes.values()]
            clouds = [self._near(values["place"][picked][k]) for values in self.clouds.values()]
            for name in ends:
                for points in (*walls, *clouds):
                    moved = carried(points, stance[k]) if name == "earth" else points
                    if len(moved):
                        ends[name].append(np.percentile(moved, USUAL_RANGE if len(moved) > MANY else (0, 100), axis=0))
        return {
            name: [np.min(one, axis=(0, 1)).tolist(), np.max(one, axis=(0, 1)).tolist()] for name, one in ends.items()
        }

    def _near(self, place: np.ndarray) -> np.ndarray:
        """The places (k, 3) m of particles that are there."""
        there = place[np.isfinite(place).all(axis=1)].astype(float)
        return there if self.axes > PLANE else np.column_stack([there, np.zeros(len(there))])


def first_stride(stage: Stage, rows: Sequence[int]) -> int:
    """Every how many of these pictures may be read at all, for the memory that they take."""
    per = 2 * stage.axes + 4  # bytes of places, angles and colours
    raw = len(rows) * sum(per * stage.count(name) for name in stage.clouds)
    return max(1, -(-raw // MOST_RAW))


def sharp_edges(shape: Shape) -> list[list[int]]:
    """Edges of faces as [corner, corner, face, face or −1, 1 if the faces meet at an angle else 0]."""
    size = max(float(np.ptp(shape.points, axis=0).max()), 1e-300)
    rounded = np.round(shape.points / (1e-6 * size)).astype(np.int64)
    _, same = np.unique(rounded, axis=0, return_inverse=True)
    found: dict[tuple[int, int], list[int]] = {}
    normals = []
    for number, cell in enumerate(shape.cells):
        corners = shape.points[cell] - shape.points[cell[0]]
        normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
        normals.append(normal / max(float(np.linalg.norm(normal)), 1e-300))
        for a, b in zip(cell.tolist(), np.roll(cell, -1).tolist(), strict=True):
            ends = tuple(sorted((int(same.ravel()[a]), int(same.ravel()[b]))))
            if ends[0] != ends[1]:
                known = found.setdefault(ends, [a, b, number, -1, 1])
                if known[2] != number:
                    known[3], known[4] = number, int(normals[known[2]] @ normals[number] < SHARP)
    return list(found.values())


def _house(stage: Stage) -> np.ndarray | None:
    """The silhouette (m, 2) m of a ship's superstructure in the tank's axes; None without one, and in space."""
    ship = stage.recording.preset.ship
    corners = silhouette(ship) if ship and stage.axes == PLANE else None
    return None if corners is None else corners - np.array(ship.hold)
