"""Consistency checks of the gauges in a preset's water; each error is one sentence that names the key."""

from collections.abc import Mapping

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import Point
from lab.preset.sections.tank import Tank
from lab.preset.sections.water.section import Gauge
from lab.preset.units import needed, show
from solvers.fluid.walls.faces import spot_on

MOST_GAUGES = 100
NEAR = 1e-3  # of the tank's larger side: how far a gauge may be from the wall that it is in


def check_gauges(gauges: Mapping[str, Gauge], tank: Tank) -> None:
    """Raise LabError for a gauge that is not where it can measure, or has keys of another kind."""
    if len(gauges) > MOST_GAUGES:
        raise LabError(f"gauges: at most {MOST_GAUGES} are possible (got {len(gauges)}).")
    check = check_in_space if tank.solid else _check_in_plane
    for name, gauge in gauges.items():
        check(f"gauges.{name}", gauge, tank)


def check_in_space(key: str, gauge: Gauge, tank: Tank) -> None:
    """Raise LabError for a gauge that does not lie in one face of a prism, or above its floor."""
    half = tank.solid.half(np.array(tank.corners))
    if gauge.kind == "force":
        raise LabError(f"{key}.kind: in space forces on all faces are told without a gauge; leave this gauge out.")
    if gauge.x is None:
        raise LabError(f"{key}.x: missing for a gauge in space; {needed('m')}.")
    if abs(gauge.x) > half * (1.0 + NEAR):
        ends = f"{show(-half, 'm')} to {show(half, 'm')}"
        raise LabError(f"{key}.x: {show(gauge.x, 'm')} is outside of the tank, which reaches from {ends}.")
    if gauge.length:
        raise LabError(f"{key}.length: in space a pressure gauge is a disc; give its radius in place of this.")
    if gauge.kind == "level":
        _check_level(key, gauge, tank)
    else:
        _check_disc(key, gauge, tank, half)


def _check_disc(key: str, gauge: Gauge, tank: Tank, half: float) -> None:
    """Raise LabError for a gauge of pressure that does not lie in one face of a prism from −`half` to `half` (m)."""
    _check_keys(key, gauge)
    place = np.array([*gauge.place, gauge.x])
    spot = spot_on(place, np.array(tank.corners), half, not tank.periodic, tank.open_edges)
    left = NEAR * max(*tank.extent, 2.0 * half)
    if spot.away > left:
        raise LabError(
            f"{key}.place: {place_of(place)} at x = {show(gauge.x, 'm')} is {show(spot.away, 'm')} away from the "
            f"tank's walls; the nearest point on one is {place_of(spot.foot)} at x = {show(float(spot.foot[2]), 'm')}."
        )
    if gauge.radius > spot.room + left:
        raise LabError(
            f"{key}.radius: {show(gauge.radius, 'm')} reaches past the edge of its face, which is "
            f"{show(spot.room, 'm')} away; take a smaller radius, or move the gauge."
        )


def _check_in_plane(key: str, gauge: Gauge, tank: Tank) -> None:
    """Raise LabError for a gauge in the plane."""
    for name in ("x", "radius"):
        if getattr(gauge, name):
            raise LabError(f"{key}.{name}: a gauge has this in space alone; give tank.along, or leave this out.")
    (_check_level if gauge.kind == "level" else _check_pressure)(key, gauge, tank)


def _check_pressure(key: str, gauge: Gauge, tank: Tank) -> None:
    """Raise LabError for a gauge of pressure or force that does not lie in one wall."""
    _check_keys(key, gauge)
    for name, given in (("length", gauge.length), ("response", gauge.response)):
        if given and gauge.kind == "force":
            raise LabError(f'{key}.{name}: goes with kind = "pressure"; a force gauge is a whole edge.')
    place, nearest, left = np.array(gauge.place), _nearest(gauge.place, tank), NEAR * max(tank.extent)
    away = float(np.hypot(*(nearest[0] - place)))
    if away > left:
        raise LabError(
            f"{key}.place: {place_of(place)} is {show(away, 'm')} away from the tank's walls; the nearest point on one "
            f"is {place_of(nearest[0])}."
        )
    if 0.5 * gauge.length > nearest[1] + left:
        raise LabError(f"{key}.length: {show(gauge.length, 'm')} reaches past the end of its wall.")


def _check_keys(key: str, gauge: Gauge) -> None:
    """Raise LabError for a gauge of pressure or force without a place, or with one of a level gauge."""
    if gauge.place is None:
        what = f'missing for a {gauge.kind} gauge; give y and z on a wall, e.g. ["0 mm", "10 mm"]'
        raise LabError(f"{key}.place: {what}.")
    if gauge.y is not None:
        raise LabError(f'{key}.y: goes with kind = "level"; a {gauge.kind} gauge has a place.')


def _nearest(place: Point, tank: Tank) -> tuple[np.ndarray, float]:
    """The point (m) on a wall that is nearest to a place, and its distance (m) from the nearer end of that wall."""
    corners = np.array(tank.corners)
    walls = [k for k in range(len(corners)) if k not in tank.open_edges]
    begin, along = corners[walls], (np.roll(corners, -1, axis=0) - corners)[walls]
    length = np.hypot(*along.T)
    share = np.clip(((np.array(place) - begin) * along).sum(axis=1) / length**2, 0.0, 1.0)
    points = begin + share[:, None] * along
    k = int(np.hypot(*(points - place).T).argmin())
    return points[k], float(length[k] * min(share[k], 1.0 - share[k]))


def _check_level(key: str, gauge: Gauge, tank: Tank) -> None:
    """Raise LabError for a level gauge beside the tank, or with keys of a pressure gauge."""
    given = {name: getattr(gauge, name) for name in ("place", "length", "radius", "response")}
    has = "y and x" if tank.solid else "y"
    for name in (name for name, value in given.items() if value):
        raise LabError(f'{key}.{name}: goes with kind = "pressure"; a level gauge has {has} alone.')
    if gauge.y is None:
        raise LabError(f"{key}.y: missing for a level gauge; {needed('m')}.")
    sides = [y for y, _ in tank.corners]
    if not min(sides) <= gauge.y <= max(sides):
        ends = f"{show(min(sides), 'm')} to {show(max(sides), 'm')}"
        raise LabError(f"{key}.y: {show(gauge.y, 'm')} is outside of the tank, which reaches from {ends}.")


def place_of(point: np.ndarray) -> str:
    """A place (m) as a preset has it."""
    return f"[{', '.join(show(float(one), 'm') for one in point[:2])}]"
