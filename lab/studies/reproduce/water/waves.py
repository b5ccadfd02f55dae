"""Waves that do not break, beside measured ones: the beat in a swaying tank, the slow swing in a pitching one.

Faltinsen, Rognebakke, Lukovsky & Timokha (2000), J. Fluid Mech. 407, 201, figure 7; Akyildiz & Ünal (2006), Ocean Eng.
33, 2135, figure 5. Both series were read off their figures, the first to some 3 mm and 0.02 s.
"""

import numpy as np
from matplotlib.figure import Figure

from lab.measures.steady import harmonics
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.estimates import Estimate
from lab.studies.reproduce.experiment import Found, Row, Told, held
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.costs import beside
from lab.studies.reproduce.water.measured import drawn

TURNS = {  # s: mm, the measured crests and troughs of the gauge 50 mm from the wall
    **{1.93: -88.0, 2.57: 142.1, 3.27: -92.5, 4.04: 109.3},
    **{7.00: -66.8, 7.71: 124.8, 8.30: -82.5, 9.16: 141.4},
}
NEAR = 0.3  # s about a measured turn, where ours is sought
EARLY, FIRST = 0.8, -41.0  # s, mm: the first trough comes before; linear theory has it so deep
CREST, LATE = "10 %: a crest of a sound computation", "0.1 s in 10 s: the beat of a sound computation"
GAUGE = 0  # the wall at which the water falls first, as in the experiment
SWAY, PITCH = (
    "sloshing_sway_rectangular/faltinsen2000_h0.6_T1.3.csv",
    "sloshing_pitch_rectangular/akyildiz_unal2006_P2.csv",
)
SWING = 0.367, -6.2, 3.22  # kPa, deg, kPa: the sine of 2 rad/s through the measured points, and their mean
THEORY = "0.323 kPa by linear potential flow, by finite differences at 2.5 mm"
COLOURS = BLUE, VERMILION, GREEN


def sway_beat(found: Found) -> Told:
    """The turns of the wave beside the measured ones."""
    heads = [f"{'crest' if size > 0 else 'trough'} at {when:g} s: {size:g} mm" for when, size in TURNS.items()]
    return beside(
        found,
        heads,
        lambda one: [f"{size:.0f} mm, {late:+.2f} s" for late, size in turns(*elevation(one))],
        lambda label, one: [*_turn_rows(label, turns(*elevation(one))), _first_row(label, one)],
        _waves,
    )


def elevation(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the rise (mm) at the gauge over the level at the start."""
    depth = one.recording.series["level_depth"][:, 0, GAUGE]
    return one.recording.series["time"], 1e3 * (depth - depth[0])


def turns(time: np.ndarray, rise: np.ndarray) -> list[tuple[float, float]]:
    """For each measured turn how much later ours comes (s), and its size (mm)."""
    found = []
    for when, size in TURNS.items():
        near = np.abs(time - when) <= NEAR
        at = int(np.argmax(np.sign(size) * rise[near]))
        found.append((float(time[near][at] - when), float(rise[near][at])))
    return found


def _turn_rows(label: str, ours: list[tuple[float, float]]) -> list[Row]:
    rows = []
    for (when, size), (_, our_size) in zip(TURNS.items(), ours, strict=True):
        if size > 0.0:
            said = f"crest at {when:g} s, {label}"
            rows.append(held(said, f"{size:g} mm", Estimate.exact(our_size), (0.9 * size, 1.1 * size), CREST, "mm"))
    worst = max((late for late, _ in ours), key=abs)
    said = f"farthest of eight crests and troughs from its time, {label}"
    return [*rows, held(said, "0 s", Estimate.exact(worst), (-0.1, 0.1), LATE, "s")]


def _first_row(label: str, one: Outcome) -> Row:
    """The first trough, which is low enough for linear theory (Faltinsen & Timokha 2009; six modes, from rest)."""
    time, rise = elevation(one)
    lowest = Estimate.exact(float(rise[time < EARLY].min()))
    said = f"first trough, {label}"
    between = 1.05 * FIRST, 0.95 * FIRST
    return held(said, f"{FIRST:g} mm by linear theory (measured: -31)", lowest, between, "5 %: ours", "mm")


def _waves(runs: dict[str, Outcome]) -> Figure:
    figure, axes = canvas(SIZE)
    for (label, one), colour in zip(runs.items(), COLOURS, strict=False):
        axes.plot(*elevation(one), color=colour, lw=1.1, label=label)
    crests = {when: size for when, size in TURNS.items() if size > 0}
    axes.errorbar(*zip(*crests.items(), strict=True), 0.1 * np.array([*crests.values()]), fmt="none", ecolor="0.4",
                  capsize=2.5, label="measured crests ± 10 %")  # fmt: skip
    if (measured := drawn(axes, SWAY)) is not None:
        axes.plot(measured[0], 1e3 * measured[1], "o", ms=2, color="black", label="measured")
    axes.set(xlabel="time (s)", ylabel="rise 50 mm from the wall (mm)")
    figure.legend(loc=BELOW, ncols=3)
    return figure


def pitch(found: Found) -> Told:
    """The swing of the pressure beside the measured one."""
    heads = ("swing (kPa)", "phase (deg)", "mean (kPa)")
    return beside(found, heads, lambda one: [f"{number:.3f}" for number in swing(one)], _swing_rows, _swings)


def _swing_rows(label: str, one: Outcome) -> list[Row]:
    size, phase, mean = map(Estimate.exact, swing(one))
    return [
        held(f"swing of the pressure, {label}", "0.367 kPa", size, (0.330, 0.404), "10 %: ours", "kPa"),
        held(f"the same, {label}", THEORY, size, (0.317, 0.329), "2 %: ours", "kPa"),
        held(f"ahead of the tank, {label}", "-6 deg", phase, (-18.0, 6.0), "0.1 s: ours", "deg"),
        held(f"mean, {label}", "3.22 kPa", mean, (3.16, 3.29), "2 %: its place follows from it", "kPa"),
    ]


def swing(one: Outcome) -> tuple[float, float, float]:
    """The sine of the tank's frequency through the pressure at the gauge that rises first: kPa, deg, and the mean."""
    time, pressure = _pressure(one)
    frequency = one.recording.preset.motion.roll.frequency
    complex_size = harmonics(time, pressure[:, None], frequency, (1,))[0, 0]
    return abs(complex_size), float(np.degrees(np.angle(1j * complex_size))), float(pressure.mean())


def _pressure(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the pressure (kPa) over whole periods."""
    series = one.recording.series
    period = 1.0 / one.recording.preset.motion.roll.frequency
    whole = series["time"] <= period * np.floor(series["time"][-1] / period)
    both = 1e-3 * series["gauge_pressure"][whole, 0]
    early = series["time"][whole] < 0.25 * period
    return series["time"][whole], both[:, int(both[early].mean(axis=0).argmax())]


def _swings(runs: dict[str, Outcome]) -> Figure:
    figure, axes = canvas(SIZE)
    for (label, one), colour in zip(runs.items(), COLOURS, strict=False):
        axes.plot(*_pressure(one), color=colour, lw=1.0, label=label)
    time = np.linspace(0.0, 10.0, 400)
    size, phase, mean = SWING
    for share in (0.9, 1.1):
        sine = mean + share * size * np.sin(2.0 * time + np.radians(phase))
        label = "sine through the measured points, ± 10 %" if share < 1 else None
        axes.plot(time, sine, color="0.5", ls=":", lw=1.0, label=label)
    if (measured := drawn(axes, PITCH)) is not None:
        axes.plot(*measured, "o", ms=3, color="black", label="measured")
    axes.set(xlabel="time (s)", ylabel="pressure on the end wall (kPa)")
    figure.legend(loc=BELOW, ncols=3)
    return figure
