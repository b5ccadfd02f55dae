"""A barge that loose cargo does capsize: her sides end little above the water, so that her lever softens and vanishes.

Sound hydrostatics, cargo that counts once: grains beside the heap of `solvers.ship.heap` at the edge of capsize.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt

import numpy as np
from matplotlib.figure import Figure

from lab.plots import BELOW, BLUE
from lab.presets import load
from lab.reproduce.capsizes import PRESET, READINGS, scan, swung
from lab.reproduce.curves import SIZE, leading_number
from lab.reproduce.experiment import Experiment, Told, observed
from lab.reproduce.runs import Batch, Outcome
from lab.reproduce.ship import AMPLITUDE, LOST, afloat
from lab.reproduce.ship import FREQUENCY as WAVES
from lab.scene import vessels
from solvers.ship.heap import HeapShip
from solvers.ship.hydrostatics import buoyancy, turned

FREQUENCY = 4.4  # rad/s, the source's
LOW = {"ship.height": "140 mm", "waves.frequency": f"{FREQUENCY} rad/s", "waves.soft_start": "0 s"}
SAYS = {"19 mm": "capsizes", "17 mm": "capsizes at 4.5 rad/s", "15 mm": "does not"}  # the source of its barge, loose
CURVE = np.arange(10.0, 31.0, 1.0)  # mm
SURE = 1.96  # standard deviations of a 95 % interval
# Of the map: waves that beds of grains meet (mm, rad/s), in the quick report fewer, and those that a heap does.
GRID = {False: ((10, 15, 20, 25, 30, 35), (3.6, 4.0, 4.4, 4.8, 5.2, 5.6)), True: ((15, 25, 35), (4.0, 4.4, 4.8))}
FINE = np.linspace(8.0, 37.0, 30), np.linspace(3.4, 5.8, 25)


def batches(quick: bool) -> dict[str, Batch]:
    """Several beds in waves on either side of the edge."""
    sizes = [f"{size} mm" for size in ((19, 15) if quick else (19, 17, 15, 13))]
    changes = afloat(quick, **LOW, **{"run.repeats": 2 if quick else 4})
    return {"low sides": Batch(PRESET, changes, {AMPLITUDE: sizes})}


def tell(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """How many beds capsized her, and how many of the heap's reposes do; with frozen cargo never."""
    runs, ship, rows = found["low sides"], low_ship(), []
    sizes = np.array([leading_number(one.setting[AMPLITUDE]) for one in runs])
    _, shares = swung(ship, sizes, np.full(len(runs), FREQUENCY))
    for one, share in zip(runs, shares, strict=True):
        lost, beds = _lost(one)
        alone = "capsizes" if one["frozen_capsized_at"].value is not None else "stands"
        said = f"{lost} of {beds} beds; {100.0 * share:.0f} % of a heap's reposes; frozen {alone}"
        size = str(one.setting[AMPLITUDE])
        rows.append(observed(f"{size}, {FREQUENCY:g} rad/s: capsize with", SAYS.get(size, ""), said, None))
    return Told(
        rows, _figure(sizes, [_lost(one) for one in runs], swung(ship, CURVE, np.full(len(CURVE), FREQUENCY))[1])
    )


def low_ship() -> HeapShip:
    """The barge with low sides, her cargo a heap; her lever is that of the clipped section held by the axis."""
    resolved = load(PRESET, LOW).resolved
    ship, heave = vessels(resolved)[0].ship, resolved.ship.heave
    rolls = np.radians(np.linspace(-120.0, 120.0, 481))
    heaves = heave + ship.about[1] - turned(ship.about, rolls)[:, 1]
    water = buoyancy(ship.load.section, ship.load.water, heaves, rolls, about=ship.about)[:, 2]
    weight = ship.body.mass * ship.gravity
    levers = turned(tuple(np.subtract(ship.body.centre, ship.about)), rolls)[:, 0] - water / weight
    return replace(READINGS[0].ship, lever=lambda roll: np.interp(roll, rolls, levers))


def _lost(one: Outcome) -> tuple[int, int]:
    """Beds that capsized her, and all."""
    ends = one["capsized_at"].worlds
    return sum(end is not None for end in ends), len(ends)


def chance(lost: int, beds: int) -> tuple[float, float]:
    """The interval that holds the chance of capsize with 95 % confidence (Wilson 1927)."""
    share, square = lost / beds, SURE**2 / beds
    middle = (share + 0.5 * square) / (1.0 + square)
    half = SURE / (1.0 + square) * sqrt(share * (1.0 - share) / beds + 0.25 * square / beds)
    return middle - half, middle + half


def map_batches(quick: bool) -> dict[str, Batch]:
    """One or two beds of coarse grains in each of many waves."""
    sizes, frequencies = GRID[quick]
    changes = {**afloat(True), **LOW, "run.repeats": 1 if quick else 2}
    del changes[WAVES]
    axes = {AMPLITUDE: [f"{size} mm" for size in sizes], WAVES: [f"{omega} rad/s" for omega in frequencies]}
    return {"low sides": Batch(PRESET, changes, axes)}


def tell_map(found: Mapping[str, Sequence[Outcome]]) -> Told:
    """From which amplitude on loose cargo capsizes her, at each frequency; and whether frozen cargo ever does."""
    runs, rows = found["low sides"], []
    for omega in sorted({leading_number(one.setting[WAVES]) for one in runs}):
        there = [one for one in runs if leading_number(one.setting[WAVES]) == omega]
        lowest = [leading_number(one.setting[AMPLITUDE]) for one in there if _lost(one)[0] > 0]
        says = f"from {min(lowest):g} mm on" if lowest else "in none of these waves"
        rows.append(observed(f"{omega:g} rad/s: loose cargo capsizes her", "", says, None))
    alone = [leading_number(one.setting[AMPLITUDE]) for one in runs if one["frozen_capsized_at"].value is not None]
    says = f"in {len(alone)} of {len(runs)} waves" + (f", from {min(alone):g} mm on" if alone else "")
    rows.append(observed("frozen cargo", "not in 17 and 19 mm", says, not alone or min(alone) > 19.0))
    return Told(rows, _map_figure(runs))


def _map_figure(runs: Sequence[Outcome]) -> Figure:
    """Where a heap capsizes her, shaded by its reposes, and beds of grains."""
    figure = Figure(figsize=(6.4, 4.2), layout="constrained")
    axes = figure.add_subplot()
    shares = np.ma.masked_equal(scan(low_ship(), *FINE).capsized, 0.0)
    shade = axes.pcolormesh(FINE[1], FINE[0], shares, cmap="Oranges", shading="nearest", vmin=-0.2, vmax=2.0)
    shade.set_rasterized(True)
    kinds = {"no bed": "none", "some": "left", "every bed": "full"}
    for name, filled in kinds.items():
        axes.plot([], [], "o", color=BLUE, fillstyle=filled, label=f"{name} capsizes her")
    for one in runs:
        lost, beds = _lost(one)
        filled = kinds["every bed" if lost == beds else "some" if lost else "no bed"]
        place = leading_number(one.setting[WAVES]), leading_number(one.setting[AMPLITUDE])
        axes.plot(*place, "o", ms=9, color=BLUE, fillstyle=filled)
        if one["frozen_capsized_at"].value is not None:
            axes.plot(*place, "x", ms=5, color="black")
    axes.plot([], [], "s", color=shade.cmap(0.5), label="a heap does, of reposes from 17 to 25 deg")
    axes.plot([], [], "x", color="black", label="frozen cargo does, too")
    axes.set_xlabel("frequency of the waves (rad/s)")
    axes.set_ylabel("amplitude of the waves (mm)")
    axes.grid(False)
    figure.legend(loc=BELOW, ncols=3)
    return figure


def _figure(sizes: np.ndarray, lost: Sequence[tuple[int, int]], heap: np.ndarray) -> Figure:
    figure = Figure(figsize=SIZE, layout="constrained")
    axes = figure.add_subplot()
    axes.step(CURVE, heap, where="mid", color="0.5", label="a heap, reposes of 17 to 25 deg")
    share = np.array([k / n for k, n in lost])
    ends = np.array([chance(k, n) for k, n in lost]).T
    axes.errorbar(sizes, share, np.abs(ends - share), fmt="o", capsize=3, label="beds of grains, 95 % confidence")
    axes.set_xlabel("amplitude of the waves (mm)")
    axes.set_ylabel("share that\ncapsizes her")
    axes.set_ylim(-0.05, 1.05)
    figure.legend(loc=BELOW, ncols=2)
    return figure


EXPERIMENTS = [
    Experiment(
        "barge-low-sides",
        "A barge with low sides and loose cargo",
        "ours",
        "its barge, with sides of 300 mm, capsizes with loose cargo in waves of 17 and 19 mm, not of 15 mm.",
        batches,
        tell,
        LOST,
        ("low sides", 0.82),
        "Her sides end 30 mm above the water, at 140 mm; all else is as above, waves at once. Held by the axis her "
        "lever is then largest at 40 deg and vanishes near 80; every part of it is known. Frozen cargo stays, loose "
        "cargo slides and takes her over, as the source saw it of its barge in waves of 17 and 19 mm: one large swing, "
        "the cargo stays where it has slid, and the next swings capsize her. Grains do so in lower waves than a heap, "
        "which needs no time to slide and never goes past its repose.",
        point=0,
    ),
    Experiment(
        "barge-map",
        "Which waves capsize the barge with low sides",
        "ours, as figures 7.8 and 7.16 to 7.19",
        "loose cargo capsizes its barge from 17 mm on, at 19 mm from 4.4 to 4.7 rad/s; frozen cargo does not.",
        map_batches,
        tell_map,
        "1 bed for 2, 3 by 3 waves for 6 by 6",
        ("low sides", 0.9),
        "Grains of 10 mm, so that so many waves can be had. Shaded is where a heap, which is at its angle of repose at "
        "once, takes her over.",
    ),
]
