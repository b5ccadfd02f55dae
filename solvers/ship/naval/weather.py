"""The weather criterion of the 2008 IS Code (IMO resolution MSC.267(85)), part A 2.3: severe wind and rolling.

A steady wind heels the ship to φ0; waves roll her from there by φ1 to windward; then a gust of half as much again
strikes. The area b that rights her beyond the gust's lever must not be less than the area a that she brings along.

    l_w1 = P A Z / (1000 g Δ),  l_w2 = 1.5 l_w1,  φ1 = 109 k X1 X2 √(r s) deg
    r = 0.73 + 0.6 OG/d,  T = 2 C B / √GM,  C = 0.373 + 0.023 B/d − 0.043 L/100
"""

from dataclasses import dataclass
from math import inf, radians, sqrt

import numpy as np

from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.curve import Levers

PRESSURE = 504.0  # Pa
GUST = 1.5
STEADY, OF_DECK = radians(16.0), 0.8  # most heel under the steady wind; share of that of the deck's edge
FURTHEST = radians(50.0)
BREADTHS = (2.4, 2.5, 2.6, 2.7, 2.8, 2.9, 3.0, 3.1, 3.2, 3.4, 3.5)  # B/d
X1 = (1.0, 0.98, 0.96, 0.95, 0.93, 0.91, 0.90, 0.88, 0.86, 0.82, 0.80)
BLOCKS = (0.45, 0.50, 0.55, 0.60, 0.65, 0.70)  # block coefficient
X2 = (0.75, 0.82, 0.89, 0.95, 0.97, 1.0)
KEELS = (0.0, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0)  # area of bilge keels, percent of L B
K = (1.0, 0.98, 0.95, 0.88, 0.79, 0.74, 0.72, 0.70)
SHARP = 0.7  # k of a ship with sharp bilges
PERIODS = (6.0, 7.0, 8.0, 12.0, 14.0, 16.0, 18.0, 20.0)  # s
S = (0.100, 0.098, 0.093, 0.065, 0.053, 0.044, 0.038, 0.035)


@dataclass(frozen=True)
class Exposed:
    """The ship as the criterion needs to know her.

    Length at the waterline, breadth, draught and height KG of the centre of gravity (m), displacement (t), block
    coefficient, metacentric height (m); the area (m²) exposed to wind and its lever (m) above half the draught; the
    area of bilge and bar keels (m²), and whether her bilges are sharp.
    """

    length: float
    breadth: float
    draught: float
    gravity_height: float
    displacement: float
    block: float
    metacentric_height: float
    wind_area: float
    wind_lever: float
    keel_area: float = 0.0
    sharp: bool = False
    gravity: float = 9.81

    @property
    def period(self) -> float:
        """Period of roll T (s) by the code's formula."""
        factor = 0.373 + 0.023 * self.breadth / self.draught - 0.043 * self.length / 100.0
        return 2.0 * factor * self.breadth / sqrt(self.metacentric_height)

    @property
    def keels(self) -> float:
        """Factor k of the bilges and keels."""
        area = 100.0 * self.keel_area / (self.length * self.breadth)
        return SHARP if self.sharp else float(np.interp(area, KEELS, K))

    @property
    def roll(self) -> float:
        """Angle φ1 (rad) by which waves roll her to windward; √(r s) needs r s ≥ 0."""
        r = 0.73 + 0.6 * (self.gravity_height - self.draught) / self.draught
        s = float(np.interp(self.period, PERIODS, S))
        shape = np.interp(self.breadth / self.draught, BREADTHS, X1) * np.interp(self.block, BLOCKS, X2)
        return radians(109.0 * self.keels * float(shape) * sqrt(max(r * s, 0.0)))

    @property
    def lever(self) -> float:
        """Lever l_w1 (m) of the steady wind."""
        return PRESSURE * self.wind_area * self.wind_lever / (1000.0 * self.gravity * self.displacement)


@dataclass(frozen=True)
class Weather:
    """Levers (m) of wind and gust, angles (rad) φ0, φ1, φ2 of the figure, and the areas a and b (m rad)."""

    wind: float
    gust: float
    heel: float
    roll: float
    end: float
    a: float
    b: float


def weather(levers: Levers, ship: Exposed, flooding: float | None = None) -> Weather:
    """The figure of 2.3.1: `end` is the least of flooding, 50° and the second crossing with the gust's lever."""
    levers, wind, gust = levers.both_sides, ship.lever, GUST * ship.lever
    heel, roll = levers.less(lambda x: np.full_like(x, wind)).crossing(0.0), ship.roll
    left = levers.less(lambda x: np.full_like(x, gust))
    first = left.crossing(-FURTHEST)
    if heel is None or first is None:
        return Weather(wind, gust, inf if heel is None else heel, roll, inf, inf, 0.0)
    second = left.crossing(first, rising=False)
    end = min(FURTHEST, inf if flooding is None else flooding, inf if second is None else second)
    begin = max(heel - roll, float(levers.heel[0]))
    a = -left.area(begin, first)
    return Weather(wind, gust, heel, roll, end, a, left.area(first, end) if end > first else 0.0)


def criteria(
    levers: Levers, ship: Exposed, deck: float | None = None, flooding: float | None = None
) -> tuple[Criterion, ...]:
    """The two criteria of 2.3.1; `deck` and `flooding`: angles (rad) of immersion of deck edge and opening."""
    found = weather(levers, ship, flooding)
    most = STEADY if deck is None else min(STEADY, OF_DECK * deck)
    note = f"l_w1 {found.wind:.3f} m, roll {np.degrees(found.roll):.1f} deg to windward, T {ship.period:.1f} s"
    ratio, heel = found.b / found.a if found.a > 0.0 else inf, found.heel
    if flooding is not None and flooding <= heel < inf:
        heel, note = inf, f"she floods at {np.degrees(flooding):.1f} deg; {note}"
    return (
        Criterion("IS Code A 2.3.1.2", "heel under steady wind", "at most", *np.degrees([most, heel]), "deg", note),
        Criterion(
            "IS Code A 2.3.1.4",
            "area b over area a",
            "at least",
            1.0,
            ratio,
            "1",
            f"a {found.a:.4f}, b {found.b:.4f} m rad, up to {np.degrees(found.end):.1f} deg",
        ),
    )
