"""The ways that grains have come in the last pictures, as tapered lines."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from lab.paint.footage import Bed
from lab.paint.painter import Camera, paint_strokes

THICK = 0.28  # half thickness at the grain over its radius
LEAST = 0.5  # radii: shorter ways are not drawn


def paint_trails(picture: np.ndarray, camera: Camera, bed: Bed, rows: Sequence[float], colour: tuple) -> None:
    """Paint the ways of a bed's grains through these frames, the latest first, relative to the tank."""
    places = [bed.position(row) for row in rows]
    length = sum(np.hypot(*(one - two).T) for one, two in pairwise(places))
    moved = np.isfinite(length) & (length > LEAST * bed.radius)
    pixels = [camera.pixels(place[moved]) for place in places]
    half = camera.scale * THICK * bed.radius[moved]
    count = max(len(places) - 1, 1)
    lines = [
        np.column_stack([one, half * (1.0 - k / count), two, half * (1.0 - (k + 1) / count)])
        for k, (one, two) in enumerate(pairwise(pixels))
    ]
    if lines and moved.any():
        paint_strokes(picture, np.concatenate(lines), colour)
