"""What the runs of a voyage say: how many are lost or listed, with their interval, and whether that can be told."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from lab.base.errors import LabError
from lab.measures.value import Value, over_worlds
from lab.preset.schema import Preset
from lab.studies.reproduce.estimates import chance
from lab.sweeps.point import Point

FEWEST = 10  # seeds, for a verdict
WIDEST = 0.4  # of the interval of a share, for a verdict
CELLS, ACROSS = 10, 100  # cells in a bed's depth, grains across a hold: with fewer the cargo is coarse
LOST = "capsized_at", "flooded_at", "sunk_at"  # measures that only a lost ship has
SHIFTED = 10.0  # % of the moment that the Grain Code assumes: from there on the cargo has shifted
UNLIKE = 2.0  # factor between the shifts of bulk and of the finest grains above which they disagree


@dataclass(frozen=True)
class Share:
    """How many of `n` runs had an outcome, with the 95 % interval of its probability (Wilson 1927)."""

    seen: int
    n: int

    @property
    def interval(self) -> tuple[float, float]:
        """From 0 to 1."""
        low, high = chance(self.seen, self.n)
        return max(0.0, low), min(1.0, high)

    def __str__(self) -> str:
        low, high = self.interval
        return f"{self.seen} of {self.n}: {self.seen / self.n:.0%} (95 %: {low:.0%} to {high:.0%})"


@dataclass(frozen=True)
class Check:
    """A run of the worst seed with grains of a `size`: the same numbers from a finer or coarser cargo."""

    size: str
    point: Point


@dataclass(frozen=True)
class Judged:
    """The runs that could be judged, `points`, of all `asked`, and `checks` of the worst with grains.

    A ship that is lost, by capsizing or by flooding, counts as listed and her cargo as shifted. `limit` is in deg.
    """

    preset: Preset
    limit: float
    points: Sequence[Point]
    checks: Sequence[Check] = field(default=())
    asked: int = 0

    def first(self, name: str) -> list[float | None]:
        """A measure of each run."""
        return [first_of(point, name) for point in self.points]

    @property
    def losses(self) -> list[bool]:
        """Whether she was lost, in each run."""
        return [is_lost(point) for point in self.points]

    def share(self, name: str, least: float) -> Share:
        """How many runs were lost or have a measure whose size is `least` or more; of those that have one or the other.

        Raises LabError where no run has.
        """
        known = [lost or size is not None for size, lost in zip(self.first(name), self.losses, strict=True)]
        if not any(known):
            raise LabError(f"none of the runs tells {name.replace('_', ' ')}: the preset's ship has no such measure.")
        seen = [lost or abs(size or 0.0) >= least for size, lost in zip(self.first(name), self.losses, strict=True)]
        return Share(sum(seen), sum(known))

    @property
    def lost(self) -> Share:
        """Runs in which she was lost."""
        return Share(sum(self.losses), len(self.points))

    @property
    def frozen_lost(self) -> Share:
        """Runs in which she would have been lost with her cargo frozen."""
        return Share(sum(is_lost(point, "frozen_") for point in self.points), len(self.points))

    @property
    def listed(self) -> Share:
        """Runs after which she lists by the limit or more."""
        return self.share("list_as_it_lay", self.limit)

    @property
    def shifted(self) -> Share:
        """Runs in which the cargo's moment reached SHIFTED of what the Grain Code assumes."""
        return self.share("largest_shifted_share", SHIFTED)

    def mean(self, name: str, unit: str) -> Value:
        """The mean size of a measure over the runs."""
        return over_worlds([float("nan") if one is None else abs(one) for one in self.first(name)], unit)

    @property
    def worst(self) -> int:
        """The number of the run with a loss, else with the largest shift."""
        shares = self.first("largest_shifted_share")
        sizes = [(lost, abs(one or 0.0)) for one, lost in zip(shares, self.losses, strict=True)]
        return max(range(len(sizes)), key=sizes.__getitem__)

    @property
    def doubts(self) -> list[str]:
        """Why nothing can be told, each in a few words; empty where something can."""
        found, listed = [], self.listed
        if listed.n < FEWEST:
            found.append(f"{listed.n} seeds are few, {FEWEST} are needed")
        if self.asked > listed.n:
            found.append(f"{self.asked - listed.n} of {self.asked} runs could not be judged")
        low, high = listed.interval
        if high - low > WIDEST:
            found.append(f"the interval is {high - low:.0%} wide, more than {WIDEST:.0%}: take more seeds")
        if coarse := coarseness(self.preset)[1]:
            found.append(coarse)
        return found + self._unlike()

    def _unlike(self) -> list[str]:
        """Whether the bulk and the finest grains tell the worst run apart, in a few words."""
        if not self.checks:
            return []
        worst, finest = self.points[self.worst], self.checks[-1]
        if is_lost(worst) and is_lost(finest.point):
            return []
        bulk, grains = (first_of(point, "largest_shifted_share") for point in (worst, finest.point))
        if bulk is None or grains is None:
            return [f"the check with grains of {finest.size} tells no shift"]
        low, high = sorted((abs(bulk), abs(grains)))
        if high < SHIFTED or high <= UNLIKE * low:
            return []
        return [f"the worst shift is {abs(bulk):.3g} % by the bulk and {abs(grains):.3g} % by grains of {finest.size}"]

    @property
    def verdict(self) -> str:
        """One sentence: what the share of worst groups is after which she lists, or why that cannot be told."""
        if self.doubts:
            return f"Cannot tell: {'; '.join(self.doubts)}."
        low, high = self.listed.interval
        return (
            f"After the worst group of such a sea she lists by {self.limit:g} deg or more, or is lost, "
            f"with a probability of {low:.0%} to {high:.0%} (95 %, {self.listed.seen} of {self.listed.n} seas)."
        )


def first_of(point: Point, name: str) -> float | None:
    """A measure of a run's only world; None where it was not found."""
    value = point.measures.get(name)
    return value.value if value is not None else None


def is_lost(point: Point, of: str = "") -> bool:
    """Whether she was lost in a run; `of` is "frozen_" for the ship with her cargo frozen."""
    return any(first_of(point, of + name) is not None for name in LOST)


def coarseness(preset: Preset) -> tuple[str, str]:
    """How fine the cargo is computed, in words, and why that is too coarse; "" where it is not."""
    if preset.bulk is not None:
        depth, spacing = preset.bulk.depth, preset.bulk.spacing
        if not depth:
            return "a bulk whose depth differs", ""
        found, least = f"{depth / spacing:.1f} cells in its depth", CELLS
        coarse = depth / spacing < CELLS
    else:
        across = preset.tank.extent[0] / preset.grains.diameter
        found, least, coarse = f"{across:.0f} grains across the hold", ACROSS, across < ACROSS
    return found, f"{found} are coarse, {least} are needed" * coarse


def read(folders: Sequence[Path], seeds: Sequence[int]) -> list[Point]:
    """The runs that have been reported."""
    found = [Point({"waves.seed": seed}, folder) for seed, folder in zip(seeds, folders, strict=True)]
    return [point for point in found if point.measures]
