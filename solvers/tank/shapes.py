"""The shapes of bodies in space: spheres, and prisms along x. Points (n, 3) m have the order y, z, x."""

from dataclasses import dataclass

import numpy as np

from solvers.tank.outline import area_below, moments


@dataclass(frozen=True)
class SphereShape:
    """A sphere of a `radius` (m) about its `middle` (m), as drawn."""

    middle: tuple[float, float, float]
    radius: float

    @property
    def volume(self) -> float:
        """Its volume (m³)."""
        return 4.0 / 3.0 * np.pi * self.radius**3

    @property
    def centroid(self) -> np.ndarray:
        """Its middle (3,) m."""
        return np.array(self.middle)

    @property
    def gyration(self) -> np.ndarray:
        """Moments of inertia (3, 3) m² about the centroid, over the mass: 2/5 R²."""
        return 0.4 * self.radius**2 * np.eye(3)

    def farthest(self, point: np.ndarray) -> float:
        """How far (m) any point of it is from a point (3,) m."""
        return float(np.linalg.norm(self.centroid - point)) + self.radius

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) m of points from its face, negative inside."""
        return np.linalg.norm(points - self.centroid, axis=1) - self.radius

    def below(self, level: float) -> float:
        """Its volume (m³) below a level (m): π h² (3 R − h)/3 of a cap of the height h."""
        height = float(np.clip(level - self.middle[1] + self.radius, 0.0, 2.0 * self.radius))
        return np.pi * height**2 * (3.0 * self.radius - height) / 3.0

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest coordinates (3,) m of its points."""
        return self.centroid - self.radius, self.centroid + self.radius


@dataclass(frozen=True)
class PrismShape:
    """A polygon of `corners` (m) in y and z, drawn out over a length `along` (m) about the `middle` (m) along x."""

    corners: tuple[tuple[float, float], ...]
    along: float
    middle: float = 0.0

    @property
    def polygon(self) -> np.ndarray:
        """The corners (m, 2) m, counter-clockwise."""
        corners = np.array(self.corners)
        return corners if moments(corners)[0] > 0.0 else corners[::-1]

    @property
    def volume(self) -> float:
        """Its volume (m³)."""
        return float(moments(self.polygon)[0]) * self.along

    @property
    def centroid(self) -> np.ndarray:
        """Its centroid (3,) m."""
        return np.array([*moments(self.polygon)[1], self.middle])

    @property
    def gyration(self) -> np.ndarray:
        """Moments of inertia (3, 3) m² about the centroid, over the mass.

        Of the section's second moments σ_ij = ∫ r_i r_j dA/A, and σ_xx = L²/12: tr(σ) 1 − σ.
        """
        spread = np.zeros((3, 3))
        spread[:2, :2], spread[2, 2] = second_moments(self.polygon), self.along**2 / 12.0
        return np.trace(spread) * np.eye(3) - spread

    def farthest(self, point: np.ndarray) -> float:
        """How far (m) any point of it is from a point (3,) m."""
        ends = self.middle + 0.5 * self.along * np.array([-1.0, 1.0])
        across = np.linalg.norm(self.polygon - point[:2], axis=1).max()
        return float(np.hypot(across, np.abs(ends - point[2]).max()))

    def distance(self, points: np.ndarray) -> np.ndarray:
        """Signed distances (n,) m of points from its faces, negative inside."""
        section = signed_distance(points[:, :2], self.polygon)
        beyond = np.abs(points[:, 2] - self.middle) - 0.5 * self.along
        outside = np.hypot(np.maximum(section, 0.0), np.maximum(beyond, 0.0))
        return outside + np.minimum(np.maximum(section, beyond), 0.0)

    def below(self, level: float) -> float:
        """Its volume (m³) below a level (m)."""
        polygon = self.polygon
        height = float(np.clip(level - polygon[:, 1].min(), 0.0, np.ptp(polygon[:, 1])))
        return area_below(polygon, height) * self.along

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """The lowest and the highest coordinates (3,) m of its points."""
        low, high = self.polygon.min(axis=0), self.polygon.max(axis=0)
        return np.array([*low, self.middle - 0.5 * self.along]), np.array([*high, self.middle + 0.5 * self.along])


def second_moments(polygon: np.ndarray) -> np.ndarray:
    """∫ r_i r_j dA/A (2, 2) m² of a counter-clockwise polygon (m, 2) m about its centroid.

    Of the triangles from the centroid: A_k/12 (a a + b b + (a + b)(a + b)), by Green's theorem.
    """
    area, centre, _ = moments(polygon)
    found = np.zeros((2, 2))
    for a, b in zip(polygon - centre, np.roll(polygon, -1, axis=0) - centre, strict=True):
        of_triangle = 0.5 * (a[0] * b[1] - a[1] * b[0])
        found += of_triangle / 12.0 * (np.outer(a, a) + np.outer(b, b) + np.outer(a + b, a + b))
    return found / area


def signed_distance(points: np.ndarray, polygon: np.ndarray) -> np.ndarray:
    """Distances (n,) m of points (n, 2) from the edges of a polygon (m, 2) m, negative inside of it."""
    nearest, inside = np.full(len(points), np.inf), np.zeros(len(points), dtype=bool)
    for begin, end in zip(polygon, np.roll(polygon, -1, axis=0), strict=True):
        way, off = end - begin, points - begin
        share = np.clip(off @ way / (way @ way), 0.0, 1.0)
        nearest = np.minimum(nearest, np.linalg.norm(off - share[:, None] * way, axis=1))
        spans = (off[:, 1] > 0.0) != (off[:, 1] > way[1])  # by the even–odd rule
        if way[1]:
            inside ^= spans & (off[:, 0] < off[:, 1] * way[0] / way[1])
    return np.where(inside, -nearest, nearest)
