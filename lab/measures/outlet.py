"""The outlet of a funnel or silo: the gap between the ends of two plates that a gate closes at the start."""

from dataclasses import dataclass

import numpy as np

from lab.recording import Recording
from solvers.machine.quantity import PLANE

NEAR = 0.01  # of a mean diameter: how far a gate's end may be from the plate's


@dataclass(frozen=True)
class Outlet:
    """Both lips of an outlet, port first: where they are at the start (2, 2), m, and the parts (2,) they belong to."""

    lips: np.ndarray
    carriers: tuple[int, int]

    def lips_at(self, recording: Recording, frame: int) -> np.ndarray:
        """The lips (W, 2, 2), m, in a picture frame."""
        moved, carriers = recording.frames["part"][frame].astype(float), list(self.carriers)
        lips = self.lips + moved[:, carriers, :PLANE]
        if "part_turn" in recording.frames:
            turn = recording.frames["part_turn"][frame].astype(float)[:, carriers]
            c, s, (y, z) = np.cos(turn), np.sin(turn), self.lips.T
            lips += np.stack([c * y - s * z, s * y + c * z], axis=-1) - self.lips
        return lips


def find_outlet(recording: Recording) -> Outlet | None:
    """The gap that a moving plate closes at the start, between the ends of two other parts; None without one."""
    lines = list(recording.parts.values())
    moving = recording.preset.parts
    for number, (name, line) in enumerate(recording.parts.items()):
        if name not in moving or not any(moving[name].move):
            continue
        lips = np.array(sorted(map(tuple, line[[0, -1]])))
        carriers = [_carrier(lip, number, lines, NEAR * recording.mean_diameter.min()) for lip in lips]
        if None not in carriers and carriers[0] != carriers[1]:
            return Outlet(lips, tuple(carriers))
    return None


def passed(recording: Recording, outlet: Outlet) -> np.ndarray:
    """Which grains (F, W, n) are below the outlet in each picture frame, those that have left the scene among them."""
    below = []
    for frame in range(len(recording.frames["time"])):
        level = outlet.lips_at(recording, frame)[:, :, 1].mean(axis=1)
        below.append(~(recording.frames["position"][frame][..., 1] >= level[:, None]))
    return np.array(below)


def _carrier(lip: np.ndarray, gate: int, lines: list[np.ndarray], near: float) -> int | None:
    """The part, other than the gate, one of whose ends is at the lip."""
    for number, line in enumerate(lines):
        if number != gate and np.hypot(*(line[[0, -1]] - lip).T).min() <= near:
            return number
    return None
