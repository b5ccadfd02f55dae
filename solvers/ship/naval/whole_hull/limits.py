"""Limiting KG: the largest height of the centre of gravity with which a ship passes each criterion.

At one displacement GZ(φ) = KN(φ) − KG sin φ, and GM = KM − KG (Biran and López-Pulido 2014, chapter 5). KN, the angle
of the deck's edge and that of flooding do not depend on KG, so they are computed once.

GZ falls with KG at each heel between 0 and 180°. So areas, the largest lever and GM fall. So does the heel of the
largest lever, as GZ loses most where sin φ is large, and the heel under an arm rises. These criteria have one passing
range, from the keel up. The weather criterion is not monotone: a larger KG gives a longer period and a smaller
steepness s, but a larger r. Therefore the margin is looked at over a grid of KG, and each change of its sign is refined
by a bracketed search (Brent 1973).
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval import grain_code, intact, weather
from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import Form, Hydrostatics
from solvers.ship.naval.immersion import deck_edges, heel_at_immersion
from solvers.ship.naval.upright import draught_for, level_at
from solvers.ship.water import Water

HEELS = np.radians(np.arange(-90.0, 91.0))
GRID = 61  # heights KG at which margins are first looked at
CLOSE = 1e-5  # m, of the search
SIDES = {"starboard": -1.0, "port": 1.0}  # the form's own heels are positive to port
FAR = 1e3  # stands for a margin that is infinite

Key = tuple[str, str]  # a criterion's rule and what it measures


@dataclass(frozen=True)
class Demands:
    """What a ship is judged by beside the general criteria.

    `points` (n, 3) m by kind: "opening", "deck". Wind: area (m²), lever (m) above half the draught, area of keels (m²),
    sharp bilges, `lwl` (m). `grain` is the heeling moment (t m) of the assumed shift in all holds, None without grain.
    """

    points: dict[str, np.ndarray] = field(default_factory=dict)
    wind_area: float | None = None
    wind_lever: float = 0.0
    keel_area: float = 0.0
    sharp: bool = False
    lwl: float | None = None
    grain: float | None = None


@dataclass(frozen=True, eq=False)
class Floating:
    """A ship at one displacement (t) and trim (m by the stern), upright; her KG is open. She trims freely as she heels.

    Raises Unavailable for what she cannot carry.
    """

    form: Form
    water: Water
    displacement: float
    trim: float
    demands: Demands

    @cached_property
    def upright(self) -> Hydrostatics:
        """Particulars of her own waterplane."""
        draught = draught_for(self.form, self.displacement, self.water, self.trim)
        return self.form.afloat(level_at(self.form, draught, self.trim), self.water)

    @cached_property
    def arms(self) -> np.ndarray:
        """KN (m) over HEELS to port."""
        return self.form.cross_curves(self.displacement, self.water, HEELS, self.upright.lcb)

    @cached_property
    def ends(self) -> dict[str, tuple[float | None, float | None]]:
        """Angles (rad) at which the deck's edge and an opening go under, by side; None where none is given."""
        points = self.demands.points
        edges = points["deck"] if "deck" in points else deck_edges(self.form)
        both = edges if len(edges) else None, points.get("opening")
        return {side: tuple(self._under(one, way) for one in both) for side, way in SIDES.items()}

    def _under(self, points: np.ndarray | None, way: float) -> float | None:
        if points is None:
            return None
        found = heel_at_immersion(self.form, self.displacement, self.water, points, way, self.upright.lcb)
        return np.inf if found is None else found

    @cached_property
    def sides(self) -> tuple[str, ...]:
        """The sides to judge her to: one if both are alike."""
        alike = np.allclose(self.arms, -self.arms[::-1], rtol=0.0, atol=1e-9 * self.form.depth)
        star, port = (np.array(self.ends[side], dtype=float) for side in SIDES)
        return ("starboard",) if alike and np.allclose(star, port, equal_nan=True) else tuple(SIDES)

    def levers(self, height: float, side: str) -> Levers:
        """GZ (m) over HEELS to a side with KG (m), free surfaces included, G amidships."""
        own = self.arms if side == "port" else -self.arms[::-1]
        return Levers(HEELS, own - height * np.sin(HEELS))

    def criteria(self, height: float, side: str) -> dict[Key, Criterion]:
        """All criteria to a side with KG (m), by rule and what they measure."""
        levers, gm = self.levers(height, side), self.upright.km - height
        deck, flooding = self.ends[side]
        found = list(intact.criteria(levers, gm, flooding))
        if self.demands.grain is not None:
            arm = grain_code.straight_line(self.demands.grain / self.displacement)
            found += grain_code.criteria(levers, arm, gm, deck, flooding)
        if self.demands.wind_area is not None and gm > 0.0:
            found += weather.criteria(levers, self._exposed(height, gm), deck, flooding)
        return {(one.rule, one.what): one for one in found}

    def _exposed(self, height: float, gm: float) -> weather.Exposed:
        upright, asked = self.upright, self.demands
        length = asked.lwl or upright.length
        block = min(1.0, upright.volume / (length * upright.breadth * upright.draught))
        return weather.Exposed(
            length,
            upright.breadth,
            upright.draught,
            height - self.form.base,
            self.displacement,
            block,
            gm,
            asked.wind_area,
            asked.wind_lever,
            asked.keel_area,
            asked.sharp,
            self.water.gravity,
        )

    def margins(self, height: float) -> dict[Key, float]:
        """Signed margins with KG (m), to the worse side: in the criterion's unit, below 0 where it fails."""
        both = [self.criteria(height, side) for side in self.sides]
        return {key: min(signed(one[key]) for one in both) for key in both[0]}


def signed(criterion: Criterion) -> float:
    """A criterion's margin as a finite number that is below 0 exactly where it fails."""
    margin = float(np.clip(np.nan_to_num(criterion.margin, nan=-FAR), -FAR, FAR))
    return max(margin, 0.0) if criterion.passed else min(margin, -1e-12)


@dataclass(frozen=True)
class Limit:
    """Ranges of KG (m) that pass, from the keel to KM, and the least KG that was looked at."""

    ranges: tuple[tuple[float, float], ...]
    least: float

    @property
    def largest(self) -> float | None:
        """The largest KG (m) that passes; None: none does."""
        return self.ranges[-1][1] if self.ranges else None

    @property
    def whole(self) -> bool:
        """Whether each smaller KG passes, too."""
        return len(self.ranges) == 1 and self.ranges[0][0] <= self.least


def passing(margin: Callable[[float], float], heights: np.ndarray, known: np.ndarray) -> Limit:
    """The ranges of KG (m) in which a margin is not below 0; `known` (n,) are its values at rising `heights` (n,)."""
    from scipy.optimize import brentq  # slow to import

    ranges, begin = [], float(heights[0]) if known[0] >= 0.0 else None
    for k in np.flatnonzero((known[:-1] >= 0.0) != (known[1:] >= 0.0)):
        edge = heights[k] if known[k] == 0.0 else heights[k + 1] if known[k + 1] == 0.0 else None
        if edge is None:
            edge = brentq(margin, heights[k], heights[k + 1], xtol=CLOSE)
        if begin is None:
            begin = float(edge)
        else:
            ranges.append((begin, float(edge)))
            begin = None
    if begin is not None:
        ranges.append((begin, float(heights[-1])))
    return Limit(tuple(ranges), float(heights[0]))


def limits(ship: Floating) -> dict[Key, Limit]:
    """The limit of each criterion, looked for from the base line up to KM, beyond which GM is negative."""
    highest = ship.upright.km
    if not highest > ship.form.base:
        raise Unavailable(f"at {ship.displacement:.5g} t her KM of {highest:.4g} m is below her keel.")
    heights = np.linspace(ship.form.base, highest * (1.0 - 1e-9), GRID)
    table = [ship.margins(height) for height in heights]
    return {
        key: passing(lambda height, key=key: ship.margins(height)[key], heights, np.array([row[key] for row in table]))
        for key in table[0]
    }


def of_all(found: dict[Key, Limit]) -> tuple[Limit, Key]:
    """The ranges in which all criteria pass, and the criterion that sets the largest KG."""
    least = next(iter(found.values())).least
    together: tuple[tuple[float, float], ...] = ((least, np.inf),)
    for one in found.values():
        pairs = [(max(a, c), min(b, d)) for a, b in together for c, d in one.ranges]
        together = tuple(sorted((a, b) for a, b in pairs if a <= b))
    none = -np.inf
    if not together:
        return Limit((), least), min(found, key=lambda key: none if found[key].largest is None else found[key].largest)
    top = together[-1][1]
    sets = min(found, key=lambda key: min(abs(end - top) for _, end in found[key].ranges))
    return Limit(together, least), sets
