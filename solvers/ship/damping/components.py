"""Roll damping of a whole ship without speed, component by component (ITTC 7.5-02-07-04.5; Himeno 1981).

The sum has friction, eddies, waves, the drag of bilge keels and their pressure on the hull; lift is nil without speed.
Each is the linear damping that takes as much energy in a cycle of an amplitude as the component does. Friction is that
of Kato (1957) with the growth of a turbulent boundary layer, 1 + 0.00814 (r² a² ω/ν)^0.386 (as Falzarano et al. 2015
have it, after Hughes). Eddies are those of Ikeda, Himeno and Tanaka (1978), section by section; waves are given by
whoever has them, by potential flow. Without sections all but friction and keels are those of `simple`.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.damping import simple
from solvers.ship.damping.keels import EQUIVALENT, Keels, Midship, bilge_radius, drag, hull_pressure
from solvers.ship.viscous import VISCOSITY, friction_arm, section_eddies

NAMES = "friction", "eddies", "waves", "keel drag", "keel pressure"
WAVES = NAMES.index("waves")
LAMINAR = 0.787  # 4/(3π) × 1.328 × √(2π/3.22), of Kato's formula
FULLEST = 0.9999  # of a Lewis section
FITTED = np.radians(np.arange(2.5, 26.0, 2.5))  # amplitudes through which B₁ and B₂ are laid


@dataclass(frozen=True)
class Slice:
    """A section with its share of the ship: `length`, `breadth` in the waterline, `draught` (m), and `area` (m²)."""

    length: float
    breadth: float
    draught: float
    area: float


@dataclass(frozen=True)
class Particulars:
    """A ship: lengths in m, `axis` the height of the axis of roll, her centre of gravity, above the keel line.

    `radius` (m) of the bilges: None follows from the midship coefficient. `density` of the water is in kg/m³.
    """

    length: float
    breadth: float
    draught: float
    block: float
    midship: float
    axis: float
    keels: Keels | None = None
    radius: float | None = None
    density: float = 1025.0
    gravity: float = 9.81

    @property
    def section(self) -> Midship:
        """Her midship section."""
        radius = bilge_radius(self.breadth, self.draught, self.midship) if self.radius is None else self.radius
        return Midship(self.breadth, self.draught, radius, self.midship, self.axis)

    @property
    def unit(self) -> float:
        """B44 (N m s) over its usual dimensionless form, ρ ∇ B² √(2g/B)."""
        mass = self.density * self.length * self.breadth * self.draught * self.block
        return mass * self.breadth**2 * sqrt(2.0 * self.gravity / self.breadth)

    def ratios(self, frequency: float) -> simple.Ratios:
        """What the simple formulas take, at a frequency (rad/s)."""
        keels = self.keels or Keels(0.0, 0.0)
        return simple.Ratios(
            self.breadth / self.draught,
            self.block,
            self.midship,
            1.0 - self.axis / self.draught,
            frequency * sqrt(0.5 * self.breadth / self.gravity),
            keels.breadth / self.breadth,
            keels.length / self.length,
        )


def friction(ship: Particulars, frequency: float, amplitude: float) -> float:
    """B44 (N m s) of skin friction at an amplitude (rad): 0.787 ρ S r² √(ω ν) with the turbulent growth."""
    girth, arm = friction_arm(ship.breadth, ship.draught, ship.block, ship.axis)
    laminar = LAMINAR * ship.density * girth * ship.length * arm**2 * sqrt(frequency * VISCOSITY)
    return laminar * (1.0 + 0.00814 * (arm**2 * amplitude**2 * frequency / VISCOSITY) ** 0.386)


def eddies(ship: Particulars, slices: Sequence[Slice], frequency: float, amplitude: float) -> float:
    """B44 (N m s) of eddies of the bare hull: Σ 4/(3π) ρ d⁴ ω a C_R Δx. Slices without a Lewis form have none."""
    total = 0.0
    for one in slices:
        full = min(one.area / (one.breadth * one.draught), FULLEST)
        above = one.draught + ship.axis - ship.draught  # of the axis above the slice's own bottom
        radius = bilge_radius(one.breadth, one.draught, full)
        try:
            coefficient = section_eddies(one.breadth, one.draught, radius, full, above)
        except (Unavailable, ValueError, ZeroDivisionError):
            continue
        total += one.length * one.draught**4 * coefficient
    return 0.5 * EQUIVALENT * ship.density * frequency * amplitude * total


def keels(ship: Particulars, frequency: float, amplitude: float) -> tuple[float, float]:
    """B44 (N m s) of the bilge keels' drag and of their pressure on the hull."""
    if ship.keels is None:
        return 0.0, 0.0
    breadth, length = ship.keels.breadth, ship.keels.length
    parts = (part(ship.section, breadth, frequency, amplitude, ship.density) for part in (drag, hull_pressure))
    first, second = parts
    return first * length, second * length


def components(
    ship: Particulars,
    frequency: float,
    amplitudes: Sequence[float],
    slices: Sequence[Slice] = (),
    waves: float | None = None,
) -> np.ndarray:
    """B44 (n, 5) N m s by NAMES at a frequency (rad/s) and amplitudes (n,) rad.

    `waves` is the wave damping (N m s) of potential flow; without it, or without slices, by `simple`. Raises
    Unavailable where that does not reach.
    """
    ratios = replace(ship, keels=None).ratios(frequency)  # keels are never by `simple` here
    if waves is None or not slices:
        ratios.require()
    made = simple.waves(ratios) * ship.unit if waves is None else waves
    rows = []
    for amplitude in amplitudes:
        turn = float(np.degrees(amplitude))
        eddy = eddies(ship, slices, frequency, amplitude) if slices else simple.eddies(ratios, turn) * ship.unit
        rows.append((friction(ship, frequency, amplitude), eddy, made, *keels(ship, frequency, amplitude)))
    return np.array(rows)


def linear_quadratic(frequency: float, amplitudes: np.ndarray, damping: np.ndarray) -> tuple[float, float, float]:
    """B₁ (N m s) and B₂ (N m s²) of B₁ φ̇ + B₂ φ̇|φ̇| with the equivalent dampings (n,) N m s, and the largest misfit.

    At amplitudes (n,) rad: B = B₁ + (8/3π) ω a B₂, by least squares of relative differences. Neither is below zero.
    """
    from scipy.optimize import nnls  # slow to import

    damping = np.asarray(damping, dtype=float)
    if not damping.any():
        return 0.0, 0.0, 0.0
    fall = EQUIVALENT * frequency * np.asarray(amplitudes)
    rows = np.column_stack([np.ones(len(fall)), fall]) / damping[:, None]
    scale = np.abs(rows).max(axis=0)
    found = nnls(rows / scale, np.ones(len(fall)))[0] / scale
    return float(found[0]), float(found[1]), float(np.abs(rows @ found - 1.0).max())
