"""Levels of accuracy: what a person asks for in one word, and what it sets. `cargolab bench accuracy` measures them."""

from dataclasses import dataclass

from lab.base.errors import LabError
from lab.preset.units import show

# Largest errors of the restitution at the derived step, and at draft's 2.75 times that: `cargolab verify` and the tests
# hold the code to them. All five normal laws, restitution 0.02 to 1, grains and walls, wherever in a step the contact
# begins, by Verlet's scheme and Gear's. Symplectic Euler is of first order where grains lose energy.
RESTITUTION, DRAFT_RESTITUTION = 1e-3, 1e-2


@dataclass(frozen=True)
class Level:
    """What a level sets, and the error that it stands for in words."""

    stiffness_scale: float  # on Young's moduli, unless contact.stiffness_scale is given
    longer_steps: float  # times the derived step, as far as its bounds may be stretched
    restitution: float  # largest relative error
    beyond: str  # what else is known of its error

    @property
    def error(self) -> str:
        """The error in words."""
        return f"restitution to {100 * self.restitution:g} %; {self.beyond}"


LEVELS = {
    "draft": Level(1e-3, 2.75, DRAFT_RESTITUTION, "softer beds slide up to 4 deg later"),
    "standard": Level(1e-2, 1.0, RESTITUTION, "no error of the softness found among 12 beds"),
    "reference": Level(1.0, 1.0, RESTITUTION, "the material's own stiffness"),
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
