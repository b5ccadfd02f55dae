"""Checks of the bodies in a preset that float: what they can be in, and whether particles can carry them."""

import numpy as np

from lab.base.errors import LabError
from lab.preset.sections.bodies.floating import draught
from lab.preset.sections.bodies.hulls import depths_of
from lab.preset.sections.parts import PartGroup
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
        if preset.grains is not None and preset.grains.room is None and part.tank is None:
            raise LabError(f"{said}: a body does not float among grains; leave out [grains] or this.")
        if preset.grains is None or not is_in(preset.grains.room, name):  # else the grains' weight counts, too
            check_draught(preset, part, said)


def check_draught(preset: Wet, part: PartGroup, key: str, cargo: float = 0.0) -> None:
    """Raise LabError for a hull that sinks, and for a body that floats on too few particles, upright as it is drawn.

    With it floats a `cargo` (kg).
    """
    spacing = preset.liquid.spacing
    mass = part.solved(0, preset.thickness).free.mass + cargo
    deep = draught(part, mass / preset.water.density, preset.thickness)
    if deep == np.inf and part.wall is not None:
        laden = f" with {cargo:.4g} kg of grains" if cargo else ""
        raise LabError(f"{key}: this hull{laden} is heavier than the water that it can displace; make it lighter.")
    if deep < SHALLOWEST * spacing:
        least = f"{deep / spacing:.2g} spacings, and {SHALLOWEST:g} are needed"
        raise LabError(f"{key}: this body floats {show(deep, 'm')} deep, {least}; take smaller particles.")


def is_in(room: str | None, name: str) -> bool:
    """Whether a room, by the names of its hull and its own, is in the hull of a name."""
    return room is not None and room.rpartition(".")[0] == name


def check_hold(preset: Wet) -> None:
    """Raise LabError if the grains cannot be in the room of a hull that they are said to be in."""
    grains = preset.grains
    if grains is None or grains.room is None:
        return
    if grains.room not in preset.rooms:
        there = f"the rooms are {', '.join(preset.rooms)}" if preset.rooms else "no part has a wall and rooms"
        raise LabError(f'grains.room: is {grains.room!r}, and {there}; name one of a hull, as "HULL.ROOM".')
    name, _, room = grains.room.rpartition(".")
    part = preset.parts[name]
    if not part.floats:
        raise LabError(f"grains.room: {name} does not float; give parts.{name}.density, or the grains a [tank].")
    if depths_of(part)[room] > 0.0:
        remedy = "leave it out, and let water in by an opening"
        raise LabError(f"parts.{name}.rooms.{room}.depth: grains in a hull are dry at first; {remedy}.")
    if preset.tank.roughness is not None:
        raise LabError("tank.roughness: lines the tank, and the grains are in a hull; leave it out.")
    if preset.motion.parts:
        raise LabError(
            "grains.room: the tank in which the hull floats must be at rest; leave out [motion], and for waves let a "
            "part move."
        )
    if preset.run.integrator != "verlet":
        raise LabError('run.integrator: grains in a hull move by "verlet" alone; leave it out.')
