"""A whole hull by its stations: displacement, hydrostatics and righting levers in calm water.

Each station is a section (`solvers.ship.section`), cut at x (m) forward; z is up. Heights are those of the stations'
own axes, and draughts are from the base line, which is at z = 0 unless the form says otherwise. Along the ship
Simpson's rule is used, in its form for unequal distances. A ship that is known by one section alone is a prism of three
equal stations, for which the rule is exact.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.outlines import Outlines
from solvers.ship.naval.wetted import wetted_surface
from solvers.ship.section import Section
from solvers.ship.water import Water

TONNE = 1000.0  # kg
CENTIMETRES = 100.0  # in a metre
DECK = 0.1  # of the greatest breadth: a station's top that is less wide is no deck
MOST_STEPS = 25  # of Newton's method for draught and trim


@dataclass(frozen=True)
class Hydrostatics:
    """Hydrostatic particulars at a draught, upright: lengths in m, displacement in t, TPC in t/cm, MCT in t m/cm.

    lcb and lcf are as the stations' x, kb, km and kml as their z, the draught is from the base line. MCT and the
    coefficients have the length between perpendiculars, and the breadth of this waterline; `length` is the waterline's,
    `waterplane` and `wetted` (the surface under water) are m².
    """

    draught: float
    volume: float
    displacement: float
    lcb: float
    kb: float
    bm: float
    km: float
    bml: float
    kml: float
    tpc: float
    mct: float
    lcf: float
    waterplane: float
    wetted: float
    length: float
    breadth: float
    block: float
    midship: float
    prismatic: float
    plane: float


@dataclass(frozen=True, eq=False)
class Form:
    """Stations x (n,) m that rise, and a section at each, None where the hull has shrunk to a point or a line.

    `length` (m) is that between perpendiculars, from the aft one at x = `aft` (m); without a length both are at the
    outermost stations. `base` (m) is the height z of the base line.
    """

    x: np.ndarray
    sections: Sequence[Section | None]
    length: float | None = None
    aft: float = 0.0
    base: float = 0.0

    def __post_init__(self):
        x = np.asarray(self.x, dtype=float)
        object.__setattr__(self, "x", x)
        if len(x) < 3 or len(x) != len(self.sections):
            raise Unavailable("a hull needs at least three stations.")
        if not (np.diff(x) > 0.0).all():
            raise Unavailable("the hull's stations must rise from aft to forward, none of them twice.")
        if not any(self.sections):
            raise Unavailable("the hull has no station with an area.")

    @property
    def perpendiculars(self) -> float:
        """Length (m) that trimming moments and coefficients are of."""
        return self.length or float(np.ptp(self.x))

    @property
    def ends(self) -> tuple[float, float]:
        """Places x (m) of the aft and the forward perpendicular."""
        aft = self.aft if self.length else float(self.x[0])
        return aft, aft + self.perpendiculars

    def draughts(self, level: np.ndarray) -> tuple[float, float]:
        """Draughts (m) at the aft and the forward perpendicular of water `level` (n,) m high at the stations."""
        slope = (level[-1] - level[0]) / (self.x[-1] - self.x[0])
        aft, fore = (float(level[0] - self.base + slope * (end - self.x[0])) for end in self.ends)
        return aft, fore

    @cached_property
    def weights(self) -> np.ndarray:
        """Weights (n,) m with which values at the stations are summed along the ship."""
        from scipy.integrate import simpson  # slow to import

        return simpson(np.eye(len(self.x)), x=self.x)

    @cached_property
    def depth(self) -> float:
        """Height (m) of her deck above the base line, where it is lowest: up to it water does not come over her.

        Stations with a narrow top do not count: a bulb before the stem and a rudder have no deck.
        """
        sections = [section for section in self.sections if section is not None]
        widest = max(float(np.ptp(section.outline[:, 0])) for section in sections)
        decked = [section for section in sections if section.top > DECK * widest] or sections
        return min(float(section.outline[:, 1].max()) for section in decked) - self.base

    @cached_property
    def volume(self) -> float:
        """Volume (m³) of the whole hull."""
        return float(sum(w * s.area for w, s in zip(self.weights, self.sections, strict=True) if s is not None))

    @cached_property
    def _outlines(self) -> Outlines:
        return Outlines(self.sections)

    def _along(self, level: np.ndarray, roll: float, plane: bool = False) -> np.ndarray:
        """Of each station (n, 3): area and moments of its immersed part, or breadth and moments of its waterline.

        level (n,): height (m) of the water; y and depth in the earth's axes, from where the stations' origin is.
        """
        found = np.zeros((len(self.x), 3))
        for k, section in enumerate(self.sections):
            if section is None:
                continue
            if plane:
                line = section.waterplane(-level[k], roll)
                found[k] = line.breadth, line.moment, line.second_moment
            else:
                wet = section.immersion(-level[k], roll)
                found[k] = wet.area, wet.moment, wet.depth_moment
        return found

    def displaced(self, level: np.ndarray, roll: float = 0.0) -> tuple[float, np.ndarray]:
        """Volume (m³) below water, and its centre x, y, z (m): y and z from the keel's point K, in the earth's axes."""
        wet = self._along(level, roll)
        volume = float(self.weights @ wet[:, 0])
        if volume <= 0.0:
            return 0.0, np.zeros(3)
        moments = self.x * wet[:, 0], wet[:, 1], level * wet[:, 0] - wet[:, 2]
        return volume, np.array([self.weights @ moment for moment in moments]) / volume

    def hydrostatics(self, draught: float, water: Water) -> Hydrostatics:
        """Particulars at an even draught (m). Raises `Unavailable` for one above the stations' tops, or a dry hull."""
        if not 0.0 < draught <= self.depth:
            raise Unavailable(
                f"the draught of {draught:.4g} m must be above 0 and at most the {self.depth:.4g} m of the stations."
            )
        return self.afloat(np.full(len(self.x), self.base + draught), water)

    def afloat(self, level: np.ndarray, water: Water) -> Hydrostatics:
        """Particulars upright with water `level` (n,) m high at the stations: of a trimmed ship, her own waterplane.

        `draught` is the mean of those at the perpendiculars. KM is GM + KG as the slope of GZ upright has it, while
        displacement and the centre of buoyancy along her are kept: the waterplane's second moment is that about the
        axis about which she then heels. Raises `Unavailable` for a dry hull.
        """
        volume, centre = self.displaced(level)
        areas, plane = self._along(level, 0.0)[:, 0], self._along(level, 0.0, plane=True)
        breadths = plane[:, 0]
        surface = float(self.weights @ breadths)
        draught = 0.5 * sum(self.draughts(level))
        if volume <= 0.0 or surface <= 0.0:
            raise Unavailable(f"at a draught of {draught:.4g} m the hull displaces nothing.")
        lcf = float(self.weights @ (self.x * breadths)) / surface
        along = float(self.weights @ ((self.x - lcf) ** 2 * breadths))
        bm, bml = self._second_moment(plane, lcf, surface, along) / volume, along / volume
        length, breadth = self._waterline(breadths), float(breadths.max())
        fullest = int(np.argmax(areas))
        displacement, full = water.density * volume / TONNE, float(areas[fullest])
        between = self.perpendiculars
        return Hydrostatics(
            draught=draught,
            volume=volume,
            displacement=displacement,
            lcb=float(centre[0]),
            kb=float(centre[2]),
            bm=bm,
            km=float(centre[2]) + bm,
            bml=bml,
            kml=float(centre[2]) + bml,
            tpc=water.density * surface / TONNE / CENTIMETRES,
            mct=displacement * bml / (CENTIMETRES * between),
            lcf=lcf,
            waterplane=surface,
            wetted=wetted_surface(self.sections, self.weights, level),
            length=length,
            breadth=breadth,
            block=volume / (between * breadth * draught),
            midship=full / (breadth * float(level[fullest] - self.base)),
            prismatic=volume / (between * full),
            plane=surface / (between * breadth),
        )

    def _second_moment(self, plane: np.ndarray, lcf: float, surface: float, along: float) -> float:
        """Second moment (m⁴) of the waterplane about the axis about which she heels if she sinks and trims freely.

        ∫y² dA − (∫y dA)²/A − (∫(x − lcf) y dA)²/∫(x − lcf)² dA; the last two vanish if both sides are alike. `plane`
        (n, 3): breadth and moments at the stations; `along`: the last integral (m⁴).
        """
        aside, skew = self.weights @ plane[:, 1], self.weights @ ((self.x - lcf) * plane[:, 1])
        return float(self.weights @ plane[:, 2] - aside**2 / surface - skew**2 / along)

    def _waterline(self, breadths: np.ndarray) -> float:
        """Length (m) of the waterline: to the stations where it ends, or where it is wet last."""
        wet = np.flatnonzero(breadths > 0.0)
        ends = max(wet[0] - 1, 0), min(wet[-1] + 1, len(self.x) - 1)
        return float(self.x[ends[1]] - self.x[ends[0]])

    def floating(self, displacement: float, water: Water, roll: float = 0.0, lcg: float | None = None) -> np.ndarray:
        """Heights z (n,) m of the water at the stations, in vertical balance with a displacement (t).

        With `lcg` (m) she also trims freely until her buoyancy is under it; without it her keel stays level.
        Raises `Unavailable` for a weight that the hull cannot carry, or a centre of gravity beyond its buoyancy.
        """
        needed = displacement * TONNE / water.density
        if not 0.0 < needed < self.volume:
            most = self.volume * water.density / TONNE
            raise Unavailable(
                f"the weight of {displacement:.5g} t does not float: it must be above 0 and below the {most:.5g} t "
                "that the whole hull displaces."
            )
        return self._level(needed, roll, 0.0) if lcg is None else self._trimmed(needed, roll, lcg)

    def _trimmed(self, needed: float, roll: float, lcg: float) -> np.ndarray:
        """Heights (n,) m of the water for a volume (m³) whose centre is `lcg` (m) forward.

        By Newton's method in the water's height and slope, whose derivatives are moments of the waterplane; where a
        corner that comes out or goes under defeats it, by a bracketed search.
        """
        from scipy.optimize import brentq

        x, steepest = self.x, 2.0 * self.depth / self.perpendiculars
        level, arm = self._level(needed, roll, 0.0), x - 0.5 * (x[0] + x[-1])
        tolerance = 1e-12 * np.array([needed, needed * self.perpendiculars])
        for _ in range(MOST_STEPS):
            areas, breadths = self._outlines.wet(level, roll)
            off = np.array([self.weights @ areas - needed, self.weights @ (x * areas) - lcg * needed])
            if (np.abs(off) <= tolerance).all():
                return level
            plane = self.weights * breadths
            change = np.array([[plane.sum(), plane @ arm], [plane @ x, plane @ (x * arm)]])
            if abs(np.linalg.det(change)) < 1e-12 * (plane.sum() * self.perpendiculars) ** 2:
                break
            rise, slope = -np.linalg.solve(change, off)
            level = level + rise + slope * arm
            if not abs(level[-1] - level[0]) <= steepest * np.ptp(x):
                break
        surplus = lambda slope: self.displaced(self._level(needed, roll, slope), roll)[1][0] - lcg  # noqa: E731
        if surplus(-steepest) * surplus(steepest) > 0.0:
            raise Unavailable(f"the weights' centre {lcg:.4g} m forward is beyond what the hull can trim to carry.")
        return self._level(needed, roll, brentq(surplus, -steepest, steepest, xtol=1e-12))

    def _level(self, needed: float, roll: float, slope: float) -> np.ndarray:
        """Heights (n,) m of the water at the stations for a volume (m³), rising forward by a slope."""
        from scipy.optimize import brentq

        tilt = slope * (self.x - 0.5 * (self.x[0] + self.x[-1]))
        size = max(section.size for section in self.sections if section is not None)
        reach = max(2.0 * size, 1.5 * self._outlines.furthest) + float(np.abs(tilt).max())
        surplus = lambda level: float(self.weights @ self._outlines.wet(level + tilt, roll)[0]) - needed  # noqa: E731
        return brentq(surplus, -reach, reach, xtol=1e-12 * size, rtol=1e-15) + tilt

    def cross_curves(
        self, displacement: float, water: Water, heels: np.ndarray, lcg: float | None = None
    ) -> np.ndarray:
        """Levers KN (m) about y = z = 0 at heels (rad) to port: KN = GZ + KG sin φ with G amidships."""
        heels = np.asarray(heels, dtype=float)
        return np.array([-self.displaced(self.floating(displacement, water, h, lcg), h)[1][1] for h in heels])

    def righting_levers(
        self,
        displacement: float,
        water: Water,
        heels: np.ndarray,
        gravity: tuple[float, float],
        lcg: float | None = None,
    ) -> np.ndarray:
        """Levers GZ (m) at heels (rad) to port, with the centre of gravity y, z (m) of `gravity`, y to starboard."""
        heels = np.asarray(heels, dtype=float)
        own = self.cross_curves(displacement, water, heels, lcg)
        return own - gravity[1] * np.sin(heels) + gravity[0] * np.cos(heels)


def prism(section: Section, length: float) -> Form:
    """A ship of one section all along a length (m); her section's lowest point is her keel."""
    keel = float(section.outline[:, 1].min())
    above = Section(section.outline - [0.0, keel]) if keel else section
    return Form(np.array([0.0, 0.5 * length, length]), (above, above, above))
