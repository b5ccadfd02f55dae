"""What claims name and no measure gives: numbers derived from outcomes, rows and figures that need code."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from lab.assembly.ship import make_water
from lab.measures.critical_angle import shift_curve
from lab.measures.value import Value, over_worlds
from lab.preset.sections.sea import Sea
from lab.report.numbers import with_error
from lab.studies.reproduce import figures, memory
from lab.studies.reproduce.estimates import Verdict, mean, ratio, together
from lab.studies.reproduce.experiment import ANY, Found, Row, Told, Tolerance, alone, counted, observed, stated
from lab.studies.reproduce.figures import DROP, THEN, leading_number
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships import capsizes, damping, low_sides, section
from lab.studies.reproduce.ships.rolls import DIGITS, FREQUENCY, FROZEN, LOOSE, PEAK, rolls_figure
from lab.studies.reproduce.water import dam_break, damper, impact, waves

ONSET = 0.02  # of the tank's amplitude: a larger response is distinguished from noise
STEP = Tolerance(0.3, "the step of our frequencies")
LARGE = 30.0  # deg: not reached with loose cargo in the source
# Sundsdal, Greco, Hanssen and Lugni (NTNU, 2025): sway and heave over the waves' amplitude, roll over their slope's
MEASURED = {
    "4.143 rad/s": (0.931, 1.210, 2.356),
    "5.194 rad/s": (0.344, 1.623, 5.933),
    "7.004 rad/s": (0.397, 0.307, 0.331),
}
HEIGHT = 12.0  # mm, their waves' amplitude
MARGIN = "20 %, at least 0.1: ours, as one run was measured at each frequency"


def spill_lag(outcomes: Sequence[Outcome], _: None) -> Value:
    """Of each bed how much later (deg) the losses turn upwards than the bed slides."""
    one = outcomes[0]
    both = zip(one["spill_upturn_angle"].worlds, one["critical_angle"].worlds, strict=True)
    return over_worlds([np.nan if None in pair else pair[0] - pair[1] for pair in both], "deg")


def early_shift(outcomes: Sequence[Outcome], tilt: float) -> Value:
    """How far the centre of mass of each bed has gone downhill at a tilt (deg), mm."""
    recording = outcomes[0].recording
    curves = [shift_curve(recording, world) for world in range(recording.worlds)]
    return over_worlds([1e3 * np.interp(tilt, *curve) for curve in curves], "mm")


def early_range(outcomes: Sequence[Outcome], until: float) -> Value:
    """How far the centre of mass of each bed goes to and fro across the tank until a time (s), mm."""
    series = outcomes[0].recording.series
    return over_worlds(1e3 * np.ptp(series["centre_of_mass"][series["time"] <= until, :, 0], axis=0), "mm")


def onset(outcomes: Sequence[Outcome], tank: float) -> Value:
    """Of each bed the frequency (Hz) at which its response first exceeds ONSET of the tank's amplitude (mm).

    Between two frequencies it is taken to grow linearly; a bed that never answers has none.
    """
    frequencies = np.array([leading_number(next(iter(one.setting.values()))) for one in outcomes])
    responses = np.array(
        [[x if x is not None else np.nan for x in one["response_amplitude"].worlds] for one in outcomes]
    )
    return over_worlds([_crossing(frequencies, curve / tank) for curve in responses.T], "Hz", missing="never answers")


def _crossing(x: np.ndarray, y: np.ndarray) -> float:
    beyond = np.flatnonzero(y > ONSET)
    if not len(beyond):
        return float("nan")
    k = int(beyond[0])
    if k == 0:
        return float(x[0])
    return float(x[k - 1] + (ONSET - y[k - 1]) / (y[k] - y[k - 1]) * (x[k] - x[k - 1]))


def stack_lag(found: Found) -> list[Row]:
    """How far the stack lags behind free fall."""
    one = found["stack"][0]
    free = 500.0 * THEN * (float(one.recording.series["time"][-1]) - DROP) ** 2
    said = f"{100.0 * (1.0 - one['top_fall'].value / free):.1f} % of {free:.0f} mm"
    return [observed("it lags behind free fall, as walls rub", "within 7 % of the experiment", said, None)]


def tanks_span(found: Found) -> list[Row]:
    """Whether the source's ratio of 5 lies between those of our tanks."""
    quantity, allowed = "5 lies between those of the tanks", "the least below 5, the largest above"
    names = [key.removesuffix(", 0 mm") for key in found if key.endswith(", 0 mm")]
    pairs = [[found[f"{name}, {centre} mm"][0]["response_amplitude"] for centre in (500, 0)] for name in names]
    ratios = sorted((one for pair in pairs if (one := ratio(*pair))), key=lambda one: one.value)
    if not ratios:
        return [observed(quantity, "5", "not found", Verdict.CANNOT_TELL, allowed)]
    least, most = ratios[0], ratios[-1]
    verdict = together([least.lies(-np.inf, 5.0), most.lies(5.0, np.inf)])
    return [observed(quantity, "5", f"{least.value:.2g} to {most.value:.2g}", verdict, allowed)]


def memory_effects(found: Found) -> list[Row]:
    """A row a combination, and the mean effect of each choice."""
    runs = found["all"]
    rows = [observed(memory.named(one), "", counted(one["critical_angle"]), None) for one in runs]
    for key, (first, second) in memory.AXES.items():
        if key in runs[0].setting:
            rows.append(observed(f"{key}: {first} against {second}", "", _effect(runs, key, first), None))
    return rows


def _effect(outcomes: Sequence[Outcome], key: str, first: object) -> str:
    """Mean difference of the critical angle between the two values of a key, with its standard error over pairs."""
    sides: tuple[list[Value], list[Value]] = ([], [])
    for one in outcomes:
        sides[one.setting[key] != first].append(one["critical_angle"])
    pairs = [(a, b) for a, b in zip(*sides, strict=True) if a and b and None not in (a.value, b.value)]
    if not pairs:
        return "not found"
    apart = sum(a.value - b.value for a, b in pairs) / len(pairs)
    errors = [value.standard_error for pair in pairs for value in pair]
    if None in errors:
        return f"{apart:+.1f} deg"
    return with_error(apart, sum(error**2 for error in errors) ** 0.5 / len(pairs), "deg", sign="+")


def largest_rolls(found: Found) -> list[Row]:
    """The largest rolls over the frequencies, with frozen and with loose cargo."""
    runs, rows = found["10 mm"], []
    frozen, loose = (_largest(runs, name) for name in ("frozen_amplitude", "roll_amplitude"))
    if frozen:
        value, at = frozen
        rows.append(stated("largest with frozen cargo", PEAK[0], value, DIGITS, exact=True))
        there = Value(at, "rad/s", worlds=(at,))
        rows.append(stated("largest with frozen cargo: frequency", PEAK[1], there, STEP, exact=True))
    quantity, source = "largest with loose cargo", "less than 30 deg, and less than frozen"
    if not (loose and frozen):
        return [*rows, observed(quantity, source, "not found", Verdict.CANNOT_TELL, ANY)]
    rolls = mean(loose[0])
    verdict = together([rolls.lies(-np.inf, LARGE), rolls.lies(-np.inf, frozen[0].value)])
    return [*rows, observed(quantity, source, f"{counted(loose[0])} at {loose[1]:g} rad/s", verdict, ANY)]


def _largest(runs: Sequence[Outcome], name: str) -> tuple[Value, float] | None:
    """The largest value of a measure, and at which frequency."""
    known = [(one[name], leading_number(one.setting[FREQUENCY])) for one in runs if mean(one[name]) is not None]
    return max(known, key=lambda pair: pair[0].value, default=None)


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
            allowed = Tolerance(max(0.2 * measured, 0.1), MARGIN)
            rows.append(stated(f"{name.split('_')[0]} at {at}", measured, found_ratio, allowed, exact=True))
    return rows


def end(one: Outcome) -> str:
    """How a ship's run ended, with loose cargo and frozen."""
    return f"{_fate(one, LOOSE)}; frozen {_fate(one, FROZEN)}"


def _fate(one: Outcome, names: tuple[str, str, str]) -> str:
    steady, when = one[names[0]], one[names[2]]
    said = alone if names is FROZEN else counted
    if when and when.value is not None:
        return f"capsizes at {said(when)}"
    return f"rolls {said(steady)}" if steady and steady.value is not None else "not steady"


DERIVED: Mapping[str, Callable[[Sequence[Outcome], float | None], Value]] = {
    one.__name__: one for one in (spill_lag, early_shift, early_range, onset)
}
ROWS: Mapping[str, Callable[[Found], list[Row]]] = {
    one.__name__: one for one in (stack_lag, tanks_span, memory_effects, largest_rolls, section_amplitudes)
}
FIGURES: Mapping[str, Callable] = {
    "shift": figures.shift,
    "against": figures.against,
    "stack": figures.stack,
    "heaps": figures.heaps,
    "descriptors": figures.descriptors,
    "courses": figures.courses,
    "memory": memory.figure,
    "rolls": rolls_figure,
}
TELLS: Mapping[str, Callable[[Found], Told]] = {
    "section": section.tell,
    "damping": damping.tell,
    "capsizes": capsizes.tell,
    "low sides": low_sides.tell,
    "map": low_sides.tell_map,
    "impact": impact.tell,
    "dam break": dam_break.tell,
    "sway beat": waves.sway_beat,
    "pitch": waves.pitch,
    "damper": damper.tell,
}
