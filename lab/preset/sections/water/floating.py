"""Checks of the bodies in a preset that float: what they can be in, and whether particles can carry them."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.parts import PartGroup
from lab.preset.sections.water.liquid import Wet
from lab.preset.units import show
from solvers.tank.outline import area_below, moments

SHALLOWEST = 2.0  # spacings: the least draught of a body that particles carry
HALVINGS = 60


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
    """Raise LabError for a body that floats on too few particles, upright as it is drawn."""
    corners, spacing = np.array(part.points), preset.liquid.spacing
    area = abs(moments(corners)[0])
    under = part.solved(0, preset.thickness).free.mass / (preset.water.density * preset.thickness)
    if under >= area:
        return
    low, high = 0.0, float(np.ptp(corners[:, 1]))
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if abs(area_below(corners, middle)) < under else (low, middle)
    if high < SHALLOWEST * spacing:
        least = f"{high / spacing:.2g} spacings, and {SHALLOWEST:g} are needed"
        raise LabError(f"{key}: this body floats {show(high, 'm')} deep, {least}; take smaller particles.")
