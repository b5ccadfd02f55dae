"""Levels of accuracy: one word of a preset, and the settings behind it. `cargolab bench accuracy` measures them."""

from collections.abc import Sequence
from dataclasses import dataclass

from lab.base.errors import LabError
from lab.preset.units import show
from solvers.machine.limit import Limit, furthest

# Largest relative errors of the restitution at the derived step, and at draft's 1.6 times that step. `cargolab verify`
# and the tests check them for all five normal laws, restitution 0.02 to 1, grains and walls, contacts that begin
# anywhere within a step, Verlet's scheme and Gear's. Symplectic Euler is of first order where grains lose energy.
RESTITUTION, DRAFT_RESTITUTION = 1e-3, 1e-2


@dataclass(frozen=True)
class Level:
    """The settings of a level, and its error in words."""

    stiffness_scale: float  # on Young's moduli, unless contact.stiffness_scale is given; see `stiffness_for`
    longer_steps: float  # factor by which the bounds on the derived step are stretched
    restitution: float  # largest relative error
    beyond: str  # what else is known of its error
    layers: int  # of particles over the depth of water, unless water.spacing is given
    of_water: str  # most errors of gentle water with so many layers: `cargolab bench water levels`

    @property
    def error(self) -> str:
        """The error in words."""
        return f"restitution to {100 * self.restitution:g} %; {self.beyond}"


WAVES = "frequencies to {} %, waves at a Reynolds number of 500 damped {} % too much, pressure at rest to {} % of ρgH"
LEVELS = {
    "draft": Level(1e-3, 1.6, DRAFT_RESTITUTION, "beds may run out some 5 % faster", 20, WAVES.format(1, 12, 0.8)),
    "standard": Level(
        1e-2, 1.0, RESTITUTION, "no error of the softness found among 12 beds", 40, WAVES.format(0.4, 4, 0.3)
    ),
    "reference": Level(1.0, 1.0, RESTITUTION, "the material's own stiffness", 80, WAVES.format(0.3, 3, 0.3)),
}
DEFAULT = "standard"
WIDEST = 8.0  # ratio of the masses of grains up to which the levels' stiffness holds: diameters as 1 to 2


def stiffness_for(level: Level, diameters: tuple[float, float], densities: Sequence[float]) -> float:
    """The factor on Young's moduli at a level, for grains from a smallest to a largest diameter (m).

    A small grain on the floor has to stop a large one that falls on it. It is pressed by ξ, (ξ/r)^(5/2) ~ (M/m) ρ v²/E
    for the masses M and m of the two, while between equal grains ξ/r does not depend on their size. With E in
    proportion to M/m the smallest grain is pressed no deeper, in its radii, than at WIDEST; a weight at rest, M g times
    the layers above, presses it less than its fall from there. No grain is stiffer than its material.
    """
    ratio = (diameters[1] / diameters[0]) ** 3 * max(densities) / min(densities)
    return min(1.0, level.stiffness_scale * max(1.0, ratio / WIDEST))


def check_forced(step: float, limits: Sequence[Limit], usual: float, force: bool) -> None:
    """Raise LabError for a step (s) longer than the `usual` one of the level if it is not forced, or than what may be.

    The derived step, that of standard, is the first of `limits`.
    """
    derived, reason, most = limits[0].step, limits[0].reason, furthest(limits)
    if step > most:
        raise LabError(
            f"run.step: {show(step, 's')} is {step / derived:.3g} times the limit of {show(derived, 's')} ({reason}), "
            f"and the run may go wrong unnoticed; leave it out, or force at most {most / derived:.3g} times the limit."
        )
    if step > usual and not force:
        stretched = "" if usual == derived else f", {usual / derived:.3g} times that at this accuracy"
        raise LabError(
            f"run.step: {show(step, 's')} is past the limit of {show(usual, 's')} ({reason}{stretched}); leave it out, "
            "or set run.force_step = true."
        )
