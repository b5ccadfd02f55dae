"""The condition of a whole hull that carries weights: how she floats, her levers, and what she is judged by."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from lab.naval.stowed import Stowed
from lab.naval.weights import Weights
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import Form, Hydrostatics
from solvers.ship.naval.grain_code import straight_line
from solvers.ship.naval.immersion import deck_edges, heel_at_immersion
from solvers.ship.naval.weather import Exposed
from solvers.ship.water import Water

HEELS = np.radians(np.arange(-90.0, 91.0))


@dataclass(frozen=True)
class Wind:
    """What the weather criterion needs: area (m²) exposed to wind, its centre's height (m) above half the draught."""

    area: float
    lever: float
    keel_area: float = 0.0
    sharp: bool = False


@dataclass(frozen=True, eq=False)
class Loaded:
    """A hull with weights, points that must stay dry (n, 3) m by kind, grain in her holds, and the wind on her.

    She trims freely. All that is asked of her is asked to the `side` that she lists to. `lwl` (m) is her length in the
    waterline; without it that is as her stations show it. `openings` are the names of the points that are openings.
    """

    form: Form
    water: Water
    weights: Weights
    points: dict[str, np.ndarray] = field(default_factory=dict)
    grain: tuple[Stowed, ...] = ()
    wind: Wind | None = None
    lwl: float | None = None
    openings: tuple[str, ...] = ()

    @cached_property
    def level(self) -> np.ndarray:
        """Heights z (n,) m of the water at the stations, upright."""
        return self.form.floating(self.weights.mass, self.water, lcg=self.weights.lcg)

    @property
    def draughts(self) -> tuple[float, float, float]:
        """Draughts (m) from the base line at the aft and the forward perpendicular, and their mean."""
        aft, fore = self.form.draughts(self.level)
        return aft, fore, 0.5 * (aft + fore)

    @cached_property
    def upright(self) -> Hydrostatics:
        """Particulars upright, trimmed as she is: KM is that of her own waterplane."""
        return self.form.afloat(self.level, self.water)

    @property
    def solid_gm(self) -> float:
        """GM (m) without free surfaces."""
        return self.upright.km - self.weights.vcg

    @property
    def metacentric_height(self) -> float:
        """GM (m) after correction for free surfaces."""
        return self.upright.km - self.weights.fluid_vcg

    @cached_property
    def starboard(self) -> Levers:
        """Righting levers (m) over `HEELS`, positive starboard down."""
        gravity = self.weights.tcg, self.weights.fluid_vcg
        port = self.form.righting_levers(self.weights.mass, self.water, HEELS, gravity, self.weights.lcg)
        return Levers(HEELS, -port[::-1])

    @property
    def heel_angle(self) -> float | None:
        """The heel (rad) at which she lies, positive starboard down; None: she comes to rest nowhere."""
        return self.starboard.equilibrium()

    @property
    def side(self) -> str:
        """The side that she is judged on: that of her list, where her levers are less."""
        return "port" if self.heel_angle is not None and self.heel_angle < 0.0 else "starboard"

    @cached_property
    def levers(self) -> Levers:
        """Righting levers (m) over `HEELS` to her `side`."""
        return self.starboard if self.side == "starboard" else Levers(HEELS, -self.starboard.lever[::-1])

    @cached_property
    def deck_edge_angle(self) -> float | None:
        """The heel (rad) to her side at which the deck's edge goes under; infinite: not up to 90°."""
        edges = self.points["deck"] if "deck" in self.points else deck_edges(self.form)
        return self._under(edges) if len(edges) else None

    @cached_property
    def flooding(self) -> float | None:
        """The heel (rad) to her side at which an opening goes under; None without openings."""
        return self._under(self.points["opening"]) if "opening" in self.points else None

    @property
    def flooded_by(self) -> str:
        """The name of the opening that goes under first; "" without names, or where none does."""
        if not self.openings or self.flooding is None or not np.isfinite(self.flooding):
            return ""
        angles = [self._under(point[None]) for point in self.points["opening"]]
        return self.openings[int(np.argmin(angles))]

    @cached_property
    def flooding_to_the_other_side(self) -> float | None:
        """The heel (rad) to her other side at which an opening goes under; None without openings."""
        return self._under(self.points["opening"], -1.0) if "opening" in self.points else None

    def _under(self, points: np.ndarray, turned: float = 1.0) -> float:
        way = turned * (1.0 if self.side == "port" else -1.0)
        found = heel_at_immersion(self.form, self.weights.mass, self.water, points, way, self.weights.lcg)
        return np.inf if found is None else found

    @property
    def exposed(self) -> Exposed | None:
        """What the weather criterion needs; None without wind."""
        if self.wind is None:
            return None
        upright, draught = self.upright, self.draughts[2]
        length = self.lwl or upright.length
        return Exposed(
            length,
            upright.breadth,
            draught,
            self.weights.fluid_vcg - self.form.base,
            self.weights.mass,
            min(1.0, upright.volume / (length * upright.breadth * draught)),
            self.metacentric_height,
            self.wind.area,
            self.wind.lever,
            self.wind.keel_area,
            self.wind.sharp,
            self.water.gravity,
        )

    @property
    def assumed_arm(self) -> float:
        """λ0 (m): the heeling moments of all holds over the displacement."""
        return sum(hold.heeling for hold in self.grain) / self.weights.mass

    @property
    def assumed(self) -> Callable[[np.ndarray], np.ndarray] | None:
        """The heeling arm (m) of the shift that the Grain Code assumes; None without grain."""
        return straight_line(self.assumed_arm) if self.grain else None
