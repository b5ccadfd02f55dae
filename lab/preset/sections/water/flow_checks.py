"""Consistency checks of water without weight, with a flow at first, or in periodic space; each error is a sentence."""

from typing import Protocol

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import depth_inside
from lab.preset.sections.axle import Axle
from lab.preset.sections.water import liquid
from lab.preset.units import show

WHOLE = 1e-6  # of a spacing, by which a periodic side may miss a whole number of them


class Whole(liquid.Wet, Protocol):
    """Those sections, and the ones that cannot be there beside such water."""

    grains: object | None
    ship: object | None
    axle: Axle | None


def check_weight(preset: Whole) -> None:
    """Raise LabError for a run without gravity of what is not grains alone, or water alone."""
    if preset.run.gravity:
        return
    for name in ("ship", "axle", "air", *(["grains"] if preset.water is not None else [])):
        if getattr(preset, name) is not None:
            raise LabError(
                f"run.gravity: grains alone or water alone can be without weight; leave out [{name}], or give some "
                "gravity."
            )


def check_flow(preset: Whole) -> None:
    """Raise LabError for a flow that water cannot start with: with weight, against walls, or of two kinds."""
    flow = preset.water.flow
    if flow is None:
        return
    if preset.run.gravity:
        raise LabError('water.flow: goes with water without weight; set run.gravity = "0 m/s^2", or leave it out.')
    if preset.parts:
        raise LabError("water.flow: parts in water that flows at first are not computed yet; leave out either.")
    if flow.free and flow.vortices:
        raise LabError("water.flow: vortices fill a tank, and other flows are of free water; give one of them.")
    if flow.centre is not None and not flow.free:
        raise LabError("water.flow.centre: goes with strain, rotation or pull; give one of them, or leave it out.")
    if flow.vortices and preset.water.periodic != "yz":
        raise LabError('water.flow.vortices: they need a tank without walls; set water.periodic = "yz".')
    if flow.free:
        _check_clear(preset)


def _check_clear(preset: Whole) -> None:
    """Raise LabError for water that flows freely and is so near to a wall that it feels it."""
    if preset.water.periodic or preset.water.depth is not None:
        raise LabError(
            "water.flow: strain, rotation and pull are of water that is free on all sides; give water.radius or "
            "water.region, and leave out water.periodic."
        )
    reach, tank = preset.liquid.reach, np.array(preset.tank.corners)
    near = min(depth_inside(corner, tank) for corner in preset.water.shape)
    if near < reach:
        raise LabError(
            f"water.flow: the water is {show(max(near, 0.0), 'm')} from a wall, which it feels within "
            f"{show(reach, 'm')}; take a larger tank."
        )


def check_periodic(preset: Whole) -> None:
    """Raise LabError for periodic space that cannot be: with what needs the walls, or of sides that do not fit."""
    water, tank = preset.water, preset.tank
    if water.periodic is None:
        return
    for name in ("grains", "ship", "axle", "air"):
        if getattr(preset, name) is not None:
            raise LabError(f"water.periodic: goes with water alone; leave it or [{name}] out.")
    if preset.parts:
        raise LabError("water.periodic: parts in periodic space are not computed yet; leave out either.")
    if water.depth is None:
        raise LabError("water.periodic: goes with level water; give water.depth, or leave it out.")
    corners = np.array(tank.corners)
    if len(corners) != 4 or not (np.ptp(corners, axis=0) == np.abs(np.diff(corners[:3], axis=0)).max(axis=0)).all():
        raise LabError("water.periodic: only the sides of a rectangle repeat; give tank.width and tank.height.")
    if any(motion.coordinate == "turn" for motion in preset.motion.parts.values()):
        raise LabError("water.periodic: space that repeats itself cannot roll; leave out the roll, or this.")
    if "z" in water.periodic and not water.full:
        raise LabError(
            f'water.periodic: with "{water.periodic}" there is neither floor nor surface; set water.full = true with '
            "water.depth = tank.height."
        )
    _check_whole(preset)
    _check_walls(preset)


def _check_whole(preset: Whole) -> None:
    """Raise LabError unless the side along y is a whole number of spacings; the depth always is."""
    (width, _), spacing = preset.tank.extent, liquid.spacing(preset)
    count = round(width / spacing)
    if "y" in preset.water.periodic and abs(width - count * spacing) > WHOLE * spacing:
        raise LabError(
            f"water.periodic: the tank's width, {show(width, 'm')}, is no whole number of spacings of "
            f"{show(spacing, 'm')}; take a width of {show(max(count, 1) * spacing, 'm')}."
        )


def _check_walls(preset: Whole) -> None:
    """Raise LabError for a gauge in a wall that is none, or a depth that has no floor."""
    tank, periodic = np.array(preset.tank.corners), preset.water.periodic
    for name, gauge in preset.gauges.items():
        if gauge.kind == "level" and "z" in periodic:
            raise LabError(f"gauges.{name}: the tank has no floor (water.periodic); leave the gauge out.")
        if gauge.kind == "level":
            continue
        edge = int(liquid.edge_of(np.array([gauge.place]), tank)[0])
        upright = tank[edge, 0] == tank[(edge + 1) % 4, 0]
        if ("y" if upright else "z") in periodic:
            raise LabError(f"gauges.{name}.place: there is no wall on this side (water.periodic); move the gauge.")
