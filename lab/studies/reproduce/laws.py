"""A question that the source leaves open: is its angle of repose due to friction without history, or to the packing?"""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from lab.measures.value import Value
from lab.report.numbers import BARS, with_error
from lab.report.plots import BLUE, VERMILION
from lab.studies.reproduce.experiment import Experiment, Told, counted, observed
from lab.studies.reproduce.runs import Batch, Outcome
from lab.studies.reproduce.tilting import ANGLE_RATE, BEDS, QUICK_BEDS, QUICK_RATE

WALLED = "tank.roughness"
AXES = {
    "contact.tangential": ["haff-werner", "mindlin"],
    WALLED: ["3 mm", False],
    "grains.spread": [0.1, 0.0],
}
WALLS = {"3 mm": "rough", False: "flat"}


def batches(quick: bool) -> dict[str, Batch]:
    """All combinations as the worlds of one sweep; in the quick report those with rough walls."""
    cost = {
        "run.accuracy": "draft",
        "run.repeats": QUICK_BEDS if quick else BEDS,
        "motion.tilt.rate": QUICK_RATE if quick else ANGLE_RATE,
    }
    if not quick:
        return {"all": Batch("tilting/scaling-150", cost, AXES)}
    return {"all": Batch("tilting/scaling-60", cost, {key: values for key, values in AXES.items() if key != WALLED})}


def named(outcome: Outcome) -> str:
    """A combination in words."""
    law, walls, spread = (outcome.setting.get(key, AXES[key][0]) for key in AXES)
    return f"{law}, {WALLS[walls]} walls, {'equal grains' if not spread else '± 10 % in diameter'}"


def tell(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """A row a combination, and the mean effect of each choice."""
    rows = [observed(named(one), "", counted(one["critical_angle"]), None) for one in found["all"]]
    for key, (first, second) in AXES.items():
        if key not in found["all"][0].setting:
            continue
        rows.append(observed(f"{key}: {first} against {second}", "", effect(found["all"], key, first), None))
    return Told(rows, figure(found["all"]))


def effect(outcomes: Sequence[Outcome], key: str, first: object) -> str:
    """Mean difference of the critical angle between the two values of a key, with its standard error over pairs."""
    sides: tuple[list[Value], list[Value]] = ([], [])
    for one in outcomes:
        sides[one.setting[key] != first].append(one["critical_angle"])
    pairs = [(a, b) for a, b in zip(*sides, strict=True) if a and b and None not in (a.value, b.value)]
    if not pairs:
        return "not found"
    mean = sum(a.value - b.value for a, b in pairs) / len(pairs)
    errors = [value.standard_error for pair in pairs for value in pair]
    if None in errors:
        return f"{mean:+.1f} deg"
    return with_error(mean, sum(error**2 for error in errors) ** 0.5 / len(pairs), "deg", sign="+")


def figure(outcomes: Sequence[Outcome]) -> Figure:
    """Critical angles ± standard deviation of all combinations."""
    drawn = Figure(figsize=(6.4, 3.2), layout="constrained")
    axes = drawn.add_subplot()
    for row, one in enumerate(outcomes):
        angle = one["critical_angle"]
        if angle and angle.value is not None:
            colour = BLUE if one.setting["contact.tangential"] == "haff-werner" else VERMILION
            axes.errorbar(angle.value, row, xerr=angle.std or 0.0, fmt="o", ms=4, capsize=2.5, color=colour)
    counts = [one["critical_angle"].n if one["critical_angle"] else 0 for one in outcomes]
    axes.set_yticks(range(len(outcomes)), [f"{named(one)} (n = {n})" for one, n in zip(outcomes, counts, strict=True)])
    axes.invert_yaxis()
    axes.set_xlabel(f"critical angle (deg), {BARS}")
    return drawn


EXPERIMENTS = [
    Experiment(
        "tilt-memory",
        "Friction with and without memory, rough and flat walls, mixed and equal grains",
        "left open by the source",
        "the angle of repose is found with friction that has no memory (Haff and Werner). Whether it is that law's, "
        "the packing's or the walls' is not asked.",
        batches,
        tell,
        "rough walls only, a tank of 60 mm for 150, 2 beds for 4, 20 deg/s for 5, draft accuracy",
        ("all", 0.8),
    )
]
