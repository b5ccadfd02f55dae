"""How a ship with cargo rolls.

Roll, sway and heave are those of the ship's axis (`lab.preset.ship.axis_motion`).
largest_roll: the largest |roll| of the run; capsized_at: when her roll left its limits; flooded_at: when the edge of
her hatch, or another opening, went under the local surface of the water.
deck_immersion_angle, downflooding_angle: at which heel the edge of her deck, and an opening, meet the still waterline
at constant displacement (`solvers.ship.openings`), her cargo as it lay at the start.
Of regular waves, over their last ten periods (`solvers.ship.outcome`): roll_amplitude, the mean over periods of half
the way from one side to the other; roll_bias, the mean roll, positive to port; both none where she was lost. Their note
says what became of her: upright, biased (by half a degree or more), capsized or flooded, and where roll has several
frequencies: a tenth or more of its rms at others than the waves' and their multiples.
sway_amplitude, heave_amplitude, roll_fundamental: of the motion of the axis at the waves' frequency, by least squares.
significant_roll, of a random sea after its soft start: the mean of the highest third of swings, each half the way from
side to side between upward crossings of the mean (Sverdrup & Munk 1947); its error is half the difference of the halves
of the run. Twice the rms of the roll where this is of a narrow band (Longuet-Higgins 1952).
roll_period: mean time between upward crossings of the mean roll in the last half of the run.
wave_power: what the waves put into her; radiated_power, viscous_power: what goes into waves and into friction of the
water; granular_power: what her loose cargo takes, lost in the grains once the motion is steady. Means over the last ten
periods, per metre of length; in a steady motion the first is the sum of the others.
frozen_amplitude, frozen_significant_roll, frozen_largest_roll, frozen_capsized_at, frozen_flooded_at: roll_amplitude,
significant_roll, largest_roll, capsized_at and flooded_at of the same ship with her cargo frozen as it lay at the
start, by herself (`solvers.ship.motion.sail`).
"""

from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from itertools import pairwise
from pathlib import Path

import numpy as np

from lab.assembly.ship import flooding_angles
from lab.base.errors import LabError
from lab.measures.value import Value, over_worlds
from lab.measures.wall_force import grain_mass
from lab.preset.ship import axis_motion, recorded_ship
from lab.recording import Recording
from lab.recording.ship_end import VERBS, End, end_of, ends
from solvers.machine.errors import BadState, Unavailable
from solvers.ship.cargo import level_area, relaxed_levers
from solvers.ship.hydrostatics import righting_levers
from solvers.ship.motion import sail, start
from solvers.ship.outcome import CYCLES, Outcome, outcome
from solvers.ship.section import Section
from solvers.ship.vessel import Vessel

LEAST_CROSSINGS = 3
FROZEN_INTERVAL = 0.01  # s
HEELS = 91  # of the curve of righting levers


def applies(recording: Recording) -> bool:
    """There is a ship."""
    return bool(recording.preset.get("ship")) and len(recording.series["time"]) > 2


def measure(recording: Recording) -> dict[str, Value]:
    """largest_roll, roll_amplitude, significant_roll (deg) …, and those of the frozen cargo."""
    time, roll = recording.series["time"], recording.series["pose"][..., 2]
    end = ends(recording.series)
    lost = np.array([one is not None for one in end])
    found = {
        "largest_roll": over_worlds(np.degrees(np.abs(roll).max(axis=0)), "deg"),
        **_losses("", recording, end),
        "roll_period": over_worlds([_period(time, r) for r in roll.T], "s", missing="too few swings"),
    }
    found |= _of_frozen(recording) | _angles(recording)
    if _of_random_sea(recording):
        found["significant_roll"] = _significant(recording, time, roll, lost)
    if wave_frequency(recording) is None:
        return found
    outcomes = [_outcome(recording, world) for world in range(recording.worlds)]
    steady = [(o.amplitude, o.mean) if o and o.kind not in VERBS else (np.nan, np.nan) for o in outcomes]
    kinds = Counter(describe(o) for o in outcomes if o)
    note = ", ".join(kind if count == recording.worlds else f"{count} {kind}" for kind, count in kinds.items())
    amplitude, mean = np.degrees(np.array(steady).T)
    found["roll_amplitude"] = over_worlds(amplitude, "deg", note=note, missing="no steady roll")
    found["roll_bias"] = over_worlds(mean, "deg", missing="no steady roll")
    parts = np.where(lost[:, None], np.nan, _fundamental(recording))
    for name, scale, unit, numbers in (
        ("sway_amplitude", 1e3, "mm", parts[:, 0]),
        ("heave_amplitude", 1e3, "mm", parts[:, 1]),
        ("roll_fundamental", np.degrees(1.0), "deg", parts[:, 2]),
    ):
        found[name] = over_worlds(scale * numbers, unit, missing="no steady motion")
    return found | _powers(recording)


def _losses(prefix: str, recording: Recording, found: Sequence[End | None]) -> dict[str, Value]:
    """When ships capsized, and when those that have openings flooded."""
    kinds = {"capsized": "did not capsize"}
    if recorded_ship(recording.preset).flooding_points:
        kinds["flooded"] = "did not flood"
    times = {kind: [end.time if end and end.kind == kind else np.nan for end in found] for kind in kinds}
    return {f"{prefix}{kind}_at": over_worlds(times[kind], "s", missing=never) for kind, never in kinds.items()}


def _angles(recording: Recording) -> dict[str, Value]:
    """Of deck immersion and downflooding, as far as she has them."""
    vessel = _vessel(recording.path)
    if vessel is None:
        return {}
    angles = flooding_angles(recorded_ship(recording.preset), vessel)
    return {name: over_worlds([np.degrees(angle)], "deg") for name, angle in angles.items() if angle is not None}


def _of_frozen(recording: Recording) -> dict[str, Value]:
    """Of the ship with her cargo frozen; none where she cannot be made, no amplitude without regular waves."""
    alone = frozen(recording)
    if alone is None:
        return {}
    time, roll, end = alone
    found = {
        "frozen_largest_roll": over_worlds([np.degrees(np.abs(roll).max())], "deg"),
        **_losses("frozen_", recording, [end]),
    }
    if _of_random_sea(recording):
        found["frozen_significant_roll"] = _significant(recording, time, roll[:, None], np.array([end is not None]))
    if wave_frequency(recording) is None:
        return found
    one = _classed(time, roll, wave_frequency(recording), end)
    size = [np.degrees(one.amplitude) if one and end is None else np.nan]
    note = describe(one) if one else ""
    return found | {"frozen_amplitude": over_worlds(size, "deg", note=note, missing="no steady roll")}


def wave_frequency(recording: Recording) -> float | None:
    """Angular frequency (rad/s) of regular waves, None without."""
    waves = recording.preset.get("waves") or {}
    return waves["frequency"] if waves.get("kind") == "regular" and waves.get("amplitude") else None


def _of_random_sea(recording: Recording) -> bool:
    return bool((recording.preset.get("waves") or {}).get("height"))


def _significant(recording: Recording, time: np.ndarray, roll: np.ndarray, lost: np.ndarray) -> Value:
    """Of roll (T, W), rad, at time (T,), s; none where she was lost (W,)."""
    begin = int(np.searchsorted(time, recording.preset["waves"]["soft_start"]))
    middle = (begin + len(time)) // 2
    parts = slice(begin, None), slice(begin, middle), slice(middle, None)
    whole, *halves = ([np.degrees(_highest_third(r[part])) for r in roll.T] for part in parts)
    size = np.where(lost, np.nan, whole)
    error = np.where(lost, np.nan, np.abs(np.subtract(*halves)) / 2)
    return over_worlds(size, "deg", uncertainties=error, kind="halves", missing="lost or too few swings")


def _highest_third(roll: np.ndarray) -> float:
    """Mean of the highest third of swings, as the module says."""
    x = roll - roll.mean() if len(roll) else roll
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0)) + 1
    if len(up) <= LEAST_CROSSINGS:
        return np.nan
    swings = 0.5 * np.array([np.ptp(x[a:b]) for a, b in pairwise(up)])
    return float(np.sort(swings)[-max(1, len(swings) // 3) :].mean())


def describe(found: Outcome) -> str:
    """In words."""
    return found.kind + (", several frequencies" if found.several and found.kind not in VERBS else "")


def frozen(recording: Recording) -> tuple[np.ndarray, np.ndarray, End | None] | None:
    """Times (s), roll (rad) and end of the ship with her cargo frozen; None where she cannot be made.

    She sails for as long as the run was to last, though its own ship may have been lost long before.
    """
    lasted, series = float(recording.series["time"][-1]), recording.series
    if any(ends(series)):
        lasted = max(lasted, recording.preset["run"]["duration"])
    return _frozen(recording.path, lasted)


@lru_cache(maxsize=4)
def _frozen(path: Path, duration: float):
    vessel = _vessel(path)
    if vessel is None:
        return None
    ship = vessel.ship
    try:
        state = start(ship, vessel.heave(ship.body, vessel.heel), vessel.heel)
        lasts, begin = duration - vessel.release, vessel.release
        voyage = sail(ship, state, FROZEN_INTERVAL, lasts, vessel.limits, begin, vessel.openings)
    except (Unavailable, BadState):
        return None
    lost = [-1.0 if when is None else when for when in (voyage.capsized, voyage.flooded)]
    return voyage.time, voyage.roll, end_of(*lost, voyage.roll[-1])


@lru_cache(maxsize=4)
def _vessel(path: Path) -> Vessel | None:
    """The ship of a recording with her cargo as it lay at the start."""
    from lab.assembly.scene import vessels
    from lab.preset.schema import Resolved
    from lab.recording import open_recording

    try:
        with open_recording(path) as recording:
            return vessels(Resolved.model_validate(recording.preset))[0]
    except (LabError, ValueError):
        return None


def levers(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray | None] | None:
    """Heels (n,) rad and righting levers (n,) m, with the cargo frozen and with it relaxed.

    Relaxed: slid to its angle of repose at each heel (`solvers.ship.cargo`), as a level filling whose centre is as high
    as that of the bed at the start; None where that is not known.
    """
    vessel = _vessel(recording.path)
    if vessel is None:
        return None
    load, loading = vessel.ship.load, vessel.ship.body.loading
    heel = np.radians(np.linspace(0.0, 180.0, HEELS))
    frozen = righting_levers(load.section, loading, load.water, heel)
    mass = grain_mass(recording)
    if mass is None:
        return heel, frozen, None
    cargo = float(mass.sum(axis=1).mean()) / _thickness(recording)
    repose = recorded_ship(recording.preset).repose
    try:
        hold = Section(recording.outline)
        area = level_area(hold, float(recording.series["centre_of_mass"][0, :, 1].mean()))
        relaxed = relaxed_levers(load.section, loading, load.water, heel, hold, area, cargo, repose)
    except Unavailable:
        return heel, frozen, None
    return heel, frozen, relaxed


def _thickness(recording: Recording) -> float:
    """How thick (m) the slab is that the cargo makes up."""
    tank, grains = recording.preset["tank"], recording.preset["grains"]
    return tank.get("thickness") or grains["diameter"]


def _powers(recording: Recording) -> dict[str, Value]:
    """Mean powers (mW/m) over the last cycles."""
    time, works = recording.series["time"], recording.series["ship_works"]
    begin = np.searchsorted(time, time[-1] - CYCLES * 2.0 * np.pi / wave_frequency(recording))
    power = 1e3 * (works[-1] - works[begin]) / max(time[-1] - time[begin], 1e-9) * (1.0, 1.0, 1.0, -1.0)
    power[[end is not None for end in ends(recording.series)]] = np.nan
    names = "wave_power", "radiated_power", "viscous_power", "granular_power"
    return {name: over_worlds(power[:, k], "mW/m", missing="no steady motion") for k, name in enumerate(names)}


def _fundamental(recording: Recording) -> np.ndarray:
    """Amplitudes (W, 3), m and rad, of sway, heave and roll at the waves' frequency over the last cycles."""
    time, frequency = recording.series["time"], wave_frequency(recording)
    last = time > time[-1] - CYCLES * 2.0 * np.pi / frequency
    moved = axis_motion(recorded_ship(recording.preset), recording.series["pose"][last])
    phase = frequency * time[last, None]
    waves = np.hstack([np.ones_like(phase), phase, np.cos(phase), np.sin(phase)])
    fitted = np.linalg.lstsq(waves, moved.reshape(len(moved), -1))[0]
    return np.hypot(fitted[2], fitted[3]).reshape(recording.worlds, 3)


def _outcome(recording: Recording, world: int) -> Outcome | None:
    end, frequency = ends(recording.series)[world], wave_frequency(recording)
    if frequency is None:
        return None
    time, roll = recording.series["time"], recording.series["pose"][:, world, 2]
    if end:
        kept = time <= end.time
        time, roll = time[kept], roll[kept]
    return _classed(time, roll, frequency, end)


def _classed(time: np.ndarray, roll: np.ndarray, frequency: float, end: End | None) -> Outcome | None:
    try:
        return outcome(time, roll, frequency, end.kind if end else "")
    except Unavailable:
        return None


def _period(time: np.ndarray, roll: np.ndarray) -> float:
    """Mean time (s) between upward crossings of the mean in the last half."""
    half = len(time) // 2
    t, x = time[half:], roll[half:] - roll[half:].mean()
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    if len(up) < LEAST_CROSSINGS:
        return np.nan
    crossing = t[up] - x[up] / (x[up + 1] - x[up]) * (t[up + 1] - t[up])
    return float(np.diff(crossing).mean())
