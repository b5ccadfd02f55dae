"""Levels of accuracy: what a person asks for in one word, and what it sets. `cargolab bench accuracy` measures them."""

from dataclasses import dataclass


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
