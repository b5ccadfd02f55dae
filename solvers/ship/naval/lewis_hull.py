"""A hull of Lewis sections from a few particulars, where no lines are free.

What must be known are length, breadth, draught, block coefficient, and KB or the waterplane coefficient C_W.

With ξ from −1 aft to 1 forward, her waterline and her sectional areas are B (1 − |ξ|^p) and B T C_M (1 − |ξ|^q). The
two powers are those at which the hull of Lewis sections has the block coefficient and KB, or C_W; a section whose
area is beyond what a Lewis form of its breadth can have takes the nearest. C_M is by Kerlen (1970), as in Schneekluth
& Bertram (1998), C_M = 1.006 − 0.0056 C_B^−3.56, unless it is given.

Limits: fore and aft body alike; one draught for all stations; upright sides above the water; a midship section not as
full as a Lewis form cannot be (`potential.lewis`). It is no ship's lines: a stand-in with her displacement and, as one
asks, her KB or her C_W, on which KM hangs. Not all of these at once.
"""

from dataclasses import dataclass

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.potential.lewis import Lewis, limits
from solvers.ship.water import Water

STATIONS = 41
POWERS = (0.6, 12.0)  # that are tried
CLOSE = 1e-6  # of both coefficients
ENDS = 1e-3  # of the breadth: where a station counts as a point


@dataclass(frozen=True)
class Particulars:
    """Length, breadth, draught and depth of the hull (m), and her coefficients.

    `block`, `plane` and `midship` are C_B, C_W and C_M, `kb` is the height (m) of the centre of buoyancy above keel;
    either `kb` or `plane` is given. Without `midship` it is that of Kerlen.
    """

    length: float
    breadth: float
    draught: float
    depth: float
    block: float
    kb: float | None = None
    plane: float | None = None
    midship: float | None = None

    @property
    def full(self) -> float:
        """C_M."""
        return self.midship or min(1.006 - 0.0056 * self.block**-3.56, 0.998)


def lewis_hull(ship: Particulars, stations: int = STATIONS) -> Form:
    """The hull. Raises `Unavailable` if no powers give her block coefficient and KB."""
    from scipy.optimize import least_squares  # slow to import

    if not ship.block < ship.full:
        raise Unavailable(
            f"the block coefficient of {ship.block:.3f} must be below that of the midship section, {ship.full:.3f}."
        )
    if (ship.kb is None) == (ship.plane is None):
        raise Unavailable("give either KB or the waterplane coefficient.")
    name = "kb" if ship.plane is None else "plane"

    def missed(powers: np.ndarray) -> np.ndarray:
        found = _form(ship, *powers, stations).hydrostatics(ship.draught, Water())
        return np.array([getattr(found, key) / getattr(ship, key) - 1.0 for key in ("block", name)])

    first = np.clip(ship.block / (ship.full - ship.block), *POWERS)
    low, high = (np.full(2, power) for power in POWERS)
    solved = least_squares(missed, [min(1.5 * first, high[0]), first], bounds=(low, high), diff_step=1e-4)
    if np.abs(solved.fun).max() > CLOSE:
        words = {"kb": "KB", "plane": "waterplane coefficient"}[name]
        block, other = (1.0 + solved.fun) * (ship.block, getattr(ship, name))
        raise Unavailable(
            f"no hull of Lewis sections has this block coefficient and {words}; "
            f"the nearest has {block:.3f} and {other:.4g}."
        )
    return _form(ship, *solved.x, stations)


def _form(ship: Particulars, waterline: float, areas: float, stations: int) -> Form:
    """The hull with the two powers."""
    along = np.cos(np.pi * np.arange(stations)[::-1] / (stations - 1))  # denser at the ends
    breadth = ship.breadth * (1.0 - np.abs(along) ** waterline)
    area = ship.breadth * ship.draught * ship.full * (1.0 - np.abs(along) ** areas)
    sections = []
    for wide, wet in zip(breadth, area, strict=True):
        if wide < ENDS * ship.breadth:
            sections.append(None)
            continue
        fullness = float(np.clip(wet / (wide * ship.draught), *limits(0.5 * wide / ship.draught)))
        sections.append(Lewis(float(wide), ship.draught, fullness).section(ship.depth))
    return Form(0.5 * ship.length * (1.0 + along), tuple(sections), ship.length)
