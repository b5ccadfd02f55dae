"""Scenes in space: what goes with a tank that is drawn out along x or turned, and what is of the plane alone."""

from collections.abc import Iterator, Sequence

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import Point
from lab.preset.sections.bodies.in_space import IN_SPACE as OF_BODIES
from lab.preset.sections.bodies.in_space import shape_of
from lab.preset.sections.history import Record
from lab.preset.sections.motion import Motion
from lab.preset.units import show
from solvers.motion import IN_SPACE
from solvers.motion.frame import OF_SPACE

PLANE_ALONE = {
    "axle": "a tank on an axle is computed in the plane alone",
    "shapes": "irregular grains are computed in the plane alone",
}
INTEGRATORS = "verlet", "symplectic-euler"
SHORTEST = 5.0  # diameters of a slice: a grain must not meet two images of another
LEAST_LONG = 2.0  # reaches of a kernel: a particle must not meet two images of another, nor feel both end walls
EVEN = 1e-9  # of the section's width: by how much its two sides may differ


def check_space(preset) -> None:
    """Raise LabError, one sentence, for a key of the plane alone in a preset (`lab.preset.schema.Preset`) in space."""
    if preset.tank.periodic and not preset.tank.along:
        raise LabError("tank.periodic: goes with the length of a slice; give tank.along, or leave this out.")
    if preset.tank.unit and not preset.tank.mesh:
        raise LabError("tank.unit: goes with the file of a mesh; give tank.mesh, or leave this out.")
    for name, part in preset.parts.items():
        for column in _columns_in_space(part.history):
            raise LabError(f"parts.{name}.history.file: a part has no {column} of its own; leave out that column.")
    if preset.tank.solid is None:
        if preset.contact.twisting != "none":
            raise LabError("contact.twisting: grains twist in space alone; give tank.along, or leave this out.")
        for key in _in_space(preset.motion):
            raise LabError(f"{key}: a tank moves so in space alone; give tank.along, or leave this out.")
        for key in _bodies_in_space(preset):
            raise LabError(f"{key}: this body is of a tank in space; give tank.along, or leave this out.")
        return
    for key, fault in _faults(preset):
        raise LabError(f"{key}: {fault}.")


def _faults(preset) -> Iterator[tuple[str, str]]:
    """The keys at fault, and why."""
    tank, grains = preset.tank, preset.grains
    key_of_space = next(f"tank.{key}" for key in ("mesh", "along", "turned") if getattr(tank, key))
    if tank.along and tank.turned and not (tank.lies or tank.mesh):
        remedy = 'leave this out, or tank.along, or set it to "x" for one that lies'
        yield "tank.turned", f"a tank is either turned about its axis or drawn out; {remedy}"
    for key, reason in PLANE_ALONE.items():
        if getattr(preset, key):
            yield key, f"{reason}; leave this out, or {key_of_space}"
    if preset.water:
        yield from _faults_of_water(preset, key_of_space)
    else:
        for key in _bodies_in_space(preset):
            yield key, "grains meet parts that are as long as the tank; leave this out"
    if preset.ship and tank.turned:
        yield "tank.turned", "a ship's hold is drawn out along her; give tank.along in its place"
    longest = tank.length or (preset.ship.length if preset.ship else None)
    if tank.along and longest and tank.along > longest:
        yield "tank.along", f"is longer than her hold, {show(longest, 'm')}; make it shorter"
    if preset.tanks:
        yield "tanks", "a ship has no further tanks in space; leave these out, or tank.along"
    for key in ("thickness", "roughness"):
        if getattr(tank, key) is not None:
            yield f"tank.{key}", f"this is of the plane alone; leave this out, or {key_of_space}"
    if tank.periodic:
        for key in _in_space(preset.motion):
            yield key, "a slice of a tank without an end moves in the plane; leave this out, or tank.periodic"
    if tank.mesh:
        yield from _faults_of_mesh(preset)
    elif tank.lies:
        yield from _faults_of_lying(preset)
    elif tank.turned:
        yield from _faults_of_turned(preset)
    if preset.run.integrator not in INTEGRATORS:
        yield "run.integrator", f"in space it is {' or '.join(INTEGRATORS)} (got {preset.run.integrator})"
    if grains is None:
        return
    if grains.bed is not None and "x" not in grains.listed.columns:
        yield "grains.bed", f"in space it has a column x, too; add it, or leave out {key_of_space}"
    if grains.surface == "undisturbed":
        yield "grains.surface", "a bed is levelled in the plane alone; take slightly-disturbed or disturbed"
    largest = preset.diameters[1]
    if tank.along and tank.along <= largest * (SHORTEST if tank.periodic else 1.0):
        least = f"{SHORTEST:g} of the largest grains, " if tank.periodic else "one grain, "
        yield "tank.along", f"must be more than {least}{show(largest, 'm')} each (got {show(tank.along, 'm')})"


def _faults_of_water(preset, key_of_space: str) -> Iterator[tuple[str, str]]:
    """The keys at fault where there is water in space, and why."""
    water, tank = preset.water, preset.tank
    if not tank.along or tank.turned:
        yield "water", f"water in space fills a tank that is drawn out; give tank.along in place of {key_of_space}"
    elif preset.pools and tank.along < (least := LEAST_LONG * preset.liquid.reach):
        yield (
            "tank.along",
            f"must be {show(least, 'm')} or more, two reaches of the water's kernel; or take finer water",
        )
    beside = {name: bool(getattr(preset, name)) for name in ("grains", "air", "ship", "damping", "inflow")}
    for name in (name for name, there in beside.items() if there):
        yield name, f"in space water is alone in its tank so far; leave this out, or {key_of_space}"
    if preset.bodies and not is_convex(tank.corners):
        yield "tank.outline", "a body that floats in space touches a tank whose corners all point outwards; draw one so"
    for name, part in preset.parts.items():
        if part.radius is None and part.along is None:
            yield f"parts.{name}", "in space water has solid bodies alone in it; give its length along x, or its radius"
        elif (ends := shape_of(part).bounds)[0][2] < -0.5 * tank.along or ends[1][2] > 0.5 * tank.along:
            yield f"parts.{name}.x", "this body stands in an end wall of the tank; move it, or make the tank longer"
        for key in ("sieve", "tank"):
            if getattr(part, key):
                yield f"parts.{name}.{key}", "this is of the plane alone; leave this out"
    for name in ("region", "radius", "flow", "periodic", "between_walls"):
        if getattr(water, name):
            yield f"water.{name}", f"this is of the plane alone; leave this out, or {key_of_space}"


def _bodies_in_space(preset) -> Iterator[str]:
    """The keys of parts that the plane does not have."""
    yield from (f"parts.{n}.{key}" for n, part in preset.parts.items() for key in OF_BODIES if getattr(part, key))


def _in_space(motion: Motion) -> Iterator[str]:
    """The keys of motions that the plane does not have."""
    yield from (f"motion.{name}" for name in IN_SPACE if getattr(motion, name))
    for name, part in motion.own.items():
        parts = part.motions if hasattr(part, "motions") else {name: part}
        yield from (f"motion.{name}" for one in parts.values() if one.coordinate in OF_SPACE)
    yield from (f"motion.history.file: column {column}" for column in _columns_in_space(motion.history))


def _columns_in_space(record: Record | None) -> list[str]:
    """The columns of a recorded motion that the plane does not have."""
    return [name for name in record.file.columns if name in IN_SPACE] if record else []


def _faults_of_turned(preset) -> Iterator[tuple[str, str]]:
    """The keys at fault in a tank that is turned about the axis z, and why."""
    if not _is_even([preset.tank.corners]):
        yield "tank.outline", "a tank that is turned has the same section on both sides of y = 0"
    lines = [part.line for part in preset.parts.values()]
    for name, part in preset.parts.items():
        if part.moves or part.move[0]:
            yield f"parts.{name}", 'in a tank that is turned a part moves up or down; give move = ["0 mm", …] alone'
        if not _is_even(lines, part.line):
            yield f"parts.{name}.points", "in a tank that is turned each part has its like on the other side of y = 0"


def _faults_of_lying(preset) -> Iterator[tuple[str, str]]:
    """The keys at fault in a tank that is turned about the axis x, and why."""
    tank, long = preset.tank, float(np.ptp(preset.tank.solid.corners[:, 1]))
    if tank.outline and preset.grains is not None and long <= preset.diameters[1]:
        yield "tank.outline", f"its {show(long, 'm')} along x must be more than one grain"
    if tank.height is not None:
        yield "tank.height", "a tank that is turned about x is as high as it is wide; leave this out"
    if not _is_even([tank.profile]):
        yield "tank.outline", "a tank that is turned about x has the same section on both sides of y = 0"
    if tank.periodic:
        yield "tank.periodic", "a tank that is turned about x has end walls; leave this out"
    for name in preset.parts:
        yield f"parts.{name}", "no parts stand in a tank that is turned about x yet; leave this out, or take tank.along"


def _faults_of_mesh(preset) -> Iterator[tuple[str, str]]:
    """The keys at fault in a tank that is a mesh, and why."""
    for key in ("width", "height", "outline", "along", "turned", "periodic"):
        if getattr(preset.tank, key):
            yield f"tank.{key}", "a mesh says all of a tank's shape; leave this out, or tank.mesh"
    if not preset.tank.lid:
        yield "tank.lid", "a mesh that is open at the top has no lid; leave this out"
    for name in preset.parts:
        yield f"parts.{name}", "no parts stand in a tank that is a mesh yet; leave this out, or take tank.along"


def _is_even(lines: Sequence[Sequence[Point]], one: Sequence[Point] | None = None) -> bool:
    """Whether a line, the first if none is given, has its mirror image among these, whatever corner it begins with."""
    sought = np.array(sorted((-y, z) for y, z in (one or lines[0])))
    slack = EVEN * max(float(np.ptp(sought, axis=0).max()), 1e-300)
    found = (np.array(sorted(line)) for line in lines if len(line) == len(sought))
    return any(np.allclose(line, sought, rtol=0.0, atol=slack) for line in found)


def is_convex(corners: Sequence[Point]) -> bool:
    """Whether all corners of a polygon turn the same way."""
    way = np.roll(np.array(corners), -1, axis=0) - np.array(corners)
    after = np.roll(way, -1, axis=0)
    turn = way[:, 0] * after[:, 1] - way[:, 1] * after[:, 0]
    return bool((turn >= 0.0).all() or (turn <= 0.0).all())
