"""Compare the measured section with the lab in the flume's own wave train, and find what each term explains."""

from collections.abc import Mapping, Sequence
from math import pi

import numpy as np
from matplotlib.figure import Figure

from lab.assembly.ship import make_water
from lab.measures.value import Value
from lab.preset.sections.sea import Sea
from lab.report.plots import BELOW, BLUE, GREY, canvas
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Found, ReportSection, Row, Tolerance, observed, stated
from lab.studies.reproduce.figures import leading_number
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.rolls import FREQUENCY
from lab.studies.reproduce.ships.section_terms import (
    COMMON,
    FLAP,
    FLUME,
    MEASUREMENTS,
    MOTIONS,
    Measurement,
    Model,
    Term,
    estimated,
    panel_change,
    potential_flow,
    rubbed,
    terms,
    usual,
)

WITHIN = 10.0  # %, tolerance beyond the readings of the two instruments
TOLERANCE = f"{WITHIN:g} % beyond what both instruments read: our choice, they differ by up to 28 %"
TOLD = 2.0  # % of the camera's reading: terms that change less in every test are left out of the table
BEGINS, ENDS = (-1.0, -0.5, 0.0, 0.5, 1.0), (-1.0, 0.0)  # periods, of other windows
PEAK = 5.0, 5.5  # rad/s, about the natural roll and heave
DENSE = np.array([4.0, 4.3, 4.6, 4.8, 4.9, 5.0, 5.1, 5.2, 5.3, 5.4, 5.5, 5.7, 6.0, 6.5, 7.0, 8.0, 9.0, 10.0])  # rad/s
SPLIT = (4.0, 6.0), (6.0, 10.0)  # rad/s, of the figure's columns
TOPS, LOWS, HIGHS = (1.8, 2.2, 16.0), (0.1, 0.015, 0.03), (1.0, 1.2, 1.2)  # of its axes
# Sundsdal, Greco, Hanssen and Lugni (NTNU, 2025): sway and heave over the waves' amplitude, roll over their slope's
MEASURED = {
    "4.143 rad/s": (0.931, 1.210, 2.356),
    "5.194 rad/s": (0.344, 1.623, 5.933),
    "7.004 rad/s": (0.397, 0.307, 0.331),
}
HEIGHT = 12.0  # mm
MARGIN = "20 %: ours, as one run was measured at each frequency"
LIGHT, WARM = "#9ecae1", "#f4a582"


def report(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """Rows of the comparison and of what explains the peak, and a table of all terms; it needs no runs."""
    base, ours = potential_flow(), estimated()
    frequencies = np.array([one.frequency for one in MEASUREMENTS])
    steady = base.steady(frequencies)
    small = np.array([base.small(one) for one in MEASUREMENTS])
    train = np.array([base.sailed(one) for one in MEASUREMENTS])
    with_term = {term: np.array([term.found(one) for one in MEASUREMENTS]) for term in terms()}
    estimate = np.array([ours.sailed(one) for one in MEASUREMENTS])
    rows = [*compared(estimate), *counted_within(estimate), other_windows()]
    rows += explained(steady, train, with_term)
    change = panel_change(160, np.unique(frequencies)).max()
    rows.append(observed("twice as many panels", "", f"changes no amplitude by more than {100.0 * change:.1f} %", None))
    return ReportSection(rows, _figure(base), _table(steady, small, train, with_term))


def compared(ours: np.ndarray) -> list[Row]:
    """Each amplitude (tests, 3) beside its two readings; it agrees if it lies within `WITHIN` of their interval."""
    rows = []
    for k, motion in enumerate(MOTIONS):
        for test, value in zip(MEASUREMENTS, ours[:, k], strict=True):
            readings = [one[k] for one in (test.camera, test.accelerometers) if one[k] is not None]
            off = [100.0 * (value / one - 1.0) for one in readings]
            agrees = min(off) <= WITHIN and max(off) >= -WITHIN
            verdict = Verdict.AGREES if agrees else Verdict.DIFFERS  # no grains: nothing varies from bed to bed
            says = ", ".join(f"{one:.3g}" for one in readings)
            apart = ", ".join(f"{one:+.0f} %" for one in off)
            rows.append(Row(f"{motion} at {test.title}", says, f"{value:.3g}", apart, TOLERANCE, verdict))
    return rows


def counted_within(ours: np.ndarray) -> list[Row]:
    """How many amplitudes lie within 10 and 20 % of each instrument alone."""
    rows = []
    for name in ("camera", "accelerometers"):
        said = np.array([getattr(test, name) for test in MEASUREMENTS], dtype=float)
        off = np.abs(ours / said - 1.0)[np.isfinite(said)]
        counts = f"{(off <= 0.1).sum()} and {(off <= 0.2).sum()} of {len(off)}"
        rows.append(observed(f"within 10 and 20 % of the {name} alone", "", counts, None))
    return rows


def other_windows() -> Row:
    """How many amplitudes lie within 10 and 20 % of the camera in other windows of our train.

    They begin up to a period earlier or later than the page's, or end a period earlier: the train is not steady, and
    which part of it is taken is our choice.
    """
    said = np.array([test.camera for test in MEASUREMENTS])
    off = np.abs(np.array([estimated().in_windows(test, shifted(test)) for test in MEASUREMENTS]) / said[:, None] - 1.0)
    ends = [f"{counts.min()} to {counts.max()}" for counts in ((off <= share).sum(axis=(0, 2)) for share in (0.1, 0.2))]
    told = f"{ends[0]} and {ends[1]} of {said.size} in {off.shape[1]} windows"
    return observed("the same of the camera, our window begun or ended up to a period off", "", told, None)


def shifted(test: Measurement) -> list[tuple[float, float]]:
    """A test's window (s) with its begin moved by BEGINS and its end by ENDS, in periods."""
    period, (begin, end) = 2.0 * pi / test.frequency, test.window
    return [(begin + first * period, end + last * period) for first in BEGINS for last in ENDS]


def explained(steady: np.ndarray, train: np.ndarray, with_term: Mapping[Term, np.ndarray]) -> list[Row]:
    """The part of the excess of roll near its peak that each term removes, in per cent of that excess."""
    peak = [k for k, test in enumerate(MEASUREMENTS) if PEAK[0] < test.frequency < PEAK[1]]
    camera = np.array([test.camera[2] for test in MEASUREMENTS])[peak]
    other = np.array([test.accelerometers[2] for test in MEASUREMENTS])[peak]
    above, excess = steady[peak, 2] / camera - 1.0, train[peak, 2] - camera
    places = ", ".join(f"{MEASUREMENTS[k].frequency:g}" for k in peak)
    rows = [
        observed(f"roll above the camera's, steady small waves, {places} rad/s", "", _per_cent(above), None),
        observed("roll above the camera's, in the flume's train", "", _per_cent(excess / camera), None),
    ]
    shares = {f"{term.name} ({term.source})": train[peak, 2] - found[peak, 2] for term, found in with_term.items()}
    shares["the accelerometers' reading for the camera's"] = other - camera
    for name, share in shares.items():
        rows.append(observed(f"of the latter explains: {name}", "", _per_cent(share / excess), None))
    return rows


def _per_cent(shares: np.ndarray) -> str:
    return ", ".join(f"{100.0 * share:+.0f} %" for share in shares)


def _table(steady, small, train, with_term: Mapping[Term, np.ndarray]) -> list[list[str]]:
    """All amplitudes, one term at a time, and how much the term changes them in per cent of the camera's readings."""
    rows = [["motion", "with", *(test.title for test in MEASUREMENTS)]]
    for k, motion in enumerate(MOTIONS):
        camera = np.array([test.camera[k] for test in MEASUREMENTS])
        other = [test.accelerometers[k] for test in MEASUREMENTS]
        rows.append([motion, "measured, camera", *(f"{value:.3g}" for value in camera)])
        rows.append([motion, "measured, accelerometers", *("" if v is None else f"{v:.3g}" for v in other)])
        rows.append([motion, "potential flow, steady small waves", *_changed(steady[:, k], camera, camera)])
        rows.append([motion, "the same in the flume's train", *_changed(small[:, k], steady[:, k], camera)])
        rows.append([motion, "the same of its height (base)", *_changed(train[:, k], small[:, k], camera)])
        for term, found in with_term.items():
            if (np.abs(found[:, k] - train[:, k]) / camera).max() > 0.01 * TOLD:
                rows.append([motion, f"base, {term.name}", *_changed(found[:, k], train[:, k], camera)])
    return rows


def _changed(values: np.ndarray, before: np.ndarray, unit: np.ndarray) -> list[str]:
    return [f"{v:.3g} ({100.0 * (v - b) / u:+.0f} %)" for v, b, u in zip(values, before, unit, strict=True)]


def section_amplitudes(found: Found) -> list[Row]:
    """Amplitudes of the section without cargo beside the measured ones."""
    rows = []
    for one in found["section"]:
        at = str(one.setting[FREQUENCY])
        omega, water = leading_number(at), make_water(Sea(depth=1.0), 9.81)
        slope = np.degrees(1e-3 * HEIGHT * float(water.wave_number(omega)))
        units = {"sway_amplitude": HEIGHT, "heave_amplitude": HEIGHT, "roll_fundamental": slope}
        for (name, per), measured in zip(units.items(), MEASURED[at], strict=True):
            ours = one[name]
            found_ratio = None if ours.value is None else Value(ours.value / per, "1", worlds=(ours.value / per,))
            allowed = Tolerance(0.2 * measured, MARGIN)
            rows.append(stated(f"{name.split('_')[0]} at {at}", measured, found_ratio, allowed, exact=True))
    return rows


def window(frequency: float) -> tuple[float, float]:
    """Time window (s after the flap's start): the train is steady, the model's own waves are not reflected back yet."""
    period, travel = 2.0 * pi / frequency, FLAP.distance / float(FLUME.group_speed(frequency))
    begin = travel + FLAP.ramp * period + 1.5
    return begin, begin + float(np.clip((3.0 * travel - begin) // period, 1, 8)) * period


def _figure(base: Model) -> Figure:
    """About the peak to the left, the small motions to the right."""
    figure, panels = canvas((9.0, 8.4), 3, 2)
    fine, curves = np.linspace(DENSE[0], DENSE[-1], 400), _dense()
    steady = base.steady(fine)
    for k, motion in enumerate(MOTIONS):
        for axes, (first, last) in zip(panels[k], SPLIT, strict=True):
            _panel(axes, {name: values[:, k] for name, values in curves.items()}, (fine, steady[:, k]))
            _readings(axes, k)
            axes.set_xlim(first, last)
        panels[k, 0].set_ylim(0.0, TOPS[k])
        panels[k, 1].set_yscale("log")
        panels[k, 1].set_ylim(LOWS[k], HIGHS[k])
        panels[k, 0].set_ylabel(f"{motion} over the waves'\n{'slope' if motion == 'roll' else 'amplitude'}")
    for axes in panels[-1]:
        axes.set_xlabel("frequency of the waves (rad/s)")
    figure.legend(*panels[0, 0].get_legend_handles_labels(), loc=BELOW, ncols=2)
    return figure


def _panel(axes, curves: Mapping[str, np.ndarray], steady: tuple[np.ndarray, np.ndarray]) -> None:
    usual_range = f"viscous roll damping usual of bare hulls: {100 * COMMON[0]:g} % to {100 * COMMON[1]:g} % at 15 deg"
    axes.fill_between(DENSE, curves["least"], curves["most"], color=WARM, alpha=0.6, lw=0, label=usual_range)
    ours = "estimated for this section: skin friction, to friction and eddies"
    axes.fill_between(DENSE, curves["rub"], curves["eddy"], color=LIGHT, lw=0, label=ours)
    axes.plot(*steady, color=GREY, ls=":", label="potential flow, steady small waves")
    axes.plot(DENSE, curves["none"], color=BLUE, label="potential flow in the flume's train")


def _readings(axes, k: int) -> None:
    camera = [(test.frequency, test.camera[k]) for test in MEASUREMENTS]
    other = [(test.frequency, test.accelerometers[k]) for test in MEASUREMENTS if test.accelerometers[k] is not None]
    axes.plot(*zip(*camera, strict=True), "o", color="black", ms=5, label="measured, camera")
    axes.plot(*zip(*other, strict=True), "^", color="black", mfc="none", ms=6, label="measured, accelerometers")


def _dense() -> dict[str, np.ndarray]:
    low, high = usual()
    models = {"none": potential_flow(), "least": low, "most": high, "rub": rubbed(), "eddy": estimated()}
    tests = [Measurement(float(w), 0.012, window(float(w)), (), (), 1.0) for w in DENSE]
    return {name: np.array([model.sailed(test) for test in tests]) for name, model in models.items()}
