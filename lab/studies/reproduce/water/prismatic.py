"""A prismatic tank, swayed and rolled: error against spacing and speed of sound, roof contact, and what runs cost.

Trimulyono, Hashimoto & Matsuda (2019), J. Mar. Sci. Eng. 7, 247. The source gives its pressures in figures only, so
runs are compared with the finest of ours: by the root mean square difference of the pressure at P1 over nine cycles,
which counts hits and where they come, by that of the mean cycle, since no two runs break alike in the same cycle, and
by the mean peak of these cycles, of means over AVERAGE. Mean peaks at P1 to
P3 are less the hydrostatic pressure at rest, as the source's are (its section 3).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.measures.value import Value, over_worlds
from lab.preset.sections.water.liquid import depth, spacing
from lab.report.numbers import with_error
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Found, ReportSection, Row, observed
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import COSTS, cost

CYCLES = 9  # the last of a run, as in the source
PHASES = 400  # of a cycle
AVERAGE = 0.010  # s
ROOF = 210.0  # mm
UPPER = ("P2", "P3")  # gauges of the upper chamber
NEAR = 10.5e-3  # m of a gauge, within which
WET = 61e-6  # m² of water are water at it: five particles of 3.5 mm, or more finer ones
DRY = "dry"
THIRTY = 30.0  # s of motion
HOURLY = 36000.0  # s from which a duration is told in hours
HOURS = {False: 9.0, True: 81.0}  # that these took the source in the plane with water alone, and with air
FALLS = "it falls with the spacing, as the source's does from 119 to 57 Pa"
RISES = "it falls as sound gets faster: of four speeds the highest is best"
COLOURS = (*(GREY,) * 3, GREEN, VERMILION, BLUE)


@dataclass(frozen=True)
class Pressure:
    """The pressure (T,) Pa at a gauge over the last CYCLES cycles, at times (T,) s."""

    time: np.ndarray
    value: np.ndarray

    @property
    def means(self) -> np.ndarray:
        """Running means over AVERAGE."""
        samples = max(1, round(AVERAGE / (self.time[1] - self.time[0])))
        return np.convolve(self.value, np.full(samples, 1.0 / samples), "same")

    @property
    def peaks(self) -> np.ndarray:
        """The highest running mean (CYCLES,) Pa of each cycle."""
        return np.array([part.max() for part in np.array_split(self.means, CYCLES)])

    @property
    def mean_peak(self) -> float:
        """Mean of the peaks (Pa)."""
        return float(self.peaks.mean())

    @property
    def error(self) -> float:
        """Standard error (Pa) of the mean peak, from the scatter of the cycles, taken as independent."""
        return float(self.peaks.std(ddof=1)) / CYCLES**0.5

    def wet(self, least: float) -> int:
        """In how many cycles the pressure comes to `least` (Pa) or more."""
        return sum(part.max() >= least for part in np.array_split(self.value, CYCLES))

    def off(self, other: "Pressure") -> float:
        """Root mean square difference (Pa) from another, of running means."""
        return float(np.sqrt(np.mean((self.means - np.interp(self.time, other.time, other.means)) ** 2)))

    @property
    def cycles(self) -> np.ndarray:
        """Running means (CYCLES, PHASES) Pa of each cycle."""
        times = np.linspace(self.time[0], self.time[-1], CYCLES * PHASES, endpoint=False)
        return np.interp(times, self.time, self.means).reshape(CYCLES, PHASES)

    def mean_cycle_off(self, other: "Pressure") -> tuple[float, float]:
        """Root mean square difference (Pa) of the mean cycle from another's, and what cycles that scatter would give.

        The second is the expected difference of two means over CYCLES of the same water, by the variance of either.
        """
        ours, theirs = self.cycles, other.cycles
        off = ours.mean(axis=0) - theirs.mean(axis=0)
        by_scatter = (ours.var(axis=0, ddof=1) + theirs.var(axis=0, ddof=1)) / CYCLES
        return float(np.sqrt(np.mean(off**2))), float(np.sqrt(np.mean(by_scatter)))


def pressure(one: Outcome, gauge: str = "P1") -> Pressure:
    """The pressure at a gauge over the last cycles of the run's motion."""
    series, column = one.recording.series, one.recording.names["gauge"].index(gauge)
    last = _last(one, series["time"])
    return Pressure(series["time"][last], series["gauge_pressure"][last, 0, column])


def _last(one: Outcome, time: np.ndarray) -> np.ndarray:
    """Which of the times (T,) s are of the last CYCLES."""
    motion = one.recording.preset.motion
    return time >= time[-1] - CYCLES / (motion.sway or motion.roll).frequency


def at_rest(one: Outcome, gauge: str) -> float:
    """The hydrostatic pressure (Pa) at the middle of a gauge: ρ g times its depth at rest, none above the surface."""
    preset = one.recording.preset
    below = depth(preset) - preset.gauges[gauge].place[1]
    return preset.water.density * preset.run.gravity * max(0.0, below)


def peak_at(outcomes: Sequence[Outcome], given: float) -> Value:
    """The mean peak (Pa) at P1, P2 or P3 less the pressure at rest, with its error; none where no water comes.

    A gauge is dry in a cycle in which it never shows the weight of one layer of particles, ρ g Δx: a gauge in air shows
    the air's pressure, which is a few Pa.
    """
    one, gauge = outcomes[0], f"P{given:.0f}"
    found, preset = pressure(one, gauge), one.recording.preset
    wet = found.wet(preset.water.density * preset.run.gravity * spacing(preset))
    if not wet:
        return over_worlds([np.nan], "Pa", missing=DRY)
    note = "" if wet == CYCLES else f", wet in {wet} of {CYCLES}"
    less = found.mean_peak - at_rest(one, gauge)
    return over_worlds([less], "Pa", uncertainties=[found.error], kind="cycles", note=note)


def cycle_peaks(outcomes: Sequence[Outcome], given: float) -> Value:
    """The peaks (Pa) at P1, P2 or P3 less the pressure at rest, of each of the CYCLES as of a bed of its own."""
    one, gauge = outcomes[0], f"P{given:.0f}"
    return over_worlds(pressure(one, gauge).peaks - at_rest(one, gauge), "Pa")


def wet_cycles(outcomes: Sequence[Outcome], given: float) -> Value:
    """The share of the time with water at P2 or P3, by pictures, of each of the CYCLES as of a bed of its own."""
    one = outcomes[0]
    frames, volume = one.recording.frames, one.recording.volume[0]
    gauge, last = np.array(one.recording.preset.gauges[f"P{given:.0f}"].place), _last(one, frames["time"])
    away = (np.linalg.norm(frames["water_position"][k][0] - gauge, axis=1) for k in np.flatnonzero(last))
    wet = np.array([volume[each < NEAR].sum() >= WET for each in away])
    return over_worlds([part.mean() for part in np.array_split(wet, CYCLES)], "")


def told_peak(one: Outcome, gauge: str) -> str:
    """The mean peak at a gauge in words."""
    value = peak_at([one], float(gauge[1:]))
    return DRY if value.value is None else with_error(value.value, value.uncertainty, "Pa") + value.note


def convergence(found: Found) -> ReportSection:
    """Runs by spacing, or by speed of sound, beside the finest, with the fastest sound."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    pressures = {label: pressure(one) for label, one in runs.items()}
    presets = {label: one.recording.preset for label, one in runs.items()}
    finest = min(runs, key=lambda label: (spacing(presets[label]), -presets[label].water.sound_speed))
    cells = []
    for label, one in runs.items():
        own = pressures[label]
        off = _off(own, pressures[finest]) if label != finest else ["", ""]
        upper = [told_peak(one, gauge) for gauge in UPPER]
        cells.append(
            [*cost(label, one), f"{own.value.mean():.0f} Pa", f"{own.mean_peak:.0f} Pa", *off, *upper, roof(one)]
        )
    heads = [*COSTS, "mean at P1", f"mean peak of {CYCLES} cycles", f"off {finest}", "mean cycle off"]
    heads += [*(f"mean peak at {gauge}" for gauge in UPPER), "highest water"]
    return ReportSection(_falls(runs, pressures, finest), _figure(pressures), [heads, *cells])


def _off(own: Pressure, finest: Pressure) -> list[str]:
    """The differences from the finest in words: of all cycles, and of the mean one."""
    mean, by_scatter = own.mean_cycle_off(finest)
    return [f"{own.off(finest):.0f} Pa", f"{mean:.0f} Pa ({by_scatter:.0f} by scatter alone)"]


def _falls(runs: Mapping[str, Outcome], pressures: Mapping[str, Pressure], finest: str) -> list[Row]:
    """Whether the difference from the finest falls with the spacing at one speed of sound, and as sound gets faster."""
    presets = {label: one.recording.preset for label, one in runs.items()}
    sizes = {label: spacing(preset) for label, preset in presets.items()}
    sounds = {label: preset.water.sound_speed for label, preset in presets.items()}
    others = [label for label in runs if label != finest]
    finer = sorted((one for one in others if sounds[one] == sounds[finest]), key=lambda one: -sizes[one])
    faster = sorted((one for one in others if sizes[one] == sizes[finest]), key=lambda one: sounds[one])
    return [
        *_row(f"difference at P1 from {finest}", FALLS, {one: pressures[one].off(pressures[finest]) for one in finer}),
        *_row(
            f"the same of the mean of {CYCLES} cycles",
            FALLS,
            {one: pressures[one].mean_cycle_off(pressures[finest])[0] for one in finer},
        ),
        *_row(f"difference at P1 from {finest}", RISES, {one: pressures[one].off(pressures[finest]) for one in faster}),
    ]


def _row(says: str, source: str, off: Mapping[str, float]) -> list[Row]:
    """Whether differences (Pa) from the finest run fall from run to run; nothing to say of one run."""
    if len(off) < 2:
        return []
    ours = ", ".join(f"{value:.0f} Pa at {label}" for label, value in off.items())
    falls = list(off.values()) == sorted(off.values(), reverse=True)
    return [observed(says, source, ours, Verdict.AGREES if falls else Verdict.DIFFERS, "each run is nearer")]


def thirty_seconds(found: Found) -> ReportSection:
    """What THIRTY seconds would cost, by runs of a part of a second, beside the source's hours."""
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    hours = HOURS[any(one.recording.preset.air for one in runs.values())]
    cells = []
    for label, one in runs.items():
        whole = THIRTY * one.cost["seconds"]["run"] / float(one.recording.series["time"][-1])
        told = f"{whole / 60.0:.0f} min" if whole < HOURLY else f"{whole / 3600.0:.0f} h"
        cells.append([*cost(label, one), told, f"{3600.0 * hours / whole:.2g}"])
    return ReportSection(
        [], None, [[*COSTS, f"{THIRTY:.0f} s would take", f"the source's {hours:g} h over that"], *cells]
    )


def roof(one: Outcome) -> str:
    """How high the water comes, in words."""
    return f"{one['highest_water'].value:.0f} mm{', the roof' if below_roof(one, ROOF) <= 0.0 else ''}"


def below_roof(one: Outcome, height: float) -> float:
    """How far (mm) the highest water is below a roof at a height (mm), less a spacing: at or below zero it touches."""
    return height - 1e3 * spacing(one.recording.preset) - one["highest_water"].value


NUMBERS = {
    "below_roof": ("mm", below_roof),
    "highest_water_alone": ("mm", lambda one, _: one["highest_water"].value),
    "p1_mean": ("Pa", lambda one, _: float(pressure(one).value.mean())),
    "p1_mean_peak": ("Pa", lambda one, _: pressure(one).mean_peak),
}


def figure(found: Found) -> Figure:
    """The pressure at P1 of all runs."""
    return _figure({label: pressure(outcomes[0]) for label, outcomes in found.items()})


def _figure(pressures: Mapping[str, Pressure]) -> Figure:
    """Running means of the pressure over the last three cycles."""
    figure, axes = canvas((SIZE[0], 3.0))
    for (label, one), colour in zip(pressures.items(), COLOURS[-len(pressures) :], strict=False):
        late = one.time >= one.time[-1] - (one.time[-1] - one.time[0]) / 3.0
        axes.plot(one.time[late], 1e-3 * one.means[late], lw=1.0, color=colour, label=label)
    axes.set(xlabel="time (s)", ylabel="pressure at P1 (kPa)")
    figure.legend(loc=BELOW, ncols=4)
    return figure
