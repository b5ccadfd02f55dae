"""Grain sizes: distributions of the diameter by number."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

MOST_DEVIATIONS = 3.0  # standard deviations at which a normal distribution is truncated, on both sides
SMALLEST_SHARE = 0.1  # smallest diameter of a normal distribution, relative to its class's diameter


@dataclass(frozen=True)
class Sizes:
    """Diameters of one or several classes of grains, each class spread about its own diameter.

    `classes`: (diameter m, share by number); the shares may have any sum. `spread`: half-width of a uniform
    distribution relative to the diameter or, if `normal`, the relative standard deviation of a normal one before it is
    truncated at ± 3 standard deviations and at a tenth of the diameter.
    """

    classes: tuple[tuple[float, float], ...]
    spread: float = 0.0
    normal: bool = False

    @property
    def mean(self) -> float:
        """Mean diameter (m) by number."""
        diameter, share = self._classes
        return float(share @ diameter * self._moments[0])

    @property
    def mean_square(self) -> float:
        """Mean squared diameter (m²) by number: 4/π times the mean area of a grain in the plane."""
        diameter, share = self._classes
        return float(share @ diameter**2 * self._moments[1])

    @property
    def mean_cube(self) -> float:
        """Mean cubed diameter (m³) by number: 6/π times the mean volume of a grain."""
        diameter, share = self._classes
        return float(share @ diameter**3 * self._moments[2])

    @property
    def range(self) -> tuple[float, float]:
        """Smallest and largest possible diameter (m)."""
        diameter = self._classes[0]
        low, high = -self.spread, self.spread
        if self.normal and self.spread:
            low, high = (self.spread * bound for bound in self._cuts)
        return float(diameter.min() * (1.0 + low)), float(diameter.max() * (1.0 + high))

    def draw(self, count: int, random: np.random.Generator) -> np.ndarray:
        """Draw radii (count,) m in random order, with each class's share exact to within one grain."""
        diameter, share = self._classes
        each = np.repeat(diameter, apportion(share * count))
        if len(diameter) > 1:
            random.shuffle(each)
        if self.normal and self.spread:
            return 0.5 * each * (1.0 + self.spread * self._standard.rvs(count, random_state=random))
        return 0.5 * each * (1.0 + self.spread * random.uniform(-1.0, 1.0, count))

    @property
    def _classes(self) -> tuple[np.ndarray, np.ndarray]:
        diameter, share = np.array(self.classes, dtype=np.float64).T
        return diameter, share / share.sum()

    @property
    def _cuts(self) -> tuple[float, float]:
        """Bounds at which the standard normal distribution is truncated."""
        return max(-MOST_DEVIATIONS, (SMALLEST_SHARE - 1.0) / self.spread), MOST_DEVIATIONS

    @property
    def _standard(self):
        from scipy.stats import truncnorm  # slow to import, and only normal sizes need it

        return truncnorm(*self._cuts)

    @property
    def _moments(self) -> tuple[float, float, float]:
        """Mean, mean square and mean cube of a diameter relative to its class's diameter."""
        if self.normal and self.spread:
            mean, variance, skew = map(float, self._standard.stats("mvs"))
            first, spread = 1.0 + self.spread * mean, self.spread**2 * variance
            return first, first**2 + spread, first**3 + 3.0 * first * spread + skew * spread**1.5
        return 1.0, 1.0 + self.spread**2 / 3.0, 1.0 + self.spread**2


def apportion(wanted: Sequence[float]) -> np.ndarray:
    """Round numbers to integers with the same sum, each within one, by the largest remainders (Hamilton's method)."""
    wanted = np.asarray(wanted, dtype=np.float64)
    whole = np.floor(wanted).astype(int)
    missing = round(wanted.sum()) - whole.sum()
    whole[np.argsort(whole - wanted, kind="stable")[:missing]] += 1
    return whole
