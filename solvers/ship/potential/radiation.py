"""Radiation and diffraction of waves by a section: added mass, damping, exciting forces. Linear, per metre of length.

Green's third identity on the wetted outline with the wave Green function: π φ + ∫ φ ∂G/∂n ds = ∫ G v_n ds, n into the
water, panels of constant potential, collocation at their middles (the potential-based relative of the close-fit source
method of Frank 1967: the unknown stays finite at a sharp bilge). It has spurious solutions at the frequencies of
standing waves inside the hull (John 1950). Inside, the same integrals vanish; requiring this at points of the interior
waterline, by least squares, removes the spurious solutions (Ohmatsu 1983).

Errors fall as the square of the panels' lengths. So each table is solved twice, with panels and with their halves, and
extrapolated (Richardson 1911). In roll they matter: its moment is what is left of forces that nearly cancel, and the
corners of a bilge, where the flow is singular, have a large part in it.

Limit: of motions that together make no waves, extrapolated damping is up to 4e-4 of its size off nil, to either side,
that of panels alone 5e-6 (boxes). The fit of the memory is off by more, and `require_damped` judges what comes of both.

All quantities oscillate as Re (… e^(−iωt)). Waves of elevation Re a e^(i(ky−ωt)) travel to starboard (+y); their phase
is taken at the y of the hull's origin. Modes are sway, heave and roll; roll is about a fixed point of the hull.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property
from math import inf

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.hydrostatics import turned
from solvers.ship.potential.green import panel_integrals
from solvers.ship.potential.panels import Panels, interior_points, wet_panels
from solvers.ship.section import Section
from solvers.ship.water import Water

PANELS = 120
LARGEST_EXPONENT = 600.0  # E₁ overflows at 700
LEAST_CLEARANCE = 0.02  # of the draught, under the keel


@dataclass(frozen=True, eq=False)
class Hydrodynamics:
    """Coefficients over angular frequencies (n,) rad/s in sway, heave, roll.

    `added_mass` and `damping` (n, 3, 3): the water's force on motion v is −A v̇ − B v (kg/m, kg, kg m; and those per
    s). `excitation` (n, 3), complex, is the force and moment per metre of wave amplitude on the fixed hull, from the
    pressure of incident and scattered waves; `froude_krylov` is the incident waves' part; `haskind` is `excitation`
    from the radiated waves by Haskind's (1957) relation. `infinite_added_mass` (3, 3) is the limit for ω → ∞.
    """

    frequency: np.ndarray
    added_mass: np.ndarray
    damping: np.ndarray
    excitation: np.ndarray
    froude_krylov: np.ndarray
    haskind: np.ndarray
    infinite_added_mass: np.ndarray

    def at(self, frequency: Sequence[float]) -> "Hydrodynamics":
        """The table at other frequencies within its range, by cubic splines; raises `Unavailable` beyond it."""
        frequency = np.atleast_1d(np.asarray(frequency, dtype=float))
        low, high = self.frequency[0], self.frequency[-1]
        if frequency.min() < low or frequency.max() > high:
            raise Unavailable(f"the table of the hull's coefficients reaches from {low:.4g} to {high:.4g} rad/s only.")
        return Hydrodynamics(frequency, *(spline(frequency) for spline in self._splines), self.infinite_added_mass)

    @cached_property
    def _splines(self) -> tuple:
        """Of all that `at` tells between the frequencies of the table."""
        from scipy.interpolate import CubicSpline  # slow to import

        tables = (self.added_mass, self.damping, self.excitation, self.froude_krylov, self.haskind)
        return tuple(CubicSpline(self.frequency, table) for table in tables)


def hydrodynamics(
    section: Section,
    water: Water,
    heave: float,
    frequency: Sequence[float],
    roll: float = 0.0,
    about: tuple[float, float] = (0.0, 0.0),
    count: int = PANELS,
) -> Hydrodynamics:
    """Coefficients of a hull at a mean heave (m) and roll (rad), about a point of its own frame.

    They are extrapolated from about `count`/2 and `count` panels. Raises `Unavailable` if frequencies or depth are out
    of range.
    """
    frequency = np.asarray(frequency, dtype=float)
    arm = turned(about, roll)
    coarse, fine = (wet_panels(section, heave, roll, count // 2, halved=halved) for halved in (0, 1))
    _check(coarse, frequency, water)
    tables = []
    for panels in (coarse, fine):
        inside = interior_points(section, heave, roll, len(panels.length))
        body = _Body(panels, inside, complex(arm[0], heave + arm[1]), water)
        tables.append(Hydrodynamics(frequency, *body.table(frequency)))
    return extrapolated(*tables)


def extrapolated(coarse: Hydrodynamics, fine: Hydrodynamics) -> Hydrodynamics:
    """The limit of tables at the same frequencies, of panels and of halved ones, whose errors are of second order."""
    pairs = {one.name: (getattr(coarse, one.name), getattr(fine, one.name)) for one in fields(fine)}
    return replace(fine, **{name: b + (b - a) / 3.0 for name, (a, b) in pairs.items() if name != "frequency"})


class _Body:
    """The panels and everything that does not depend on the frequency."""

    def __init__(self, panels: Panels, inside: np.ndarray, about: complex, water: Water):
        self.panels, self.water = panels, water
        self.points = np.concatenate([panels.middle, inside])
        n, arm = panels.normal, panels.middle - about
        # Normal velocities of unit motion in each mode; for roll it is the moment of the normal.
        self.modes = np.stack([n.real, n.imag, arm.real * n.imag - arm.imag * n.real], axis=-1)
        self.weights = self.modes * panels.length[:, None]

    def table(self, frequency: np.ndarray) -> list[np.ndarray]:
        """What `solve` gives at each frequency (rad/s), and the added mass for ω → ∞."""
        solved = zip(*(self.solve(omega) for omega in frequency), strict=True)
        return [*map(np.array, solved), self.infinite_added_mass()]

    def solve(self, omega: float):
        """Added mass, damping, excitation, its Froude–Krylov part, and excitation by Haskind's relation."""
        density = self.water.density
        single, matrix = self._equations(omega)
        incident, incident_slope = self._incident(omega)
        right = np.column_stack([single @ self.modes, 2.0 * np.pi * incident])
        potential = _least_squares(matrix, right)
        radiated, total = potential[:, :3], potential[:, 3]
        force = -density * self.weights.T @ radiated
        incident = incident[: len(total)]
        pressure = -1j * omega * density
        haskind = pressure * (self.weights.T @ incident - (radiated.T * self.panels.length) @ incident_slope)
        return (
            force.real,
            omega * force.imag,
            pressure * self.weights.T @ total,
            pressure * self.weights.T @ incident,
            haskind,
        )

    def infinite_added_mass(self) -> np.ndarray:
        """Added mass (3, 3) for ω → ∞, with the surface condition φ = 0."""
        single, matrix = self._equations(inf)
        potential = _least_squares(matrix, single @ self.modes)
        return (-self.water.density * self.weights.T @ potential).real

    def _equations(self, omega: float):
        """∫G ds and the matrix of the potentials, with a row for each panel and each interior point."""
        single, matrix = panel_integrals(self.points, self.panels, omega, self.water)
        matrix = matrix.astype(complex)
        matrix[np.diag_indices(len(self.panels.length))] += np.pi
        return single, matrix

    def _incident(self, omega: float):
        """Potential of waves of unit amplitude at the points, and its slope along the panels' normals."""
        k, depth = float(self.water.wave_number(omega)), self.water.depth
        scale = -1j * self.water.gravity / omega
        y, z = self.points.real, self.points.imag
        # cosh k(z + h)/cosh kh without overflow
        gone = np.exp(-2.0 * k * depth)
        rising, falling = np.exp(k * z) / (1.0 + gone), gone * np.exp(-k * z) / (1.0 + gone) if gone else 0.0
        wave = scale * np.exp(1j * k * y)
        slope_y, slope_z = 1j * k * wave * (rising + falling), k * wave * (rising - falling)
        count, n = len(self.panels.length), self.panels.normal
        return wave * (rising + falling), slope_y[:count] * n.real + slope_z[:count] * n.imag


def _least_squares(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Least squares by the normal equations; equations of the second kind are well enough conditioned for it."""
    adjoint = matrix.conj().T
    return np.linalg.solve(adjoint @ matrix, adjoint @ right)


def _check(panels: Panels, frequency: np.ndarray, water: Water) -> None:
    """Raise `Unavailable`, one sentence, if frequencies or depth are out of range."""
    draught = -panels.start.imag.min()
    if not (frequency > 0.0).all() or not np.isfinite(frequency).all():
        raise Unavailable("frequencies must be above zero and finite.")
    highest = np.sqrt(LARGEST_EXPONENT * water.gravity / (2.0 * draught))
    if (frequency > highest).any():
        raise Unavailable(f"frequencies must stay below {highest:.4g} rad/s, where waves no longer reach the keel.")
    if water.depth < (1.0 + LEAST_CLEARANCE) * draught:
        raise Unavailable(f"the water must be deeper than the draught of {draught:.4g} m by 2 % or more.")
