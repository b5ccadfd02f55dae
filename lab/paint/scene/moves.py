"""Where points are that move: carried by a body, and between two frames."""

import numpy as np


def moved_line(line: np.ndarray, shift: np.ndarray, turn: float) -> np.ndarray:
    """A line (m, 2) m as drawn, turned by `turn` (rad) and displaced by `shift` (m)."""
    c, s = np.cos(turn), np.sin(turn)
    return shift + line @ np.array([[c, s], [-s, c]])


def on_the_way(
    one: np.ndarray, two: np.ndarray, rate_one: np.ndarray, rate_two: np.ndarray, share: float, time: float
) -> np.ndarray:
    """Places between two frames `time` (s) apart, by the cubic with the places and rates of both (Hermite 1878).

    It leaves the straight way by half of that way at most, since the rates of grains that collide meanwhile mislead.
    """
    straight = one + share * (two - one)
    rise = share * (1.0 - share) ** 2 * time * rate_one - share**2 * (1.0 - share) * time * rate_two
    bend = rise - share * (1.0 - share) * (1.0 - 2.0 * share) * (two - one)
    way, size = np.linalg.norm(two - one, axis=-1, keepdims=True), np.linalg.norm(bend, axis=-1, keepdims=True)
    return straight + bend * np.minimum(1.0, 0.5 * way / np.maximum(size, 1e-30))
