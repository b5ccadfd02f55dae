"""How the same ship rolls with her cargo frozen as it lay at the start, which shows what the loose cargo changes.

She is computed by herself, without grains (`solvers.ship.motion.sail`), for as long as the run was to last.
frozen_largest_roll, frozen_capsized_at, frozen_flooded_at, frozen_amplitude, frozen_significant_roll: as largest_roll,
capsized_at, flooded_at, roll_amplitude and significant_roll of `ship_roll`. Error: as there.
Her roll is drawn in the figures of `ship_roll`.
"""

from dataclasses import replace
from functools import lru_cache
from math import ceil
from pathlib import Path

import numpy as np

from lab.measures.ship import (
    has_ship,
    in_random_sea,
    in_words,
    losses,
    regular_outcome,
    significant_roll,
    vessel_of,
    wave_frequency,
)
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from lab.recording.ship_end import End, end_of, ends
from solvers.machine.errors import BadState, Unavailable
from solvers.ship.hydrostatics import turned
from solvers.ship.motion import Voyage, sail, start
from solvers.ship.vessel import Vessel

INTERVAL = 0.01  # s, between the samples of her roll
LONGEST = 0.05  # s, of a step: also for ships that do not swing, whose waves and memory ask for some
STEPS = 40  # of the Runge–Kutta method in her shortest period: 1e-4 of the swing after ten of them


def applies(recording: Recording) -> bool:
    """There is a ship with cargo, and she can be computed by herself."""
    return has_ship(recording) and frozen(recording) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """frozen_largest_roll, frozen_amplitude, frozen_significant_roll (deg), frozen_capsized_at and so on (s)."""
    time, roll, end = frozen(recording)
    found = {
        "frozen_largest_roll": over_worlds([np.degrees(np.abs(roll).max())], "deg"),
        **losses("frozen_", recording, [end]),
    }
    if in_random_sea(recording):
        lost = np.array([end is not None])
        found["frozen_significant_roll"] = significant_roll(recording, time, roll[:, None], lost)
    if wave_frequency(recording) is None:
        return found
    one = regular_outcome(time, roll, wave_frequency(recording), end)
    size = [np.degrees(one.amplitude) if one and end is None else np.nan]
    note = in_words(one) if one else ""
    return found | {"frozen_amplitude": over_worlds(size, "deg", note=note, missing="no steady roll")}


def frozen(recording: Recording) -> tuple[np.ndarray, np.ndarray, End | None] | None:
    """Times (T',), s, roll (T',), rad, and end of the ship with her cargo frozen.

    None without cargo, which leaves nothing to freeze, and where she cannot be computed.
    She sails for as long as the run was to last, even if a ship of the run was lost long before.
    """
    if not recording.preset.matters:
        return None
    lasted, series = float(recording.series["time"][-1]), recording.series
    if any(ends(series)):
        lasted = max(lasted, recording.preset.duration)
    return _frozen(recording.path, lasted)


def frozen_voyage(recording: Recording) -> tuple[np.ndarray, np.ndarray, End | None] | None:
    """As `frozen`, with the poses (T', 3) of the tank, m, m, rad, in place of roll."""
    lasted = max(float(recording.series["time"][-1]), recording.preset.duration)
    voyage = _sailed(recording.path, lasted) if recording.preset.matters and has_ship(recording) else None
    if voyage is None:
        return None
    ship = recording.preset.ship
    arm = turned(tuple(np.subtract(ship.hold, ship.about)), voyage.roll)
    return voyage.time, np.column_stack([voyage.state[:, :2] + arm, voyage.roll]), _end(voyage)


def _frozen(path: Path, duration: float) -> tuple[np.ndarray, np.ndarray, End | None] | None:
    """As `frozen`, of the recording at `path`, for so long (s)."""
    voyage = _sailed(path, duration)
    return None if voyage is None else (voyage.time, voyage.roll, _end(voyage))


def _end(voyage: Voyage) -> End | None:
    lost = [-1.0 if when is None else when for when in (voyage.capsized, voyage.flooded)]
    return end_of(*lost, voyage.roll[-1])


@lru_cache(maxsize=4)
def _sailed(path: Path, duration: float) -> Voyage | None:
    """The voyage of the ship of the recording at `path` with her cargo frozen, for so long (s)."""
    vessel = vessel_of(path)
    if vessel is None:
        return None
    ship = vessel.ship
    try:
        state = start(ship, vessel.heave(ship.body, vessel.heel), vessel.heel)
        lasts, step = duration - vessel.release, step_of(vessel)
        whole = step * ceil(lasts / step - 1e-9)
        voyage = sail(ship, state, step, whole, vessel.limits, vessel.release, vessel.openings)
    except (Unavailable, BadState):
        return None
    return _sampled(voyage, vessel, lasts)


def step_of(vessel: Vessel) -> float:
    """The step (s) in which a ship with frozen cargo is computed, a multiple of INTERVAL."""
    return INTERVAL * max(1, int(min(vessel.shortest_period / STEPS, LONGEST) / INTERVAL + 1e-9))


def _sampled(voyage: Voyage, vessel: Vessel, lasts: float) -> Voyage:
    """Poses and velocities of a voyage every INTERVAL, by cubics through its steps (Hermite), up to her loss."""
    from scipy.interpolate import CubicHermiteSpline  # slow to import

    path = CubicHermiteSpline(voyage.time, voyage.state[:, :3], voyage.state[:, 3:6])
    count = round(min(lasts, voyage.time[-1] - voyage.time[0]) / INTERVAL)
    time = voyage.time[0] + INTERVAL * np.arange(1 + count)
    found = replace(voyage, time=time, state=np.hstack([path(time), path(time, 1)]))
    if voyage.capsized is None and voyage.flooded is None:
        return found
    for k in np.flatnonzero(time > voyage.time[-2]):  # the step in which she is lost
        flooded = vessel.openings and vessel.ship.load.depths(vessel.openings, found.state[k, :3], time[k]).max() > 0.0
        if flooded or not vessel.limits[0] < found.roll[k] < vessel.limits[1]:
            when = {"flooded" if voyage.capsized is None else "capsized": float(time[k])}
            return replace(found, time=time[: k + 1], state=found.state[: k + 1], **when)
    return found
