"""Lines over the view: the forces between grains, their velocities, rings and crosses."""

import numpy as np

from lab.paint.forces.chains import chains
from lab.paint.painter import Camera
from lab.view.shown import Shown

THICKEST = 0.3  # half thickness of the line of the largest force, over the mean radius
LONGEST, FASTEST = 6.0, 0.99  # length in radii of the line for the speed at this quantile


def force_strokes(shown: Shown, camera: Camera) -> tuple[np.ndarray, float]:
    """Force chains, lines from the grains to their contacts as thick as the forces; the largest force (N)."""
    footage, frame = shown.footage, shown.frame
    place = footage.grains("position", frame)
    grains, arms, thickness, largest = chains(footage.pressing(frame), place)
    lines = np.stack([place[grains], place[grains] + arms], axis=1)
    half = thickness * (THICKEST * footage.radius[0].mean() * camera.scale)
    return strokes(camera, lines, half, half), largest


def velocity_strokes(shown: Shown, camera: Camera) -> tuple[np.ndarray, float]:
    """Tapered lines along the velocities relative to the tank; the speed (m/s) of the longest."""
    footage, frame = shown.footage, shown.frame
    place, velocity = (footage.grains(name, frame) for name in ("position", "velocity"))
    speed, radius = np.hypot(*velocity.T), footage.radius[0].mean()
    largest = float(np.nanquantile(speed, FASTEST))
    moving = speed > 0.03 * largest
    tips = place + velocity * (LONGEST * radius / max(largest, 1e-9))
    half = np.full(moving.sum(), max(0.15 * radius * camera.scale, 0.7))
    return strokes(camera, np.stack([place, tips], axis=1)[moving], half, 0.0 * half), largest


def ring(x: float, y: float, radius: float, half: float) -> np.ndarray:
    """A circle as strokes (k, 6) in pixels; `half` is half its thickness."""
    turn = np.linspace(0.0, 2.0 * np.pi, 33)
    points = np.column_stack([x + radius * np.cos(turn), y + radius * np.sin(turn), np.full(33, half)])
    return np.hstack([points[:-1], points[1:]])


def strokes(camera: Camera, lines: np.ndarray, first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Lines (k, 2, 2) m as strokes (k, 6) in pixels; `first`, `second`: half thickness (pixels) at their ends."""
    ends = camera.pixels(lines.reshape(-1, 2)).reshape(-1, 2, 2)
    return np.column_stack([ends[:, 0], first, ends[:, 1], second])
