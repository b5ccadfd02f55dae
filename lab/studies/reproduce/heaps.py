"""Heaps under a funnel, the source's "shipboard" test: tips at rest and rising, wide and narrow bases, arches."""

from collections.abc import Mapping, Sequence

from matplotlib.figure import Figure

from lab.report.numbers import BARS
from lab.report.plots import BLUE, GREY
from lab.studies.reproduce.estimates import difference, falling, mostly
from lab.studies.reproduce.experiment import ANY, ONE_BED, Experiment, Told, Tolerance, counted, held, observed, stated
from lab.studies.reproduce.runs import Batch, Outcome
from lab.studies.reproduce.tilting import ANGLE_RATE, QUICK_RATE

HEAPS = Tolerance(0.5, "the source's std of 12 heaps")
CODE = "1 deg: the source calls the 3 of the Code in very good agreement with its 4"
NARROW = "at rest, narrow base"
NAMES = {
    "rising, 25 mm/s": "rising-slow",
    "rising, 50 mm/s": "rising-fast",
    "rising, 25 mm/s, tip of 3 d": "rising-slow-3d",
    "at rest": "fixed",
    NARROW: "narrow-base",
    "at rest, tip of 2 d": "arching",
}
EQUAL = "rising, 25 mm/s, equal grains"
BOX = "in the tilting box"
# The grains of the heaps in a tank 60 of them wide, lined with grains as their base is.
AS_HEAPED = {
    "tank.width": "360 mm",
    "tank.height": "220 mm",
    "tank.roughness": "6 mm",
    "grains.diameter": "6 mm",
    "grains.depth": "92 mm",
}
# Not in the quick report; and what the source says of them.
SKIPPED = {
    "rising, 25 mm/s, tip of 3 d": "as a tip of 6 d",
    EQUAL: "21 deg, by its text",
    "at rest": "no number",
}
PICTURED = "rising, 25 mm/s"


def batches(quick: bool) -> dict[str, Batch]:
    """One run a funnel, and the same grains in a tilting box."""
    asked = [says for says in NAMES if not (quick and says in SKIPPED)]
    runs = {says: Batch(f"funnel/{NAMES[says]}", cost(says, quick)) for says in asked}
    rate = {"motion.tilt.rate": QUICK_RATE if quick else ANGLE_RATE}
    if not quick:
        runs[EQUAL] = Batch("funnel/rising-slow", {**cost(EQUAL, quick), "grains.spread": 0.0})
    return {**runs, BOX: Batch("tilting/scaling-180", {**cost(BOX, quick), **AS_HEAPED, **rate})}


def cost(says: str, quick: bool) -> dict[str, object]:
    """Settings that limit the cost: most heaps where the source has a number, fewest where runs take longest."""
    heaps = {PICTURED: 8, BOX: 12, "rising, 25 mm/s, tip of 3 d": 2}.get(says, 4)
    less = {} if says == BOX else {"grains.count": 1000 if says == NARROW else 1500}
    return {"run.accuracy": "draft", **({"run.repeats": 1, **less} if quick else {"run.repeats": heaps})}


def tell(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """Angles of the heaps at rest, and the arch."""
    angle = {says: outcomes[0]["heap_angle"] for says, outcomes in found.items() if says != BOX}
    angle[BOX] = found[BOX][0]["critical_angle"]
    slow, fast = angle["rising, 25 mm/s"], angle["rising, 50 mm/s"]
    rows = [stated("rising at 25 mm/s", 21.0, slow, HEAPS), stated(BOX, 25.0, angle[BOX], ONE_BED)]
    rows.append(held("the heap below the box", "almost 4 deg", difference(angle[BOX], slow), (3.0, 5.0), CODE, "deg"))
    rows.append(observed("rising at 50 mm/s", "less than at 25 mm/s", counted(fast), falling([slow, fast]), ANY))
    for says, source in SKIPPED.items():
        if says in angle:
            rows.append(observed(says, source, counted(angle[says]), None))
    rows.append(stated("on a narrow base", 22.5, angle[NARROW], HEAPS))
    clogged = found["at rest, tip of 2 d"][0]["clogged"]
    shut = [bool(one) for one in clogged.worlds if one is not None] if clogged else []
    said = f"{sum(shut)} of {len(shut)} heaps"
    rows.append(observed("tip of 2 d: clogged", "arches", said, mostly(sum(shut), len(shut)), "more than half of all"))
    return Told(rows, _figure(angle))


def _figure(angle: Mapping) -> Figure:
    figure = Figure(figsize=(6.4, 2.6), layout="constrained")
    axes = figure.add_subplot()
    known = {says: value for says, value in angle.items() if value and value.value is not None}
    for row, value in enumerate(known.values()):
        axes.errorbar(value.value, row, xerr=value.std or 0.0, fmt="o", ms=4, capsize=2.5, color=BLUE)
    axes.axvline(21.0, color=GREY, ls=":")
    axes.annotate("source, 25 mm/s", (21.1, 0.6), fontsize=7, color=GREY)
    axes.set_yticks(range(len(known)), [f"{says} (n = {value.n})" for says, value in known.items()])
    axes.invert_yaxis()
    axes.set_xlabel(f"heap at rest, box at the slide (deg), {BARS}")
    return figure


EXPERIMENTS = [
    Experiment(
        "funnel",
        "Heaps under a funnel",
        "appendix D",
        "under a funnel raised at 25 mm/s the angle of repose is 21 ± 0.5 deg (12 heaps), some 4 deg below the tilting "
        "box, and less at 50 mm/s; on a narrow base 22.5 deg; a tip of 2 diameters arches.",
        batches,
        tell,
        "1 heap of 1500 grains (on the narrow base 1000) for 2 to 8 of 2500, tips of 6 diameters only, none at rest "
        "above a wide base, no equal grains, draft accuracy",
        (PICTURED, 0.6),
        "Heap and box are both some 5 deg lower than the source's, so that their difference is much the same: grains "
        "of ± 10 % in diameter slide sooner than equal ones, which the source has (see equal grains and unequal ones "
        "in lined tanks). Equal ones lie in crystals, and a heap of them is as steep as it happens to grow; the "
        "source's lies in between.",
    )
]
