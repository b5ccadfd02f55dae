"""What is told of a run of flooding: heel, trim, draughts and levels in time, what happened when, and how she ends.

Heel is positive starboard down, trim by the stern; draughts are at her ends, from the base line.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lab.naval.flooding.build import Built, build
from lab.naval.flooding.case import LoadedCase
from solvers.ship.flooding.balance import Plunges, Pose
from solvers.ship.flooding.openings import SEA
from solvers.ship.flooding.residual import displacement, levers, metacentric_height, without
from solvers.ship.flooding.run import Course, Moment
from solvers.ship.flooding.survival import Survival, survival
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.immersion import deck_edges

DONE = 0.01  # of a room's volume: so near to the end it has come to rest
SHARES = 0.0, 0.25, 0.5, 0.75, 1.0  # of the water aboard at the end: the intermediate stages
LEVEL = 0.005  # of her depth: a room whose level is so near to the sea's is open to it
HEELS = np.radians(np.arange(0.0, 91.0, 1.0))
COARSE = np.radians(np.arange(0.0, 62.0, 2.0))  # of the stages


@dataclass(frozen=True, eq=False)
class Stage:
    """A stage of flooding: what it is, its moment, GM (m) and s_intermediate by added weight; None: not told."""

    what: str
    moment: Moment
    gm: float
    factor: float | None


@dataclass(eq=False)
class Results:
    """A run and its ship."""

    built: Built
    course: Course
    kind: str = "cargo"
    edges: np.ndarray = field(init=False)

    def __post_init__(self):
        self.edges = deck_edges(self.built.form)

    @property
    def moments(self) -> list[Moment]:
        """The moments of the run."""
        return self.course.moments

    @cached_property
    def time(self) -> np.ndarray:
        """Times (T,) s."""
        return np.array([one.time for one in self.moments])

    @cached_property
    def heel(self) -> np.ndarray:
        """Heel (T,) rad, positive starboard down."""
        return np.array([-one.pose.roll for one in self.moments]) + 0.0

    @cached_property
    def draughts(self) -> np.ndarray:
        """Draughts (T, 2) m at the aft and the forward perpendicular, in her middle plane."""
        return np.array([draughts(one.pose, self.built) for one in self.moments])

    @property
    def trim(self) -> np.ndarray:
        """Trim (T,) m by the stern."""
        return self.draughts[:, 0] - self.draughts[:, 1]

    @cached_property
    def freeboard(self) -> np.ndarray:
        """Least height (T,) m of the deck's edge above the sea."""
        return np.array([float(one.pose.heights(self.edges).min()) for one in self.moments])

    @cached_property
    def volume(self) -> np.ndarray:
        """Volumes (T, n) m³ of water in the rooms."""
        return np.array([one.volume for one in self.moments])

    @property
    def mass(self) -> np.ndarray:
        """Water (T,) kg in all rooms."""
        return self.built.ship.water.density * self.volume.sum(axis=1)

    @cached_property
    def rest_time(self) -> float | None:
        """When (s) all rooms and her heel have come to rest for good; None: not within the run."""
        if self.course.end != "afloat":
            return None
        off = np.abs(self.volume - self.volume[-1]) / self.built.ship.rooms.full
        moving = np.flatnonzero((off > DONE).any(axis=1) | (np.abs(self.heel - self.heel[-1]) > np.radians(0.1)))
        last = int(moving[-1]) + 1 if len(moving) else 0
        return float(self.time[last]) if last < 0.9 * (len(self.time) - 1) else None

    @cached_property
    def deck_time(self) -> float | None:
        """When (s) the deck's edge first goes under; None: it does not."""
        under = np.flatnonzero(self.freeboard <= 0.0)
        if not len(under):
            return None
        k = int(under[0])
        if k == 0:
            return float(self.time[0])
        high, low = self.freeboard[k - 1], self.freeboard[k]
        return float(self.time[k - 1] + high / (high - low) * (self.time[k] - self.time[k - 1]))

    @property
    def largest(self) -> tuple[float, float]:
        """The largest heel (rad, positive to starboard) and when (s)."""
        k = int(np.argmax(np.abs(self.heel)))
        return float(self.heel[k]), float(self.time[k])

    @cached_property
    def stages(self) -> list[Stage]:
        """Stages by the water aboard, and that of the largest heel."""
        total = self.volume.sum(axis=1)
        gained = total[-1] - total[0]
        places = {f"{100 * share:.0f} %": int(np.argmax(total >= total[0] + share * gained)) for share in SHARES}
        places["100 %"] = len(total) - 1
        if abs(self.largest[0]) > np.radians(0.1):
            places["largest heel"] = int(np.argmax(np.abs(self.heel)))
        found = sorted(places.items(), key=lambda one: one[1])
        return [Stage(what, self.moments[k], *self._judged(self.moments[k])) for what, k in found]

    def _judged(self, moment: Moment) -> tuple[float, float | None]:
        """GM (m) and s_intermediate of a stage, its water kept as she heels; s where she lies at rest."""
        if self.built.flooding.inertia is not None:
            return self.gm(moment), None
        side = self._side(moment)
        try:
            curve = Levers(COARSE, levers(self.built.ship, moment.volume, COARSE, moment.pose, side))
        except Plunges:
            return self.gm(moment), 0.0
        return self.gm(moment), survival(curve, self.kind, False).factor

    def gm(self, moment: Moment) -> float:
        """GM (m) of M + ρ Σ v_i with all free surfaces."""
        return metacentric_height(self.built.ship, moment.volume, moment.pose)

    @cached_property
    def open_rooms(self) -> np.ndarray:
        """Which rooms (n,) are open to the sea at the end: an opened way leads there and they stand level with it."""
        rooms, last = self.built.ship.rooms, self.moments[-1]
        reached, flooding = {SEA}, self.built.flooding
        ways = [
            set(one.between)
            for one in flooding.openings
            if one.share(last.time, 0.0, one.name in self.course.doors) == 1.0
        ]
        for _ in ways:
            reached |= {name for way in ways if way & reached for name in way}
        near = np.abs(last.level) <= LEVEL * self.built.form.depth
        full = last.volume >= rooms.full * (1.0 - 1e-6)
        return np.array([name in reached for name in rooms.names]) & (near | full) & (last.overpressure == 0.0)

    @cached_property
    def lost_buoyancy(self):
        """The ship without the rooms that are open to the sea, and the water that is left aboard (k,) m³."""
        return without(self.built.ship, self.open_rooms), self.moments[-1].volume[~self.open_rooms]

    @property
    def side(self) -> int:
        """The side of her list at the end, 1 port and −1 starboard."""
        return self._side(self.moments[-1])

    def _side(self, moment: Moment) -> int:
        roll = moment.pose.roll
        return self.built.ship.side if abs(roll) < np.radians(0.01) else int(np.sign(roll))

    @cached_property
    def residual(self) -> Levers | None:
        """Levers (m) of M by lost buoyancy over heels to the side of her list; None unless she floats at rest."""
        if self.rest_time is None:
            return None
        ship, aboard = self.lost_buoyancy
        try:
            return Levers(HEELS, levers(ship, aboard, HEELS, self.moments[-1].pose, self.side))
        except Plunges:
            return None

    @cached_property
    def flooding_heel(self) -> float | None:
        """The heel (rad) to her side at which an open way in goes under that is dry at the end; None: none does."""
        last = self.moments[-1].pose
        points = [
            one.corners
            for one in self.built.flooding.openings
            if SEA in one.between and one.opens is not None and float(last.heights(one.corners).min()) > 0.0
        ]
        if not points:
            return None
        ship, aboard = self.lost_buoyancy
        near = last
        for heel in HEELS:
            near = ship.at_heel(aboard, self.side * heel, near)
            if float(near.heights(np.concatenate(points)).min()) <= 0.0:
                return float(heel)
        return None

    @cached_property
    def survival(self) -> Survival | None:
        """The factor s at the end; None unless she floats at rest."""
        return None if self.residual is None else survival(self.residual, self.kind, True, self.flooding_heel)

    @property
    def displacements(self) -> tuple[float, float]:
        """Masses (kg) by added weight and by lost buoyancy."""
        ship, aboard = self.lost_buoyancy
        return displacement(self.built.ship, self.moments[-1].volume), displacement(ship, aboard)

    @property
    def heights(self) -> tuple[float, float]:
        """GM (m) by added weight and by lost buoyancy, each of its own displacement."""
        ship, aboard = self.lost_buoyancy
        last = self.moments[-1]
        return self.gm(last), metacentric_height(ship, aboard, last.pose)


def compute(loaded: LoadedCase) -> Results:
    """The run of a case. Raises LabError."""
    built = build(loaded)
    return Results(built, built.flooding.course(), loaded.case.ship.kind)


def draughts(pose: Pose, built: Built) -> tuple[float, float]:
    """Draughts (m) at the perpendiculars: along the keel's normal in her middle plane."""
    x = np.array(built.form.ends)
    cos = float(np.cos(pose.roll))
    depth = (pose.level + pose.slope * x) / max(abs(cos), 1e-6) * np.sign(cos)
    return tuple((depth - built.form.base).tolist())
