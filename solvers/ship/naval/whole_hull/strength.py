"""Longitudinal strength in still water: shear force and bending moment of the hull as a beam.

Load q = w − b (kN/m): weight less buoyancy, downward positive. Shear force F = ∫ q dx and bending moment M = ∫ F dx
are integrated forward from the aft end (IACS UR S11, S11.2.1.1). So hogging is positive: a ship heavy at her ends has
M > 0 amidships.

Buoyancy is ρ g A(x), with the sectional areas A at the stations on the waterline on which she floats, and a monotone
cubic between the stations (Fritsch and Carlson 1980). A weight spreads evenly over its extent, or, with its centre off
the middle of that, linearly: w = (m/l) (1 + 12 e s/l²), with s from the middle and e the centre's place there.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import TONNE, Form
from solvers.ship.naval.outlines import Outlines
from solvers.ship.water import Water

POINTS = 2001  # of the fine line along her
KILO = 1000.0


@dataclass(frozen=True)
class Extent:
    """A weight: mass (t), centre x (m), and its ends aft and forward (m); without ends it stands at a point.

    Raises Unavailable where the weight would be below 0 somewhere in its extent: the centre must lie in its middle
    third.
    """

    name: str
    mass: float
    centre: float
    aft: float | None = None
    forward: float | None = None

    def __post_init__(self):
        if self.aft is None or self.forward is None:
            return
        length = self.forward - self.aft
        if not length > 0.0:
            raise Unavailable(f"{self.name}: its forward end must be forward of its aft end.")
        if abs(self.centre - 0.5 * (self.aft + self.forward)) > length / 6.0 * (1.0 + 1e-9):
            raise Unavailable(
                f"{self.name}: its centre at {self.centre:.5g} m is not in the middle third of {self.aft:.5g} to "
                f"{self.forward:.5g} m, so no straight distribution has it; split the weight in two."
            )

    @property
    def is_point(self) -> bool:
        """Whether it has no extent."""
        return self.aft is None or self.forward is None

    @property
    def ends(self) -> tuple[float, float]:
        """Aft and forward end (m)."""
        return (self.centre, self.centre) if self.is_point else (self.aft, self.forward)

    def rate(self, x: np.ndarray) -> np.ndarray:
        """Mass per length (t/m) at places (n,) m; 0 for one at a point, which has none."""
        if self.is_point:
            return np.zeros_like(x)
        length, skew, s = self._shape(x)
        inside = (x >= self.aft) & (x <= self.forward)
        return np.where(inside, self.mass / length * (1.0 + skew * s), 0.0)

    def behind(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mass (t) aft of places (n,) m, and its moment (t m) about each of them."""
        if self.is_point:
            return self.mass * (x >= self.centre), self.mass * np.maximum(x - self.centre, 0.0)
        length, skew, s = self._shape(np.clip(x, self.aft, self.forward))
        h, each = 0.5 * length, self.mass / length
        mass = each * ((s + h) + 0.5 * skew * (s**2 - h**2))
        moment = each * (0.5 * (s + h) ** 2 + 0.5 * skew * ((s**3 + h**3) / 3.0 - h**2 * (s + h)))
        return mass, moment + self.mass * np.maximum(x - self.forward, 0.0)

    def _shape(self, x: np.ndarray) -> tuple[float, float, np.ndarray]:
        length, middle = self.forward - self.aft, 0.5 * (self.aft + self.forward)
        return length, 12.0 * (self.centre - middle) / length**2, x - middle


@dataclass(frozen=True, eq=False)
class Beam:
    """Curves along her at x (n,) m: weight, buoyancy, load (kN/m), shear (kN), moment (kN m, hogging positive).

    `shear` and `moment` close at the forward end; `open_shear` (kN) and `open_moment` (kN m) is what was left there
    before that was taken out in proportion to the length.
    """

    x: np.ndarray
    weight: np.ndarray
    buoyancy: np.ndarray
    shear: np.ndarray
    moment: np.ndarray
    open_shear: float
    open_moment: float
    points: tuple[Extent, ...]

    @property
    def load(self) -> np.ndarray:
        """Weight less buoyancy (kN/m); weights at a point are not in it."""
        return self.weight - self.buoyancy

    def most(self, name: str, way: float) -> tuple[float, float]:
        """The largest value of a curve, or with way −1 the least one, and its place (m)."""
        curve = getattr(self, name)
        k = int(np.argmax(way * curve))
        return float(curve[k]), float(self.x[k])


def still_water(form: Form, water: Water, weights: Sequence[Extent]) -> Beam:
    """The beam of a hull that carries weights, trimmed freely. Raises Unavailable for what does not float."""
    from scipy.interpolate import PchipInterpolator  # slow to import

    mass = sum(one.mass for one in weights)
    centre = sum(one.mass * one.centre for one in weights) / mass
    level = form.floating(mass, water, lcg=centre)
    area = PchipInterpolator(form.x, Outlines(form.sections).wet(level, 0.0)[0])
    first, second = area.antiderivative(), area.antiderivative(2)
    x = _places(form, weights)
    inside = np.clip(x, form.x[0], form.x[-1])  # a weight may overhang her last stations
    each, per = water.density * water.gravity / KILO, TONNE * water.gravity / KILO  # kN/m³, kN/t
    volume, arm = first(inside), second(inside) + (x - inside) * first(inside)  # aft of x, first is 0 at x[0]
    heavy = [one.behind(x) for one in weights]
    shear = per * sum(one for one, _ in heavy) - each * volume
    moment = per * sum(one for _, one in heavy) - each * arm
    share, left = (x - x[0]) / np.ptp(x), (float(shear[-1]), float(moment[-1]))
    return Beam(
        x=x,
        weight=per * sum(one.rate(x) for one in weights),
        buoyancy=each * np.where(x == inside, area(inside), 0.0),
        shear=shear - share * left[0],
        moment=moment - share * left[1],
        open_shear=left[0],
        open_moment=left[1],
        points=tuple(one for one in weights if one.is_point),
    )


def _places(form: Form, weights: Sequence[Extent]) -> np.ndarray:
    """Places (n,) m along her: a fine line, her stations, and both sides of each end of a weight."""
    ends = np.array([end for one in weights for end in one.ends])
    low, high = min(form.x[0], ends.min()), max(form.x[-1], ends.max())
    beside = 1e-9 * (high - low)
    found = np.concatenate([np.linspace(low, high, POINTS), form.x, ends, ends - beside, ends + beside])
    return np.unique(np.clip(found, low, high))
