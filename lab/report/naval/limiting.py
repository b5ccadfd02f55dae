"""Limiting KG of a hull over displacements and trims: the table, the curves, and the sentences beside them."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from string import ascii_lowercase

import numpy as np

from lab.naval import tables
from lab.naval.loaded import Loaded
from lab.report.stability import columns, save_axes
from solvers.ship.naval.form import Form
from solvers.ship.naval.upright import level_at
from solvers.ship.naval.whole_hull.limits import Demands, Floating, Key, Limit, limits, of_all
from solvers.ship.water import Water

NAME = "limiting-kg"
STYLES = "-", "--", "-.", ":"


@dataclass(frozen=True, eq=False)
class Judged:
    """A ship at one displacement and trim, and the limit of KG of each criterion."""

    ship: Floating
    found: dict[Key, Limit]

    @property
    def together(self) -> tuple[Limit, Key]:
        """The limit of all criteria, and the one that sets it."""
        return of_all(self.found)


def judged(form: Form, water: Water, draughts: Sequence[float], trim: float, demands: Demands) -> list[Judged]:
    """The limits at mean draughts (m) with a trim (m) by the stern."""
    rows = []
    for draught in draughts:
        displacement = form.afloat(level_at(form, float(draught), trim), water).displacement
        ship = Floating(form, water, displacement, trim, demands)
        rows.append(Judged(ship, limits(ship)))
    return rows


def demands_of(ship: Loaded) -> Demands:
    """What a hull that carries weights is judged by, her own centre of gravity aside."""
    wind = {}
    if ship.wind is not None:
        wind = {"wind_area": ship.wind.area, "wind_lever": ship.wind.lever, "keel_area": ship.wind.keel_area}
        wind["sharp"] = ship.wind.sharp
    grain = sum(hold.heeling for hold in ship.grain) if ship.grain else None
    return Demands(ship.points, **wind, lwl=ship.lwl, grain=grain)


def as_loaded(ship: Loaded) -> str:
    """One sentence: her KG as she is loaded beside the limit at her displacement and trim."""
    aft, fore, _ = ship.draughts
    floating = Floating(ship.form, ship.water, ship.weights.mass, aft - fore, demands_of(ship))
    limit, (rule, what) = of_all(limits(floating))
    has = f"As loaded, {ship.weights.mass:.5g} t, trim {aft - fore:.3f} m: KG fluid {ship.weights.fluid_vcg:.3f} m"
    if limit.largest is None:
        return f"{has}; no KG passes ({rule}, {what})."
    spare = limit.largest - ship.weights.fluid_vcg
    told = f"{spare:.3f} m to spare" if spare >= 0.0 else f"{-spare:.3f} m too high"
    aside = "" if abs(ship.weights.tcg) < 1e-9 else " G aside of her middle is not in it."
    return f"{has}, limit {limit.largest:.3f} m ({rule}, {what}): {told}.{aside}"


def table(rows: Sequence[Judged]) -> tables.Table:
    """Limits in m, a column a criterion; "none" where no KG passes, "KM" where each up to KM does."""
    keys = list(rows[0].found)
    header = [
        "displacement t",
        "T m",
        "trim m",
        "KM m",
        *(f"{rule}: {what} m" for rule, what in keys),
        "all m",
        "set by",
    ]
    lines = []
    for row in rows:
        upright, (limit, (rule, what)) = row.ship.upright, row.together
        cells = [f"{row.ship.displacement:.1f}", f"{upright.draught:.3f}", f"{row.ship.trim:.3f}", f"{upright.km:.3f}"]
        cells += [_cell(row.found[key], upright.km) for key in keys]
        lines.append((*cells, _cell(limit, upright.km), f"{rule}: {what}"))
    return tuple(header), lines


def _cell(limit: Limit, km: float) -> str:
    if limit.largest is None:
        return "none"
    return "KM" if limit.largest > km * (1.0 - 1e-6) else f"{limit.largest:.3f}"


def shown(rows: Sequence[Judged]) -> list[str]:
    """The table as lines, its criteria by letters, and sentences on what is not a single range."""
    header, lines = table(rows)
    keys, letters = header[4:-2], ascii_lowercase
    named = dict(zip(keys, letters, strict=False))
    short = tuple(named.get(name, name) for name in header)
    brief = [(*line[:-1], named[f"{line[-1]} m"]) for line in lines]
    told = ["Limiting KG (m), free surfaces included:", *columns((short, brief), short)]
    told += [f"  {letter}  {name[:-2]}" for name, letter in named.items()]
    told += ["  none: no KG passes; KM: each KG up to KM passes"]
    return told + list(_broken(rows))


def _broken(rows: Sequence[Judged]):
    """A sentence for each displacement at which a KG below the limit fails, too."""
    for row in rows:
        limit = row.together[0]
        if limit.largest is not None and not limit.whole:
            ranges = " and ".join(f"{low:.3f} to {high:.3f}" for low, high in limit.ranges)
            yield f"  At {row.ship.displacement:.5g} t, trim {row.ship.trim:g} m, only KG from {ranges} m passes."


def write_figure(folder: Path, name: str, rows: Sequence[Judged], loaded: Loaded | None) -> Path:
    """The curves of the limit of all criteria by trim, those of each criterion thin for the first trim."""

    def draw(axes) -> None:
        trims = sorted({row.ship.trim for row in rows})
        for trim, style in zip(trims, STYLES * len(trims), strict=False):
            label = "all criteria" + (f", trim {trim:g} m" if len(trims) > 1 else "")
            axes.plot(*_curve([row for row in rows if row.ship.trim == trim]), "k" + style, lw=2.0, label=label)
        first = [row for row in rows if row.ship.trim == rows[0].ship.trim]
        for key in rows[0].found:
            axes.plot(*_curve(first, key), lw=1.0, label=f"{key[0]}: {key[1]}")
        axes.plot([row.ship.displacement for row in first], [row.ship.upright.km for row in first], "k:", label="KM")
        if loaded is not None:
            axes.plot(loaded.weights.mass, loaded.weights.fluid_vcg, "k^", label="as loaded, KG fluid")
        tops = [row.ship.upright.km for row in first if row.ship.upright.draught > 0.3 * row.ship.form.depth]
        axes.set_ylim(0.0, 1.1 * max(tops or [row.ship.upright.km for row in first]))
        axes.set_xlabel("displacement (t)")
        axes.set_ylabel("largest KG that passes (m)")

    return save_axes(folder / f"{NAME}.png", name, draw)


def _curve(rows: Sequence[Judged], key: Key | None = None) -> tuple[list[float], list[float]]:
    found = [row.together[0] if key is None else row.found[key] for row in rows]
    heights = [np.nan if limit.largest is None else limit.largest for limit in found]
    return [row.ship.displacement for row in rows], heights
