"""Limiting KG and longitudinal strength of the conditions of a ship file, where they are asked for."""

from pathlib import Path

from lab.naval import tables
from lab.naval.ship_file.ship import Condition, Ship
from lab.report.hull import Asked
from lab.report.naval import limiting, strength
from solvers.ship.naval.whole_hull.strength import Beam, Extent, still_water

Found = tuple[list[str], dict[str, tables.Table]]


def beam_of(condition: Condition) -> Beam:
    """A condition's shear force and bending moment in still water; weights without blocks stand at a point."""
    weights = []
    for one in condition.items:
        blocks = [Extent(one.name, mass, 0.5 * (aft + fore), aft, fore) for aft, fore, mass in one.spread if mass]
        weights += blocks or [Extent(one.name, one.mass, one.lcg)]
    return still_water(condition.form, condition.water, weights)


def strengths(ship: Ship, folder: Path) -> Found:
    """Lines and tables of strength of each condition; the figures are saved."""
    lines, written = [], {}
    for name, one in ship.conditions.items():
        beam = beam_of(one)
        strength.write_figure(folder, f"{ship.title}: {one.title or name}", beam, f"{name}-{strength.NAME}")
        written[f"{name}-{strength.NAME}"] = strength.table(ship.form, beam)
        lines += ["", f"{name}:", *strength.shown(beam)]
    return lines, written


def limits(ship: Ship, draughts: list[float], asked: Asked, folder: Path) -> Found:
    """Lines and the table of limiting KG by the rules of the first condition; each condition beside its own limit."""
    some = list(ship.conditions.values())
    rows = []
    for trim in asked.kg_trim or (asked.trim,):
        rows += limiting.judged(ship.form, ship.water, draughts, trim, limiting.demands_of(some[0]))
    limiting.write_figure(folder, ship.title, rows, some[0])
    lines = ["", f"Judged by what {next(iter(ship.conditions))} is judged by:", *limiting.shown(rows), ""]
    lines += [f"{name}: {limiting.as_loaded(one)}" for name, one in ship.conditions.items()]
    return lines, {limiting.NAME: limiting.table(rows)}
