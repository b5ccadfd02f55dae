"""The sheet of criteria of a condition: with the shift that the codes assume, and with the cargo as it lay in a run."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from math import inf
from typing import Protocol

import numpy as np

from lab.naval.condition import Cargo, Condition
from solvers.ship.naval import grain_code, intact, trimming, weather
from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import TONNE

DIGITS = {"m": 3, "m rad": 4, "deg": 2, "1": 3}  # after the point

NO_PERIOD = "The weather criterion was not judged: without a positive GM she has no period of roll."
ASSUMED, AS_IT_LIES = "assumed shift", "as it lay farthest aside"


@dataclass(frozen=True)
class Row:
    """A criterion of a sheet, and with which shift of the cargo it was judged, "" where that does not matter.

    Where that shift is a run's, `told` is what its beds tell of the criterion, and `grounds` what they are.
    """

    shift: str
    criterion: Criterion
    told: str = ""
    grounds: str = ""

    @property
    def verdict(self) -> str:
        """ "pass" or "fail"; of a run that cannot tell, "cannot tell"."""
        return self.told or self.criterion.verdict


class Judged(Protocol):
    """What a ship is judged by: levers to a side, GM (m), angles (rad) of deck edge and flooding, wind, grain's arm."""

    side: str
    levers: Levers
    metacentric_height: float
    deck: float | None
    flooding: float | None
    exposed: weather.Exposed | None
    assumed: Callable[[np.ndarray], np.ndarray] | None


def rows(ship: Judged, lying: Callable[[np.ndarray], np.ndarray] | None = None) -> list[Row]:
    """All criteria that the ship can be judged by; `lying`: the heeling arm (m) of the cargo as it lay."""
    levers, height, ends, found = ship.levers, ship.metacentric_height, (ship.deck_edge_angle, ship.flooding), []
    for name, arm in arms(ship, lying).items():
        *shifted_so, least = grain_code.criteria(levers, arm, height, *ends)
        found += [Row(name, criterion) for criterion in shifted_so]
    if found:
        found.append(Row("", least))
    found += [Row("", criterion) for criterion in intact.criteria(levers, height, ship.flooding)]
    if ship.exposed is not None and height > 0.0:
        found += [Row("", criterion) for criterion in weather.criteria(levers, ship.exposed, *ends)]
    return found


def arms(ship: Judged, lying: Callable | None = None) -> dict[str, Callable[[np.ndarray], np.ndarray]]:
    """Heeling arms (m) of the cargo by name: with the assumed shift, and as it lay in a run."""
    found = {ASSUMED: ship.assumed, AS_IT_LIES: lying}
    return {name: arm for name, arm in found.items() if arm is not None}


def shifted(aside: float, up: float) -> Callable[[np.ndarray], np.ndarray]:
    """The heeling arm (m) of a centre of gravity that has moved (m) to the side that goes down and upwards.

    It is exact for cargo that lies still: G moves from (0, KG) to (aside, KG + up), so GZ loses aside cos φ + up sin φ.
    """
    return lambda heel: aside * np.cos(heel) + up * np.sin(heel)


def unjudged(condition: Condition) -> Iterator[str]:
    """What could not be judged and why, a sentence each."""
    if condition.exposed is None:
        yield "The weather criterion was not judged: give stability.wind_area and stability.wind_lever."
    if condition.exposed is not None and not condition.metacentric_height > 0.0:
        yield NO_PERIOD
    if condition.cargo is None:
        yield "The Grain Code was not judged: there is no grain, or the preset says no level of it (grains.depth)."
    if condition.cargo is not None and trimming.unevenness_limit(condition.repose, 1.0) is not None:
        angle = f"{np.degrees(condition.repose):.0f} deg of repose"
        yield f"A cargo of {angle} is no grain: the Grain Code's rows show what its shift would do, none is a rule."
    if condition.scale == 1.0 and condition.hydrostatics.breadth < 5.0:
        yield "A model's levers are judged as if a ship were so small; give ship.scale for those of the full scale."


def facts(condition: Condition) -> list[tuple[str, str]]:
    """The condition in rows of a name and a text."""
    h = condition.hydrostatics
    of = "her lines" if condition.lines else "her section"
    rows = [
        ("displacement", f"{condition.displacement:.5g} t, by {condition.form.perpendiculars:.5g} m of {of}"),
        ("draught", f"{condition.draught:.4g} m, breadth {h.breadth:.4g} m, block coefficient {condition.block:.3f}"),
        ("KB, BM, KM", f"{h.kb:.3f}, {h.bm:.3f}, {h.km:.3f} m"),
        *_gravity(condition),
        (
            "deck edge under",
            "no deck is given" if condition.deck_edge_angle is None else degrees(condition.deck_edge_angle),
        ),
        ("downflooding", "no opening is given" if condition.flooding is None else degrees(condition.flooding)),
        ("levers vanish", vanishing(condition.levers)),
    ]
    if condition.cargo is None:
        return rows
    return [*rows, *_loaded(condition, condition.cargo)]


def _gravity(condition: Condition) -> list[tuple[str, str]]:
    """Rows on the centre of gravity, the free surfaces of tanks, and GM solid and fluid."""
    rise = condition.fluid_height - condition.gravity_height
    rows = []
    for tank in condition.tanks:
        breadth, length = (condition.scale * size for size in (tank.breadth, tank.length))
        moment = tank.moment * condition.scale**4 / TONNE
        rows.append(
            (f"free surface, {tank.tank}", f"{breadth:.5g} m broad, {length:.5g} m long, rho i = {moment:.4g} t m")
        )
    if condition.aside > 0.0:
        rows.append(("G aside", f"{condition.aside:.3f} m to {condition.side}, the side that she is judged on"))
    return [
        *rows,
        ("KG solid, fluid", f"{condition.gravity_height:.3f}, {condition.fluid_height:.3f} m"),
        ("GM solid", f"{condition.solid_gm:.3f} m"),
        ("free surfaces", f"{condition.free_surface:.4g} t m / {condition.displacement:.5g} t = {rise:.3f} m"),
        ("GM fluid", f"{condition.metacentric_height:.3f} m"),
        *_lolled(condition),
    ]


def _lolled(condition: Condition) -> list[tuple[str, str]]:
    """A row on where a ship lies that does not stand upright."""
    if condition.metacentric_height > 0.0:
        return []
    angle = condition.levers.equilibrium()
    return [("lolls", "nowhere: she capsizes" if angle is None else f"to {degrees(angle)}, as GM is negative")]


def _loaded(condition: Condition, cargo: Cargo) -> list[tuple[str, str]]:
    """Rows on the hold and the grain in it."""
    given, assumed = condition.given, grain_code.ASSUMED[condition.given.filling]
    stows = f"{cargo.volume:.5g} m3, {cargo.mass:.5g} t; stowage factor {condition.stowage:.3f} m3/t"
    angle, moment = np.degrees(assumed.surface), condition.assumed_moment
    return [
        *(
            (
                "hold" if one.hold is condition.hold else f"hold {one.name}",
                f"{one.hold.length:.4g} m long, {one.hold.volume:.5g} m3, {given.filling} to {one.level:.3f} m",
            )
            for one in condition.stowed
        ),
        ("grain", stows + (f" (the bed's {cargo.stowage:.3f})" if given.stowage else "")),
        (
            "assumed shift",
            f"surface {angle:.0f} deg, {moment:.5g} m4 x {assumed.factor:.2f}, arm {condition.assumed_arm:.3f} m",
        ),
    ]


def shown(value: float, unit: str) -> str:
    """A number of a sheet as surveyors round it: millimetres, hundredths of a degree, tenths of a mm rad."""
    if value == inf:
        return "none"
    return f"{value:.{DIGITS.get(unit, 3)}f}"


def vanishing(levers: Levers) -> str:
    """The angle of vanishing stability."""
    if float(levers.at(levers.highest(0.0, float(levers.heel[-1])))) <= 0.0:
        return "she has none"
    return degrees(levers.vanishing, f"beyond {np.degrees(levers.heel[-1]):.0f} deg")


def degrees(angle: float | None, never: str = "never") -> str:
    """An angle (rad) in degrees; `never` for None."""
    return never if angle is None or angle == inf else f"{np.degrees(angle):.1f} deg"
