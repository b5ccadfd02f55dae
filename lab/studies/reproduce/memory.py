"""Friction with and without memory, walls and sizes of grains: the combinations of one grid, in words and drawn."""

from matplotlib.figure import Figure

from lab.report.numbers import BARS
from lab.report.plots import BLUE, VERMILION
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.runs import Outcome

AXES = {
    "contact.tangential": ["haff-werner", "mindlin"],
    "tank.roughness": ["3 mm", False],
    "grains.spread": [0.1, 0.0],
}
WALLS = {"3 mm": "rough", False: "flat"}


def named(outcome: Outcome) -> str:
    """A combination in words."""
    law, walls, spread = (outcome.setting.get(key, AXES[key][0]) for key in AXES)
    return f"{law}, {WALLS[walls]} walls, {'equal grains' if not spread else '± 10 % in diameter'}"


def figure(found: Found) -> Figure:
    """Critical angles ± standard deviation of all combinations."""
    outcomes = found["all"]
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
