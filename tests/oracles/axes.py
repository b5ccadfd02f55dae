"""Axes for arrays of tests, whose names say nothing."""

from solvers.machine.state import Axis


def axes(*lengths: int) -> tuple[Axis, ...]:
    """Axes of these lengths."""
    return tuple(Axis(f"axis {k}", length) for k, length in enumerate(lengths))
