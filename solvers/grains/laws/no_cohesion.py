"""Dry grains, which do not pull at one another."""

import taichi as ti

from solvers.grains.materials import Interface


@ti.data_oriented
class NoCohesion:
    """No pull: nothing of cohesion is compiled or kept."""

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
