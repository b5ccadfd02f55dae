"""The contact laws in a preset, and the factor on the stiffness."""

from dataclasses import dataclass
from typing import Annotated, Literal

from solvers.grains.laws import COHESION, NORMAL, ROLLING, TANGENTIAL, TWISTING
from solvers.grains.shapes.given import CONTACTS
from solvers.machine.marks import Cheap, Doc, Interval

StiffnessScale = Annotated[float, Interval(gt=0, le=1)]


@dataclass(frozen=True)
class Contact:
    """The contact laws, and the factor on Young's moduli that allows longer steps."""

    normal: Annotated[Literal[*NORMAL], Doc("Law of the normal force: repulsion and losses.")] = "hertz-viscoelastic"
    tangential: Annotated[Literal[*TANGENTIAL], Doc("Law of the tangential force: friction.")] = "haff-werner"
    rolling: Annotated[Literal[*ROLLING], Doc("Law of the torque against rolling.")] = "none"
    twisting: Annotated[Literal[*TWISTING], Doc("Law of the torque about the normal, in space.")] = "none"
    cohesion: Annotated[Literal[*COHESION], Doc("Law of the pull of liquid between grains.")] = "none"
    stiffness_scale: Annotated[
        StiffnessScale | None,
        Cheap(),
        Doc("Factor on Young's moduli, which allows longer steps; by run.accuracy and the range of sizes without it."),
    ] = None
    outlines: Annotated[Literal[*CONTACTS], Doc("Contact rule of irregular grains.")] = "continuous"
    nodes: Annotated[
        int, Interval(ge=8, le=2000), Doc("Nodes on each irregular outline, for the rules that use nodes.")
    ] = 120
