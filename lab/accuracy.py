"""Levels of accuracy: what a person asks for in one word, and what it sets. `cargolab bench accuracy` measures them."""

from dataclasses import dataclass

from lab.errors import LabError
from lab.units import show


@dataclass(frozen=True)
class Level:
    """What a level sets, and the error that it stands for in words."""

    stiffness_scale: float  # on Young's moduli, unless contact.stiffness_scale is given
    longer_steps: float  # times the derived step, at which restitution is right to 0.1 %
    error: str


LEVELS = {
    "draft": Level(1e-3, 2.75, "restitution to 1 %; softer beds slide up to 4 deg later"),
    "standard": Level(1e-2, 1.0, "restitution to 0.1 %; no error of the softness found among 12 beds"),
    "reference": Level(1.0, 1.0, "restitution to 0.1 %; the material's own stiffness"),
}
DEFAULT = "standard"

# A step may be forced this many times past the derived one, about 16 steps a collision: restitution then errs by some
# 2 %, as the square of the step, and beds settle as they should. Beyond, runs go on without a sign of trouble while
# restitution is wrong by more.
FURTHEST = 5.0


def check_forced(step: float, derived: float, reason: str, force: bool) -> None:
    """Raise LabError for a step (s) past the derived one that is not forced, or further than results bear."""
    limit = f"the limit of {show(derived, 's')} ({reason})"
    if step > FURTHEST * derived:
        raise LabError(
            f"run.step: {show(step, 's')} is {step / derived:.3g} times {limit}, and collisions would go wrong without "
            f"a sign of it; leave it out, or force at most {FURTHEST:g} times the limit."
        )
    if step > derived and not force:
        raise LabError(f"run.step: {show(step, 's')} is past {limit}; leave it out, or set run.force_step = true.")
