"""Irregular grains: round outlines against discs, descriptors, random phases, heaps, chickpeas."""

from collections.abc import Callable, Mapping, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.measures.critical_angle import shift_curve
from lab.measures.value import Value, over_worlds
from lab.report.numbers import BARS
from lab.report.plots import GREY
from lab.studies.reproduce.curves import shift_against_tilt
from lab.studies.reproduce.estimates import Estimate, difference, falling, paired_ratio, ratio
from lab.studies.reproduce.experiment import ONE_BED, Experiment, Row, Told, Tolerance, counted, held, observed, stated
from lab.studies.reproduce.runs import Batch, Outcome

Found = Mapping[str, Sequence[Outcome]]
Course = Callable[[Outcome], tuple[np.ndarray, np.ndarray]]
BOX, SWAY = "shapes/box", "shapes/sway"
NODES, OUTLINE, FRICTION = "contact.nodes", "shapes.grain.descriptors", "material.friction"
MORE = 2.5  # deg by which the source's heap of slightly disturbed discs is steeper than that of discs
HEAPS = Tolerance(0.7, "the source's std of heaps of discs, 0.5 deg, times √2")
FAR, NEAR = "55 deg", "40 deg"  # tilts at which irregular grains, and discs, have slid
EARLY, EARLY_TIME = 10.0, 0.5  # deg and s, before a bed slides
SHIFT_LABELS = "tilt (deg)", "shift downhill of one bed (mm)"
SECONDS = 2.0  # length of a swayed bed's course in the figure
SOURCE_ERRORS = {  # of discs by so many nodes, or more, section 8.2
    36: ("7 to 8 % off", (0.92, 1.08)),
    80: ("2 % off", (0.98, 1.02)),
    120: ("less than 0.5 % off", (0.995, 1.005)),
}
NAMES = {2: "D_2", 3: "D_3", 4: "D_4", 8: "D_8"}
SLIGHT = {"count": 20, "D2": 0.03, "D3": 0.02, "D8": 0.005}
IRREGULAR = {"count": 20, "D2": 0.16, "D3": 0.08, "D8": 0.02}


def cost(quick: bool, beds: int, angle: str = FAR, rate: str = "20 deg/s") -> dict[str, object]:
    """Draft accuracy, 80 mm of grains for 110 and a fast tilt; in the quick report three beds, of 40 mm."""
    if quick:
        less = {"grains.depth": "40 mm", "motion.tilt.rate": "20 deg/s", "run.repeats": 3}
    else:
        less = {"grains.depth": "80 mm", "motion.tilt.rate": rate, "run.repeats": beds}
    return {"run.accuracy": "draft", "motion.tilt.angle": angle, **less}


def as_discs_and_nodes(preset: str, run: Mapping[str, object], nodes: Sequence[int]) -> dict[str, Batch]:
    """Discs as discs, as smooth outlines, and by nodes, all from the same beds of discs."""
    circle = {OUTLINE: [], "grains.settled_as": "discs"}
    return {
        "discs": Batch(preset, {**run, "shapes.grain": False}),
        "smooth": Batch(preset, {**run, **circle}),
        "nodes": Batch(preset, {**run, **circle, "contact.outlines": "nodes"}, {NODES: list(nodes)}),
    }


def one_descriptor(n: int, value: float) -> list[float]:
    """D_1 … D_n relative to R0, all zero but the last."""
    return [0.0] * (n - 1) + [value]


def over(quantity: str, source: str, found: Estimate | None, between: tuple[float, float] | None = None) -> Row:
    """A row for the ratio of a mean to that of discs; the source's range is `between`."""
    quantity = f"{quantity}, over discs"
    if between:
        return held(quantity, source, found, between, f"{between[0]:g} to {between[1]:g}: the source's own")
    ours, known = ("not found", "") if found is None else (found.told(), found.interval())
    return Row(quantity, source, ours, known, "", None)


def round_batches(quick: bool) -> dict[str, Batch]:
    """Round grains in a tilting box, tilted as the source's are."""
    return as_discs_and_nodes(BOX, cost(quick, 6, NEAR, "10 deg/s"), [36, 120] if quick else [36, 80, 120, 200])


def round_ones(found: Found) -> Told:
    """The shift of round outlines before their bed slides, relative to that of discs, their angle and their cost.

    Once beds slide they diverge, however similar the forces, as do beds of discs that differ in the last bit.
    """
    rows = _beside_discs(found, f"shift at {EARLY:g} deg", early_shift, judged=True)
    rows += _beside_discs(found, "critical angle", lambda one: one["critical_angle"], judged=False)
    return Told(rows, _courses_and_cost(found, _shift, EARLY, SHIFT_LABELS))


def slow_batches(quick: bool) -> dict[str, Batch]:
    """Round grains tilted as slowly as the source's slowest, up to angles at which their beds only creep."""
    run = {"run.accuracy": "draft", "motion.tilt.angle": "12 deg", "run.repeats": 2 if quick else 3}
    run["motion.tilt.rate"], run["grains.depth"] = ("1 deg/s", "20 mm") if quick else ("0.3 deg/s", "40 mm")
    return as_discs_and_nodes(BOX, run, [36, 120] if quick else [36, 120, 500])


def slow_ones(found: Found) -> Told:
    """The shift of slowly tilted round outlines relative to that of discs."""
    rows = _beside_discs(found, f"shift at {EARLY:g} deg", early_shift, judged=True)
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    _draw_courses(figure.add_subplot(), found, _shift, EARLY, SHIFT_LABELS)
    return Told(rows, figure)


def _shift(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Tilt (deg) and how far the centre of mass of the first bed has gone downhill (m)."""
    return shift_curve(one.recording, 0)


def early_shift(one: Outcome) -> Value:
    """How far the centre of mass of each bed has gone downhill at `EARLY`, mm."""
    curves = [shift_curve(one.recording, world) for world in range(one.recording.worlds)]
    return over_worlds([1e3 * np.interp(EARLY, *curve) for curve in curves], "mm")


def _beside_discs(found: Found, quantity: str, value: Callable[[Outcome], Value | None], judged: bool) -> list[Row]:
    """Rows of the ratio of a quantity of smooth outlines and of nodes to that of discs, bed by bed."""
    discs, smooth = (value(found[name][0]) for name in ("discs", "smooth"))
    rows = [observed(f"{quantity}: discs", "", counted(discs), None)]
    rows.append(over(f"{quantity}: smooth outlines", "", paired_ratio(smooth, discs)))
    for one in found["nodes"]:
        nodes = one.setting[NODES]
        says, between = SOURCE_ERRORS.get(nodes, SOURCE_ERRORS[120]) if judged else ("", None)
        rows.append(over(f"{quantity}: {nodes} nodes", says, paired_ratio(value(one), discs), between))
    return rows


def _drawn(found: Found) -> dict[str, Outcome]:
    """The outcomes whose courses are drawn: discs, smooth outlines, and few, more and many nodes."""
    by_nodes = {one.setting[NODES]: one for one in found["nodes"]}
    nodes = {f"{n} nodes": by_nodes[n] for n in (36, 120, 500) if n in by_nodes}
    return {"discs": found["discs"][0], "smooth outlines": found["smooth"][0], **nodes}


def _draw_courses(axes: Axes, found: Found, course: Course, early: float, labels: tuple[str, str]) -> None:
    """Courses (x, y in m), compared until `early`."""
    for name, one in _drawn(found).items():
        x, y = course(one)
        axes.plot(x, 1e3 * y, label=name, lw=1.2)
    axes.axvline(early, color=GREY, ls=":", lw=1.0)
    axes.set(xlabel=labels[0], ylabel=labels[1])
    axes.legend()


def _courses_and_cost(found: Found, course: Course, early: float, labels: tuple[str, str]) -> Figure:
    """Figure of courses and of the computing time of whole runs per grain and step."""
    figure = Figure(figsize=(7.2, 3.4), layout="constrained")
    left, right = figure.subplots(1, 2)
    _draw_courses(left, found, course, early, labels)
    right.plot([one.setting[NODES] for one in found["nodes"]], [_time(one) for one in found["nodes"]], "o-", ms=3.5)
    for name, style in (("discs", ":"), ("smooth", "--")):
        right.axhline(_time(found[name][0]), color=GREY, ls=style, lw=1.0, label=name)
    right.set(xlabel="nodes", ylabel="time per grain and step, compiling\nand output included (µs)")
    right.set_ylim(bottom=0.0)
    right.legend()
    return figure


def _time(one: Outcome) -> float:
    return 1e6 * one.cost["wall_s"] / one.cost["grain_steps"]


def sway_batches(quick: bool) -> dict[str, Batch]:
    """Round grains that are swayed."""
    run = {"run.accuracy": "draft", "run.repeats": 1 if quick else 2}
    run |= {"grains.depth": "40 mm", "run.duration": "3 s"} if quick else {"grains.depth": "80 mm"}
    return as_discs_and_nodes(SWAY, run, [36, 120])


def swayed(found: Found) -> Told:
    """First swing and later amplitude of the centre of mass relative to those of discs, and its course."""
    rows = _beside_discs(found, f"range in the first {EARLY_TIME:g} s", early_range, judged=True)
    rows += _beside_discs(found, "amplitude", lambda one: one["response_amplitude"], judged=False)
    labels = "time (s)", "centre of mass of one bed (mm)"
    return Told(rows, _courses_and_cost(found, _sway, EARLY_TIME, labels))


def _sway(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Time (s) and how far the centre of mass of the first bed is across the tank (m), at the beginning."""
    time, y = one.recording.series["time"], one.recording.series["centre_of_mass"][:, 0, 0]
    begun = time <= SECONDS
    return time[begun], y[begun] - y[0]


def early_range(one: Outcome) -> Value:
    """How far the centre of mass of each bed goes to and fro across the tank until `EARLY_TIME`, mm."""
    series = one.recording.series
    return over_worlds(1e3 * np.ptp(series["centre_of_mass"][series["time"] <= EARLY_TIME, :, 0], axis=0), "mm")


def descriptor_batches(quick: bool) -> dict[str, Batch]:
    """One descriptor at a time."""
    run = cost(quick, 6)
    sizes = {n: [0.08, 0.16] if quick else [0.04, 0.08, 0.16] for n in (2, 3)} | {n: [0.03, 0.06] for n in (4, 8)}
    runs = {"discs": Batch(BOX, {**cost(quick, 8, NEAR), "shapes.grain": False})}
    for n, values in sizes.items():
        runs[NAMES[n]] = Batch(BOX, run, {OUTLINE: [one_descriptor(n, value) for value in values]})
    return runs


def descriptors(found: Found) -> Told:
    """Critical angles relative to those of discs; in the source they grow with the descriptor."""
    discs = found["discs"][0]["critical_angle"]
    rows, largest = [observed("discs", "", counted(discs), None)], []
    for name in NAMES.values():
        for one in found[name]:
            angle = ratio(one["critical_angle"], discs)
            rows.append(over(f"{name} = {one.setting[OUTLINE][-1]:g} R0", "", angle))
        largest.append(found[name][-1]["critical_angle"])
    said, verdict = ", ".join(map(counted, largest)), falling(largest)
    rows.append(observed("the largest of each", "D_2 > D_3 > D_4 > D_8", said, verdict, "each step above zero"))
    return Told(rows, _descriptor_figure(found, discs))


def _descriptor_figure(found: Found, discs: Value) -> Figure:
    figure = Figure(figsize=(6.4, 3.4), layout="constrained")
    axes = figure.add_subplot()
    for name in NAMES.values():
        points = [(one.setting[OUTLINE][-1], one["critical_angle"]) for one in found[name]]
        known = [(x, v.value / discs.value, (v.std or 0.0) / discs.value) for x, v in points if v and v.value]
        if known:
            axes.errorbar(*zip(*known, strict=True), fmt="o-", ms=3.5, capsize=2, label=name)
    axes.axhline(1.0, color=GREY, ls=":", lw=1.0)
    axes.set_xlabel("descriptor relative to R0")
    axes.set_ylabel(f"critical angle over that of discs\n{BARS}")
    axes.legend()
    return figure


def phase_batches(quick: bool) -> dict[str, Batch]:
    """Beds whose grains all have one outline, drawn anew for each bed."""
    draw = {"shapes.grain": False, "shapes.drawn.draws": 1}
    slight = {**cost(quick, 12, NEAR), **draw, "shapes.drawn.spectrum": SLIGHT}
    irregular = {**cost(quick, 12), **draw, "shapes.drawn.spectrum": IRREGULAR}
    discs = Batch(BOX, {**cost(quick, 8, NEAR), "shapes.grain": False})
    return {"discs": discs, "slightly disturbed": Batch(BOX, slight), "irregular": Batch(BOX, irregular)}


def phases(found: Found) -> Told:
    """In the source slightly disturbed outlines slide as discs do, irregular ones much later."""
    angle = {name: outcomes[0]["critical_angle"] for name, outcomes in found.items()}
    discs = angle["discs"]
    rows = [observed(name, "", counted(value), None) for name, value in angle.items()]
    slight, irregular = (ratio(angle[name], discs) for name in ("slightly disturbed", "irregular"))
    rows.append(over("slightly disturbed", "within 5 %", slight, (0.95, 1.05)))
    rows.append(over("irregular", "1.7, from 1.4 to 1.8", irregular, (1.4, 1.8)))
    return Told(rows, shift_against_tilt({name: outcomes[0] for name, outcomes in found.items()}))


def heap_batches(quick: bool) -> dict[str, Batch]:
    """The funnel of the granular report, of discs and of slightly disturbed ones."""
    beds = {"discs": ("funnel/rising-slow", 4), "outlines": ("shapes/heap", 2)}
    return {
        name: Batch(preset, {"run.accuracy": "draft", "run.repeats": 1 if quick else heaps, "grains.count": 800})
        for name, (preset, heaps) in beds.items()
    }


def heaps(found: Found) -> Told:
    """In the source the heap of slightly disturbed discs is a little steeper than that of discs."""
    angle = {name: outcomes[0]["heap_angle"] for name, outcomes in found.items()}
    rows = [observed(name, "", counted(value), None) for name, value in angle.items()]
    between = MORE - HEAPS.within, MORE + HEAPS.within
    more = difference(angle["outlines"], angle["discs"])
    rows.append(held("outlines less discs", f"{MORE} deg", more, between, HEAPS.words("deg"), "deg"))
    return Told(rows)


def pea_batches(quick: bool) -> dict[str, Batch]:
    """The tank of chapter 9 with chickpeas of both frictions."""
    run = {"run.repeats": 2, "grains.depth": "60 mm"} if quick else {"run.repeats": 4, "motion.tilt.angle": "60 deg"}
    run |= {"run.accuracy": "draft", "motion.tilt.rate": "10 deg/s"}
    return {"chickpeas": Batch("shapes/chickpeas-tank", run, {FRICTION: [0.3, 0.5]})}


def peas(found: Found) -> Told:
    """Chickpeas flow about where the experiment's do."""
    rows, curves, says = [], {}, {0.3: 45.0, 0.5: 44.3}  # deg, 9 and 7.2 % over 41.3
    for one in found["chickpeas"]:
        name, angle = f"friction {one.setting[FRICTION]:g}", one["critical_angle"]
        rows.append(stated(f"{name}: angle of repose, the source's", says[one.setting[FRICTION]], angle, ONE_BED))
        rows.append(stated(f"{name}: angle of repose, the experiment's", 41.3, angle, ONE_BED))
        rows.append(stated(f"{name}: first slip, beside the experiment's heap", 37.0, one["first_slip_angle"], ONE_BED))
        curves[name] = one
    return Told(rows, shift_against_tilt(curves))


EXPERIMENTS = [
    Experiment(
        "outline-discs",
        "Round outlines against discs",
        "8.2.1",
        "tilted at 0.3 and 10 deg/s, discs by nodes slide as exact ones do: within 0.5 % from 120 nodes on, 2 % at 80, "
        "8 % at 50.",
        round_batches,
        round_ones,
        "3 beds for 6 of half the depth, 20 deg/s for 10, 36 and 120 nodes only",
        ("smooth", 0.6),
        "A bed is compared with the same one of discs, until it slides: then grains whose forces differ in a last "
        "digit part, and critical angles of single beds differ by several degrees. Smooth outlines move as discs do. "
        "Contact by nodes keeps a bed back that creeps, the more the fewer there are; the source, which compares "
        "whole curves, does not tell of it. A disc by n nodes rolls as a polygon of n corners does, on slopes over "
        "180/n degrees alone (36: 5, 120: 1.5; tested with single discs), which would do that.",
    ),
    Experiment(
        "outline-discs-slow",
        "Round outlines against discs, tilted slowly",
        "8.2.1",
        "tilted at 0.3 deg/s, discs by nodes move as exact ones do: within 0.5 % from 120 nodes on.",
        slow_batches,
        slow_ones,
        "2 beds for 3 of half the depth, 1 deg/s for 0.3, 36 and 120 nodes only",
        ("smooth", 1.0),
        "In the full report smooth outlines and 500 nodes creep as discs do, jump by jump; fewer nodes hold a bed "
        "back, as above: a polygon of n corners does not roll on slopes below 180/n degrees (500: 0.36).",
    ),
    Experiment(
        "outline-sway",
        "Round outlines against discs, swayed",
        "8.2.2",
        "swayed by 50 mm at 1.8 Hz the centre of mass of discs by nodes goes to and fro as that of exact ones does: "
        "within 0.5 % from 120 nodes on, 2 % at 80, 7 % at 36.",
        sway_batches,
        swayed,
        "1 bed for 2 of half the depth, 3 s for 6",
        ("smooth", 0.7),
        "As above: alike until the bed slides, within half a second; its amplitude later is one of few unlike cycles.",
    ),
    Experiment(
        "outline-descriptors",
        "One descriptor at a time",
        "8.3.1",
        "the angle of repose grows with the descriptor, most with D_2, then D_3, D_4 and D_8; 12 beds scatter by 10 %.",
        descriptor_batches,
        descriptors,
        "3 beds for 6 of half the depth, two sizes of each descriptor",
        ("D_2", 0.6),
        "Every descriptor makes a bed stand more steeply. Six beds do not tell their order; but eight lobes, which the "
        "source's grains hardly feel, are felt here as much as two or three, though less high. Why is not known.",
    ),
    Experiment(
        "outline-phases",
        "Random phases",
        "8.3.2",
        "beds of equal grains whose phases are drawn: slightly disturbed discs slide within 5 % of discs, irregular "
        "ones at 1.7 times, from 1.4 to 1.8.",
        phase_batches,
        phases,
        "3 draws for 12, half the depth",
        ("irregular", 0.6),
    ),
    Experiment(
        "outline-heaps",
        "Heaps of slightly disturbed discs",
        "8.3.3",
        "under a funnel raised at 25 mm/s slightly disturbed discs heap up 2.5 deg steeper than discs.",
        heap_batches,
        heaps,
        "1 heap for 4 of discs and 2 of outlines",
        ("outlines", 0.8),
        "So few heaps do not tell: the two of outlines of the full report are 4 deg apart.",
    ),
    Experiment(
        "outline-chickpeas",
        "Chickpeas by their outlines",
        "9.3",
        "in the experiment a heap at 37 deg, flow at 41.3 deg; irregular grains flow on average 9 % later, with a "
        "friction of 0.5 by 7 %.",
        pea_batches,
        peas,
        "2 beds for 4 of half the depth",
        ("chickpeas", 0.6),
        "In the full report ours flow 8 to 13 deg below the experiment, with a friction of 0.3 no later than spheres "
        "of their sizes between smooth walls (29.8 ± 1.2 deg, six beds, `tilting/chickpeas`). Their spectra are our "
        "choice, after lengths and widths of chickpeas; the source's are in a figure without numbers. As with random "
        "phases, outlines that bend add less here than there; why is not known. With more friction our mean is higher, "
        "within the scatter, the source's lower.",
    ),
]
