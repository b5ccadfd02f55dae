"""Surfaces of water beside measured ones: profiles of a dam break over a wet bed, waves at gauges of a flume.

Jánosi, Jan, Szabó & Tél (2004), Exp. Fluids 37, 219 (SPHERIC benchmark 5): the profiles carry no times; they are
62.5 ms apart, and the last is taken at the time at which it fits ours best. As read, the water far ahead lies up to
7 mm over the 38 mm of the bed; each profile is taken down to that. Waves: CIEMito flume, UPC Barcelona.
"""

from collections.abc import Callable, Sequence
from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lab.preset.sections.water.liquid import spacing
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn, series
from lab.studies.reproduce.water.theory import wavemaker
from lab.studies.reproduce.water.theory.wave_tank import WaveTank, rise_at

BETWEEN = 0.0625  # s, two profiles
PROFILES = (1, 2, 4, 5, 7)  # those that are there
HIGH = 60.0  # mm: the breaking front is the farthest water as high
TIP = 60.0  # mm on either side of it are left out
STILL, AHEAD = 38.0, 120.0  # mm: depth of the bed, which lies still so far before the front
COLOURS = BLUE, VERMILION, GREEN
FLUME = "ciemito_flume/piston_and_gauges.csv"
NODES = 150  # of the surface of potential flow: 250 change heights of waves by 0.2 %
STARTED = 0.882  # s, in the record, when the piston begins to move


def surface(one: Outcome, frame: int, at: np.ndarray) -> np.ndarray:
    """Height (mm) of the highest water at places (mm), by the particles within a spacing; NaN where there is none."""
    place = 1e3 * np.asarray(one.recording.frames["water_position"][frame][0], dtype=float)
    size = 1e3 * spacing(one.recording.preset)
    near = np.abs(place[:, 0] - at[:, None]) < size
    highest = np.where(near, place[:, 1], -np.inf).max(axis=1) + 0.5 * size
    return np.where(np.isfinite(highest), highest, np.nan)


@cache
def profile(number: int) -> tuple[np.ndarray, np.ndarray] | None:
    """Places and heights (mm) of a measured profile; None if it is not there."""
    read = series(f"spheric05_dam_break_wet_bed/profile_{number}.csv")
    if read is None:
        return None
    x, y = 10.0 * read
    return x, y + STILL - float(np.median(y[x > front(x, y) + AHEAD]))


def front(x: np.ndarray, y: np.ndarray) -> float:
    """The place (mm) of the farthest water that is HIGH."""
    return float(x[y > HIGH].max())


def off(one: Outcome, frame: int, number: int) -> float:
    """Root mean square difference (mm) of our surface in a frame from a measured profile, its breaking tip left out."""
    x, y = profile(number)
    kept = np.abs(x - front(x, y)) > TIP
    x, y = x[kept], y[kept]
    return float(np.sqrt(np.nanmean((surface(one, frame, x) - y) ** 2)))


def first_time(one: Outcome, _: object) -> float:
    """The time (s) of the first profile, from that of the frame that the last one fits best."""
    last = PROFILES[-1]
    if profile(last) is None:
        return np.nan
    time = one.recording.frames["time"][:]
    frames = np.flatnonzero(time > (last - 1) * BETWEEN)
    return float(time[min(frames, key=lambda k: off(one, k, last))]) - (last - 1) * BETWEEN


def profile_off(one: Outcome, number: float) -> float:
    """How far (mm, rms) our surface is from a measured profile, the first of which is at `first_time`."""
    wanted, time = first_time(one, None) + (number - 1) * BETWEEN, one.recording.frames["time"][:]
    if np.isnan(wanted) or time[-1] < wanted - 0.01:
        return np.nan
    return off(one, int(np.abs(time - wanted).argmin()), int(number))


def crest_ratio(one: Outcome, asked: Sequence[float]) -> float:
    """Mean height of our waves over the measured ones at a gauge (its number), between two times (s) of the run.

    A height is the largest less the smallest rise of a period of 1 s.
    """
    gauge, begin, end = int(asked[0]), asked[1], asked[2]
    read = series(FLUME)
    time, depth = one.recording.series["time"], one.recording.series["level_depth"][:, 0, gauge]
    if read is None or time[-1] < end - 0.01:
        return np.nan
    ours = _heights(time, depth, begin, end)
    return float(np.mean(ours) / np.mean(_heights(read[0] - STARTED, read[2 + gauge], begin, end)))


def crest_over_potential_flow(one: Outcome, asked: Sequence[float]) -> float:
    """The same over the heights of nonlinear potential flow, which the piston moves in the same way."""
    gauge, begin, end = int(asked[0]), asked[1], asked[2]
    time, depth = one.recording.series["time"], one.recording.series["level_depth"][:, 0, gauge]
    ours = _heights(time, depth, begin, end)
    return float(np.mean(ours) / np.mean(_heights(*nonlinear(one, gauge), begin, end)))


def linear_over_measured(one: Outcome, asked: Sequence[float]) -> float:
    """Mean height of the waves of linear theory over the measured ones, as in `crest_ratio`."""
    return _over_measured(linear, one, asked)


def potential_flow_over_measured(one: Outcome, asked: Sequence[float]) -> float:
    """That of nonlinear potential flow."""
    return _over_measured(nonlinear, one, asked)


def _over_measured(theory: Callable, one: Outcome, asked: Sequence[float]) -> float:
    gauge, begin, end = int(asked[0]), asked[1], asked[2]
    read = series(FLUME)
    if read is None:
        return np.nan
    measured = _heights(read[0] - STARTED, read[2 + gauge], begin, end)
    return float(np.mean(_heights(*theory(one, gauge), begin, end)) / np.mean(measured))


def linear(one: Outcome, gauge: int) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) s and rise (T,) m at a gauge by linear theory, of the piston as it moves in the run."""
    time = np.arange(0.0, 8.0, 0.01)
    return wavemaker.rise(time, _piston(one)(time), _depth(one), _places(one)[gauge])


def nonlinear(one: Outcome, gauge: int) -> tuple[np.ndarray, np.ndarray]:
    """The same by nonlinear potential flow, up to the end of the run."""
    duration = float(one.recording.series["time"][-1])
    rise = rise_at(WaveTank(_depth(one), _length(one), NODES), _piston(one), duration, _places(one))
    instants = np.arange(0.0, duration, 0.01)
    return instants, rise(instants)[:, gauge]


def _length(one: Outcome) -> float:
    return float(np.asarray(one.recording.preset.tank.outline)[:, 0].max())


def _piston(one: Outcome) -> Callable:
    return one.recording.preset.parts["piston"].history.history.motions["sway"].curve


def _depth(one: Outcome) -> float:
    return float(np.asarray(one.recording.preset.water.region)[:, 1].max())


def _places(one: Outcome) -> tuple[float, ...]:
    return tuple(gauge.y for gauge in one.recording.preset.gauges.values())


def _heights(time: np.ndarray, rise: np.ndarray, begin: float, end: float) -> list[float]:
    edges = np.arange(begin, end + 1e-9, 1.0)
    return [float(np.ptp(rise[(time >= low) & (time < low + 1.0)])) for low in edges[:-1]]


NUMBERS = {
    "first_profile": ("s", first_time),
    "profile_off": ("mm", profile_off),
    "crest_ratio": ("1", crest_ratio),
    "crest_over_potential_flow": ("1", crest_over_potential_flow),
    "linear_over_measured": ("1", linear_over_measured),
    "potential_flow_over_measured": ("1", potential_flow_over_measured),
}


def profiles(found: Found) -> Figure:
    """Our surface of the finest run beside the measured profiles, one panel each, with 5 mm about these."""
    one = list(found.values())[-1][0]
    drawing, panels = canvas((SIZE[0], 6.0), len(PROFILES), 1, sharex=True)
    start, time = first_time(one, None), one.recording.frames["time"][:]
    for axes, number in zip(panels, PROFILES, strict=True):
        when = (0.156 if np.isnan(start) else start) + (number - 1) * BETWEEN
        frame = int(np.abs(time - when).argmin())
        place = 1e3 * np.asarray(one.recording.frames["water_position"][frame][0], dtype=float)
        axes.plot(place[:, 0], place[:, 1], ".", ms=0.8, color=BLUE, alpha=0.4)
        if (read := profile(number)) is not None:
            axes.plot(*read, color="black", lw=1.0)
            for way in (-5.0, 5.0):
                axes.plot(read[0], read[1] + way, color="0.5", lw=0.5)
        axes.set(xlim=(300.0, 1050.0), ylim=(0.0, 160.0), ylabel=f"{time[frame]:.3f} s")
    panels[-1].set_xlabel("mm from the upstream wall")
    return drawing


def waves(found: Found) -> Figure:
    """The rise at both gauges beside the measured ones."""
    drawing, panels = canvas((SIZE[0], 4.6), 2, 1, sharex=True)
    for gauge, axes in enumerate(panels):
        for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
            rows = outcomes[0].recording.series
            depth = rows["level_depth"][:, 0, gauge]
            axes.plot(rows["time"], 1e3 * (depth - depth[0]), color=colour, lw=1.0, label=label)
        when, rise = nonlinear(next(iter(found.values()))[0], gauge)
        axes.plot(when, 1e3 * rise, color="0.4", lw=0.8, ls="--", label="potential flow")
        if (read := drawn(axes, FLUME)) is not None:
            axes.plot(read[0] - STARTED, 1e3 * read[2 + gauge], "o", ms=1.8, color="black", label="measured")
        axes.set(xlim=(0.0, 7.0), ylabel=f"rise at L{gauge + 1} (mm)")
    panels[-1].set_xlabel("time (s)")
    drawing.legend(*panels[0].get_legend_handles_labels(), loc=BELOW, ncols=4)
    return drawing
