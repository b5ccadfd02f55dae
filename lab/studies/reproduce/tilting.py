"""Tilted tanks: materials, surfaces, low walls, depths of fill, hysteresis, sizes of tanks."""

from collections.abc import Mapping, Sequence

import numpy as np

from lab.measures.value import Value, over_worlds
from lab.studies.reproduce.curves import against, shift_against_tilt
from lab.studies.reproduce.estimates import (
    Estimate,
    Verdict,
    alike,
    difference,
    falling,
    mean,
    mostly,
    scatters_more,
    together,
)
from lab.studies.reproduce.experiment import ONE_BED, Experiment, Row, Told, counted, held, observed, stated
from lab.studies.reproduce.runs import Batch, Outcome

# The source tilts at 0.15 to 3 deg/s; below 3 a bed costs hours here. `cargolab bench accuracy rate` sees no effect of
# the rate on the critical angle between 1 and 30 deg/s, but a fast tilt merges the steps of a slide. So only studies
# that need nothing but this angle are tilted faster, at a rate of their own.
RATE, ANGLE_RATE, QUICK_RATE = "3 deg/s", "5 deg/s", "20 deg/s"
BEDS, QUICK_BEDS = 4, 2
QUICK_END = "34 deg"  # tilt at which all beds of discs have slid
LOST = "2 beds for 4, 20 deg/s for 3 to 34 deg, both at draft accuracy"
STRICT = "each step above zero"
MUCH = 80.0  # %: "almost all" of a shift
RIM_BEDS = 8
SMOOTH, LINED, EQUAL = "smooth tank", "lined tank", "lined tank, equal grains"
SPREAD = "grains.spread"
SPREADS = [0.0, 0.03, 0.1]
Found = Mapping[str, Sequence[Outcome]]


def tilted(preset: str, quick: bool, beds: int = BEDS, rate: str = RATE, **changes: object) -> Batch:
    """A preset at draft accuracy, with the number of beds and the tilt rate that the computing time allows."""
    cost = {
        "run.accuracy": "draft",
        "run.repeats": QUICK_BEDS if quick else beds,
        "motion.tilt.rate": QUICK_RATE if quick else rate,
        **({"motion.tilt.angle": QUICK_END} if quick else {}),
    }
    return Batch(preset, {**cost, **changes})


def only(found: Found) -> dict[str, Outcome]:
    """The single outcome of each batch."""
    return {name: outcomes[0] for name, outcomes in found.items()}


def materials(found: Found) -> Told:
    """Angles at which the surfaces flow, in the wide tank."""
    runs = only(found)
    flows = {"A": 18.0, "B": 16.5, "C": 11.7}
    rows = [
        stated(f"{name} begins to flow", angle, runs[name]["first_slip_angle"], ONE_BED)
        for name, angle in flows.items()
    ]
    first = [runs[name]["first_slip_angle"] for name in flows]
    rows.append(observed("order", "A after B after C", ", ".join(map(counted, first)), falling(first), STRICT))
    main = [counted(runs[name]["critical_angle"]) for name in flows]
    rows.append(observed("main slide of A, B, C", "after a small heap", ", ".join(main), None))
    return Told(rows, shift_against_tilt(runs))


def similar(found: Found) -> Told:
    """Angles at which the surfaces flow where tanks are similar in diameters."""
    runs = only(found)
    rows = [
        stated(f"{name} begins to flow", angle, runs[name]["first_slip_angle"], ONE_BED)
        for name, angle in {"B": 22.0, "C": 17.0}.items()
    ]
    slip = {name: runs[name]["first_slip_angle"] for name in "ABC"}
    found = mean(slip["A"])
    still = mostly(len(slip["A"].worlds), len(slip["A"].worlds)) if slip["A"] else Verdict.CANNOT_TELL
    verdict = still if found is None else found.lies(22.0 - ONE_BED.within, np.inf)
    rows.append(observed("A", "not by 22 deg", counted(slip["A"]), verdict, f"{ONE_BED.words('deg')}, below"))
    order = list(slip.values())
    rows.append(observed("order", "A after B after C", ", ".join(map(counted, order)), falling(order), STRICT))
    return Told(rows, shift_against_tilt(runs))


def surfaces(found: Found) -> Told:
    """The same main angle whatever the surface."""
    runs = only(found)
    angles = {name: outcome["critical_angle"] for name, outcome in runs.items()}
    known = [value for value in angles.values() if value and value.value is not None]
    spread = max(v.value for v in known) - min(v.value for v in known) if len(known) == len(angles) else None
    rows = [
        observed(f"main slide, {name}", "nearly the same for all", counted(value), None)
        for name, value in angles.items()
    ]
    same = alike(list(angles.values()), ONE_BED.within)
    said = "not found" if spread is None else f"{spread:.1f} deg"
    rows.append(observed("largest difference", "nearly none", said, same, f"{ONE_BED.words('deg')}, of any two"))
    steps = {name: runs[name]["main_steps"] for name in runs}
    rows.append(observed("the curve", "steps", ", ".join(f"{name} {counted(v)}" for name, v in steps.items()), None))
    return Told(rows, shift_against_tilt(runs))


def low_walls(found: Found) -> Told:
    """Grains creep over walls as high as the bed before it slides."""
    low, high = found["low walls"][0], found["high walls"][0]
    upturn, slide = low["spill_upturn_angle"], high["critical_angle"]
    rows = [
        observed("first 1 % is lost", "creeping losses of some 2 %", counted(low["spill_start_angle"]), None),
        observed("losses turn upwards", "sharply", counted(upturn), None),
        observed("the same bed slides", "", counted(low["critical_angle"]), None),
        observed("losses turn upwards after it", "", _lag(low), None),
        observed("slide between high walls", "", counted(slide), None),
        _lead("upturn before that slide", upturn, slide),
        observed("lost in the end", "", counted(low["spilled_fraction"]), None),
    ]
    return Told(rows, shift_against_tilt({"low walls": low, "high walls": high}))


def rim_batches(quick: bool) -> dict[str, Batch]:
    """More beds of iron ore, tilted faster, with low walls and with high ones: on smooth walls, lined, and equal."""
    if quick:  # the beds of the experiment before, which are not run again
        low, high = tilted("tilting/lowwall", quick), tilted("tilting/surface-slightly-disturbed", quick)
        return {f"{SMOOTH}, low walls": low, f"{SMOOTH}, high walls": high}
    changes = {SMOOTH: {}, LINED: {"tank.roughness": "2 mm"}, EQUAL: {"tank.roughness": "2 mm", SPREAD: 0.0}}
    batches = {}
    for name, change in changes.items():
        rate, end = ("5 deg/s", "40 deg") if name == EQUAL else ("10 deg/s", "32 deg")
        run = {"beds": RIM_BEDS, "rate": rate, "motion.tilt.angle": end, **change}
        batches[f"{name}, low walls"] = tilted("tilting/lowwall", quick, **run)
        batches[f"{name}, high walls"] = tilted("tilting/materials-b", quick, **run)
    return batches


def rims(found: Found) -> Told:
    """Lead of the upturn of the losses over the slide between high walls, and lag behind the slide of the same bed."""
    rows = []
    for name in (SMOOTH, LINED, EQUAL):
        if f"{name}, low walls" in found:
            low, high = found[f"{name}, low walls"][0], found[f"{name}, high walls"][0]
            upturn, slide = low["spill_upturn_angle"], high["critical_angle"]
            rows.append(observed(f"{name}: losses turn upwards", "", counted(upturn), None))
            rows.append(observed(f"{name}: after the slide of the same bed", "", _lag(low), None))
            rows.append(observed(f"{name}: slide between high walls", "", counted(slide), None))
            rows.append(_lead(f"{name}: upturn before that slide", upturn, slide))
    return Told(rows)


def _lead(quantity: str, upturn: Value, slide: Value) -> Row:
    """Row of the lead of the losses' upturn over the slide in other beds."""
    return held(
        quantity, "1.7 to 6.8 deg", difference(slide, upturn), (1.7, 6.8), "1.7 to 6.8 deg: the source's range", "deg"
    )


def _lag(low: Outcome) -> str:
    """Text of the lag of the losses' upturn behind the slide in the same low-walled beds."""
    both = zip(low["spill_upturn_angle"].worlds, low["critical_angle"].worlds, strict=True)
    return counted(over_worlds([np.nan if None in pair else pair[0] - pair[1] for pair in both], "deg"))


def fills(found: Found) -> Told:
    """The angle falls with the depth of the fill."""
    runs = only(found)
    said = {"shallow": 27.0, "intermediate": 24.0, "deep": 21.0}
    rows = [
        stated(f"angle of repose, {name}", angle, runs[name]["critical_angle"], ONE_BED) for name, angle in said.items()
    ]
    angles = [runs[name]["critical_angle"] for name in said]
    verdict = falling(angles)
    rows.append(observed("the deeper", "the smaller the angle", ", ".join(map(counted, angles)), verdict, STRICT))
    return Told(rows, shift_against_tilt(runs))


def spread_batches(quick: bool) -> dict[str, Batch]:
    """Two depths of fill over the spread of the grains' sizes."""
    depths = ("shallow",) if quick else ("shallow", "intermediate")
    changes = tilted("", quick, rate=ANGLE_RATE).changes
    return {depth: Batch(f"tilting/fill-{depth}", changes, {SPREAD: SPREADS}) for depth in depths}


def spreads(found: Found) -> Told:
    """The more alike the grains, the later they slide."""
    rows = []
    for depth, outcomes in found.items():
        angles = [one["critical_angle"] for one in outcomes]
        source = {"shallow": 27.0, "intermediate": 24.0}[depth]
        rows.append(stated(f"{depth}, equal grains", source, angles[0], ONE_BED))
        for spread, angle in zip(SPREADS[1:], angles[1:], strict=True):
            rows.append(observed(f"{depth}, ± {100 * spread:g} % in diameter", "", counted(angle), None))
        rows.append(observed(f"{depth}: the more alike, the later", "", falling(angles).value, None))
    figure = against(
        SPREAD, "diameters spread to either side by this share", dict(found), "critical_angle", "critical angle (deg)"
    )
    return Told(rows, figure)


def way_back(found: Found) -> Told:
    """The part of its shift that the bed keeps when it is tilted back."""
    runs, rows = only(found), []
    for name, run in runs.items():
        kept = run["kept_shift"]
        rows.append(stated(f"{name}: angle of repose on the way out", 24.0, run["critical_angle"], ONE_BED))
        rows.append(_much(f"{name}: shift kept at 0 deg", mean(kept), counted(kept)))
    return Told(rows, shift_against_tilt(runs))


def _much(quantity: str, found: Estimate | None, ours: str) -> Row:
    verdict = Verdict.CANNOT_TELL if found is None else found.lies(MUCH, np.inf)
    return observed(quantity, "almost all", ours, verdict, f"at least {MUCH:g} %: how we read the word")


def way_back_batches(quick: bool) -> dict[str, Batch]:
    """Grains of ± 10 % in diameter, and equal ones as the source's are."""
    far = {"motion.tilt.angle": "40 deg"}
    runs = {"unequal grains": tilted("tilting/hysteresis", quick, **far)}
    if not quick:
        runs["equal grains"] = tilted("tilting/hysteresis", quick, rate=ANGLE_RATE, **far, **{SPREAD: 0.0})
    return runs


def sizes(found: Found) -> Told:
    """Smaller tanks slide later, and scatter more."""
    runs = only(found)
    angles = [runs[name]["critical_angle"] for name in ("60 mm", "150 mm", "180 mm")]
    rows = [
        observed(f"angle of repose, {name}", "", counted(outcome["critical_angle"]), None)
        for name, outcome in runs.items()
    ]
    order = ", ".join(map(counted, angles))
    rows.append(observed("the smaller the tank", "the larger the angle", order, falling(angles), STRICT))
    stds = ", ".join("?" if angle is None or angle.std is None else f"{angle.std:.1f} deg" for angle in angles)
    most = together([scatters_more(angles[0], other) for other in angles[1:]])
    rows.append(observed("std of the smallest tank", "the largest", stds, most, "ratios of variances above 1"))
    return Told(rows, shift_against_tilt(runs))


def peas(found: Found) -> Told:
    """Spheres flow long before chickpeas do."""
    run = found["spheres"][0]
    angle = run["critical_angle"]
    rows = [
        stated("first slip, beside the experiment's heap", 37.0, run["first_slip_angle"], ONE_BED),
        stated("angle of repose, the experiment's", 41.3, angle, ONE_BED),
        stated("angle of repose, the source's own spheres, 13 deg below the experiment", 28.3, angle, ONE_BED),
    ]
    return Told(rows, shift_against_tilt({"spheres": run}))


EXPERIMENTS = [
    Experiment(
        "tilt-materials",
        "Tilt of three ores in one tank",
        "5.2.1, first configuration",
        "in a tank of 192 mm with 2000 grains, tilted at 3 deg/s, the free surface flows at 6, 5.5 and 3.9 s (18, "
        "16.5 and 11.7 deg) for copper (A), iron ore (B) and gold ore (C); a heap comes before the main slide.",
        lambda quick: {name: tilted(f"tilting/materials-{name.lower()}", quick) for name in "ABC"},
        materials,
        LOST,
        ("B", 0.8),
        "A slide begins here with the first step of the centre of mass, which `first_slip_angle` finds; the source "
        "read it off pictures. Copper's first steps are the smallest, so there the two may differ most.",
    ),
    Experiment(
        "tilt-similar",
        "Tilt of three ores in tanks of 60 diameters",
        "5.2.1, second configuration",
        "in tanks 60 diameters wide and 20 deep, tilted at 2 deg/s, B and C flow at 11 and 8.5 s (22 and 17 deg); A "
        "has not moved by then.",
        lambda quick: {name: tilted(f"tilting/materials-similar-{name.lower()}", quick) for name in "ABC"},
        similar,
        LOST,
        ("B", 0.8),
        "The three have the same friction, so in tanks of as many diameters they differ mostly by how far their weight "
        "presses them into each other, which slopes of hard grains do not know: A and B slide alike within scatter.",
    ),
    Experiment(
        "tilt-surface",
        "Undisturbed, slightly disturbed and disturbed surfaces",
        "5.3.1",
        "the centre of mass shifts in steps; the main angle is nearly the same for all three surfaces.",
        lambda quick: {
            name.replace("-", " "): tilted(f"tilting/surface-{name}", quick)
            for name in ("undisturbed", "slightly-disturbed", "disturbed")[quick:]
        },
        surfaces,
        f"{LOST}; no undisturbed surface",
        ("disturbed", 0.6),
    ),
    Experiment(
        "tilt-low-walls",
        "Walls as high as the bed",
        "5.3.2",
        "after a creeping loss of some 2 % the losses turn sharply upwards, 1.7 to 6.8 deg before the bed slides "
        "between high walls.",
        lambda quick: {
            "low walls": tilted("tilting/lowwall", quick),
            "high walls": tilted("tilting/surface-slightly-disturbed", quick),
        },
        low_walls,
        LOST,
        ("low walls", 0.7),
        "Losses follow the slide of their own bed. Before which slide of another bed they come is chance: the next "
        "experiment has more beds.",
    ),
    Experiment(
        "tilt-rim",
        "Walls as high as the bed, in more beds",
        "5.3.2",
        "the losses turn sharply upwards 1.7 to 6.8 deg before the bed slides between high walls.",
        rim_batches,
        rims,
        "the beds of the experiment before, 2 for 8, 20 deg/s for 10",
        ("smooth tank, low walls", 0.7),
        "Only grains that move can be lost, so the losses follow the slide of their own bed, by what it takes to come "
        "over the rim: 0.44 ± 0.05 s (s.e.) in the lined tank, which is 4.4 deg at this rate, nothing that shows at "
        "3 deg/s (the experiment before), and a tenth of a degree at the source's 0.3. That an unlined bed slips on "
        "its floor first is not the reason: a lined one lags as long. The source holds single beds of equal grains "
        "against each other. Two such beds differ by some 5 deg (the root of the sum of both squared standard "
        "deviations), so leads of 1.7 to 6.8 deg come by chance.",
    ),
    Experiment(
        "tilt-fill",
        "Depth of the fill",
        "5.3.3",
        "at depths of 0.075, 0.15 and 0.37 of the width the angle of repose is 27, 24 and 21 deg; the rate matters "
        "little.",
        lambda quick: {name: tilted(f"tilting/fill-{name}", quick) for name in ("shallow", "intermediate", "deep")},
        fills,
        LOST,
        ("intermediate", 0.8),
        "Our grains differ by ± 10 % in diameter, the source's do not: the next experiment has what that does to the "
        "angle.",
    ),
    Experiment(
        "tilt-spread",
        "Equal grains and unequal ones in lined tanks",
        "5.3.3, whose grains are equal",
        "at depths of 0.075 and 0.15 of the width the angle of repose is 27 and 24 deg.",
        spread_batches,
        spreads,
        "the shallow fill only, 2 beds for 4, 20 deg/s for 5",
        ("shallow", 0.8),
        "Equal grains lie in patches of crystal, no two beds alike, and slide late: at about the source's angles, "
        "whose grains are equal. Ours of ± 10 % in diameter, which have no crystals, slide 6 to 11 deg earlier.",
    ),
    Experiment(
        "tilt-hysteresis",
        "Out to 40 deg and back",
        "5.3.4",
        "tilted back from 40 deg the bed keeps almost the whole of its shift.",
        way_back_batches,
        way_back,
        "2 beds for 4, 20 deg/s for 3, no equal grains, both at draft accuracy",
        ("unequal grains", 0.5),
        "A bed keeps what its slope can hold once it is level again: the steeper it can lie, the more.",
    ),
    Experiment(
        "tilt-scaling",
        "Sizes of tanks lined with grains",
        "5.4.2",
        "the mean of 12 beds each: the smaller the tank, the larger the angle of repose and its scatter.",
        lambda quick: {
            f"{width} mm": tilted(
                f"tilting/scaling-{width}", quick, 12, ANGLE_RATE, **({"run.repeats": 4} if quick else {})
            )
            for width in (60, 150, 180)
        },
        sizes,
        "4 beds for 12, 20 deg/s for 5, both at draft accuracy",
        ("60 mm", 0.8),
    ),
    Experiment(
        "tilt-chickpeas",
        "Chickpeas as spheres",
        "9.3",
        "in the experiment a heap forms at 37 deg and the surface flows at 41.3 deg; spheres of the measured sizes "
        "flow 13 deg too early.",
        lambda quick: {"spheres": tilted("tilting/chickpeas", quick, beds=6, **{"motion.tilt.angle": "45 deg"})},
        peas,
        "2 beds for 6, 20 deg/s for 3 (source: 0.5), draft accuracy",
        ("spheres", 0.8),
    ),
]
