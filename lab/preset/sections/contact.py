"""The contact laws in a preset, and the factor on the stiffness."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

from lab.preset.accuracy import LEVELS
from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL
from solvers.grains.shapes.given import CONTACTS
from solvers.machine.marks import Interval

StiffnessScale = Annotated[float, Interval(gt=0, le=1)]


@dataclass(frozen=True)
class ContactGiven:
    """The contact laws, and the factor on Young's moduli that allows longer steps (None: set by `run.accuracy`).

    `outlines`: the contact rule of irregular grains; `nodes`: number on each outline, for the rules that use nodes.
    """

    normal: Literal[*NORMAL] = "hertz-viscoelastic"
    tangential: Literal[*TANGENTIAL] = "haff-werner"
    rolling: Literal[*ROLLING] = "none"
    cohesion: Literal[*COHESION] = "none"
    stiffness_scale: StiffnessScale | None = None
    outlines: Literal[*CONTACTS] = "continuous"
    nodes: Annotated[int, Interval(ge=8, le=2000)] = 120


@dataclass(frozen=True)
class Contact(ContactGiven):
    """The contact laws with the stiffness factor filled in."""

    stiffness_scale: StiffnessScale = field(kw_only=True)


def full_contact(given: ContactGiven, accuracy: str) -> Contact:
    """The resolved contact laws; a stiffness factor that is not given follows from the level of accuracy."""
    scale = given.stiffness_scale or LEVELS[accuracy].stiffness_scale
    return Contact(**{**vars(given), "stiffness_scale": scale})
