"""The beds that the studies tilt and sway, small so that many can be run, and the results of a sweep over them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes

from lab.measures.value import over_worlds
from lab.report.numbers import mean_within
from lab.report.page import Page
from lab.studies.reproduce.runs import Batch, Outcome, carry_out, outcomes

TANK = {"tank.width": "60 mm", "tank.height": "50 mm", "grains.depth": "30 mm"}  # some 200 grains of 3 mm
STIFF = {"contact.stiffness_scale": 1e-3, "run.accuracy": "standard"}
TILT = {**TANK, **STIFF, "motion.tilt.rate": "10 deg/s", "motion.tilt.angle": "40 deg", "run.repeats": 12}
SWAY = {
    **TANK,
    **STIFF,
    "motion.soft_start": "0.5 s",
    "motion.sway.amplitude": "15 mm",
    "motion.sway.frequency": "3 Hz",
    "run.duration": "4 s",
    "run.repeats": 6,
}
TILTED, SWAYED = "tilting/quick", "shaking/sway"


@dataclass(frozen=True)
class Point:
    """One point of a sweep: its settings, its measures over the beds, its cost (grain-steps and steps of a bed)."""

    setting: Mapping[str, object]
    worlds: Mapping[str, np.ndarray]
    steps: float
    folder: Path

    def mean(self, name: str) -> float:
        """Mean of a measure over the beds that have it; NaN where none has."""
        return float(np.mean(self.worlds[name])) if len(self.worlds[name]) else float("nan")

    def half_interval(self, name: str) -> float:
        """Half the 95 % interval of the mean (Student 1908); NaN for fewer than two beds."""
        found = over_worlds(self.worlds[name], "1")
        return float("nan") if found.interval is None else found.interval[1] - found.value


def sweep(
    name: str, axes: Mapping[str, Sequence], overrides: Mapping[str, object], folder: Path, fast: bool
) -> list[Point]:
    """Run a preset over `axes`, or go on with it or read it where it is done; `fast` takes a hasty version of it."""
    if fast:
        hasty = {"run.repeats": 2, "grains.depth": "9 mm", "run.accuracy": "draft"}
        overrides = {**overrides, **hasty}
    print(f"{folder.name}: {name} over {', '.join(axes)}", flush=True)
    carry_out(Batch(name, overrides, axes), folder, quiet=True)
    return [_point(one) for one in outcomes(folder)]


def _point(one: Outcome) -> Point:
    found = {name: value.worlds for name, value in one.measures.items()}
    worlds = {name: np.array([x for x in numbers if x is not None], dtype=float) for name, numbers in found.items()}
    return Point(one.setting, worlds, one.cost["grain_steps"] / len(next(iter(found.values()))), one.folder)


def mean_and_interval(point: Point, name: str, digits: int = 2) -> str:
    """A measure's mean and its 95 % interval, as text."""
    return mean_within(point.mean(name), over_worlds(point.worlds[name], "1").interval, digits)


def add_table(
    page: Page, head: str, labels: Sequence[str], points: Sequence[Point], names: Sequence[str], cost: float = 0.0
) -> None:
    """A row a point: measures (deg) as means with intervals and, with a `cost`, steps relative to so many."""
    columns = [f"{name.replace('_', ' ')} (deg)" for name in names] + (["cost"] if cost else [])
    rows = [
        [label, *(mean_and_interval(p, name) for name in names), *([p.steps / cost] if cost else [])]
        for label, p in zip(labels, points, strict=True)
    ]
    page.table([head, *columns], rows)


def draw_bars(axes: Axes, x: Sequence[float], points: Sequence[Point], name: str, how: tuple[str, str]) -> None:
    """A measure's means with their intervals; how: colour and label."""
    values, errors = [p.mean(name) for p in points], [p.half_interval(name) for p in points]
    axes.errorbar(x, values, errors, color=how[0], marker="o", markersize=4, capsize=3, label=how[1])
