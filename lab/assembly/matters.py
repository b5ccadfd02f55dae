"""What the solver is told of each matter of a preset beside grains, whose places are found with them: a line each."""

from lab.assembly.water import fluid_of
from lab.preset.schema import Preset
from solvers.tank.given import Given

MATTERS = {"water": fluid_of}


def others_of(preset: Preset) -> tuple[Given, ...]:
    """The matters of a preset that are not grains. Raises LabError."""
    return tuple(MATTERS[name](preset) for name in preset.matters if name in MATTERS)
