"""Force chains: lines from grains' centres to their contacts, as thick as the forces."""

from collections.abc import Sequence

import numpy as np

from lab.paint.colours import spread
from lab.paint.footage import Bed
from lab.paint.painter import Camera, paint_strokes
from solvers.grains.pressing import NOBODY, Pressing

TYPICAL = 0.99  # quantile of the forces that is drawn with thickness 1
MOST = 1.5  # largest thickness, for still larger forces
THICKEST = 0.42  # half thickness of the line of the typical force, over the mean radius
FRAMES = 10  # from which the typical force of a film is taken


def chains(
    pressing: Pressing, place: np.ndarray, typical: float | None = None
) -> tuple[np.ndarray, np.ndarray, np.ndarray, float]:
    """Grains (k,), arms (k, 2) m from their centres to contacts, their thickness, and the force (N) of thickness 1.

    place: positions (n, 2) m of the grains; typical: that force, by default the quantile TYPICAL of these. A force
    between grains is two lines; only for discs are they collinear.
    """
    force = np.hypot(*pressing.force.T)
    if not len(force):
        return np.zeros(0, dtype=int), np.zeros((0, 2)), force, typical or 0.0
    typical = typical or float(np.quantile(force, TYPICAL))
    mutual = pressing.grains[:, 1] != NOBODY
    grains = np.concatenate([pressing.grains[:, 0], pressing.grains[mutual, 1]])
    ends = np.concatenate([pressing.place, pressing.place[mutual]])
    forces = np.concatenate([force, force[mutual]])
    return grains, ends - place[grains], np.minimum(forces / max(typical, 1e-300), MOST), typical


def typical_force(beds: Sequence[Bed]) -> float:
    """The force (N) of thickness 1 in a film of these beds: the quantile TYPICAL where it is largest."""
    forces = [np.hypot(*bed.pressing(frame).force.T) for bed, frame in spread(beds, FRAMES)]
    return max((float(np.quantile(force, TYPICAL)) for force in forces if len(force)), default=0.0)


def paint_chains(picture: np.ndarray, camera: Camera, bed: Bed, row: float, typical: float, colour: tuple) -> None:
    """Paint the chains of a bed over its grains; of a picture between two frames, with the forces of the nearer one."""
    if not typical:
        return
    frame = round(float(row))
    grains, arms, thickness, _ = chains(bed.pressing(frame), bed.position(frame), typical)
    centre = bed.position(row)[grains]
    half = thickness * (THICKEST * float(bed.radius.mean()) * camera.scale)
    first, second = camera.pixels(centre), camera.pixels(centre + arms)
    paint_strokes(picture, np.column_stack([first, half, second, half]), colour)


def newtons(force: float) -> str:
    """A force with its unit."""
    return f"{force:.2g} N" if force >= 0.1 else f"{1e3 * force:.2g} mN" if force >= 1e-4 else f"{1e6 * force:.2g} µN"
