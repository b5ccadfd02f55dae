"""The outline of an irregular grain by Fourier descriptors, and its sizes, mass and inertia."""

from dataclasses import dataclass
from functools import cached_property
from math import hypot, inf, pi

import numpy as np

from solvers.grains.shapes import series
from solvers.machine.errors import BadOutline

ROUNDING = 1e-14  # of a radius: smaller differences count as zero
MOST_SAMPLES = 2**15
LOOKS = 16  # samples per wave of the last descriptor


@dataclass(frozen=True)
class Contour:
    """R(θ) = R0 + Σ_{n≥1} D_n cos(nθ + δ_n), θ counter-clockwise (Spandonidis 2016, eq. 8.1).

    `radius` R0 and `descriptors` D_1, D_2, … in m, `phases` δ_1, δ_2, … in rad. Raises BadOutline unless R is positive
    everywhere, so that the outline is star-shaped about the origin and does not cross itself.
    """

    radius: float
    descriptors: tuple[float, ...] = ()
    phases: tuple[float, ...] = ()

    def __post_init__(self):
        for name in ("descriptors", "phases"):  # arrays are accepted, but only tuples can be compared and hashed
            object.__setattr__(self, name, tuple(float(x) for x in getattr(self, name)))
        if len(self.descriptors) != len(self.phases):
            counts = f"got {len(self.descriptors)} descriptors and {len(self.phases)} phases"
            raise BadOutline(f"each descriptor needs a phase ({counts}).")
        if not np.isfinite([self.radius, *self.descriptors, *self.phases]).all():
            raise BadOutline("radius, descriptors and phases must be finite numbers.")
        surely = sum(map(abs, self.descriptors)) < self.radius  # which takes a hundredth of the time
        if not surely and not self.smallest_radius > 0.0:
            raise BadOutline(
                f"the polar radius falls to {self.smallest_radius:.3g} m, but must be positive everywhere; "
                "take smaller descriptors or other phases."
            )

    @classmethod
    def through(cls, radii: np.ndarray, count: int | None = None) -> "Contour":
        """The outline with polar radii (k,) m at equally spaced angles from 0, by FFT; at most `count` descriptors."""
        mean, amplitudes, phases = series.coefficients(radii)
        return cls(mean, amplitudes[:count], phases[:count])

    def polar(self, angle: np.ndarray, derivative: int = 0) -> np.ndarray:
        """R (m) at angles (rad, any shape), or its derivative of a given order (m)."""
        mean = self.radius if derivative == 0 else 0.0
        return mean + series.harmonics(angle, *self._coefficients, derivative)

    def points(self, angle: np.ndarray) -> np.ndarray:
        """Points (…, 2) m of the outline at polar angles (rad)."""
        return self.polar(angle)[..., None] * _direction(angle)

    def normals(self, angle: np.ndarray) -> np.ndarray:
        """Outward unit normals (…, 2) at polar angles (rad)."""
        radius, slope = self.polar(angle)[..., None], self.polar(angle, 1)[..., None]
        along = _direction(angle)
        across = np.stack([-along[..., 1], along[..., 0]], axis=-1)
        return (radius * along - slope * across) / np.hypot(radius, slope)

    def tangents(self, angle: np.ndarray) -> np.ndarray:
        """Unit tangents (…, 2), the normals turned counter-clockwise by 90°."""
        normal = self.normals(angle)
        return np.stack([-normal[..., 1], normal[..., 0]], axis=-1)

    @cached_property
    def bounding_radius(self) -> float:
        """Largest R (m)."""
        return self.radius + series.largest(*self._coefficients)

    @cached_property
    def smallest_radius(self) -> float:
        """Smallest R (m)."""
        amplitudes, phases = self._coefficients
        return self.radius - series.largest(-amplitudes, phases)

    @cached_property
    def equivalent_radius(self) -> float:
        """Radius (m) of the disc of equal area, R0 √(1 + ½ Σ (D_n/R0)²)."""
        relative = self._coefficients[0] / self.radius
        return self.radius * float(np.sqrt(1.0 + 0.5 * relative @ relative))

    @property
    def area(self) -> float:
        """Area (m²), π R0² + π/2 Σ D_n²."""
        return pi * self.equivalent_radius**2

    @cached_property
    def centroid(self) -> np.ndarray:
        """Centroid (2,) m, ∫ R³ (cos θ, sin θ) dθ/(3 × area), by the trapezoid rule, which is exact here."""
        cubes = (self._samples / self.equivalent_radius) ** 3
        return 2.0 / 3.0 * self.equivalent_radius * (cubes[:, None] * _direction(self._angles)).mean(axis=0)

    @cached_property
    def spread(self) -> float:
        """Second moment of area about the centroid, relative to that of the disc of equal area; 1 for a disc."""
        relative = self._samples / self.equivalent_radius
        offset = self.centroid / self.equivalent_radius
        return float((relative**4).mean() - 2.0 * offset @ offset)

    @cached_property
    def polar_moment(self) -> float:
        """Second moment J (m⁴) of the area A about the centroid c, ∫ R⁴ dθ/4 − A c²."""
        return 0.5 * pi * self.equivalent_radius**4 * self.spread

    @cached_property
    def perimeter(self) -> float:
        """Length (m) of the outline, by the trapezoid rule with points doubled until it has converged."""
        count, before, length = 4 * len(self._angles), inf, 0.0
        while abs(length - before) > ROUNDING * self.radius and count < MOST_SAMPLES:
            angle = _even(count)
            before, length = length, 2.0 * pi * float(np.hypot(self.polar(angle), self.polar(angle, 1)).mean())
            count *= 2
        return length

    def mass(self, density: float) -> float:
        """Mass (kg) of a grain of a density (kg/m³): that of the sphere of equal area, 4/3 π r³ ρ.

        Mass and `inertia` are exactly those of the solid with the thickness √(r² − (r s)²) on either side of the plane,
        s running from 0 at the centroid to 1 at the outline: a sphere over a disc, an ellipsoid over an ellipse.
        """
        return 4.0 / 3.0 * np.pi * self.equivalent_radius**3 * density

    def inertia(self, density: float) -> float:
        """Moment of inertia (kg m²) about the centroid, 4/5 m J/A with J the polar moment of the area A, see `mass`."""
        return self.mass(density) * self.equivalent_radius**2 * self.spread / 2.5

    @cached_property
    def convex(self) -> bool:
        """Whether the outline is convex, κ ≥ 0 at all sampled angles."""
        return bool(self._curvature.min() >= 0.0)

    @cached_property
    def sharpest_dent(self) -> float:
        """The least radius of curvature (m) of the concave parts of the outline; infinite if it is convex."""
        deepest = float(self._curvature.min())
        return -1.0 / deepest if deepest < 0.0 else inf

    @cached_property
    def _curvature(self) -> np.ndarray:
        """Curvature κ = (R² + 2 R'² − R R'')/(R² + R'²)^(3/2) (1/m) at equally spaced angles."""
        angle = _even(LOOKS * (1 + len(self.descriptors)))
        radius, slope, bend = (self.polar(angle, order) for order in range(3))
        return (radius**2 + 2.0 * slope**2 - radius * bend) / np.hypot(radius, slope) ** 3

    @cached_property
    def sharpest_change(self) -> float:
        """The largest rate of change of curvature along the outline, |dκ/ds| (1/m²), at sampled angles."""
        angle = _even(LOOKS * (1 + len(self.descriptors)))
        radius, slope, bend, change = (self.polar(angle, order) for order in range(4))
        size = radius**2 + slope**2
        turns = radius**2 + 2.0 * slope**2 - radius * bend
        along = size * (2.0 * radius * slope + 3.0 * slope * bend - radius * change)
        return float(np.abs((along - 3.0 * turns * slope * (radius + bend)) / size**3).max())

    @cached_property
    def least_mass(self) -> float:
        """The least effective mass against a push along a normal of the outline, relative to the grain's mass.

        1/(1 + m l²/I) with l the lever of the normal about the centroid, which must be the origin; 1 for a disc.
        """
        angle = _even(LOOKS * (1 + len(self.descriptors)))
        (x, y), (ny, nz) = self.points(angle).T, self.normals(angle).T
        lever = (x * nz - y * ny) / self.equivalent_radius
        return float(1.0 / (1.0 + 2.5 / self.spread * (lever**2).max()))

    def scaled(self, factor: float) -> "Contour":
        """The similar outline `factor` times as large."""
        return Contour(factor * self.radius, factor * np.array(self.descriptors), self.phases)

    def with_diameter(self, diameter: float) -> "Contour":
        """The similar outline with the area of a disc of a diameter (m)."""
        return self.scaled(0.5 * diameter / self.equivalent_radius)

    def centred(self, error: float = 1e-9) -> "Contour":
        """The same outline about its centroid, to within `error` times R0 at every angle.

        It has as many descriptors as this accuracy needs. Raises BadOutline if the outline is not star-shaped about its
        centroid, or needs too many descriptors.
        """
        centre = self.centroid
        if hypot(*centre) <= ROUNDING * self.radius:
            return self
        count = 8 * len(self._angles)
        while count < MOST_SAMPLES:
            mean, amplitudes, phases = series.coefficients(self._radii_about(centre, _even(count)))
            left_out = np.cumsum(amplitudes[::-1])[::-1]
            needed = int(np.sum(left_out > error * self.radius))
            if needed <= len(amplitudes) // 2:
                return Contour(mean, amplitudes[:needed], phases[:needed])
            count *= 2
        raise BadOutline("the outline bends too sharply, as seen from its centroid, to be described about it.")

    def _radii_about(self, centre: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Distances (m) from an interior point to the outline in given directions (rad), by Newton's method."""
        angle = _even(8 * len(self._angles))
        away, advance = self._seen_from(centre, angle)
        if not advance.min() > 0.0:
            raise BadOutline("the outline is not star-shaped about its centroid: part of it hides behind another.")
        seen = np.unwrap(np.angle(away))
        angle = direction + np.interp(direction, seen, angle - seen, period=2.0 * pi)
        for _ in range(50):
            away, advance = self._seen_from(centre, angle)
            miss = np.angle(np.exp(1j * direction) / away)
            angle = angle + miss / advance
            if np.abs(miss).max() < ROUNDING:
                break
        return np.abs(self._seen_from(centre, angle)[0])

    def _seen_from(self, centre: np.ndarray, angle: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Outline points from a centre, as complex numbers (m), and the derivative of their direction by θ."""
        turn = np.exp(1j * angle)
        away = self.polar(angle) * turn - complex(*centre)
        along = (self.polar(angle, 1) + 1j * self.polar(angle)) * turn
        return away, (along / away).imag

    @cached_property
    def _coefficients(self) -> tuple[np.ndarray, np.ndarray]:
        return np.array(self.descriptors), np.array(self.phases)

    @cached_property
    def _angles(self) -> np.ndarray:
        """Equally spaced angles (k,) rad, enough for the trapezoid rule to be exact for R⁴, of degree 4 N."""
        return _even(4 * len(self.descriptors) + 2)

    @cached_property
    def _samples(self) -> np.ndarray:
        return self.polar(self._angles)


def _even(count: int) -> np.ndarray:
    return 2.0 * pi / count * np.arange(count)


def _direction(angle: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)
