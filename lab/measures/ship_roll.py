"""How a ship with cargo rolls. Roll, sway and heave are those of her axis (`lab.preset.ship.axis_motion`).

largest_roll: the largest |roll| of the run. capsized_at: when her roll left its limits. flooded_at: when the edge of
her hatch, or another opening, went under the local surface of the water. sunk_at: when more water had entered her
than her reserve buoyancy bears.
roll_period: mean time between upward crossings of the mean roll in the last half of the run.

In regular waves, over their last ten periods (`solvers.ship.outcome`); none for a ship that was lost:
roll_amplitude: half the way from one side to the other, the mean over periods. roll_bias: the mean roll, positive to
port. The note of the amplitude says what became of her: upright, biased (by half a degree or more), capsized, flooded
or sunk. It says "several frequencies" where a tenth or more of the rms of the roll is at frequencies other than the
waves' and its multiples.
sway_amplitude, heave_amplitude, roll_fundamental: of the motion of the axis at the waves' frequency, by least squares.

In a random sea, after its soft start:
significant_roll: the mean of the highest third of the swings, each half the way from side to side between upward
crossings of the mean (Sverdrup & Munk 1947). For a roll of a narrow band it is twice the rms (Longuet-Higgins 1952).
Error: half the difference between the two halves of the run.
"""

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band, error_of, median_band, swing, thinned
from lab.measures.loose import is_loose
from lab.measures.ship import (
    LEAST_CROSSINGS,
    has_ship,
    in_random_sea,
    in_words,
    losses,
    moved_axis,
    regular_outcome,
    significant_roll,
    wave_frequency,
)
from lab.measures.ship_frozen import frozen
from lab.measures.spectrum import QUIETEST, amplitude_spectrum
from lab.measures.value import Value, over_worlds
from lab.preset.sections.ship import axis_place
from lab.recording import Recording
from lab.recording.ship_end import VERBS, End, ends
from solvers.machine.quantity import ROLL
from solvers.ship.outcome import CYCLES, Outcome

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MARGIN = 0.02  # of the time shown: left empty after the loss of a ship
LEAST_PORTRAIT = 20  # samples
HIGHEST_ROLL = 3.0  # Hz


def applies(recording: Recording) -> bool:
    """There is a ship."""
    return has_ship(recording)


def measure(recording: Recording) -> dict[str, Value]:
    """largest_roll, roll_amplitude, roll_bias, significant_roll (deg), capsized_at, roll_period (s) and so on."""
    time, roll = recording.series["time"], recording.series["pose"][..., ROLL]
    end = ends(recording.series)
    lost = np.array([one is not None for one in end])
    found = {
        "largest_roll": over_worlds(np.degrees(np.abs(roll).max(axis=0)), "deg"),
        **losses("", recording, end),
        "roll_period": over_worlds([_period(time, r) for r in roll.T], "s", missing="too few swings"),
    }
    if in_random_sea(recording):
        found["significant_roll"] = significant_roll(recording, time, roll, lost)
    if wave_frequency(recording) is None:
        return found
    return found | _steady_roll(recording) | _fundamental(recording, lost)


def _steady_roll(recording: Recording) -> dict[str, Value]:
    """roll_amplitude and roll_bias (deg)."""
    outcomes = [_outcome(recording, world) for world in range(recording.worlds)]
    steady = [(o.amplitude, o.mean) if o and o.kind not in VERBS else (np.nan, np.nan) for o in outcomes]
    kinds = Counter(in_words(o) for o in outcomes if o)
    note = ", ".join(kind if count == recording.worlds else f"{count} {kind}" for kind, count in kinds.items())
    amplitude, mean = np.degrees(np.array(steady).T)
    return {
        "roll_amplitude": over_worlds(amplitude, "deg", note=note, missing="no steady roll"),
        "roll_bias": over_worlds(mean, "deg", missing="no steady roll"),
    }


def _fundamental(recording: Recording, lost: np.ndarray) -> dict[str, Value]:
    """sway_amplitude, heave_amplitude (mm) and roll_fundamental (deg); none for a ship that was lost (W,)."""
    time, frequency = recording.series["time"], wave_frequency(recording)
    last = time > time[-1] - CYCLES * 2.0 * np.pi / frequency
    moved = moved_axis(recording, last)
    phase = frequency * time[last, None]
    waves = np.hstack([np.ones_like(phase), phase, np.cos(phase), np.sin(phase)])
    fitted = np.linalg.lstsq(waves, moved.reshape(len(moved), -1))[0]
    parts = np.hypot(fitted[2], fitted[3]).reshape(recording.worlds, 3)
    parts[lost] = np.nan
    units = {"sway_amplitude": (1e3, "mm"), "heave_amplitude": (1e3, "mm"), "roll_fundamental": (np.degrees(1), "deg")}
    return {
        name: over_worlds(scale * parts[:, k], unit, missing="no steady motion")
        for k, (name, (scale, unit)) in enumerate(units.items())
    }


def _outcome(recording: Recording, world: int) -> Outcome | None:
    """What became of the ship of one world, until she was lost."""
    end, time = ends(recording.series)[world], recording.series["time"]
    roll = recording.series["pose"][:, world, ROLL]
    if end:
        kept = time <= end.time
        time, roll = time[kept], roll[kept]
    return regular_outcome(time, roll, wave_frequency(recording), end)


def _period(time: np.ndarray, roll: np.ndarray) -> float:
    """Mean time (s) between upward crossings of the mean in the last half of a roll (T,), rad; NaN for too few."""
    half = len(time) // 2
    t, x = time[half:], roll[half:] - roll[half:].mean()
    up = np.flatnonzero((x[:-1] < 0.0) & (x[1:] >= 0.0))
    if len(up) < LEAST_CROSSINGS:
        return np.nan
    crossing = t[up] - x[up] / (x[up + 1] - x[up]) * (t[up + 1] - t[up])
    return float(np.diff(crossing).mean())


def draw_roll(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Roll of a ship in time, with loose and with frozen cargo; below her sway and heave and the shift of her cargo."""
    time, moved = recording.series["time"], moved_axis(recording)
    moves = recording.preset.ship.freedom != "roll"
    laden, loose = recording.preset.matters, _loose(recording)
    panels = sheet.panels(heights=(2, *(1,) * moves, *(1,) * bool(laden)), columns=3)
    upper, lower = panels[0, 0], panels[-1, 0]
    alone = frozen(recording)
    if alone is not None:
        upper.plot(*thinned(alone[0], np.degrees(alone[1])), color=GREY, lw=0.9, label="cargo frozen")
    for world, end in enumerate(ends(recording.series)):
        turned = np.degrees(moved[:, world, 2])
        upper.plot(*thinned(time, turned), color=BLUE, lw=1.0, label=None if world else loose)
        if end:
            _mark_end(upper, end, recording.worlds)
    _draw_answer(sheet, upper, recording, values)
    upper.set_ylabel("roll (deg),\npositive to port")
    if moves:
        band(panels[1, 0], time, 1e3 * moved[..., 0], BLUE, "sway of the axis")
        band(panels[1, 0], time, 1e3 * moved[..., 1], GREEN, "heave of the axis")
        panels[1, 0].set_ylabel("sway, heave\n(mm)")
    if laden:
        cargo = "centre_of_mass" if is_loose(recording) else "water_centre"
        centre = 1e3 * recording.series[cargo][..., 0]
        band(lower, time, centre - centre[0], VERMILION)
        lower.set_ylabel(f"shift of the\n{'cargo' if is_loose(recording) else 'water'} (mm)")
    lower.set_xlabel(f"time (s); axis: {axis_place(recording.preset.ship)}")
    lower.set_xlim(time[0], time[-1] + (MARGIN * np.ptp(time) if any(ends(recording.series)) else 0.0))


def _loose(recording: Recording) -> str:
    """What the curves of the run itself show."""
    return "cargo loose" if recording.preset.matters else "empty hold"


def _draw_answer(sheet: Sheet, axes: "Axes", recording: Recording, values: Mapping[str, Value]) -> None:
    """The amplitude about the mean roll, over the time that it was measured in."""
    time, frequency = recording.series["time"], wave_frequency(recording)
    middle = values["roll_bias"].value if "roll_bias" in values else 0.0
    if frequency is not None and middle is not None:
        span = max(time[0], time[-1] - CYCLES * 2.0 * np.pi / frequency), time[-1]
        swing(sheet, axes, middle, values.get("roll_amplitude"), "roll amplitude", VERMILION, span)
    elif "significant_roll" in values:
        span = recording.preset.waves.soft_start, time[-1]
        swing(sheet, axes, 0.0, values["significant_roll"], "significant roll", VERMILION, span)


def _mark_end(axes: "Axes", end: End, worlds: int) -> None:
    """The time at which a ship was lost; in words where there is only one ship."""
    axes.axvline(end.time, color=VERMILION, lw=1.0)
    axes.plot(end.time, np.degrees(end.roll), "x", color=VERMILION)
    if worlds == 1:
        words = {"xycoords": axes.get_xaxis_transform(), "textcoords": "offset points", "ha": "right", "va": "bottom"}
        axes.annotate(end.words, (end.time, 1.0), (0, 2), color=VERMILION, fontsize=8, **words)


def draw_portrait(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Phase portrait of a ship's roll, the last half of the run darker."""
    ((axes,),) = sheet.panels()
    roll, rate = (np.degrees(recording.series[name][..., ROLL]) for name in ("pose", "pose_rate"))
    half = len(roll) // 2
    alone = frozen(recording)
    if alone is not None and len(alone[1]) > LEAST_PORTRAIT:
        later = slice(len(alone[1]) // 2, None)
        turned = np.degrees(alone[1])
        axes.plot(turned[later], np.gradient(turned, alone[0])[later], color=GREY, lw=0.8, label="cargo frozen")
    for world in range(recording.worlds):
        axes.plot(*thinned(roll[: half + 1, world], rate[: half + 1, world]), color=BLUE, lw=0.5, alpha=0.3)
        label = None if world else f"{_loose(recording)}, last half"
        axes.plot(*thinned(roll[half:, world], rate[half:, world]), color=BLUE, lw=0.9, label=label)
    axes.set_xlabel("roll (deg)")
    axes.set_ylabel("rate of roll (deg/s)")


def draw_spectrum(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Amplitude spectrum of a ship's roll over the last half of the run; none where a ship was lost."""
    time, roll = recording.series["time"], np.degrees(recording.series["pose"][..., ROLL])
    half = len(time) // 2
    if any(ends(recording.series)) or len(time) - half < LEAST_PORTRAIT:
        return
    frequencies, amplitudes = amplitude_spectrum(time[half:], roll[half:])
    if not amplitudes.any():
        return
    ((axes,),) = sheet.panels()
    kept = (frequencies > 0.0) & (frequencies < HIGHEST_ROLL)
    median_band(axes, 2.0 * np.pi * frequencies[kept], amplitudes[kept], BLUE, "roll")
    axes.set_yscale("log")
    axes.set_ylim(QUIETEST * amplitudes.max(), 2.0 * amplitudes.max())
    driven = wave_frequency(recording)
    if driven is not None:
        axes.axvline(driven, color=GREY, ls=":", lw=0.8, label=f"waves of {driven:.3g} rad/s")
    fitted = values.get("roll_fundamental")
    if driven is not None and fitted is not None and fitted.value is not None:
        label = f"fitted amplitude {sheet.words(fitted)}"
        axes.errorbar([driven], [fitted.value], [error_of(fitted)], fmt="ko", ms=3.5, capsize=2.5, label=label)
    axes.set_xlim(0.0, 2.0 * np.pi * HIGHEST_ROLL)
    axes.set_xlabel("frequency (rad/s)")
    axes.set_ylabel("amplitude of roll (deg)")


FIGURES = {"roll": draw_roll, "portrait": draw_portrait, "roll-spectrum": draw_spectrum}
