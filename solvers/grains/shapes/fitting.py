"""Fourier descriptors fitted to an outline given by points."""

from dataclasses import dataclass
from math import pi
from pathlib import Path

import numpy as np

from solvers.grains.shapes.contour import ROUNDING, Contour
from solvers.machine.errors import BadOutline

LEAST_POINTS = 8
LEFT_OUT = 1e-3  # rms of the descriptors left out, relative to R0, if no number of descriptors is given
RESAMPLED = 8  # equally spaced angles per point
MOST_MOVES = 50


@dataclass(frozen=True)
class Fit:
    """A contour about its own centroid, which lies at `centre` (y, z) m in the points' axes.

    `rms` and `largest` (m) are the errors in polar radius at the points.
    """

    contour: Contour
    centre: tuple[float, float]
    rms: float
    largest: float


def fit(points: np.ndarray, count: int | None = None) -> Fit:
    """Fit a contour of `count` descriptors to points (k, 2) m in order; the last may repeat the first.

    By the FFT of the polar radius about the centroid, resampled at equally spaced angles by monotone cubic pieces
    (Fritsch and Carlson 1980), which do not overshoot. Without a count the descriptors left out have an rms of at most
    a thousandth of R0, but there are at most (k − 1)/2. Raises BadOutline for too few points, and if the outline is not
    star-shaped about the centroid.
    """
    points = _checked(np.asarray(points, dtype=float))
    most = (len(points) - 1) // 2
    if count is not None and not 0 <= count <= most:
        raise BadOutline(f"{len(points)} points allow for 0 to {most} descriptors (got {count}).")
    centre = _centroid(points)
    if count is None:
        count = _needed(Contour.through(_resampled(points, centre), most))
    for _ in range(MOST_MOVES):
        contour = Contour.through(_resampled(points, centre), count)
        offset = complex(*contour.centroid)
        if abs(offset) <= ROUNDING * contour.radius:
            break
        centre += offset
    away = _complex(points) - centre
    error = np.abs(away) - contour.polar(np.angle(away))
    return Fit(contour, (centre.real, centre.imag), float(np.sqrt((error**2).mean())), float(np.abs(error).max()))


def read_points(path: str | Path) -> np.ndarray:
    """Read points (k, 2) from a CSV file with two numbers per line and an optional header line.

    Lines that begin with # are ignored. Raises BadOutline, one sentence with the file's name.
    """
    try:
        lines = Path(path).read_text("utf-8-sig").splitlines()
        lines = [line for line in lines if line.strip() and not line.lstrip().startswith("#")]
        named = bool(lines) and not _is_number(lines[0].split(",")[0])
        points = np.array([[float(cell) for cell in line.split(",")] for line in lines[named:]])
    except OSError as error:
        raise BadOutline(f"{path}: cannot be read: {error.strerror or error}.") from None
    except ValueError:  # also for a file that is not text, and for lines of unequal length
        raise BadOutline(f"{path}: two numbers a line are needed, with a comma between them.") from None
    if points.ndim != 2 or points.shape[1] != 2:
        raise BadOutline(f"{path}: two numbers a line are needed, with a comma between them.")
    return points


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _checked(points: np.ndarray) -> np.ndarray:
    """The points counter-clockwise, without the repeated last one; raises BadOutline if they are no outline."""
    if points.ndim != 2 or points.shape[1] != 2:
        raise BadOutline(f"points (k, 2) are needed (got an array of shape {points.shape}).")
    if not np.isfinite(points).all():
        raise BadOutline("the points of an outline must be finite numbers.")
    if len(points) > 1 and (points[0] == points[-1]).all():
        points = points[:-1]
    if len(points) < LEAST_POINTS:
        raise BadOutline(f"an outline needs at least {LEAST_POINTS} points (got {len(points)}).")
    area = _moments(points)[0]
    if abs(area) <= ROUNDING * np.ptp(points, axis=0).max() ** 2:
        raise BadOutline("the outline has no area.")
    return points if area > 0.0 else points[::-1]


def _moments(points: np.ndarray) -> tuple[float, complex]:
    """Area (m²) of the polygon, positive if counter-clockwise, and its first moment (m³), about the first point."""
    away = _complex(points) - complex(*points[0])
    following = np.roll(away, -1)
    crossed = (away.conjugate() * following).imag
    return 0.5 * float(crossed.sum()), complex((crossed * (away + following)).sum() / 6.0)


def _centroid(points: np.ndarray) -> complex:
    area, moment = _moments(points)
    return complex(*points[0]) + moment / area


def _resampled(points: np.ndarray, centre: complex) -> np.ndarray:
    """Polar radii (m) about a centre at equally spaced angles from 0."""
    from scipy.interpolate import PchipInterpolator  # slow to import

    away = _complex(points) - centre
    advance = np.angle(np.roll(away, -1) / away)
    if not advance.min() > 0.0:
        where = int(np.argmin(advance)) + 1
        raise BadOutline(f"the outline is not star-shaped: seen from its centroid it turns back at point {where}.")
    if advance.sum() > 3.0 * pi:
        raise BadOutline("the outline goes round more than once.")
    angle = np.angle(away[0]) + np.concatenate([[0.0], np.cumsum(advance[:-1])])
    around = np.concatenate([angle - 2.0 * pi, angle, angle + 2.0 * pi])
    radius = PchipInterpolator(around, np.tile(np.abs(away), 3))
    first, count = angle[0], RESAMPLED * len(points)
    even = 2.0 * pi / count * np.arange(count)
    return radius(first + np.mod(even - first, 2.0 * pi))


def _needed(contour: Contour) -> int:
    """Number of descriptors needed for an rms error of LEFT_OUT times R0."""
    square = 0.5 * np.cumsum(np.array(contour.descriptors[::-1]) ** 2)[::-1]
    return int(np.sum(square > (LEFT_OUT * contour.radius) ** 2))


def _complex(points: np.ndarray) -> np.ndarray:
    return points[:, 0] + 1j * points[:, 1]
