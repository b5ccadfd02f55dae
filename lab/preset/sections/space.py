"""Scenes in space: what of a preset goes with a tank that is drawn out along x, and what is of the plane alone."""

from collections.abc import Iterator

from lab.base.errors import LabError
from lab.preset.units import show

PLANE_ALONE = {
    "water": "water is computed in the plane alone",
    "ship": "a ship's holds are computed in the plane alone",
    "axle": "a tank on an axle is computed in the plane alone",
    "shapes": "irregular grains are computed in the plane alone",
}
INTEGRATORS = "verlet", "symplectic-euler"


def check_space(preset) -> None:
    """Raise LabError, one sentence, for a key of the plane alone in a preset (`lab.preset.schema.Preset`) in space."""
    if preset.tank.along is None:
        return
    for key, fault in _faults(preset):
        raise LabError(f"{key}: {fault}.")


def _faults(preset) -> Iterator[tuple[str, str]]:
    """The keys at fault, and why."""
    tank, grains = preset.tank, preset.grains
    for key, reason in PLANE_ALONE.items():
        if getattr(preset, key):
            yield key, f"{reason}; leave this out, or tank.along"
    for key in ("thickness", "roughness", "length"):
        if getattr(tank, key) is not None:
            why = "the tank is as thick as it is long" if key == "thickness" else "this is of the plane alone"
            yield f"tank.{key}", f"{why} where tank.along is given; leave this out"
    if preset.run.integrator not in INTEGRATORS:
        yield "run.integrator", f"in space it is {' or '.join(INTEGRATORS)} (got {preset.run.integrator})"
    if grains is None:
        return
    if grains.bed is not None:
        yield "grains.bed", "a list of grains is of the plane alone; give count or depth, or leave out tank.along"
    if grains.surface == "undisturbed":
        yield "grains.surface", "a bed is levelled in the plane alone; take slightly-disturbed or disturbed"
    if preset.diameters[1] >= tank.along:
        largest, along = show(preset.diameters[1], "m"), show(tank.along, "m")
        yield "tank.along", f"grains of up to {largest} do not fit into a tank {along} long; make it longer"
