"""A curve of righting levers: its value between the points, its crossings, its largest lever and the area under it."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

FINE = 2001  # points at which crossings and the largest lever are first looked for
NOTHING = 1e-12  # of the largest lever: so little counts as none


@dataclass(frozen=True, eq=False)
class Levers:
    """Righting levers GZ (m) at heels (rad) that rise, to the side that is looked at.

    Between the points the curve is a cubic spline (not-a-knot), the batten of hand calculations.
    """

    heel: np.ndarray
    lever: np.ndarray

    def __post_init__(self):
        object.__setattr__(self, "heel", np.asarray(self.heel, dtype=float))
        object.__setattr__(self, "lever", np.asarray(self.lever, dtype=float))

    @property
    def both_sides(self) -> "Levers":
        """The curve with its mirror image to the other side, where it begins upright: of a ship equal on both sides."""
        if self.heel[0] < 0.0:
            return self
        rest = slice(None, 0, -1)
        return Levers(np.append(-self.heel[rest], self.heel), np.append(-self.lever[rest], self.lever))

    @cached_property
    def _spline(self):
        from scipy.interpolate import CubicSpline  # slow to import

        return CubicSpline(self.heel, self.lever)

    def at(self, heel) -> np.ndarray:
        """Levers (m) at heels (rad)."""
        return self._spline(heel)

    def less(self, arm: Callable[[np.ndarray], np.ndarray]) -> "Levers":
        """What is left of the levers beside a heeling arm (m), a function of heels (rad)."""
        return Levers(self.heel, self.lever - arm(self.heel))

    def area(self, begin: float, end: float) -> float:
        """Area (m rad) under the curve between two heels (rad)."""
        return float(self._spline.integrate(begin, end))

    @property
    def metacentric_height(self) -> float:
        """Slope (m) of the curve upright, GM."""
        return float(self._spline(0.0, 1))

    def crossing(self, begin: float, rising: bool = True) -> float | None:
        """The first heel (rad) from `begin` on at which the curve crosses zero upwards, or downwards; or None."""
        from scipy.optimize import brentq

        heel = np.linspace(begin, self.heel[-1], FINE)
        lever = self._spline(heel) * (1.0 if rising else -1.0)
        found = np.flatnonzero((lever[:-1] < 0.0) & (lever[1:] >= 0.0))
        return float(brentq(self._spline, heel[found[0]], heel[found[0] + 1])) if len(found) else None

    def equilibrium(self) -> float | None:
        """The heel (rad) at which she lies, nearest to upright on the side that pulls her; None: there is none.

        A ship that nothing pulls and that does not stand upright lolls to the side that is looked at.
        """
        upright = float(self._spline(0.0))
        if abs(upright) <= NOTHING * float(np.abs(self.lever).max()):
            return 0.0 if self.metacentric_height > 0.0 else self.crossing(0.0)
        if upright < 0.0:
            return self.crossing(0.0)
        back = Levers(-self.heel[::-1], -self.lever[::-1])
        found = back.crossing(0.0)
        return None if found is None else -found

    def reach(self, flooding: float | None = None) -> float:
        """The heel (rad) up to which her levers count: the curve's end, or the `flooding` angle.

        Areas of the 2008 IS Code end at that angle (part A, 2.2.1); the other rows are judged alike, since water enters
        the hull beyond it. 0 if an opening is under water as she lies.
        """
        last = float(self.heel[-1])
        if flooding is None or flooding >= last:
            return last
        return flooding if flooding > max(self.equilibrium() or 0.0, 0.0) else 0.0

    def highest(self, begin: float, end: float) -> float:
        """The heel (rad) of the largest lever between two heels (rad)."""
        heel = np.linspace(begin, end, FINE)
        k = int(np.argmax(self._spline(heel)))
        if 0 < k < FINE - 1:
            slope = self._spline.derivative()
            inside = slope.roots(extrapolate=False)
            near = inside[(inside >= heel[k - 1]) & (inside <= heel[k + 1])]
            if len(near):
                return float(near[np.argmax(self._spline(near))])
        return float(heel[k])

    @cached_property
    def vanishing(self) -> float | None:
        """The heel (rad) beyond that of the largest lever at which the levers vanish; None: not within the curve."""
        return self.crossing(self.highest(0.0, self.heel[-1]), rising=False)
