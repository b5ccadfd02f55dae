"""Flooding in time: volumes of water and air in each room, and how the ship lies, from the first inflow on.

dv_i/dt = Σ Q into room i. The volumes, the air of rooms that are not vented, and heave and roll where she moves are
integrated by LSODA (Petzold 1983), which changes to an implicit method where small rooms level out fast. Without motion
she lies at each evaluation as she comes to rest with the water that is in her. Steps end where a cover opens and where
a door gives way.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from solvers.ship.flooding import air
from solvers.ship.flooding.balance import Floating, Plunges, Pose
from solvers.ship.flooding.motion import Inertia, accelerations, height_of, pose_of
from solvers.ship.flooding.openings import SEA, Flow, Opening, Side, through
from solvers.ship.flooding.rooms import Filled

RELATIVE, ABSOLUTE = 1e-6, 1e-9  # errors of a step, of values and of rooms' volumes
OF_AIR = 1e-6  # the same of the air in them
ROWS = 200  # at least so many moments of a run are kept
FEWEST = 50  # steps of a run
SLACK = 1e-9  # of the run: moments this near to each other are one


@dataclass(frozen=True, eq=False)
class Moment:
    """One moment of a run: time (s), volumes and air (n,) m³, levels (n,) m above the sea, flows (k,), and her pose."""

    time: float
    volume: np.ndarray
    overpressure: np.ndarray
    level: np.ndarray
    flow: np.ndarray
    pose: Pose


@dataclass(frozen=True, eq=False)
class Course:
    """What happened: moments in order, the end ("afloat", "capsized", "sunk" or "plunged"), and times (s) of doors."""

    moments: list[Moment]
    end: str
    doors: dict[str, float] = field(default_factory=dict)


@dataclass(eq=False)
class Flooding:
    """A ship with openings that floods from a pose on, for a `duration` (s); `inertia`: she moves, None: she rests."""

    ship: Floating
    openings: Sequence[Opening]
    start: Pose
    duration: float
    inertia: Inertia | None = None
    outside: float = air.PRESSURE

    def __post_init__(self):
        rooms = self.ship.rooms
        self._closed = np.array([not one.vented for one in rooms.rooms], dtype=bool)
        self._index = np.array([one.index for one in rooms.rooms])
        place = {SEA: -1} | {name: k for k, name in enumerate(rooms.names)}
        self._ends = [(place[one.between[0]], place[one.between[1]]) for one in self.openings]
        self._depth = float(np.ptp(self.ship.hull.reach(0.0, 0.0)))
        self._row = self.duration / ROWS
        self._begin()

    def _begin(self) -> None:
        self._collapsed: dict[str, float] = {}
        self._near, self._most = self.start, np.inf  # where she lay last; water (m³) with which she had no rest

    def course(self) -> Course:
        """The whole run."""
        self._begin()
        rooms = self.ship.rooms
        volume = np.array([one.water for one in rooms.rooms])
        state = [volume, (rooms.full - volume)[self._closed]]
        if self.inertia is not None:
            state.append([height_of(self.ship, self.start), 0.0, self.start.roll, 0.0])
        now, found, end = np.concatenate(state), [], "afloat"
        marks = sorted({one.opens for one in self.openings if one.opens and one.opens < self.duration})
        marks, time = [*marks, self.duration], 0.0
        try:
            first, end = self._moment(0.0, now)
            found += [first] if first else []
            while end == "afloat" and time < self.duration * (1.0 - SLACK):
                until = next(mark for mark in marks if mark > time * (1.0 + SLACK) + SLACK * self.duration)
                time, now, end = self._advance(time, now, until, found)
        except Plunges:
            end = "plunged"
        return Course(found, end, dict(self._collapsed))

    def _advance(self, time: float, state: np.ndarray, until: float, found: list[Moment]):
        """From a time to a mark, or to where a door gives way or she is lost: time, state, end."""
        from scipy.integrate import LSODA  # slow to import

        how = {"rtol": RELATIVE, "atol": self._tolerance(), "max_step": self.duration / FEWEST}
        solver = LSODA(self.rates, time, state, until, **how)
        while solver.status == "running":
            before = solver.t
            solver.step()
            between = solver.dense_output()
            for row in self._rows(before, solver.t, until):
                now = between(row) if row < solver.t else solver.y.copy()
                moment, end = self._moment(row, now)
                if end != "afloat":
                    return row, now, end
                self._near, self._most = moment.pose, np.inf
                found.append(moment)
                if broken := self._broken():
                    self._collapsed |= dict.fromkeys(broken, row)
                    return row, now, "afloat"
        return until, solver.y, "afloat"

    def _rows(self, before: float, after: float, until: float) -> list[float]:
        """The moments to be kept after a time and up to another: each multiple of a row, and the mark at the end."""
        first, last = int(before / self._row * (1.0 + SLACK)) + 1, int(after / self._row * (1.0 + SLACK))
        rows = [min(number * self._row, after) for number in range(first, last + 1)]
        return rows if after < until or (rows and rows[-1] >= until) else [*rows, until]

    def rates(self, time: float, state: np.ndarray) -> np.ndarray:
        """Rates of all that is integrated."""
        volume, amount, motion = self._parts(state)
        pose = self._pose_or_last(volume, motion)
        filled = self.ship.rooms.filled(volume, pose.slope, pose.roll)
        flows, pressure = self.flows(time, volume, amount, pose, filled)
        water, gas = np.zeros(len(volume) + 1), np.zeros(len(volume) + 1)  # the last one is the sea's
        for (one, two), flow in zip(self._ends, flows, strict=True):
            water[one] -= flow.water
            water[two] += flow.water
            if flow.air:
                source = one if flow.air > 0.0 else two
                upstream = pressure[source] if source >= 0 else 0.0
                index = self._index[source] if source >= 0 else 1.0
                moved = air.as_air(flow.air, self.ship.water.density, upstream, index, self.outside)
                gas[one] -= moved
                gas[two] += moved
        rates = [water[:-1], gas[:-1][self._closed]]
        if self.inertia is not None:
            speed = motion[1], motion[3]
            up, turn = accelerations(self.ship, self.inertia, volume, pose, filled, speed)
            rates.append([motion[1], up, motion[3], turn])
        return np.concatenate(rates)

    def flows(self, time, volume, amount, pose: Pose, filled: Filled) -> tuple[list[Flow], np.ndarray]:
        """What flows through each opening at a time (s), and the air's overpressure (n,) Pa in each room."""
        water, rooms = self.ship.water, self.ship.rooms
        pressure = np.zeros(len(rooms))
        if self._closed.any():
            room = (rooms.full - volume)[self._closed]
            full, index = rooms.full[self._closed], self._index[self._closed]
            pressure[self._closed] = air.overpressure(amount, room, full, index, self.outside)
        weight = water.density * water.gravity
        levels = (filled.level - pose.level) * pose.tilt
        sides = [*map(Side, levels, pressure / weight), Side(0.0)]
        found = []
        for opening, (one, two) in zip(self.openings, self._ends, strict=True):
            at = float(pose.heights(opening.centre))
            whole = through(opening, pose.up, at, (sides[one], sides[two]), water.gravity, self._depth)
            share = opening.share(time, whole.head, opening.name in self._collapsed)
            found.append(Flow(share * whole.water, share * whole.air, whole.head))
        return found, pressure

    def _parts(self, state: np.ndarray):
        """Volumes (n,), air of all rooms that are not vented, and heave and roll."""
        count, closed = len(self.ship.rooms), int(self._closed.sum())
        return state[:count], state[count : count + closed], state[count + closed :]

    def _pose(self, volume: np.ndarray, motion: np.ndarray) -> Pose | None:
        if self.inertia is not None:
            return pose_of(self.ship, motion[0], motion[2], self.start.slope)
        volume = np.clip(volume, 0.0, self.ship.rooms.full)
        return None if self.ship.sinks(volume) else self.ship.rest(volume, self._near)

    def _pose_or_last(self, volume: np.ndarray, motion: np.ndarray) -> Pose:
        """How she lies; a step that leads beyond where she is lost goes on as she lay, until its end is looked at."""
        if volume.sum() >= self._most:
            return self._near
        try:
            pose = self._pose(volume, motion)
        except Plunges:
            pose = None
        if pose is None:
            self._most = volume.sum()
        return pose or self._near

    def _moment(self, time: float, state: np.ndarray) -> tuple[Moment | None, str]:
        """What there is at a time (s), and what has become of her; no moment where she has no place."""
        volume, amount, motion = self._parts(state)
        kept = np.clip(volume, 0.0, self.ship.rooms.full)
        if self.inertia is None and self.ship.sinks(kept):
            return None, "sunk"
        pose = self._pose(volume, motion)
        if pose is None:
            return None, "capsized"
        deep = pose.level > 2.0 * float(self.ship.hull.reach(pose.slope, pose.roll)[1][0])
        end = "capsized" if abs(pose.roll) > self.ship.capsize else "sunk" if deep else "afloat"
        filled = self.ship.rooms.filled(volume, pose.slope, pose.roll)
        flows, pressure = self.flows(time, volume, amount, pose, filled)
        levels = (filled.level - pose.level) * pose.tilt
        self._heads = [one.head for one in flows]
        return Moment(float(time), kept, pressure, levels, np.array([one.water for one in flows]), pose), end

    def _broken(self) -> list[str]:
        """Closed doors that give way at the last moment's heads."""
        doors = [(one, head) for one, head in zip(self.openings, self._heads, strict=True) if one.collapse is not None]
        return [one.name for one, head in doors if one.name not in self._collapsed and head > one.collapse]

    def _tolerance(self) -> np.ndarray:
        full, size = self.ship.rooms.full, self.ship.hull.size
        parts = [full, OF_AIR / ABSOLUTE * full[self._closed]]
        if self.inertia is not None:
            parts.append([size, size, 1.0, 1.0])
        return ABSOLUTE * np.concatenate(parts)
