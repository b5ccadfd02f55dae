"""What the bulk of a preset must agree with: its tanks, its own keys, and what it cannot be together with."""

from typing import Protocol

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import area
from lab.preset.sections.bulk.beds import Bed, beds_of
from lab.preset.sections.bulk.beds import Filled as Bedded
from lab.preset.sections.bulk.section import Bulk
from lab.preset.units import show

LEAST_CELLS = 2.0  # in the depth of a layer
LEAST_ACROSS = 4.0  # across a hopper
MOST_CELLS = 400_000  # in all tanks
THE_TANK = "the tank"  # what the first one is called


class Filled(Bedded, Protocol):
    """The sections of a preset that its bulk must agree with."""

    grains: object | None
    water: object | None
    parts: dict[str, object]
    axle: object | None
    axes: int


def check_bulk(preset: Filled) -> None:
    """Raise LabError for keys of the bulk that contradict each other, and for what it cannot do."""
    bulk, tank = preset.bulk, preset.tank
    if bulk is None:
        return
    _check_company(preset)
    if (bulk.depth is None) == (bulk.region is None):
        raise LabError("bulk.depth: give either a depth or a region of the bulk.")
    if (bulk.repose is None) == (bulk.friction is None):
        raise LabError("bulk.repose: give either an angle of repose or a friction of the bulk.")
    _check_friction(bulk)
    corners = np.array(tank.corners)
    if bulk.region is not None:
        _check_region(bulk, corners)
    elif bulk.depth >= float(np.ptp(corners[:, 1])):
        raise LabError(f"bulk.depth: the tank is {show(float(np.ptp(corners[:, 1])), 'm')} high; fill it less.")
    beds = beds_of(preset)
    for bed in beds:
        _check_cells(bulk, bed, THE_TANK if bed is beds[0] else f"tanks.{bed.name}")
    cells = sum(np.prod(np.ptp(bed.corners, axis=0)) / _cell(bulk, bed) ** 2 for bed in beds)
    if cells > MOST_CELLS:
        there = THE_TANK if len(beds) == 1 else "all tanks"
        raise LabError(
            f"bulk.spacing: {there} would have {cells:.3g} cells, more than {MOST_CELLS:.0e}; make them wider."
        )


def _check_company(preset: Filled) -> None:
    """Raise LabError for what bulk cannot be together with."""
    others = {
        "grains": preset.grains is not None,
        "water": preset.water is not None,
        "parts": bool(preset.parts),
        "axle": preset.axle is not None,
    }
    for name, there in others.items():
        if there:
            raise LabError(f"bulk: goes with no [{name}] yet; leave one of the two out.")
    if preset.axes > 2:
        raise LabError("bulk: is plane only; leave tank.along, tank.turned and tank.mesh out.")
    if not preset.tank.lid:
        raise LabError("tank.lid: bulk needs a closed tank; leave this out.")
    for name, further in preset.tanks.items():
        if not further.lid:
            raise LabError(f"tanks.{name}.lid: bulk needs a closed tank; leave this out.")
        if further.depth is None:
            raise LabError(
                f"tanks.{name}.depth: missing; say how deep the bulk is in it, or leave the whole tank out, which "
                "would be empty."
            )


def _check_friction(bulk: Bulk) -> None:
    if bulk.rough and bulk.wall_friction is not None:
        raise LabError("bulk.rough: along rough walls nothing slides; leave bulk.wall_friction out, or this.")
    if bulk.wall_friction is not None and bulk.wall_friction > bulk.slow_friction * (1.0 + 1e-9):
        raise LabError(
            f"bulk.wall_friction: {bulk.wall_friction:.3g} is more than the bed's own {bulk.slow_friction:.3g}, so "
            "it would slide within itself first; lower it, or set bulk.rough = true."
        )
    if bulk.start_friction is not None and bulk.start_friction < bulk.slow_friction:
        raise LabError(
            f"bulk.start_friction: is less than the {bulk.slow_friction:.3g} of a bed that slides; raise it, or leave "
            "this out."
        )
    if bulk.fast_friction is not None and bulk.fast_friction < bulk.slow_friction:
        raise LabError(
            f"bulk.fast_friction: is less than the {bulk.slow_friction:.3g} of slow flow; raise it, or set "
            'bulk.law = "constant".'
        )


def _check_region(bulk: Bulk, corners: np.ndarray) -> None:
    """Raise LabError for a region that is not in the tank."""
    try:
        region = np.array(bulk.place)
    except LabError as error:
        raise LabError(f"bulk.region: {error}") from None
    slack = 1e-6 * float(np.ptp(corners, axis=0).max())
    outside = (region < corners.min(axis=0) - slack).any() or (region > corners.max(axis=0) + slack).any()
    if outside or area([tuple(one) for one in region]) <= 0.0:
        raise LabError("bulk.region: reaches out of the tank; move its corners into the tank.")


def _cell(bulk: Bulk, bed: Bed) -> float:
    """The width (m) of a cell in the tank of a bed."""
    wide = float(np.ptp(bed.corners[:, 0]))
    return wide / max(1, round(wide / bulk.spacing))


def _check_cells(bulk: Bulk, bed: Bed, tank: str) -> None:
    """Raise LabError for cells that are too wide for the layer or the hopper of a tank, as it is called."""
    cell, high, what = _cell(bulk, bed), bed.high, "the bed" if tank == THE_TANK else f"the bed in {tank}"
    if high < LEAST_CELLS * cell:
        raise LabError(
            f"bulk.spacing: {what} is {show(high, 'm')} deep, less than {LEAST_CELLS:g} cells of {show(cell, 'm')}; "
            f"make cells of {show(high / LEAST_CELLS, 'm')} at most."
        )
    across = _width_at(bed.corners, float(bed.corners[:, 1].min()) + LEAST_CELLS * cell)
    if across < LEAST_ACROSS * cell * (1.0 - 1e-9):
        raise LabError(
            f"bulk.spacing: two cells above its floor {tank} is {show(across, 'm')} wide, less than "
            f"{LEAST_ACROSS:g} cells of {show(cell, 'm')}; make cells of {show(across / LEAST_ACROSS, 'm')} at most."
        )


def _width_at(corners: np.ndarray, height: float) -> float:
    """The width (m) of a polygon at a height (m): what lies inside it on a level line."""
    z, y = corners[:, 1], corners[:, 0]
    ahead = np.roll(np.arange(len(corners)), -1)
    passes = (z > height) != (z[ahead] > height)
    share = (height - z[passes]) / (z[ahead][passes] - z[passes])
    places = np.sort(y[passes] + share * (y[ahead][passes] - y[passes]))
    return float((places[1::2] - places[::2]).sum())
