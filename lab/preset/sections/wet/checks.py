"""Consistency checks of grains in water; each error is one sentence that names the key."""

from typing import Protocol

from lab.base.errors import LabError
from lab.preset.kept.content import FIRST
from lab.preset.sections.contact import Contact
from lab.preset.sections.grains import Grains
from lab.preset.sections.ship import Ship
from lab.preset.sections.water import liquid
from lab.preset.sections.wet.states import SHARES, share_of, state
from lab.preset.units import show

COARSEST = 2.0  # grains' diameters: the least spacing of water, whose kernel then smooths over four of them
ROUNDED = 0.9  # what rounding to a whole number of rows over the depth may leave of that


class Whole(liquid.Wet, Protocol):
    """Those sections, and the ones that say something of wet cargo."""

    grains: Grains | None
    ship: Ship | None
    axes: int
    shapes: dict
    mean_diameter: float
    inflow: dict
    contact: Contact
    tanks: dict
    axle: object | None
    soaks: bool


def is_wet(preset: Whole) -> bool:
    """Whether grains and water are in one tank."""
    water, grains = preset.water, preset.grains
    if water is None or grains is None or grains.room is not None:
        return False
    given = any(getattr(water, name) is not None for name in ("depth", "region", "radius", *SHARES))
    return given or any(inlet.room == FIRST for inlet in preset.inflow.values())


def check_wet(preset: Whole) -> None:
    """Raise LabError for wet cargo that cannot be, and for keys of it where there is none."""
    water, grains = preset.water, preset.grains
    if preset.soaks:
        _check_company(preset, preset.grains.room)
        _check_sizes(preset)
        return
    if not is_wet(preset):
        if grains is not None and grains.true_size is not None:
            raise LabError("grains.true_size: goes with water in the grains' tank; add [water], or leave it out.")
        if water is not None and water.drag is not None:
            raise LabError("water.drag: goes with grains in the water; add [grains], or leave it out.")
        for name in (name for name, part in preset.parts.items() if part.sieve):
            raise LabError(f"parts.{name}.sieve: goes with grains in the water of their tank; leave it out.")
        return
    _check_company(preset)
    for name in ("region", "radius", "flow", "periodic"):
        if getattr(water, name) is not None:
            remedy = "give water.depth, moisture or saturation"
            raise LabError(f"water.{name}: water between grains starts level and at rest; {remedy}.")
    _check_sizes(preset)


def _check_sizes(preset: Whole) -> None:
    """Raise LabError for particles of water, a slab or a true size that do not suit the grains."""
    water, grains = preset.water, preset.grains
    asked = liquid.spacing(preset) if water.spacing == "auto" else water.spacing
    if liquid.spacing(preset) < ROUNDED * COARSEST * preset.mean_diameter:
        least = show(COARSEST * preset.mean_diameter, "m")
        raise LabError(
            f"water.spacing: {show(asked, 'm')} is under two grains' diameters; the water is a mean over many "
            f"grains: take at least {least}."
        )
    if preset.thickness < preset.mean_diameter * (1.0 - 1e-9):
        least = show(preset.mean_diameter, "m")
        raise LabError(
            f"tank.thickness: {show(preset.thickness, 'm')} is less than the grains' mean diameter; in water the slab "
            f"is a layer of whole grains: take at least {least}."
        )
    if grains.true_size is not None and grains.true_size > preset.mean_diameter * (1.0 + 1e-9):
        raise LabError(
            f"grains.true_size: {show(grains.true_size, 'm')} is more than the grains' own diameter, "
            f"{show(preset.mean_diameter, 'm')}; a computed grain stands for smaller ones: take less, or leave it out."
        )


def _check_company(preset: Whole, room: str | None = None) -> None:
    """Raise LabError for what cannot be together with grains in water, in the tank or in a `room` of a hull."""
    beside = {
        "ship.bare": (preset.ship is not None and preset.ship.bare, "in a ship whose centre is told without the water"),
        "axle": (preset.axle is not None, "in a tank on an axle"),
        "tank.along": (preset.axes > 2, "in space"),
        "tank.roughness": (preset.tank.roughness is not None, "over a rough lining"),
        "shapes": (bool(preset.shapes), "of irregular grains"),
        "air": (preset.air is not None, "with air"),
        "water.between_walls": (preset.water.between_walls, "with friction on the walls before and behind"),
        "water.full": (preset.water.full, "in a full tank"),
        "water.model": (preset.water.model != "sph", "in frozen, linear or level water"),
        "inflow": (bool(preset.inflow and share_of(preset.water)), "that are wet by a share and take in water, too,"),
        "tanks": (bool(preset.tanks), "beside further tanks"),
        "water.shifting": (preset.water.shifting != "none", "with shifted particles"),
    }
    if preset.contact.cohesion != "none":
        _check_bridges(preset, room)
    for name, part in preset.parts.items():
        if (not part.sieve or part.floats) if room is None else (part.tank == room and not part.sieve):
            raise LabError(
                f"parts.{name}: grains in water are not computed round what holds water back; set parts.{name}.sieve = "
                "true for a plate that holds grains alone, or leave it out."
            )
    for key, (there, what) in beside.items():
        if there:
            raise LabError(f"{key}: grains in water are not computed {what} yet; leave this out, or the water.")


def _check_bridges(preset: Whole, room: str | None) -> None:
    """Raise LabError for liquid bridges in a bed that has none: its pores are full from the start on."""
    wet = None if room else state(preset)
    if wet and wet.saturation >= 1.0:
        filled = f"{100.0 * wet.saturation:.3g} %"
        raise LabError(
            f"contact.cohesion: this water fills {filled} of the pores, so that no grain has bridges; leave this out, "
            "or take less water."
        )
