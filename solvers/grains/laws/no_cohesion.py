"""Dry grains, without cohesion."""

import taichi as ti

from solvers.grains.materials import Interface


@ti.data_oriented
class NoCohesion:
    """No cohesion: nothing of it is compiled or stored."""

    constants = ()
    memory = ()
    needs = ()
    pulls = False

    def coefficients(self, between: Interface) -> list[float]:
        """None."""
        return []

    def limits(self, between: Interface, mass: float, radius: float, speed: float) -> list[tuple[float, str]]:
        """None."""
        return []

    def range(self, between: Interface) -> float:
        """Zero (m)."""
        return 0.0
