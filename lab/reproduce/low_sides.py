"""A barge that loose cargo does capsize: her sides end little above the water, so that her lever softens and vanishes.

Sound hydrostatics, cargo that counts once: grains beside the heap of `solvers.ship.heap` at the edge of capsize.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt

import numpy as np
from matplotlib.figure import Figure

from lab.plots import BELOW
from lab.presets import load
from lab.reproduce.capsizes import PRESET, READINGS, swung
from lab.reproduce.curves import SIZE, leading_number
from lab.reproduce.experiment import Experiment, Told, observed
from lab.reproduce.runs import Batch, Outcome
from lab.reproduce.ship import AMPLITUDE, LOST, afloat
from lab.scene import vessels
from solvers.ship.heap import HeapShip
from solvers.ship.hydrostatics import buoyancy, turned

FREQUENCY = 4.4  # rad/s, the source's
LOW = {"ship.height": "140 mm", "waves.frequency": f"{FREQUENCY} rad/s", "waves.soft_start": "0 s"}
SAYS = {"19 mm": "capsizes", "17 mm": "capsizes at 4.5 rad/s", "15 mm": "does not"}  # the source of its barge, loose
CURVE = np.arange(10.0, 31.0, 1.0)  # mm
SURE = 1.96  # standard deviations of a 95 % interval


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
    )
]
