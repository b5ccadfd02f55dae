"""Tilted, shaken and heaped beds: losses over a low wall, the onset of a response, walls and laws with memory."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.measures.value import Value, over_worlds
from lab.report.numbers import BARS, with_error
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.reproduce.estimates import Verdict, ratio, together
from lab.studies.reproduce.experiment import Found, Row, counted, observed
from lab.studies.reproduce.figures import leading_number
from lab.studies.reproduce.runs import Outcome

ONSET = 0.02  # of the tank's amplitude: a larger response is distinguished from noise
# Of the grid of laws, walls and sizes: the choices of each key, and what walls are called.
AXES = {
    "contact.tangential": ["haff-werner", "mindlin"],
    "tank.roughness": ["3 mm", False],
    "grains.spread": [0.1, 0.0],
}
WALLS = {"3 mm": "rough", False: "flat"}


def spill_lag(outcomes: Sequence[Outcome], _: None) -> Value:
    """Of each bed how much later (deg) the losses turn upwards than the bed slides."""
    one = outcomes[0]
    both = zip(one["spill_upturn_angle"].worlds, one["critical_angle"].worlds, strict=True)
    return over_worlds([np.nan if None in pair else pair[0] - pair[1] for pair in both], "deg")


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


def heaps(found: Found, box: str) -> Figure:
    """Angles of heaps at rest and of the box at the slide, ± standard deviation."""
    figure, axes = canvas((6.4, 2.6))
    angles = {says: runs[0]["critical_angle" if says == box else "heap_angle"] for says, runs in found.items()}
    known = {says: value for says, value in angles.items() if value and value.value is not None}
    for row, value in enumerate(known.values()):
        axes.errorbar(value.value, row, xerr=value.std or 0.0, fmt="o", ms=4, capsize=2.5, color=BLUE)
    axes.axvline(21.0, color=GREY, ls=":")
    axes.annotate("source, 25 mm/s", (21.1, 0.6), fontsize=7, color=GREY)
    axes.set_yticks(range(len(known)), [f"{says} (n = {value.n})" for says, value in known.items()])
    axes.invert_yaxis()
    axes.set_xlabel(f"heap at rest, box at the slide (deg), {BARS}")
    return figure


def combination(outcome: Outcome) -> str:
    """A combination in words."""
    law, walls, spread = (outcome.setting.get(key, AXES[key][0]) for key in AXES)
    return f"{law}, {WALLS[walls]} walls, {'equal grains' if not spread else '± 10 % in diameter'}"


def memory_effects(found: Found) -> list[Row]:
    """A row a combination, and the mean effect of each choice."""
    runs = found["all"]
    rows = [observed(combination(one), "", counted(one["critical_angle"]), None) for one in runs]
    for key, (first, second) in AXES.items():
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


def memory(found: Found) -> Figure:
    """Critical angles ± standard deviation of all combinations."""
    outcomes = found["all"]
    drawn, axes = canvas((6.4, 3.2))
    for row, one in enumerate(outcomes):
        angle = one["critical_angle"]
        if angle and angle.value is not None:
            colour = BLUE if one.setting["contact.tangential"] == "haff-werner" else VERMILION
            axes.errorbar(angle.value, row, xerr=angle.std or 0.0, fmt="o", ms=4, capsize=2.5, color=colour)
    counts = [one["critical_angle"].n if one["critical_angle"] else 0 for one in outcomes]
    axes.set_yticks(
        range(len(outcomes)), [f"{combination(one)} (n = {n})" for one, n in zip(outcomes, counts, strict=True)]
    )
    axes.invert_yaxis()
    axes.set_xlabel(f"critical angle (deg), {BARS}")
    return drawn
