"""A barge that loose cargo does capsize: it has little freeboard and floods through its hatch.

With correct hydrostatics and cargo counted once: grains compared with the heap of the module `sliding_heap` near the
limit of loss.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure

from lab.assembly.scene import vessels
from lab.preset.find import load
from lab.report.plots import BELOW, BLUE, canvas
from lab.studies.reproduce.estimates import chance, surely
from lab.studies.reproduce.experiment import EXACT, ReportSection, Row, counted, observed
from lab.studies.reproduce.figures import SIZE, leading_number
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.capsizes import CARGO, NATURAL, REPOSES, scan, swung
from lab.studies.reproduce.ships.capsizes import PRESET as BARGE
from lab.studies.reproduce.ships.rolls import AMPLITUDE
from lab.studies.reproduce.ships.rolls import FREQUENCY as WAVES
from lab.studies.reproduce.ships.sliding_heap import HeapShip, box_heap
from solvers.ship.hydrostatics import buoyancy, metacentric_height, turned
from solvers.ship.motion import RollDamping

PRESET = "ship/capsize-map"
FREQUENCY = 4.4  # rad/s, the source's and the preset's
SAYS = {"19 mm": "capsizes", "17 mm": "capsizes at 4.5 rad/s", "15 mm": "does not"}  # the source of its barge, loose
HIGHEST = 19.0  # mm: up to these waves the source's barge stands with frozen cargo
CURVE = np.arange(10.0, 31.0, 1.0)  # mm
WIDE = (8.0, 3.6)  # inches
# Of the map: waves (mm, rad/s) that a heap meets.
FINE = np.linspace(10.0, 35.0, 26), np.linspace(3.8, 5.4, 17)


def report(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """In how many beds, and at how many of the heap's angles of repose, she was lost; and with frozen cargo."""
    runs, ship, rows = found["low sides"], low_ship(), []
    sizes = np.array([leading_number(one.setting[AMPLITUDE]) for one in runs])
    _, shares = swung(ship, sizes, np.full(len(runs), FREQUENCY))
    for one, share in zip(runs, shares, strict=True):
        size, heap = str(one.setting[AMPLITUDE]), f"lost with {100.0 * share:.0f} % of a heap's reposes"
        said = f"{_fates(one)}; {heap}; frozen {_frozen(one)}"
        rows.append(observed(f"{size}, {FREQUENCY:g} rad/s", SAYS.get(size, ""), said, None))
    return ReportSection(
        rows, _figure(sizes, [_lost(one) for one in runs], swung(ship, CURVE, np.full(len(CURVE), FREQUENCY))[1])
    )


def low_ship() -> HeapShip:
    """The barge with a hatch, her cargo a heap; her lever is that of the clipped section held by the axis."""
    resolved = load(PRESET).resolved
    given, ship = resolved.ship, vessels(resolved)[0].ship
    section, water, weight = ship.load.section, ship.load.water, ship.body.mass * ship.gravity
    rolls = np.radians(np.linspace(-120.0, 120.0, 481))
    heaves = given.heave + ship.about[1] - turned(ship.about, rolls)[:, 1]
    moments = buoyancy(section, water, heaves, rolls, about=ship.about)[:, 2]
    levers = turned(tuple(np.subtract(ship.body.centre, ship.about)), rolls)[:, 0] - moments / weight
    depth, hold = resolved.grains.depth, np.ptp(resolved.tank.corners, axis=0)
    mass = CARGO * depth / load(BARGE).resolved.grains.depth
    heap = box_heap(*hold, depth, given.hold[1] - given.about[1], mass, REPOSES[-1])
    height = metacentric_height(section, ship.body.loading, water)
    lever = lambda roll: np.interp(roll, rolls, levers)  # noqa: E731
    openings = np.subtract(given.flooding_points, given.about)
    free = HeapShip(weight, height, lever, 1.0, ship.gravity, RollDamping(), heap, openings=openings).tuned(NATURAL)
    linear, quadratic = 2.0 * given.damping * NATURAL * free.inertia, given.quadratic_damping * free.inertia
    return replace(free, damping=RollDamping(linear, quadratic))


def _lost(one: Outcome) -> tuple[int, int]:
    """Beds with which she was lost, and all."""
    ends = zip(one["capsized_at"].worlds, one["flooded_at"].worlds, strict=True)
    lost = [end != (None, None) for end in ends]
    return sum(lost), len(lost)


def _fates(one: Outcome) -> str:
    """How many beds she floods and capsizes with, and when."""
    verbs = {"flooded_at": "floods", "capsized_at": "capsizes"}
    told = [f"{verb} at {counted(one[name])}" for name, verb in verbs.items() if one[name].value is not None]
    return ", ".join(told) or f"stands with {len(one['flooded_at'].worlds)} beds"


def _frozen(one: Outcome) -> str:
    """What becomes of her with her cargo frozen."""
    found = {one["frozen_flooded_at"].value: "floods", one["frozen_capsized_at"].value: "capsizes"}
    return next((f"{verb} at {when:.3g} s" for when, verb in found.items() if when is not None), "stands")


def report_map(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """From which amplitude on she is lost with loose cargo, at each frequency; and with frozen cargo."""
    runs = found["low sides"]
    return ReportSection([*_edge(runs, "lost with loose cargo"), frozen_row(runs)], _map_figure(runs))


def frozen_row(runs: Sequence[Outcome]) -> Row:
    """In which waves of a map she is lost with frozen cargo; judged where loose cargo loses her in waves as low."""
    alone = [leading_number(one.setting[AMPLITUDE]) for one in runs if _frozen(one) != "stands"]
    says = f"in {len(alone)} of {len(runs)} waves" + (f", from {min(alone):g} mm on" if alone else "")
    lower = [leading_number(one.setting[AMPLITUDE]) for one in runs if _lost(one)[0]]
    fails = bool(lower) and min(lower) <= HIGHEST  # else that frozen cargo does not lose her tells nothing
    alike = surely(not alone or min(alone) > HIGHEST) if fails else None
    says += "" if fails else f"; not judged, loose cargo does not lose her in the waves up to {HIGHEST:g} mm, either"
    return observed("lost with frozen cargo", "not in 17 and 19 mm", says, alike, EXACT)


def report_tank(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """From which amplitude on she is lost, at each frequency, with the water in her tank loose and frozen."""
    rows = [row for name, runs in found.items() for row in _edge(runs, f"lost, {name}")]
    figure, panels = canvas(WIDE, 1, len(found), sharey=True, squeeze=False)
    for axes, (name, runs) in zip(panels[0], found.items(), strict=True):
        for one in runs:
            filled = "full" if _lost(one)[0] else "left" if _cut(one) else "none"
            place = leading_number(one.setting[WAVES]), leading_number(one.setting[AMPLITUDE])
            axes.plot(*place, "o", ms=11, color=BLUE, fillstyle=filled)
            if when := _when(one):
                axes.annotate(f"{when:.0f} s", place, (0, 9), textcoords="offset points", ha="center", fontsize=8)
        axes.set_title(name)
        axes.set_xlabel("frequency of the waves (rad/s)")
        axes.margins(0.15)
        axes.grid(False)
    panels[0][0].set_ylabel("amplitude of the waves (mm)")
    for label, filled in {
        "stands": "none",
        "not known: stopped by the watch": "left",
        "lost, and when": "full",
    }.items():
        panels[0][0].plot([], [], "o", color=BLUE, fillstyle=filled, label=label)
    figure.legend(loc=BELOW, ncols=3)
    return ReportSection(rows, figure)


def _cut(one: Outcome) -> bool:
    """Whether the watch has stopped her run before she was lost, so that it says nothing of that wave."""
    return one.status != "complete" and not _lost(one)[0]


def _when(one: Outcome) -> float | None:
    """When she was lost with the first bed (s)."""
    times = [one["capsized_at"].worlds[0], one["flooded_at"].worlds[0]]
    return min((time for time in times if time is not None), default=None)


def _edge(runs: Sequence[Outcome], says: str) -> list[Row]:
    """A row for each frequency: in which waves she is lost, and of which the watch has left nothing known."""
    rows = []
    for omega in sorted({leading_number(one.setting[WAVES]) for one in runs}):
        there = [one for one in runs if leading_number(one.setting[WAVES]) == omega]
        lost = [leading_number(one.setting[AMPLITUDE]) for one in there if _lost(one)[0] > 0]
        cut = [leading_number(one.setting[AMPLITUDE]) for one in there if _cut(one)]
        stands = [size for one in there if (size := leading_number(one.setting[AMPLITUDE])) not in (*lost, *cut)]
        told = _from(lost, stands) + (f"; not known at {', '.join(f'{size:g}' for size in cut)} mm" if cut else "")
        rows.append(observed(f"{omega:g} rad/s: {says}", "", told, None))
    return rows


def _from(lost: Sequence[float], stands: Sequence[float]) -> str:
    """In which waves (mm) she is lost; some higher ones she may stand."""
    if not lost:
        return "in none of these waves"
    higher = [f"{size:g}" for size in stands if size > min(lost)]
    return f"from {min(lost):g} mm on" + (f", but for {', '.join(higher)} mm" if higher else "")


def _map_figure(runs: Sequence[Outcome]) -> Figure:
    """Where she is lost with a heap, shaded by its reposes, and with beds of grains."""
    figure, axes = canvas((6.4, 4.2))
    shares = np.ma.masked_equal(scan(low_ship(), *FINE).capsized, 0.0)
    shade = axes.pcolormesh(FINE[1], FINE[0], shares, cmap="Oranges", shading="nearest", vmin=-0.2, vmax=2.0)
    shade.set_rasterized(True)
    kinds = {"no bed": "none", "some": "left", "every bed": "full"}
    for name, filled in kinds.items():
        axes.plot([], [], "o", color=BLUE, fillstyle=filled, label=f"lost with {name}")
    for one in runs:
        lost, beds = _lost(one)
        filled = kinds["every bed" if lost == beds else "some" if lost else "no bed"]
        place = leading_number(one.setting[WAVES]), leading_number(one.setting[AMPLITUDE])
        axes.plot(*place, "o", ms=9, color=BLUE, fillstyle=filled)
        if _frozen(one) != "stands":
            axes.plot(*place, "x", ms=5, color="black")
    axes.plot([], [], "s", color=shade.cmap(0.5), label="with a heap, of reposes from 17 to 25 deg")
    axes.plot([], [], "x", color="black", label="with frozen cargo, too")
    axes.set(xlabel="frequency of the waves (rad/s)", ylabel="amplitude of the waves (mm)")
    axes.grid(False)
    figure.legend(loc=BELOW, ncols=3)
    return figure


def _figure(sizes: np.ndarray, lost: Sequence[tuple[int, int]], heap: np.ndarray) -> Figure:
    figure, axes = canvas(SIZE)
    axes.step(CURVE, heap, where="mid", color="0.5", label="a heap, reposes of 17 to 25 deg")
    share = np.array([k / n for k, n in lost])
    ends = np.array([chance(k, n) for k, n in lost]).T
    axes.errorbar(
        sizes, share, np.abs(ends - share), fmt="o", capsize=3, label="beds of grains, bars: Wilson's interval (95 %)"
    )
    axes.set(xlabel="amplitude of the waves (mm)", ylabel="share with which\nshe is lost")
    axes.set_ylim(-0.05, 1.05)
    figure.legend(loc=BELOW, ncols=2)
    return figure
