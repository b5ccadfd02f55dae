"""All tanks of a preset: where they are in the plane, and the water in them."""

from dataclasses import dataclass

import numpy as np

from lab.base.errors import LabError
from lab.preset.outline import stands_out
from lab.preset.sections.tank import FurtherTank, check_tank
from lab.preset.sections.water.inflow import Tanked, check_inflow, rooms_with_inflow
from lab.preset.sections.wet.states import share_of, state
from lab.preset.units import show
from solvers.fluid.start.packing import area_of, below
from solvers.tank import tank as solved

MOST_TANKS = 20


@dataclass(frozen=True, eq=False)
class Pool:
    """The water of the tank of this `number`: the polygon (m, 2) m that it fills up to a `level` (m).

    More may enter one that is `open`, which may be empty at the start.
    """

    number: int
    polygon: np.ndarray
    level: float
    open: bool = False

    @property
    def depth(self) -> float:
        """Depth (m) of the water, or height of its region or drop."""
        return self.level - float(self.polygon[:, 1].min())

    @property
    def most(self) -> float:
        """Largest depth (m) that it may have."""
        return float(np.ptp(self.polygon[:, 1])) if self.open else self.depth

    def places(self, spacing: float) -> int:
        """How many particles, a `spacing` (m) apart, may still enter."""
        if not self.open:
            return 0
        filled = area_of(below(self.polygon, self.level)) if self.depth > 0.0 else 0.0
        return int((area_of(self.polygon) - filled) / spacing**2)


def pools(preset: Tanked) -> tuple[Pool, ...]:
    """The water of each tank that has some, in the axes of the first tank; the first tank's is first."""
    water, outline, found, entered = preset.water, np.array(preset.tank.corners), [], rooms_with_inflow(preset)
    if water is None:
        return ()
    if water.shape is not None:
        found.append(Pool(0, water.shape, float(water.shape[:, 1].max())))
    elif (deep := depth_of(preset)) is not None or 0 in entered:
        found.append(Pool(0, outline, float(outline[:, 1].min()) + (deep or 0.0), 0 in entered))
    for number, tank in enumerate(preset.tanks.values(), start=1):
        if tank.depth is not None or number in entered:
            outline = outline_of(preset, tank)
            level = float(outline[:, 1].min()) + (tank.depth or 0.0)
            found.append(Pool(number, outline, level, number in entered))
    return tuple(found)


def depth_of(preset: Tanked) -> float | None:
    """The depth (m) of the first tank's water: as given, or the one expected where its share of wet cargo is given."""
    wet = share_of(preset.water) and state(preset)
    return wet.level if wet else preset.water.depth


def outline_of(preset: Tanked, tank: FurtherTank) -> np.ndarray:
    """The outline (m, 2) m of a further tank in the axes of the first one."""
    return np.array(tank.corners) + np.subtract(tank.place, preset.ship.hold)


def outline_at(preset: Tanked, number: int) -> np.ndarray:
    """The outline (m, 2) m of the tank of a number in the axes of the first one."""
    return outline_of(preset, [*preset.tanks.values()][number - 1]) if number else np.array(preset.tank.corners)


def further_tanks(preset: Tanked, thickness: float) -> tuple[solved.Tank, ...]:
    """The further tanks as the solver takes them, of a `thickness` (m)."""
    return tuple(
        solved.Tank(outline_of(preset, tank), thickness, tank.open_edges, tank.length) for tank in preset.tanks.values()
    )


def check_tanks(preset: Tanked) -> None:
    """Raise LabError for further tanks without a ship, out of her hull, too long, or with water that does not fit."""
    if len(preset.tanks) >= MOST_TANKS:
        raise LabError(f"tanks: at most {MOST_TANKS - 1} further tanks are possible (got {len(preset.tanks)}).")
    ship = preset.ship
    if ship is None:
        if preset.tanks:
            raise LabError("tanks: go with a ship; add a table [ship], or leave them out.")
        check_inflow(preset)
        return
    for name, tank in preset.tanks.items():
        if tank.length and not ship.length:
            raise LabError(f"tanks.{name}.length: is a share of the ship's; give ship.length as well.")
        if tank.length and tank.length > ship.length:
            raise LabError(f"tanks.{name}.length: is more than the ship's, {show(ship.length, 'm')}.")
    for name, tank in preset.tanks.items():
        _check_further(preset, name, tank)
    check_inflow(preset)


def _check_further(preset: Tanked, name: str, tank: FurtherTank) -> None:
    """Raise LabError for a further tank."""
    key = f"tanks.{name}"
    try:
        check_tank(tank)
    except LabError as error:
        raise LabError(str(error).replace("tank.", f"{key}.", 1)) from None
    out = stands_out(np.array(tank.corners) + np.array(tank.place), preset.ship.corners)
    if out is not None:
        place = f"[{show(float(out[0]), 'm')}, {show(float(out[1]), 'm')}]"
        raise LabError(f"{key}.place: the tank stands out of the hull at {place}; move it, or change hull or tank.")
    if tank.depth is None:
        return
    if preset.water is None and preset.bulk is None:
        raise LabError(f"{key}.depth: goes with water or bulk; add a table [water] or [bulk], or leave this out.")
    if tank.depth >= tank.extent[1]:
        high = show(tank.extent[1], "m")
        raise LabError(f"{key}.depth: {show(tank.depth, 'm')} is not less than the tank's height, {high}.")
