"""How stable a ship is in calm water: her righting levers, and the heels at which her deck and openings go under.

deck_immersion_angle, downflooding_angle: the heel at which the edge of her deck, and an opening, meet the still
waterline at constant displacement (`solvers.ship.openings`), her cargo as it lay at the start. They follow from the
preset, so they are without error.
"""

from collections.abc import Mapping

import numpy as np

from lab.assembly.ship import flooding_angles
from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, mark
from lab.measures.loose import is_loose, mass_aboard
from lab.measures.ship import has_ship, vessel_of
from lab.measures.value import Value, over_worlds
from lab.preset.schema import Preset
from lab.preset.sections.bulk.beds import beds_of
from lab.preset.sections.water.tanks import outline_of
from lab.recording import Recording
from solvers.fluid.start.packing import below
from solvers.machine.errors import Unavailable
from solvers.ship.cargo import filling_centre, level_area, relaxed_levers
from solvers.ship.hydrostatics import Loading, righting_lever, righting_levers
from solvers.ship.section import Section
from solvers.ship.vessel import Vessel
from solvers.tank.outline import moments

HEELS = 91  # of the curve of righting levers
ANGLES = {  # how they are drawn
    "deck_immersion_angle": {"color": GREEN, "ls": "--"},
    "downflooding_angle": {"color": VERMILION, "ls": "-"},
}


def applies(recording: Recording) -> bool:
    """There is a ship that can be built from the preset."""
    return has_ship(recording) and vessel_of(recording.path) is not None


def measure(recording: Recording) -> dict[str, Value]:
    """deck_immersion_angle and downflooding_angle (deg), of a ship that has a deck or openings."""
    angles = flooding_angles(recording.preset.ship, vessel_of(recording.path))
    return {name: over_worlds([np.degrees(angle)], "deg") for name, angle in angles.items() if angle is not None}


def levers(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
    """Heels (n,) rad and righting levers (n,) m, with the cargo frozen and with the cargo slid to its repose.

    The cargo that slides lies at its angle of repose at each heel (`solvers.ship.cargo`). It is a level filling whose
    centre is as high as that of the bed at the start; None where that is not known, and without cargo.
    """
    vessel = vessel_of(recording.path)
    load, loading = vessel.ship.load, vessel.ship.body.loading
    heel = np.radians(np.linspace(0.0, 180.0, HEELS))
    frozen = righting_levers(load.section, loading, load.water, heel)
    if not recording.preset.matters:
        return heel, frozen, None
    if not is_loose(recording):
        return heel, frozen, _with_level_water(recording.preset, vessel, heel)
    repose = recording.preset.ship.repose
    try:
        relaxed = relaxed_levers(load.section, loading, load.water, heel, _fillings(recording), repose)
    except Unavailable:
        return heel, frozen, None
    return heel, frozen, relaxed


def _fillings(recording: Recording) -> list[tuple[Section, float, float]]:
    """The holds of loose cargo, each with its area (m²) and mass (kg a metre of the ship). Raises Unavailable."""
    preset = recording.preset
    if preset.bulk and preset.tanks:
        share = preset.bulk.density / (preset.ship.length or 1.0)
        return [(Section(bed.corners), bed.area, share * bed.area * bed.along) for bed in beds_of(preset)]
    hold, height = Section(recording.outline), float(recording.series["centre_of_mass"][0, :, 1].mean())
    return [(hold, level_area(hold, height), float(mass_aboard(recording).mean()))]


def _with_level_water(preset: Preset, vessel: Vessel, heels: np.ndarray) -> np.ndarray | None:
    """Righting levers (n,) m with the water in all tanks level; None where she does not float."""
    load, loading = vessel.ship.load, vessel.ship.body.loading
    moved, tanks = np.zeros((len(heels), 2)), [preset.tank, *preset.tanks.values()]
    outlines = [np.array(preset.tank.corners), *(outline_of(preset, tank) for tank in preset.tanks.values())]
    try:
        for pool in (one for one in preset.pools if one.depth):  # a room may be empty at first
            along = tanks[pool.number].length
            share = along / preset.ship.length if along else 1.0
            hold, area = Section(outlines[pool.number]), moments(below(pool.polygon, pool.level))[0]
            upright = filling_centre(hold, area, 0.0)
            shifts = [filling_centre(hold, area, heel) - upright for heel in heels]
            moved += share * preset.water.density * area / loading.mass * np.array(shifts)
        centres = np.add(loading.centre, moved).tolist()
        return np.array(
            [
                righting_lever(load.section, Loading(loading.mass, tuple(centre)), load.water, heel)
                for centre, heel in zip(centres, heels, strict=True)
            ]
        )
    except Unavailable:
        return None


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Righting lever of a ship against her heel, her cargo frozen as it lay at the start, or slid to repose.

    Upright lines: where the edge of her deck, and an opening, meet the still waterline at constant displacement.
    """
    ((axes,),) = sheet.panels()
    heel, lever, relaxed = levers(recording)
    axes.plot(np.degrees(heel), 1e3 * lever, color=GREY, label="cargo frozen" if recording.preset.matters else "empty")
    if relaxed is not None:
        label = f"cargo slid to a repose of {np.degrees(recording.preset.ship.repose):.3g} deg"
        if not is_loose(recording):
            label = "water level in the tanks"
        axes.plot(np.degrees(heel), 1e3 * relaxed, color=BLUE, label=label)
    axes.axhline(0, color=GREY, lw=0.8)
    mark(sheet, axes, values.get("largest_roll"), "largest roll of the run", GREY, ":")
    for name, style in ANGLES.items():
        if name in values:
            axes.axvline(
                values[name].value, lw=1.0, label=f"{name.replace('_', ' ')} {values[name].value:.1f} deg", **style
            )
    axes.set_xlim(0, 180)
    axes.set_xticks(range(0, 181, 30))
    axes.set_xlabel("heel (deg)")
    axes.set_ylabel("righting lever GZ (mm)")


FIGURES = {"lever": draw}
