"""Tables of a ship by her file: conditions side by side, their criteria, capacities, free surfaces by heel, weights."""

from collections.abc import Mapping, Sequence
from math import inf

import numpy as np

from lab.naval import sheet, tables
from lab.naval.ship_file.items import Liquid
from lab.naval.ship_file.ship import Condition, Ship
from lab.naval.tables import Table
from solvers.ship.naval.compartments.compartment import Compartment
from solvers.ship.naval.form import TONNE
from solvers.ship.naval.grain_code import ASSUMED

LEVELS = 20  # rows of a capacity table
HEELS = (5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0)  # deg, of the transfer of liquids


def conditions(ship: Ship) -> Table:
    """How she floats in each condition, a column each; heel is positive starboard down."""
    columns = [_floats(one) for one in ship.conditions.values()]
    rows = [(name, unit, *(column[name, unit] for column in columns)) for name, unit in columns[0]]
    return ("", "unit", *ship.conditions), rows


def _floats(one: Condition) -> dict[tuple[str, str], str]:
    """Cells of a condition by quantity and unit."""
    total, (aft, fore, mean), upright = one.weights, one.draughts, one.upright
    highest = one.levers.highest(0.0, float(one.levers.heel[-1]))
    grain = sum(hold.heeling for hold in one.grain)
    return {
        ("sea", "kg/m3"): f"{one.water.density:.1f}",
        ("displacement", "t"): f"{total.mass:.1f}",
        ("LCG", "m"): f"{total.lcg:.3f}",
        ("TCG to starboard", "m"): f"{total.tcg:.3f}",
        ("KG solid", "m"): f"{total.vcg:.3f}",
        ("free surfaces", "t m"): f"{total.free_surface:.1f}",
        ("KG fluid", "m"): f"{total.fluid_vcg:.3f}",
        ("draught aft", "m"): f"{aft:.3f}",
        ("draught forward", "m"): f"{fore:.3f}",
        ("draught mean", "m"): f"{mean:.3f}",
        ("trim by the stern", "m"): f"{aft - fore:.3f}",
        ("list to starboard", "deg"): "none" if one.heel_angle is None else _degrees(one.heel_angle),
        ("KM", "m"): f"{upright.km:.3f}",
        ("GM solid", "m"): f"{one.solid_gm:.3f}",
        ("GM fluid", "m"): f"{one.metacentric_height:.3f}",
        ("judged to", ""): one.side,
        ("largest lever", "m"): f"{float(one.levers.at(highest)):.3f}",
        ("largest lever at", "deg"): _degrees(highest),
        ("deck edge under", "deg"): _degrees(one.deck_edge_angle),
        ("downflooding", "deg"): _degrees(one.flooding),
        ("levers vanish", "deg"): _degrees(one.levers.vanishing),
        ("grain moment", "t m"): f"{grain:.1f}",
        ("grain arm upright", "m"): f"{one.assumed_arm:.3f}",
    }


def _degrees(angle: float | None) -> str:
    return "none" if angle is None or angle == inf else f"{np.degrees(angle) + 0.0:.2f}"


def criteria(rows: Mapping[str, Sequence[sheet.Row]]) -> Table:
    """The criteria of all conditions, the condition in the first column."""
    found = {name: tables.criteria(one) for name, one in rows.items()}
    header = next(iter(found.values()))[0]
    return ("condition", *header), [(name, *line) for name, (_, lines) in found.items() for line in lines]


def attained(rows: Mapping[str, Sequence[sheet.Row]]) -> Table:
    """The criteria side by side: what each condition attains, its margin and verdict in one cell."""
    names = {(row.criterion.rule, row.criterion.what, row.criterion.unit): row for one in rows.values() for row in one}
    lines = []
    for rule, what, unit in names:
        cells = [
            next((row for row in one if (row.criterion.rule, row.criterion.what) == (rule, what)), None)
            for one in rows.values()
        ]
        found = next(row for row in cells if row is not None).criterion
        numbers = [cell for row in cells for cell in _attained(row)]
        limits = {sheet.shown(row.criterion.limit, unit) for row in cells if row is not None}
        lines.append((rule, what, found.kind, limits.pop() if len(limits) == 1 else "differs", unit, *numbers))
    header = [cell for name in rows for cell in (name, "margin", "")]
    return ("rule", "criterion", "required", "limit", "unit", *header), lines


def _attained(row: sheet.Row | None) -> tuple[str, str, str]:
    """What was attained, the margin, the verdict."""
    if row is None:
        return "not judged", "", ""
    one = row.criterion
    return sheet.shown(one.attained, one.unit), sheet.shown(one.margin, one.unit), row.verdict


def capacity(space: Compartment, density: float | None = None) -> Table:
    """Volume, centre and free surface by level: of a tank with a liquid (kg/m³) masses, of a hold grain moments."""
    levels = space.floor + (space.top - space.floor) * np.arange(1, LEVELS + 1) / LEVELS
    surfaces = [ASSUMED[name].surface for name in ("filled", "partly-filled")]
    lines = []
    for level in np.minimum(levels, space.top).tolist():
        volume = space.volume_to(level)
        x, y, z = space.centre_to(level)
        line = [f"{level:.3f}", f"{100.0 * volume / space.volume:.1f}", f"{volume:.1f}"]
        line += [f"{one + 0.0:.3f}" for one in (x, np.round(y, 9), z)]
        if density is None:
            line += [f"{space.volumetric_moment(volume, angle):.1f}" for angle in surfaces]
        else:
            second = float(space.second_moment_at(level)) if level < space.top else 0.0
            line += [f"{volume * density / TONNE:.1f}", f"{second:.1f}", f"{second * density / TONNE:.1f}"]
        lines.append(tuple(line))
    header = "level m", "full %", "volume m3", "LCG m", "TCG m", "VCG m"
    if density is None:
        return (*header, "moment at 15 deg m4", "moment at 25 deg m4"), lines
    return (*header, "mass t", "second moment m4", "FSM t m"), lines


def free_surfaces(one: Condition) -> Table:
    """Of each tank with a free surface: its moment by heel, as the liquid's actual transfer and as ρ i sin φ."""
    heels = np.radians(HEELS)
    lines = []
    for liquid in one.liquids:
        if liquid.moves:
            lines.append((liquid.tank, "transfer", *_liquid(liquid), *(f"{m:.1f}" for m in liquid.transfer(heels))))
            steady = liquid.fsm * np.sin(heels)
            lines.append((liquid.tank, "rho i sin(heel)", *_liquid(liquid), *(f"{m:.1f}" for m in steady)))
    header = "tank", "moment", "full %", "mass t", "level m", "FSM t m"
    return (*header, *(f"at {heel:g} deg t m" for heel in HEELS)), lines


def _liquid(liquid: Liquid) -> tuple[str, ...]:
    share, mass = 100.0 * liquid.share, liquid.volume * liquid.density / TONNE
    return f"{share:.1f}", f"{mass:.1f}", f"{liquid.level:.3f}", f"{liquid.fsm:.1f}"


def weights(one: Condition) -> Table:
    """All that she weighs, and the sum."""
    keys = "mass", "lcg", "tcg", "vcg", "fsm"
    lines = [(row.name, *(f"{np.round(getattr(row, key), 9) + 0.0:.3f}" for key in keys)) for row in one.items]
    total = one.weights
    sums = total.mass, total.lcg, np.round(total.tcg, 9) + 0.0, total.vcg, total.free_surface
    header = "name", "mass t", "lcg m", "tcg m", "vcg m", "fsm t m"
    return header, [*lines, ("total", *(f"{value:.3f}" for value in sums))]


def grain(one: Condition) -> Table:
    """The grain in her holds, as a grain stability calculation lists it."""
    stowed = {row.name: row for row in one.grain}
    lines = []
    for cargo in one.cargo:
        if row := stowed.get(cargo.hold):
            cells = f"{cargo.level:.3f}", f"{cargo.volume:.1f}", f"{row.stowage:.3f}", f"{cargo.item.mass:.1f}"
            moments = f"{row.moment:.1f}", f"{row.factor:.2f}", f"{row.heeling:.1f}"
            lines.append((row.name, row.filling, *cells, *moments))
    sums = f"{sum(row.moment for row in one.grain):.1f}", "", f"{sum(row.heeling for row in one.grain):.1f}"
    header = "hold", "filling", "level m", "volume m3", "stowage m3/t", "mass t", "moment m4", "factor"
    return (*header, "heeling moment t m"), [*lines, ("total", *[""] * 5, *sums)]


def all_of(ship: Ship, rows: Mapping[str, Sequence[sheet.Row]]) -> dict[str, Table]:
    """Every table of a ship by the name of its file, those of the hull aside."""
    found = {f"tank-{name}": capacity(tank, ship.densities[name]) for name, tank in ship.tanks.items()}
    found |= {f"hold-{name}": capacity(hold) for name, hold in ship.holds.items()}
    if not ship.conditions:
        return found
    found |= {"conditions": conditions(ship), "criteria": criteria(rows)}
    for name, one in ship.conditions.items():
        found[f"{name}-weights"] = weights(one)
        found[f"{name}-righting-levers"] = tables.levers(one)
        found[f"{name}-free-surfaces"] = free_surfaces(one)
        if one.grain:
            found[f"{name}-grain"] = grain(one)
    return found
