"""What happens in a recording: the loss of a ship, an avalanche or an impact of water, and a sentence on it."""

from dataclasses import dataclass

import numpy as np

from lab.paint.curves import monotonic
from lab.paint.decorations import number
from lab.paint.footage import Bed
from lab.paint.space.stance import lengths
from solvers.machine.quantity import ROLL

SMOOTH = 0.1  # s over which the rate of the shift is smoothed
STRONG = 2.0  # times the mean rate of a shift, or the median of a pressure: what counts as an event
LIVELY = 0.7  # weight of the contents' way over that of time, for the moments of a contact sheet
POURED = 1.0  # mean grain diameters that the centre of grains comes down which pour
LEAST = 0.1  # mean grain diameters: a smaller shift of the centre of mass is none


@dataclass(frozen=True)
class Event:
    """An event of one bed: when (s), and what is said of it at the end of a film."""

    time: float
    says: str


def find_event(bed: Bed) -> Event | None:
    """The event of a bed, None if nothing stands out."""
    end = bed.footage.ends[bed.world]
    if end:
        return Event(end.time, f"She {end.words}")
    return _impact(bed) or _avalanche(bed)


def _impact(bed: Bed) -> Event | None:
    """The highest pressure at a gauge, where it stands out of the gauge's own record."""
    pool = bed.footage.water
    if pool is None or not pool.gauges:
        return None
    pressure = np.nan_to_num(bed.footage.measured("gauge_pressure")[:, bed.world])
    row, gauge = np.unravel_index(int(np.argmax(pressure)), pressure.shape)
    peak, usual = float(pressure[row, gauge]), float(np.median(np.abs(pressure[:, gauge])))
    if peak <= 0.0 or peak < STRONG * usual:
        return None
    told = f"{number(1e-3 * peak, 2)} kPa" if peak >= 1e3 else f"{number(peak, 0)} Pa"
    time = float(bed.footage.series_time[row])
    return Event(time, f"Highest pressure {told} at {list(pool.gauges)[gauge]}, {number(time, 2)} s")


def _avalanche(bed: Bed) -> Event | None:
    """The fastest shift of the grains' centre of mass in a tank that tilts steadily."""
    footage = bed.footage
    tilt, time = footage.series_pose[:, bed.world, ROLL], footage.series_time
    if bed.empty or footage.centre_of_mass is None or len(time) < 3 or not monotonic(tilt):
        return None
    centre = footage.centre_of_mass[:, bed.world]
    step = float(np.median(np.diff(time)))
    width = max(1, round(SMOOTH / step))
    rate = lengths(np.gradient(centre, time, axis=0))
    rate = np.convolve(np.nan_to_num(rate), np.full(width, 1.0 / width), "same")
    row = int(np.argmax(rate))
    way = float(np.nansum(lengths(np.diff(centre, axis=0))))
    if way < LEAST * bed.diameter or rate[row] < STRONG * rate.mean():
        return None
    return Event(float(time[row]), f"Avalanche at {number(abs(np.degrees(tilt[row])), 1)}°, {number(time[row], 2)} s")


def half_poured(bed: Bed) -> float | None:
    """When (s) the grains' centre has come down half of its way, where they pour out of something that stands still."""
    footage = bed.footage
    if bed.empty or not footage.parts or np.ptp(bed.pose, axis=0).any():
        return None
    down = footage.centre_of_mass[0, bed.world, 1] - footage.centre_of_mass[:, bed.world, 1]
    if not down[-1] > POURED * bed.diameter:
        return None
    return float(footage.series_time[np.argmax(down >= 0.5 * down[-1])])


def telling_moments(bed: Bed, count: int) -> np.ndarray:
    """Times (count,) s from the first frame to the last: closer together where the contents move faster."""
    footage = bed.footage
    time, first, last = footage.series_time, footage.time[0], footage.time[-1]
    way = np.zeros(len(time))
    for name in ("centre_of_mass", "water_centre"):
        found = footage.centre_of_mass if name == "centre_of_mass" else footage.water and footage.measured(name)
        if found is not None:
            steps = np.nan_to_num(lengths(np.diff(found[:, bed.world], axis=0)))
            way[1:] += LIVELY * np.cumsum(steps) / max(steps.sum(), 1e-30)
    even = (time - first) / max(last - first, 1e-30)
    course = np.maximum.accumulate(even + way)
    course = course + 1e-12 * np.arange(len(course))
    at = np.interp([first, last], time, course)
    return np.clip(np.interp(np.linspace(*at, count), course, time), first, last)
