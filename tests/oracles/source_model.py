"""The barge and the equations of motion of Spandonidis (2016), chapter 7 and appendix E, for comparison.

The printed equations have errors. These corrections are used here:
- eq. 7.1: B₂ φ|φ| is B₂ φ̇|φ̇|.
- eq. 7.2 to 7.4: distances from P stand for levers, of the grains even the mean of their distances. Moments are taken
  with signed levers here, each weight at its own centre.
- eq. 7.3: its formulae are of a box whose immersed area stays what it was. So is the clipped outline here, at any
  angle, on either side.
- eq. 7.6 and E.13: heave's excitation lacks the amplitude A and its restoring term is printed A_WPZ; eq. E.9 has the
  body's motion in mode i where mode j is meant.
- The equations are about P, on the waterline, with a diagonal matrix of mass, as if the centre of gravity were there.
  Here the couplings m c of `solvers.ship.motion` are added.
- The ship's inertia I in roll's excitation −I A k ω² sin ωt is kept as printed. The long waves' Froude–Krylov force has
  ρ ∫∫(y² − z²) dA of the water displaced in its place.

Elevation is A cos(ky − ωt) at y = 0 wherever the hull is, the water deep. The roll counts as in the rest of the lab.
"""

from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, pi, sin

import numpy as np

from solvers.ship.body import Body
from solvers.ship.hydrostatics import Loading, balanced_heave, metacentric_height, turned
from solvers.ship.linear import inertia_for_roll
from solvers.ship.loads import Floating
from solvers.ship.motion import RollDamping, Ship, frozen_at
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.section import Section, box
from solvers.ship.water import Water
from solvers.ship.waves import soft_start

ROLLS = 361  # of the table of levers, over a turn

BREADTH, HEIGHT, DRAUGHT = 0.34, 0.30, 0.11  # m
PIVOT = (0.0, DRAUGHT)  # P, the middle of the waterline
FIXED_AXIS, FREE = 2.0 * pi * 0.78, 2.0 * pi / 1.35  # rad/s: natural roll about P, and in three degrees of freedom
GRAVITY_HEIGHT = 0.0926  # m above the bottom


def barge() -> Section:
    """Its hull's section."""
    return box(BREADTH, HEIGHT)


def barge_body(axis_is_fixed: bool) -> Body:
    """Barge and cargo as one, with the natural frequency of roll that the source found for the one or other model.

    Neither centre of gravity nor inertia is given. The centre is put where GM is 50 mm; the inertia follows, a radius
    of gyration of 0.36 breadths (usual of ships) for the fixed axis and 0.39 when free. One hull cannot have both
    frequencies: a fixed axis is a constraint, and without it roll is faster (Rayleigh 1873), not slower.
    """
    section, water = barge(), Water()
    body = Body(water.density * BREADTH * DRAUGHT, (0.0, GRAVITY_HEIGHT), 0.0)
    frequency = FIXED_AXIS if axis_is_fixed else FREE
    table = hydrodynamics(section, water, -DRAUGHT, [frequency - 0.05, frequency, frequency + 0.05], about=PIVOT)
    free = (not axis_is_fixed, not axis_is_fixed, True)
    ship = Ship(body, Floating(section, water, PIVOT), frozen_at(table, frequency), PIVOT, free=free)
    return inertia_for_roll(ship, section, water, -DRAUGHT, table.at([frequency]))


@dataclass(frozen=True, eq=False)
class Afloat:
    """A section that displaces its whole loading at any roll, `about` a point P of it."""

    section: Section
    loading: Loading
    water: Water
    about: tuple[float, float]

    @property
    def weight(self) -> float:
        """N/m."""
        return self.loading.mass * self.water.gravity

    @cached_property
    def heave(self) -> float:
        """Of the hull's origin (m), upright."""
        return balanced_heave(self.section, self.loading, self.water, 0.0)

    @cached_property
    def metacentric_height(self) -> float:
        """GM (m), upright."""
        return metacentric_height(self.section, self.loading, self.water)

    @cached_property
    def lever(self):
        """Function of the roll (rad): the buoyancy's lever (m) about P, periodic."""
        from scipy.interpolate import CubicSpline  # slow to import

        rolls = np.linspace(-pi, pi, ROLLS)
        heaves = np.array([balanced_heave(self.section, self.loading, self.water, roll) for roll in rolls])
        levers = self.section.immersion(heaves, rolls).centroid[:, 0] - turned(self.about, rolls)[:, 0]
        levers[-1] = levers[0]
        return CubicSpline(rolls, levers, bc_type="periodic")


@dataclass(frozen=True, eq=False)
class RollInWaves:
    """Moments of eq. 7.1 about a fixed P: buoyancy in calm water and W GM A k r cos ωt, r the effective wave slope."""

    afloat: Afloat
    amplitude: float = 0.0
    frequency: float = 1.0
    effective_slope: float = 1.0
    soft_start: float = 0.0

    def force(self, pose: np.ndarray, time: float) -> np.ndarray:
        """Force (N/m) and moment (N) about P, (3,)."""
        height = self.amplitude * float(soft_start(time, self.soft_start))
        slope = self.effective_slope * height * self.frequency**2 / self.afloat.water.gravity
        turning = float(self.afloat.lever(pose[2])) + self.afloat.metacentric_height * slope * cos(
            self.frequency * time
        )
        return self.afloat.weight * np.array([0.0, 1.0, turning])

    @property
    def still(self) -> "RollInWaves":
        """The same in calm water."""
        return replace(self, amplitude=0.0)


@dataclass(frozen=True, eq=False)
class FreeInWaves:
    """Forces of eq. E.13 on a hull free in sway, heave and roll; `inertia` (kg m) is the ship's about P.

    Buoyancy's moment is at the roll relative to the wave's slope (eq. E.12).
    """

    afloat: Afloat
    inertia: float
    amplitude: float = 0.0
    frequency: float = 1.0
    soft_start: float = 0.0

    def force(self, pose: np.ndarray, time: float) -> np.ndarray:
        """Force (N/m) and moment (N) about P, (3,)."""
        afloat, omega = self.afloat, self.frequency
        height = self.amplitude * float(soft_start(time, self.soft_start))
        rise, slope = height * cos(omega * time), height * omega**2 / afloat.water.gravity * sin(omega * time)
        spring = afloat.water.density * afloat.water.gravity * self._breadth
        sink = pose[1] - afloat.heave - afloat.about[1]
        acceleration = omega**2 * afloat.loading.mass
        return np.array(
            [
                -acceleration * height * sin(omega * time),
                afloat.weight + spring * (rise - sink) - acceleration * rise,
                afloat.weight * float(afloat.lever(pose[2] - slope)) - self.inertia * omega**2 * slope,
            ]
        )

    @cached_property
    def _breadth(self) -> float:
        return float(self.afloat.section.waterplane(self.afloat.heave, 0.0).breadth)

    @property
    def still(self) -> "FreeInWaves":
        """The same in calm water."""
        return replace(self, amplitude=0.0)


def source_roll(
    body: Body,
    amplitude: float,
    frequency: float,
    damping: RollDamping,
    effective_slope: float = 1.0,
    soft_start: float = 0.0,
    about: tuple[float, float] = PIVOT,
) -> Ship:
    """The barge in roll about the fixed P alone, eq. 7.1; δI and wave damping are those of the waves' frequency."""
    afloat = Afloat(barge(), body.loading, Water(), about)
    load = RollInWaves(afloat, amplitude, frequency, effective_slope, soft_start)
    return Ship(body, load, _coefficients(afloat, frequency), about, damping, free=(False, False, True))


def source_free(
    body: Body,
    amplitude: float,
    frequency: float,
    damping: RollDamping,
    soft_start: float = 0.0,
    about: tuple[float, float] = PIVOT,
) -> Ship:
    """The barge free in sway, heave and roll, eq. E.13; A and B are those of the waves' frequency, once for all."""
    afloat = Afloat(barge(), body.loading, Water(), about)
    apart = np.subtract(body.centre, about)
    inertia = body.inertia + body.mass * float(apart @ apart)
    load = FreeInWaves(afloat, inertia, amplitude, frequency, soft_start)
    return Ship(body, load, _coefficients(afloat, frequency), about, damping)


def _coefficients(afloat: Afloat, frequency: float):
    near = frequency * np.array([0.98, 1.0, 1.02])
    return frozen_at(hydrodynamics(afloat.section, afloat.water, afloat.heave, near, about=afloat.about), frequency)
