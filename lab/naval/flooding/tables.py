"""Tables of a run of flooding as CSV and for the page, and the facts in words."""

import numpy as np

from lab.naval.flooding.results import Results, draughts
from lab.naval.tables import Table
from solvers.ship.naval.form import TONNE

SMALL = 1.0  # below so many tonnes masses are told in kg
ENDS = {
    "afloat": "afloat at the end of the run, {} s",
    "capsized": "capsizes after {} s",
    "sunk": "sinks after {} s",
    "plunged": "plunges after {} s: no trim carries the water in her ends",
}


def levels(results: Results) -> Table:
    """All in time: heel, trim, draughts, water and levels of each room, flows."""
    names = results.built.ship.rooms.names
    openings = [one.name for one in results.built.flooding.openings]
    header = ["time s", "heel deg", "trim m", "draught aft m", "draught forward m", "freeboard m", "water kg"]
    header += [f"{name} m3" for name in names] + [f"{name} level m" for name in names]
    header += [f"{name} air Pa" for name in names] + [f"{name} m3/s" for name in openings]
    rows = []
    for k, one in enumerate(results.moments):
        values = [one.time, np.degrees(results.heel[k]), results.trim[k], *results.draughts[k]]
        values += [results.freeboard[k], results.mass[k], *one.volume, *one.level, *one.overpressure, *one.flow]
        rows.append([f"{value + 0.0:.6g}" for value in values])
    return header, rows


def stages(results: Results) -> Table:
    """The stages of flooding."""
    heavy = results.mass.max() >= SMALL * TONNE
    header = ("stage", "time s", f"water {'t' if heavy else 'kg'}", "draught aft m", "draught forward m")
    header += ("heel deg", "freeboard m", "GM m", "s intermediate")
    rows = []
    for stage in results.stages:
        one = stage.moment
        water = results.built.ship.water.density * float(one.volume.sum()) / (TONNE if heavy else 1.0)
        aft, fore = draughts(one.pose, results.built)
        freeboard = float(one.pose.heights(results.edges).min())
        values = one.time, water, aft, fore, -np.degrees(one.pose.roll), freeboard, stage.gm
        told = "" if stage.factor is None else f"{stage.factor:.3f}"
        rows.append((stage.what, *map(_digits, values), told))
    return header, rows


def rooms(results: Results) -> Table:
    """What is in each room at the end."""
    header = "room", "volume m3", "water m3", "filled %", "level above the sea m", "air Pa", "open to the sea"
    ship, last, rows = results.built.ship, results.moments[-1], []
    for k, room in enumerate(ship.rooms.rooms):
        full = ship.rooms.full[k]
        values = full, last.volume[k], 100.0 * last.volume[k] / full, last.level[k], last.overpressure[k]
        cells = [_digits(value) for value in values]
        rows.append((room.name, *cells, "yes" if results.open_rooms[k] else "no"))
    return header, rows


def residual(results: Results) -> Table | None:
    """Levers after flooding."""
    if results.residual is None:
        return None
    side = "port" if results.side > 0 else "starboard"
    pairs = zip(np.degrees(results.residual.heel), results.residual.lever, strict=True)
    return (f"heel to {side} deg", "GZ m"), [(f"{heel:.1f}", f"{lever:.5f}") for heel, lever in pairs]


def facts(results: Results) -> list[tuple[str, str]]:
    """What happened, in rows of a name and a text."""
    ship, course = results.built.ship, results.course
    heel, when = results.largest
    rows = [
        ("without water", f"{mass(ship.mass)}, KG {ship.centre[2]:.4g} m"),
        ("outcome", ENDS[course.end].format(f"{results.time[-1]:.4g}")),
        ("water aboard", mass(results.mass[-1])),
        ("deck's edge under", _at(results.deck_time, "never")),
        ("largest heel", f"{side(heel)} at {when:.4g} s"),
        ("at rest from", _at(results.rest_time, "not within the run")),
    ]
    rows += [(f"{name} gives way", f"{time:.4g} s") for name, time in course.doors.items()]
    return rows + (_final(results) if course.end == "afloat" else [])


def _final(results: Results) -> list[tuple[str, str]]:
    """How she floats at the end, by both methods, and what is left of her stability."""
    aft, fore = results.draughts[-1]
    added, lost = results.displacements
    one, two = results.heights
    rows = [
        ("heel at the end", side(float(results.heel[-1]))),
        ("draughts at the end", f"aft {aft:.4g}, forward {fore:.4g} m"),
        ("added weight", f"{mass(added)}, GM {one:.4g} m"),
        ("lost buoyancy", f"{mass(lost)}, GM {two:.4g} m"),
    ]
    found = results.survival
    if found is None:
        return [*rows, ("levers left", "not told: she is not at rest; let the run be longer")]
    at = f"largest lever {found.lever:.3g} m, range {np.degrees(found.range):.3g} deg"
    told = "not told at this heel" if found.factor is None else f"{found.factor:.3f}"
    return [*rows, ("levers left", at), ("s at the end (SOLAS II-1/7-2)", f"{told}, {results.kind} ship")]


def _digits(value: float) -> str:
    """Four digits, and nothing where there is nothing but rounding."""
    return f"{round(value, 6) + 0.0:.4g}"


def side(heel: float) -> str:
    """A heel (rad) as an angle and a side."""
    if abs(heel) < np.radians(0.005):
        return "none"
    return f"{abs(np.degrees(heel)):.2f} deg to {'starboard' if heel > 0.0 else 'port'}"


def mass(value: float) -> str:
    """A mass (kg) in tonnes, or kg if it is small."""
    return f"{value / TONNE:.5g} t" if value >= SMALL * TONNE else f"{value:.4g} kg"


def _at(time: float | None, never: str) -> str:
    return never if time is None else f"{time:.4g} s"


def all_of(results: Results) -> dict[str, Table]:
    """Every table by the name of its file."""
    found = {"levels": levels(results), "stages": stages(results), "rooms": rooms(results)}
    curve = residual(results)
    return found if curve is None else found | {"residual-levers": curve}
