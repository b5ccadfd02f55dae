"""A bound on the time step, with its reason."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Limit:
    """A bound on the step and its reason; neither integrator nor level of accuracy stretches a `firm` one."""

    step: float  # s
    reason: str
    firm: bool = False
