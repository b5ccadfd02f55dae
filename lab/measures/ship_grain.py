"""How far the grain in a ship's hold has shifted, beside what the International Grain Code assumes.

The cargo's centre has moved aside by s (m, in the hold) since it settled. Its volumetric heeling moment is V s, V the
level filling of the settled bed, of all holds together; `assumed_moment` is that of a surface turned to 15 or 25 deg
(`solvers.ship.naval`), in each of them, without the factor for the vertical part. Both are of the whole ship, at the
full scale if the preset has one.

shifted_moment: the mean over the last tenth of the run, positive to starboard. Error: half the difference between the
two halves of that time. largest_shifted_moment: the largest to either side. shifted_share: `shifted_moment`, whatever
its side, over `assumed_moment`; largest_shifted_share: of the largest.
list_as_it_lay, area_as_it_lay: heel of equilibrium and residual area (Grain Code A 7.1) in calm water with the cargo as
it lay when it was farthest aside, G moved aside and up with it: the worst of the run. assumed_list, assumed_area: with
the assumed shift; these follow from the preset and the settled bed alone.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from lab.base.errors import LabError
from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band, mean_label
from lab.measures.loose import is_loose, mass_aboard
from lab.measures.naval_levers import draw_levers
from lab.measures.ship import has_ship, vessel_of
from lab.measures.value import Value, over_worlds
from lab.naval import sheet
from lab.naval.condition import Condition, condition, level_of
from lab.preset.schema import Preset
from lab.recording import Recording
from solvers.machine.errors import Unavailable
from solvers.machine.quantity import PLANE, ROLL
from solvers.ship.cargo import ONE, level_area
from solvers.ship.hydrostatics import Loading, balanced_heave
from solvers.ship.naval.grain_code import ASSUMED, residual
from solvers.ship.section import Section

LAST = 0.1  # of a run: over it the final shift is averaged
FULL = 0.999  # of a hold: more than this is no level filling any more
LISTS = 201  # times at which her list is drawn
NONE = "no angle of equilibrium"


@dataclass(frozen=True, eq=False)
class Shift:
    """A ship's condition with her settled bed, the cargo's way aside and up (T, W, 2) m at the full scale.

    `share`: mass of the cargo over that of the whole ship.
    """

    condition: Condition
    way: np.ndarray
    share: float

    @property
    def moment(self) -> np.ndarray:
        """Volumetric moment (T, W) m⁴, positive to starboard."""
        return self.condition.cargo.volume * self.way[..., 0]

    def lying(self, way: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
        """The heeling arm (m) of the cargo moved by a way (2,), towards the side that it lies on."""
        return sheet.shifted(self.share * abs(float(way[0])), self.share * float(way[1]))

    @property
    def farthest(self) -> np.ndarray:
        """The way (W, 2) m of the cargo when it was farthest aside."""
        rows = np.abs(self.way[..., 0]).argmax(axis=0)
        return self.way[rows, np.arange(self.way.shape[1])]

    def last(self, time: np.ndarray) -> slice:
        """The rows of the last tenth of the time (T,)."""
        return slice(int(np.searchsorted(time, time[-1] - LAST * (time[-1] - time[0]))), None)


def applies(recording: Recording) -> bool:
    """There is a ship with grains that settled as a level filling, and she can be judged."""
    return has_ship(recording) and shift(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """Moments (m⁴), shares (%), lists (deg) and residual areas (m rad)."""
    found, time = shift(recording), recording.series["time"]
    rows = found.last(time)
    moment = found.moment[rows]
    half = len(moment) // 2
    errors = np.abs(moment[:half].mean(axis=0) - moment[half:].mean(axis=0)) / 2.0
    final, largest = moment.mean(axis=0), np.abs(found.moment).max(axis=0)
    assumed = found.condition.assumed_moment
    levers, flooding = found.condition.levers, found.condition.flooding
    ends = [residual(levers, found.lying(way), flooding) for way in found.farthest]
    code = residual(levers, found.condition.assumed, flooding)
    return {
        "shifted_moment": over_worlds(final, "m^4", uncertainties=errors, kind="halves", note="positive to starboard"),
        "largest_shifted_moment": over_worlds(largest, "m^4"),
        "assumed_moment": over_worlds([assumed], "m^4", note=_surface(found.condition)),
        "shifted_share": over_worlds(100.0 * np.abs(final) / assumed, "%", note="of the assumed moment"),
        "largest_shifted_share": over_worlds(100.0 * largest / assumed, "%", note="of the assumed moment"),
        "list_as_it_lay": over_worlds([_degrees(end.heel) for end in ends], "deg", missing=NONE),
        "assumed_list": over_worlds([_degrees(code.heel)], "deg", missing=NONE),
        "area_as_it_lay": over_worlds([end.area for end in ends], "m rad"),
        "assumed_area": over_worlds([code.area], "m rad"),
    }


def _degrees(angle: float) -> float:
    return float(np.degrees(angle)) if np.isfinite(angle) else np.nan


def _surface(found: Condition) -> str:
    assumed = ASSUMED[found.given.filling]
    return f"surface at {np.degrees(assumed.surface):.0f} deg; the code adds a factor of {assumed.factor:.2f}"


def shift(recording: Recording) -> Shift | None:
    """The shift of a recording's cargo; None where the bed is no level filling or the ship cannot be judged."""
    return _shift(str(recording.path), len(recording.series["time"])) if is_loose(recording) else None


@lru_cache(maxsize=4)
def _shift(path: str, _rows: int) -> Shift | None:
    from lab.recording import open_recording

    with open_recording(path) as recording:
        preset, vessel = recording.preset, vessel_of(recording.path)
        centre = np.array(recording.series["centre_of_mass"], dtype=float)[..., :PLANE]
        if vessel is None or not len(centre):
            return None
        mass = float(mass_aboard(recording).mean())
        hold = Section(recording.outline)
    try:
        level = level_of(preset) if _several(preset) else _settled(hold, float(centre[0, :, 1].mean()))
        if level is None:
            return None
        found = condition(preset, vessel, level, mass)
    except (Unavailable, LabError):
        return None
    return Shift(found, (centre - centre[0]) * found.scale, found.cargo.mass / found.displacement)


def _several(preset: Preset) -> bool:
    """Whether there are several holds, whose centre does not tell their levels."""
    return bool(preset.bulk and preset.tanks)


def _settled(hold: Section, height: float) -> float | None:
    """The level (m) of the filling whose centre is at a height (m); None in a full hold. Raises Unavailable."""
    area = level_area(hold, height)
    return None if area > FULL * hold.area else -balanced_heave(hold, Loading(area, (0.0, 0.0)), ONE, 0.0)


def draw_moment(sheet_: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Heel and list of the ship, and volumetric moment of her cargo, against time, positive to starboard.

    Her list is the heel at which she would lie in calm water with the cargo as it lies then. Level lines: the assumed
    shift to either side, of 15 and 25 deg, and that of the preset with its factor.
    """
    found, series = shift(recording), recording.series
    heel, moment = sheet_.panels(heights=(1, 1.4))[:, 0]
    band(heel, series["time"], -np.degrees(series["pose"][..., ROLL]), GREY, "heel")
    rows = np.unique(np.linspace(0, len(found.way) - 1, LISTS).astype(int))
    band(heel, np.array(series["time"])[rows], listed(found, rows), "black", "list with the cargo as it lies")
    heel.set_ylabel("heel, list to\nstarboard (deg)")
    band(moment, series["time"], found.moment, BLUE, f"moment of the shift, {mean_label(recording.worlds)}")
    ship = found.condition
    given = ASSUMED[ship.given.filling]
    lines = [(ASSUMED["filled"].surface, 1.0, GREEN, ":"), (ASSUMED["partly-filled"].surface, 1.0, VERMILION, "--")]
    if given.factor != 1.0:
        lines.append((given.surface, given.factor, VERMILION, "-"))
    for surface, factor, colour, style in lines:
        size = ship.moment_at(surface) * factor
        angle = f"{np.degrees(surface):.0f} deg" + (f" x {factor:.2f}" if factor != 1.0 else "")
        for side in (1.0, -1.0):
            label = f"assumed, {angle}: {size:.5g} m⁴" if side > 0.0 else None
            moment.axhline(side * size, color=colour, ls=style, lw=1.0, label=label)
    moment.set_ylabel("volumetric moment (m⁴)")
    moment.set_xlabel("time (s)")


def listed(found: Shift, rows: np.ndarray) -> np.ndarray:
    """Lists (k, W) deg in calm water with the cargo as it lay in rows of the series, positive to starboard.

    Not a number where she would come to rest nowhere.
    """
    lists = np.full((len(rows), found.way.shape[1]), np.nan)
    for k, row in enumerate(rows):
        for world, way in enumerate(found.way[row]):
            lies = found.condition.levers.less(found.lying(way)).equilibrium()
            lists[k, world] = np.nan if lies is None else np.degrees(lies) * np.sign(way[0])
    return lists


def draw_criteria(sheet_: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Righting levers with the heeling arms of the assumed shift and of the cargo as it lay farthest aside."""
    ((axes,),) = sheet_.panels(columns=1)
    found = shift(recording)
    draw_levers(axes, found.condition, found.lying(worst(found)))


def worst(found: Shift) -> np.ndarray:
    """The way (2,) m of the cargo when it was farthest aside, of the world in which that was most."""
    return found.farthest[int(np.argmax(np.abs(found.farthest[:, 0])))]


FIGURES = {"shifted-moment": draw_moment, "criteria": draw_criteria}
