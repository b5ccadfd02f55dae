"""How densely spheres in space are packed, in a tank without parts: the share of the bed's inside that they fill.

The inside is what lies INSIDE mean diameters from all walls, above the floor and below the surface, that is
below the tops of nine tenths of the columns (`surface_slope`). The share of POINTS drawn at random in it that lie in a
sphere is the packing fraction.

packing_fraction_start, packing_fraction: of the settled bed, and of the last picture frame. Error: standard error of
the share of the points.
"""

import numpy as np

from lab.measures.surface_slope import free_surface
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL, SPACE

OF = "grains"
INSIDE = 2.0  # mean diameters
POINTS = 40_000
LEAST_POINTS = 1_000  # within the inside
SURFACE = 10.0  # %, of the columns whose tops may be lower
SHALLOW = "the bed is too shallow, or too small, for an inside"


def applies(recording: Recording) -> bool:
    """There are spheres in space, and pictures of them."""
    return recording.content.axes == SPACE and not recording.parts and len(recording.frames["time"]) > 0


def measure(recording: Recording) -> dict[str, Value]:
    """packing_fraction_start and packing_fraction."""
    return {"packing_fraction_start": _fraction(recording, 0), "packing_fraction": _fraction(recording, -1)}


def _fraction(recording: Recording, frame: int) -> Value:
    """The packing fraction of each world in a picture frame."""
    position = recording.frames["position"][frame].astype(float)
    if recording.preset.tank.lies:  # a drum is the same however far it has turned, but its bed is level in the earth
        roll = recording.frames["pose"][frame][:, ROLL, None].astype(float)
        y, z = position[..., 0].copy(), position[..., 1].copy()
        position[..., 0], position[..., 1] = np.cos(roll) * y - np.sin(roll) * z, np.sin(roll) * y + np.cos(roll) * z
    found = np.array(
        [packing(recording, place, radius) for place, radius in zip(position, recording.radius, strict=True)]
    )
    return over_worlds(found[:, 0], "1", uncertainties=found[:, 1], kind="sampling", missing=SHALLOW)


def packing(recording: Recording, place: np.ndarray, radius: np.ndarray) -> tuple[float, float]:
    """The share of the inside that spheres at `place` (n, 3) m with `radius` (n,) m fill, and its standard error."""
    from scipy.spatial import cKDTree  # slow to import

    solid, outline, diameter = recording.preset.tank.solid, recording.outline, 2.0 * float(radius.mean())
    held = np.isfinite(place).all(axis=1)
    place, radius = place[held], radius[held]
    half, away = solid.half(outline), INSIDE * diameter
    _, tops = free_surface(place, radius, outline, 2.0 * half)
    if not len(tops):
        return np.nan, np.nan
    surface = float(np.percentile(tops, SURFACE))
    lower, upper = np.append(outline.min(axis=0), -half), np.append(outline.max(axis=0), half)
    points = np.random.default_rng(0).uniform(lower, [upper[0], max(surface - away, lower[1]), upper[2]], (POINTS, 3))
    points = points[solid.clear(points, outline, away)]
    if len(points) < LEAST_POINTS:
        return np.nan, np.nan
    if solid.period:  # with its images
        place = np.concatenate([np.add(place, [0.0, 0.0, shift * solid.period]) for shift in (-1, 0, 1)])
        radius = np.tile(radius, 3)
    near = cKDTree(place).query_ball_point(points, radius.max())
    filled = np.array(
        [
            bool(np.any(((place[k] - point) ** 2).sum(axis=1) < radius[k] ** 2))
            for k, point in zip(near, points, strict=True)
        ]
    )
    share = float(filled.mean())
    return share, float(np.sqrt(share * (1.0 - share) / len(points)))
