"""Checks of the bodies in a preset that float: what they can be in, and whether particles can carry them."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.parts import PartGroup
from lab.preset.sections.water.bodies import draught
from lab.preset.sections.water.liquid import Wet
from lab.preset.units import show

SHALLOWEST = 2.0  # spacings: the least draught of a body that particles carry


def check_floating(preset: Wet) -> None:
    """Raise LabError, one sentence, for the first body that cannot float as this preset says."""
    for name in preset.bodies:
        part, key = preset.parts[name], f"parts.{name}"
        said = f"{key}.{'density' if part.mass is None else 'mass'}"
        if preset.water is None or preset.liquid.model != "sph":
            raise LabError(f"{said}: a body that floats needs water of particles; add [water], or leave this out.")
        if preset.ship is not None or preset.axle is not None:
            raise LabError(
                f"{said}: a body does not float in a tank that answers its load; leave out [ship] or [axle]."
            )
        if preset.grains is not None and part.tank is None:
            raise LabError(f"{said}: a body does not float among grains; leave out [grains] or this.")
        _check_draught(preset, part, said)


def _check_draught(preset: Wet, part: PartGroup, key: str) -> None:
    """Raise LabError for a hull that sinks, and for a body that floats on too few particles, upright as it is drawn."""
    spacing = preset.liquid.spacing
    mass = part.solved(0, preset.thickness).free.mass
    deep = draught(part, mass / (preset.water.density * preset.thickness))
    if deep == np.inf and part.wall is not None:
        raise LabError(f"{key}: this hull is heavier than the water that it can displace; make it lighter.")
    if deep < SHALLOWEST * spacing:
        least = f"{deep / spacing:.2g} spacings, and {SHALLOWEST:g} are needed"
        raise LabError(f"{key}: this body floats {show(deep, 'm')} deep, {least}; take smaller particles.")
