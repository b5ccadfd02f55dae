"""A motion without movement: a tank held at an angle."""

from dataclasses import dataclass

import taichi as ti


@ti.func
def held(table: ti.template(), w, first, t):
    """An angle that is always the same."""
    return ti.Vector([table[w, first], 0.0, 0.0])


@dataclass(frozen=True)
class Held:
    """A tank that stands at an angle (rad) about its origin."""

    angle: float
    centre: tuple[float, float] = (0.0, 0.0)

    coordinate = "turn"
    state = staticmethod(held)

    def duration(self) -> float:
        return 0.0

    def parameters(self, soft_start: float) -> list[float]:
        return [self.angle]

    def fastest(self, soft_start: float) -> float:
        return 0.0
