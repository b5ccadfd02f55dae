"""What `explain` and a run's summary say of bulk."""

import math
from collections.abc import Iterator

from lab.base.text import inline
from lab.preset.schema import Preset
from lab.preset.sections.bulk.beds import beds_of
from lab.preset.units import show
from lab.recording import Recording
from solvers.bulk.given import Bulk

# What a continuum of grains cannot do
CANNOT = (
    "It cannot jam, arch or segregate, and it starts and stops at one angle, where grains start some degrees later and "
    "run on. Layers under two cells are not resolved; loose beds do not compact, dense ones do not dilate."
)
# How far it is from beds of grains (docs/physics/bulk-beside-grains.md)
BESIDE = (
    "shifts within 8 % of those of 120 across in rolls of the box that its friction was found in, a sixth short in a "
    "hold with hoppers, half in sway of half of g, in a twentieth of the time; 30 across lack a half; a wedge that "
    "lies at ship.repose costs nothing"
)
POINT_STEPS_PER_CORE = 6e6  # a second of one core (AMD EPYC, Zen 3)


def described(preset: Preset, scene) -> list[tuple[str, str]]:
    """The rows on the bulk of a preset; none without."""
    bulk: Bulk | None = scene.of(Bulk)
    if bulk is None:
        return []
    material, grid = bulk.material, bulk.grid
    angle = math.degrees(math.atan(material.friction))
    law = "whatever the speed" if preset.bulk.law == "constant" else f"{material.fast_friction:.3g} in very fast flow"
    cell = show(grid.smallest, "m")
    walls = "held fast by rough ones" if preset.bulk.rough else f"{material.wall_friction:.3g}"
    return [
        ("bed", f"{show(preset.bulk.density, 'kg/m^3')}, {bulk.count} points, four a cell of {cell}"),
        *_tanks(preset, bulk),
        ("friction", f"{material.friction:.3g}, a slope of {angle:.1f} deg; {law}"),
        ("at walls", walls),
        (
            "stiffness",
            f"{show(material.young, 'Pa')}, {preset.bulk.stiffness:g} times the bottom's stress; "
            "16 times as stiff shifts 1 to 3 % less",
        ),
        (
            "stands for",
            f"grains of {show(preset.bulk.diameter, 'm')}, {_grains(preset, bulk)} of them a metre of length",
        ),
        ("cannot", CANNOT),
        ("beside grains", BESIDE),
    ]


def _tanks(preset: Preset, bulk: Bulk) -> list[tuple[str, str]]:
    """A row on each of several tanks; none of one alone."""
    beds = beds_of(preset) if preset.tanks else ()
    return [
        (f"in {bed.name}", f"{show(bed.high, 'm')} deep, {bed.area:.4g} m^2, {count} points")
        for bed, count in zip(beds, bulk.fill if beds else (), strict=True)
    ]


def _grains(preset: Preset, bulk: Bulk) -> str:
    """How many grains a metre of it has."""
    volume = bulk.mass / bulk.material.density * preset.bulk.packing
    return f"{volume / (math.pi / 6.0 * preset.bulk.diameter**3):.1g}"


def in_tank(recording: Recording) -> Iterator[str]:
    """What was in the tank."""
    bulk = recording.preset.bulk
    count = recording.bulk_volume.shape[1]
    angle = math.degrees(math.atan(bulk.slow_friction))
    bed = f"bulk of {show(bulk.density, 'kg/m^3')} as a continuum"
    yield f"{bed}, {count} material points in cells of {_cell(recording)}"
    if recording.preset.tanks:
        beds = (f"{bed.name} {show(bed.high, 'm')} deep" for bed in beds_of(recording.preset))
        yield f"in {1 + len(recording.preset.tanks)} tanks: {inline(', '.join(beds))}"
    yield f"friction {bulk.slow_friction:.3g}, a slope of {angle:.1f} deg; at walls " + (
        "held fast" if bulk.rough else f"{bulk.along_walls:.3g}"
    )


def _cell(recording: Recording) -> str:
    """The width of a cell."""
    width = float(recording.outline[:, 0].max() - recording.outline[:, 0].min())
    return show(width / max(1, round(width / recording.preset.bulk.spacing)), "m")


def cautions(recording: Recording) -> Iterator[str]:
    """What a reader must know about the run and cannot see from the numbers."""
    yield f"Bulk is a continuum. {CANNOT}"
