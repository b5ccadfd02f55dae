"""What drives a tank: the arrow from its place at rest to its place now, and a line of text."""

import numpy as np

from lab.paint.painter import Camera, paint_strokes, paint_tank
from lab.preset.schema import Preset
from solvers.motion.frame import is_turn

AWAY, HALF, HEAD, WIDE = (
    0.9,
    0.1,
    1.1,
    0.42,
)  # in u: distance off the tank, half thickness, length and half width of the head
LEAST = 1.2  # u; shorter ways have no arrow
STEPS = 24  # pieces of a way


def paint_arrow(
    picture: np.ndarray, camera: Camera, outline: np.ndarray, pose: np.ndarray, unit: float, colour: tuple
) -> None:
    """Paint the way of a tank's upper corner from rest to a pose (Y, Z, φ), outside the tank, with a head at its end.

    camera: of the earth's points. The coordinates of the pose grow alike along the way.
    """
    corner = outline[np.argmax(outline @ [1.0, 2.0])]
    out = corner - outline.mean(axis=0)
    start = corner + AWAY * unit / camera.scale * np.sign(out)
    paint_way(picture, _carried(camera, start, np.linspace(0.0, 1.0, STEPS + 1)[:, None] * pose), unit, colour)


def paint_way(picture: np.ndarray, way: np.ndarray, unit: float, colour: tuple) -> None:
    """Paint a way (STEPS + 1, 2) in pixels as an arrow; nothing if it is too short for one."""
    pieces = np.hypot(*np.diff(way, axis=0).T)
    if pieces.sum() < LEAST * unit:
        return
    end = way[-1]
    shaft = np.cumsum(pieces[::-1])[::-1] > 0.8 * HEAD * unit  # pieces that end before the head begins
    half = np.full((STEPS, 1), HALF * unit)
    paint_strokes(picture, np.hstack([way[:-1], half, way[1:], half])[shaft], colour)
    back = way[int(shaft.sum())]
    along = (end - back) / max(np.linalg.norm(end - back), 1e-9)
    foot, side = end - HEAD * unit * along, WIDE * unit * np.array([-along[1], along[0]])
    head = np.array([end, foot + side, foot - side]) * [1.0, -1.0]
    paint_tank(picture, Camera(1.0, (0.0, 0.0)), head, 0.0, colour, colour)


def _carried(camera: Camera, point: np.ndarray, poses: np.ndarray) -> np.ndarray:
    """Pixels (k, 2) of a tank's point (m) at poses (k, 3); camera: of the earth's points."""
    turn = camera.turn + poses[:, 2]
    cosine, sine, (y, z) = np.cos(turn), np.sin(turn), point
    turned = np.column_stack([cosine * y - sine * z, -sine * y - cosine * z])  # a picture's rows run downwards
    return camera.pixels(poses[:, :2]) + camera.scale * turned


def drive_text(preset: Preset) -> str:
    """What drives the tank in a few words: the waves, or the motions by amplitude and frequency."""
    if preset.ship:
        return _waves_text(preset)
    moved = [text for name, part in preset.motion.parts.items() if (text := _motion_text(name, part))]
    return ", ".join(moved) or _raised_text(preset)


def _raised_text(preset: Preset) -> str:
    """How fast a pair of plates is raised, as a funnel is."""
    speeds = [part.speed for part in preset.parts.values() if part.move[1] > 0.0 and not part.move[0] and part.speed]
    return f"raised at {1e3 * speeds[0]:.3g} mm/s" if preset.grains and len(speeds) == 2 else ""


def _waves_text(preset: Preset) -> str:
    waves = preset.waves
    height = 0.0 if waves is None else waves.height or 2.0 * (waves.amplitude or 0.0)
    if not height or not waves.frequency:
        return ""
    size = f"{height:.3g} m" if height >= 1.0 else f"{1e3 * height:.3g} mm"
    kind = "waves" if waves.kind == "regular" else "irregular waves"
    return f"{kind} of {size}, {2.0 * np.pi / waves.frequency:.3g} s"


def _motion_text(name: str, part: object) -> str:
    turns = is_turn(part.coordinate)
    amplitude, frequency = getattr(part, "amplitude", None), getattr(part, "frequency", None)
    if amplitude is not None and frequency is not None:
        size = f"{np.degrees(amplitude):.3g}°" if turns else f"{1e3 * amplitude:.3g} mm"
        return f"{name} ±{size} at {frequency:.3g} Hz"
    rate = getattr(part, "rate", None)
    if rate is not None and turns:
        return f"{name} at {np.degrees(rate):.3g}°/s"
    return ""
