"""How a tank on an axle rolls, beside the same tank empty.

largest_roll: the largest |roll| of the run (deg). empty_roll: that of the empty tank under the same slide of the mass,
computed here from the axle's equation (`solvers.motion.axle`). roll_over_empty: the first over the second.
roll_lag: by how much of a period the roll lags behind the sliding mass (deg, 0 to 360), both through the sine of the
slide's frequency over the last half of the run; the empty tank's is in the note.
axle_residual: the largest |gain of the empty tank's energy − works| over the largest work, from the recorded ones; it
falls with the step. Error: none of their own.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREY, VERMILION, Sheet, band, note
from lab.measures.sloshing_frequency import peak_frequency
from lab.measures.steady import harmonics
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL
from solvers.motion.axle import Axle
from solvers.ship.waves import soft_start

LEAST_SAMPLES = 32
STEP = 1e-3  # s, of the empty tank's motion: 2e-7 of a period of 2 s


def applies(recording: Recording) -> bool:
    """The tank is on an axle, and the run has a few samples."""
    return recording.preset.axle is not None and len(recording.series["time"]) > LEAST_SAMPLES


def measure(recording: Recording) -> dict[str, Value]:
    """largest_roll, empty_roll and roll_lag (deg), roll_over_empty and axle_residual (%)."""
    time, roll = recording.series["time"], recording.series["pose"][..., ROLL]
    empty = empty_roll(recording)
    largest, alone = np.degrees(np.abs(roll).max(axis=0)), float(np.degrees(np.abs(empty).max()))
    found = {"largest_roll": over_worlds(largest, "deg")}
    if recording.preset.matters:
        found["empty_roll"] = over_worlds(np.full(recording.worlds, alone), "deg")
        share = 100.0 * largest / alone if alone else np.full(recording.worlds, np.nan)
        found["roll_over_empty"] = over_worlds(share, "%", missing="the empty tank does not roll")
    if recording.preset.axle.slide:
        slide = recording.series["axle_slide"]
        lags = [lag(time, slide[:, w], roll[:, w]) for w in range(recording.worlds)]
        said = f"empty {lag(time, slide[:, 0], empty):.0f} deg" if recording.preset.matters else ""
        found["roll_lag"] = over_worlds(lags, "deg", note=said, missing="no steady slide")
    return found | {"axle_residual": over_worlds(_residual(recording), "%", missing="nothing moves")}


def lag(time: np.ndarray, slide: np.ndarray, roll: np.ndarray) -> float:
    """How far (deg) the roll (T,) lags behind the slide (T,), from 0 to 360; NaN if the mass does not swing."""
    half = slice(len(time) // 2, None)
    time, both = time[half], np.stack([slide[half], roll[half]], axis=1)
    frequency = float(peak_frequency(time, both[:, :1] - both[:, :1].mean())[0])
    if not np.isfinite(frequency):
        return np.nan
    mass, tank = harmonics(time, both, frequency, (1,))[0]
    return float(np.degrees(np.angle(mass / tank)) % 360.0) if tank else np.nan


def empty_roll(recording: Recording) -> np.ndarray:
    """Roll (T,) rad of the empty tank at the times of the series, under the recorded slide."""
    axle, series = recording.preset.axle.solved, recording.series
    return swing(axle, recording.preset.run.gravity, series["time"], series["axle_slide"][:, 0])


def swing(axle: Axle, gravity: float, time: np.ndarray, slide: np.ndarray) -> np.ndarray:
    """Roll (T,) rad of an empty tank by `OnAxle`'s scheme, with the slide (T,) m as the spline through its samples."""
    from scipy.interpolate import CubicSpline  # slow to import

    start = int(np.searchsorted(time, axle.release - 1e-9))
    count = max(1, round((time[-1] - axle.release) / STEP)) if start < len(time) else 0
    dt = (time[-1] - axle.release) / max(count, 1)
    curve = CubicSpline(time, slide)
    x, between = curve(axle.release + dt * np.arange(count)), curve(axle.release + dt * (np.arange(count) + 0.5))
    inertia, roll, rate, rolls = axle.inertia + axle.mass * between**2, axle.heel, 0.0, np.zeros(count + 1)
    rolls[0], before = roll, inertia[0] if count else 0.0
    for k in range(count):
        kick = dt if k else 0.5 * dt
        lever = axle.moment * np.sin(roll) - axle.mass * x[k] * np.cos(roll)
        braked = 0.5 * kick * axle.damping
        momentum = (before - braked) * rate + kick * gravity * lever
        momentum -= np.clip(momentum, -kick * axle.friction, kick * axle.friction)
        rate, before = momentum / (inertia[k] + braked), inertia[k]
        roll += dt * rate
        rolls[k + 1] = roll
    found = np.interp(time, axle.release + dt * np.arange(count + 1), rolls)
    return np.where(time < axle.release, axle.heel * soft_start(time, axle.release), found)


def _residual(recording: Recording) -> np.ndarray:
    """Share (W,) % of the largest work that the tank's energy misses, after its release."""
    series = recording.series
    after = series["time"] >= recording.preset.axle.release
    energy, works = series["axle_energy"][after], series["axle_works"][after] * [1.0, 1.0, -1.0, -1.0]
    missing = np.abs(energy - energy[:1] - (works - works[:1]).sum(axis=2)).max(axis=0, initial=0.0)
    most = np.abs(works).max(axis=(0, 2), initial=0.0)
    return np.divide(100.0 * missing, most, out=np.full_like(most, np.nan), where=most > 0.0)


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The roll beside that of the empty tank, and the moment of what is in the tank."""
    time, series = recording.series["time"], recording.series
    roll = np.degrees(series["pose"][..., ROLL])
    full = bool(recording.preset.matters)
    panels = sheet.panels(heights=(2, 1)) if full else sheet.panels(columns=1)
    upper = panels[0][0]
    if full:
        upper.plot(time, np.degrees(empty_roll(recording)), color=GREY, lw=0.8, label="empty")
    band(upper, time, roll, BLUE, "roll")
    note(sheet, upper, values.get("largest_roll"), "largest")
    upper.set_ylabel("roll (deg)")
    if full:
        band(panels[1][0], time, series["axle_moment"], VERMILION)
        panels[1][0].set_ylabel("moment (N m)")
    panels[-1][0].set_xlabel("time (s)")
    panels[-1][0].set_xlim(time[0], time[-1])


FIGURES = {"axle_roll": draw}
