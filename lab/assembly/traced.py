"""The outline of a grain from a picture: the largest thing in it that differs from what is around."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import write_text

LARGEST = 4000  # pixels of a side that are looked at; larger pictures are made smaller
LEAST = 400  # pixels of area, of what can be a grain
USUAL = 120  # points of an outline
MOST = 1000
SMOOTHED = 1.0  # pixels over which the picture is smoothed
SHADES = 256


@dataclass(frozen=True)
class Traced:
    """An outline (n, 2), y to the right and z up, about its centroid, counter-clockwise; in m, or in pixels.

    `equal` is the diameter of the disc of equal area, in the same unit; `level` the shade, 0 to 1, that parts the grain
    from what is around it.
    """

    points: np.ndarray
    level: float
    in_metres: bool

    @property
    def area(self) -> float:
        """The area inside."""
        return _area(self.points)

    @property
    def equal(self) -> float:
        """Diameter of the disc of equal area."""
        return 2.0 * float(np.sqrt(self.area / np.pi))

    def write(self, path: Path | str) -> Path:
        """Write it as the CSV file that `shapes.NAME.contour` takes."""
        unit = "m" if self.in_metres else "pixels"
        lines = [f"# outline from a picture, in {unit}", "y,z", *(f"{y:.7g},{z:.7g}" for y, z in self.points)]
        write_text(Path(path), "\n".join(lines) + "\n")
        return Path(path)


def trace(picture: Path | str, width: float | None = None, points: int = USUAL) -> Traced:
    """The outline of the largest thing in a picture, of so many points evenly spaced along it.

    Grain and background are parted at the shade of Otsu (1979), along which the contour runs; light on dark or dark on
    light: the background is what most of the edge of the picture shows. Holes inside are filled. width (m): of the
    grain, from left to right. Raises LabError for what is no picture, or shows no grain, or one that is cut off.
    """
    if not 8 <= points <= MOST:
        raise LabError(f"outline: from 8 to {MOST} points make an outline (got {points}).")
    if width is not None and not 0.0 < width < np.inf:
        raise LabError(f"outline: the width must be greater than 0 (got {width:g} m).")
    shades = _shades(Path(picture))
    level = otsu(shades)
    edge = np.concatenate([shades[0], shades[-1], shades[:, 0], shades[:, -1]])
    if np.median(edge) > level:  # a dark grain on a light ground
        shades, level = 1.0 - shades, 1.0 - level
    line = _longest(shades, level, picture)
    line = _even(line, points)
    line -= _centroid(line)
    if width is not None:
        line *= width / np.ptp(line[:, 0])
    return Traced(line, level, width is not None)


def otsu(shades: np.ndarray) -> float:
    """The shade that parts a picture so that the variance between both parts is largest (Otsu 1979)."""
    counts, ends = np.histogram(shades, SHADES, (0.0, 1.0))
    middles, share = 0.5 * (ends[1:] + ends[:-1]), counts / counts.sum()
    below, moment = np.cumsum(share), np.cumsum(share * middles)
    with np.errstate(invalid="ignore", divide="ignore"):
        between = (moment[-1] * below - moment) ** 2 / (below * (1.0 - below))
    best = np.nanmax(np.where(np.isfinite(between), between, np.nan), initial=0.0)
    same = np.flatnonzero(between >= best * (1.0 - 1e-9))  # all shades between two of which nothing is
    if not len(same):  # all of one shade
        return float(shades.flat[0])
    return float(0.5 * (ends[same[0] + 1] + ends[same[-1] + 1]))


def _shades(path: Path) -> np.ndarray:
    """The picture's shades (height, width), 0 to 1; what is transparent is background."""
    from PIL import Image, ImageFilter, UnidentifiedImageError

    try:
        with Image.open(path) as image:
            image = image.convert("RGBA")
            ground = Image.new("RGBA", image.size, "white")
            image = Image.alpha_composite(ground, image).convert("L")
    except (UnidentifiedImageError, OSError, ValueError, Image.DecompressionBombError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else "it is no picture"
        raise LabError(f"{path} cannot be read as a picture ({why}): name a PNG or JPEG file.") from None
    if max(image.size) > LARGEST:
        image.thumbnail((LARGEST, LARGEST))
    return np.asarray(image.filter(ImageFilter.GaussianBlur(SMOOTHED)), dtype=float) / (SHADES - 1)


def _longest(shades: np.ndarray, level: float, picture: object) -> np.ndarray:
    """The contour of the largest area at a level, (n, 2) in pixels, z up, counter-clockwise."""
    from contourpy import contour_generator

    ground = float(min(level, shades.min()) - 1.0)
    framed = np.pad(shades, 1, constant_values=ground)  # so that what is cut off by the edge is closed as well
    lines = [line for line in contour_generator(z=framed).lines(level) if len(line) > 3]
    areas = [abs(_area(line)) for line in lines]
    if not areas or max(areas) < LEAST:
        raise LabError(f"{picture} shows nothing that stands out from its ground: take one with more contrast.")
    line = lines[int(np.argmax(areas))][:-1]
    high, wide = shades.shape
    if line.min() < 1.0 or line[:, 0].max() > wide or line[:, 1].max() > high:
        raise LabError(f"{picture}: the largest thing in it is cut off by the edge; take one that shows all of it.")
    line = line * (1.0, -1.0)
    return line if _area(line) > 0.0 else line[::-1]


def _even(line: np.ndarray, points: int) -> np.ndarray:
    """A closed line with so many points, evenly spaced along it."""
    closed = np.vstack([line, line[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(closed, axis=0).T))])
    at = np.linspace(0.0, along[-1], points, endpoint=False)
    return np.column_stack([np.interp(at, along, closed[:, axis]) for axis in range(2)])


def _area(line: np.ndarray) -> float:
    """Area inside a closed line, negative where it runs clockwise."""
    y, z = line.T
    return 0.5 * float(y @ np.roll(z, -1) - z @ np.roll(y, -1))


def _centroid(line: np.ndarray) -> np.ndarray:
    after = np.roll(line, -1, axis=0)
    cross = line[:, 0] * after[:, 1] - after[:, 0] * line[:, 1]
    return ((line + after) * cross[:, None]).sum(axis=0) / (3.0 * cross.sum())
