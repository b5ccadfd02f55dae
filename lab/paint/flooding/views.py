"""A flooded ship cut open, across at the damage or along her middle plane: hull, rooms with their water, the sea.

A view is a list of shapes in the earth's axes, m from where she stands and above the sea, for one moment.
"""

from dataclasses import dataclass

import numpy as np

from lab.naval.flooding.build import Built
from lab.paint.scene.ship import clipped
from solvers.ship.flooding.balance import Pose
from solvers.ship.flooding.openings import SEA, Opening
from solvers.ship.flooding.run import Moment

MARK = 0.012  # of the view's size: least half length of an opening that is seen end on


@dataclass(frozen=True, eq=False)
class View:
    """Polygons (m, 2) m: the hull, each room and the water in it; openings as lines (2, 2) m, open or not, by name."""

    hull: np.ndarray
    rooms: list[np.ndarray]
    water: list[np.ndarray]
    openings: dict[str, tuple[np.ndarray, bool]]


class Section:
    """The cut across her at the place x (m) of the first opening to the sea, seen from astern: starboard right."""

    title = "section at the damage"

    def __init__(self, built: Built):
        self._built = built
        ways = [one for one in built.flooding.openings if SEA in one.between] or list(built.flooding.openings)
        self._x = float(ways[0].centre[0])
        form = built.form
        stations = [k for k, one in enumerate(form.sections) if one is not None]
        nearest = min(stations, key=lambda k: abs(form.x[k] - self._x))
        self._hull = form.sections[nearest].outline
        rooms = built.ship.rooms.rooms
        self._rooms = [k for k, one in enumerate(rooms) if one.aft <= self._x <= one.forward]
        self._openings = [one for one in built.flooding.openings if self._near(one)]

    def at(self, moment: Moment, done: dict[str, float]) -> View:
        """The view at a moment; `done`: when doors gave way."""
        pose, rooms = moment.pose, self._built.ship.rooms.rooms
        shapes = [self._turned(rooms[k].outline, pose) for k in self._rooms]
        water = [
            clipped(shape, moment.level[k]) if moment.volume[k] > 0.0 else np.zeros((0, 2))
            for k, shape in zip(self._rooms, shapes, strict=True)
        ]
        size = float(np.ptp(self._hull, axis=0).max())
        openings = {}
        for one in self._openings:
            line = _longest(one.corners[:, 1:], MARK * size)
            openings[one.name] = self._turned(line, pose), is_open(one, moment.time, done)
        return View(self._turned(self._hull, pose), shapes, water, openings)

    def _near(self, one: Opening) -> bool:
        names = {self._built.ship.rooms.names[k] for k in self._rooms} | {SEA}
        return set(one.between) <= names

    def _turned(self, points: np.ndarray, pose: Pose) -> np.ndarray:
        cos, sin = np.cos(pose.roll), np.sin(pose.roll)
        y, z = points.T
        return np.column_stack([cos * y - sin * z, sin * y + cos * z - pose.level - pose.slope * self._x])


class Profile:
    """The cut along her middle plane, the bow to the right; rooms aside are shown in it, too."""

    title = "profile"

    def __init__(self, built: Built):
        self._built = built
        form = built.form
        kept = [(x, one.outline[:, 1]) for x, one in zip(form.x, form.sections, strict=True) if one is not None]
        keel = np.array([(x, float(z.min())) for x, z in kept])
        deck = np.array([(x, float(z.max())) for x, z in kept])
        self._hull = np.concatenate([keel, deck[::-1]])
        self._rooms = [
            np.array([[one.aft, low], [one.forward, low], [one.forward, high], [one.aft, high]])
            for one in built.ship.rooms.rooms
            for low, high in [(float(one.outline[:, 1].min()), float(one.outline[:, 1].max()))]
        ]

    def at(self, moment: Moment, done: dict[str, float]) -> View:
        """The view at a moment; `done`: when doors gave way."""
        pose = moment.pose
        water = []
        for k, (room, level) in enumerate(zip(self._rooms, moment.level, strict=True)):
            full = moment.volume[k] / self._built.ship.rooms.full[k]
            shape = clipped(self._turned(room, pose), level) if full > 0.0 else np.zeros((0, 2))
            water.append(shape)
        openings = {}
        for one in self._built.flooding.openings:
            size = float(np.ptp(self._hull, axis=0).max())
            line = _longest(one.corners[:, [0, 2]], MARK * size)
            openings[one.name] = self._turned(line, pose), is_open(one, moment.time, done)
        rooms = [self._turned(room, pose) for room in self._rooms]
        return View(self._turned(self._hull, pose), rooms, water, openings)

    def _turned(self, points: np.ndarray, pose: Pose) -> np.ndarray:
        x, z = points.T
        up = np.cos(pose.roll) * z
        along = (x + pose.slope * up) * pose.tilt
        return np.column_stack([along, (up - pose.level - pose.slope * x) * pose.tilt])


def is_open(one: Opening, time: float, done: dict[str, float]) -> bool:
    """Whether an opening lets water by freely at a time (s)."""
    return (one.opens is not None and time >= one.opens) or done.get(one.name, np.inf) <= time


def _longest(points: np.ndarray, least: float) -> np.ndarray:
    """Ends (2, 2) m of an opening in a cut, at least twice `least` (m) long."""
    centre = points.mean(axis=0)
    spread = np.ptp(points, axis=0)
    axis = int(np.argmax(spread))
    half = np.zeros(2)
    half[axis] = max(0.5 * spread[axis], least)
    return np.array([centre - half, centre + half])
