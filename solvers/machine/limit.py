"""A bound on the time step, with its reason."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import inf


@dataclass(frozen=True)
class Limit:
    """A bound on the step and its reason; neither integrator nor level of accuracy stretches a `firm` one.

    A user may force a step of up to `forced` times the bound.
    """

    step: float  # s
    reason: str
    firm: bool = False
    forced: float = 2.0


def furthest(limits: Iterable[Limit]) -> float:
    """The longest step (s) that may be forced; ∞ without bounds."""
    return min((limit.forced * limit.step for limit in limits), default=inf)
