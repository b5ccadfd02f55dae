"""`cargolab hull`: hydrostatics, cross curves and, with weights, the criteria of a hull from offsets or a surface."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.assembly.lines.offsets import is_plain, read_offsets, rows_of, text_of
from lab.base.errors import LabError
from lab.base.files import write_text
from lab.measures.naval_levers import draw_levers
from lab.naval import sheet, tables
from lab.naval.compartments import read_holds
from lab.naval.hull import DEEPEST, GEOMETRY, Hull, read_hull
from lab.naval.loaded import Loaded, Wind
from lab.naval.points import check_near, names_of_openings, read_points
from lab.naval.stowed import Stowed, read_stowed
from lab.naval.surfaces.axes import Axes
from lab.naval.surfaces.offsets import write_offsets
from lab.naval.surfaces.selfcheck import self_check
from lab.naval.weights import Weights, extents, read_weights
from lab.report.naval import limiting, strength
from lab.report.stability import HEEL, SIGNS, aligned, columns, save_axes
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.naval.holds import Hold
from solvers.ship.naval.whole_hull.limits import Demands
from solvers.ship.naval.whole_hull.strength import still_water
from solvers.ship.water import Water

WITH_WEIGHTS = "points", "grain", "wind", "strength"
BRIEFLY = (  # what is shown
    *("T m", "displacement t", "LCB m", "KB m", "KM m", "KML m"),
    *("TPC t/cm", "MCT t m/cm", "LCF m", "wetted m2", "Cb"),
)


@dataclass(frozen=True)
class Asked:
    """What is asked of a hull: files of weights, points, grain and holds, wind (area m², lever m), a section's place.

    The water's density is in kg/m³; `stations` is the fewest cuts of a surface, and what follows is of surfaces, too
    (`lab.naval.surfaces.axes`). `lbp` and `lwl` are her lengths (m) between perpendiculars, from the aft one at x =
    `ap` (m), and in the waterline. With `fair` the offsets of a station are joined by fair curves. Hydrostatics are at
    each `draught` (m) and of each `displacement` (t), with neither at multiples of a `step` (m), with a `trim` (m).
    """

    density: float = 1025.0
    stations: int = 41
    scale: float = 1.0
    up: str = "z"
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    mirror: bool = False
    close: bool = False
    weights: Path | None = None
    points: Path | None = None
    grain: Path | None = None
    holds: Path | None = None
    wind: tuple[float, float] | None = None
    keels: float = 0.0
    sharp: bool = False
    at: float | None = None
    lbp: float | None = None
    lwl: float | None = None
    ap: float = 0.0
    fair: bool = False
    draught: tuple[float, ...] = ()
    displacement: tuple[float, ...] = ()
    trim: float = 0.0
    step: float | None = None
    limiting_kg: bool = False
    kg_trim: tuple[float, ...] = ()
    strength: bool = False


def read(path: Path, asked: Asked) -> Hull:
    """The hull of a file. Raises LabError."""
    axes = Axes(asked.scale, asked.up, asked.origin, asked.mirror, asked.close)
    how = {"fair": asked.fair, "stations": asked.stations, "lbp": asked.lbp, "lwl": asked.lwl, "ap": asked.ap}
    return read_hull(path, density=asked.density, axes=axes, **how)


def between_offsets(path: Path, form: Form, fair: bool) -> str:
    """What lies between the offsets of a station, and how much it matters to her volume."""
    other, deepest = read_offsets(path, not fair), np.full(len(form.x), DEEPEST * form.depth)
    more = form.displaced(deepest)[0] / other.displaced(deepest)[0] - 1.0
    curved, straight = ("fair curves", "straight lines") if fair else ("straight lines", "fair curves (--fair)")
    return f"between offsets {curved}: {100.0 * more:+.2f} % of volume beside {straight}"


def examine(path: Path, folder: Path, asked: Asked) -> tuple[str, dict[str, tables.Table]]:
    """Write the tables of a hull, and with a file of weights her levers and criteria.

    Returns the text to show, and the tables by name. Raises LabError for files that are no hull, and weights that do
    not float.
    """
    for name in WITH_WEIGHTS:
        if getattr(asked, name) and not asked.weights:
            raise LabError(f"--{name}: needs --weights, by which she floats; give both.")
    if asked.kg_trim and not asked.limiting_kg:
        raise LabError("--kg-trim: is of --limiting-kg; give both.")
    ship = read(path, asked)
    form, mesh, water = ship.form, ship.mesh, ship.water
    draughts = _draughts(ship, asked)
    try:
        written = {
            "hydrostatics": tables.hydrostatics(form, water, draughts, asked.trim),
            "cross-curves": tables.cross_curves(form, water, draughts),
        }
        lines = [f"{path.name}: {len(form.x)} stations over {np.ptp(form.x):.5g} m, depth {form.depth:.4g} m"]
        lines += self_check(form, mesh, asked.stations)
        if mesh is None and path.suffix.lower() not in GEOMETRY:
            lines.append(f"  {between_offsets(path, form, asked.fair)}")
        lines += ["", *([f"  trim {asked.trim:g} m by the stern"] if asked.trim else [])]
        lines += columns(written["hydrostatics"], BRIEFLY)
        holds = read_holds(asked.holds, form) if asked.holds else {}
        written |= {f"hold-{name}": tables.hold(hold) for name, hold in holds.items()}
        loaded = _loaded(form, water, asked, holds) if asked.weights else None
        if loaded:
            found, tables_of = _judged(loaded, asked, folder, path.name)
            lines += ["", *found]
            written |= tables_of
        if asked.limiting_kg:
            found, written[limiting.NAME] = _limiting(ship, draughts, asked, loaded, folder)
            lines += ["", *found]
        if asked.at is not None:
            lines += ["", outline_at(form, asked.at)]
    except Unavailable as error:
        raise LabError(f"{path.name}: {error}") from None
    own_form = mesh is not None or asked.fair or not is_plain(path)
    _spare(path, asked, [folder / f"{name}.csv" for name in (*written, *["offsets"] * own_form)])
    tables.write(written, folder)
    if mesh is None and own_form:
        write_text(folder / "offsets.csv", text_of(list(rows_of(form))))
    if mesh and (said := write_offsets(form, folder)):
        lines += ["", said]
    return "\n".join([*lines, "", SIGNS if mesh is None else f"{HEEL}; x, y and z are those of the file."]), written


def _draughts(ship: Hull, asked: Asked) -> list[float]:
    """The draughts (m) that are asked for, those of the displacements asked for, else round ones."""
    found = [ship.draught(draught, None, asked.trim) for draught in asked.draught]
    found += [ship.draught(None, displacement, asked.trim) for displacement in asked.displacement]
    if found and asked.step:
        raise LabError("--step: is of a table at round draughts; leave it out, or --draught and --displacement.")
    return found or ship.draughts(asked.step, asked.trim).tolist()


def _spare(path: Path, asked: Asked, written: list[Path]) -> None:
    """Raise LabError if a table would be written over one that was read."""
    given = [one.resolve() for one in (path, asked.weights, asked.points, asked.grain, asked.holds) if one]
    for one in written:
        if one.resolve() in given:
            raise LabError(f"--out: {one} was read and would be written over; choose another folder.")


def _limiting(ship: Hull, draughts: list[float], asked: Asked, loaded: Loaded | None, folder: Path):
    """Lines and the table of limiting KG; its figure is saved."""
    demands = limiting.demands_of(loaded) if loaded else Demands(lwl=asked.lwl)
    rows = []
    for trim in asked.kg_trim or (asked.trim,):
        rows += limiting.judged(ship.form, ship.water, draughts, trim, demands)
    limiting.write_figure(folder, ship.name, rows, loaded)
    return limiting.shown(rows) + ([limiting.as_loaded(loaded)] if loaded else []), limiting.table(rows)


def _loaded(form: Form, water: Water, asked: Asked, holds: dict[str, Hold]) -> Loaded:
    """The hull with the weights, points, grain and wind of the files asked for."""
    points = read_points(asked.points) if asked.points else {}
    names = names_of_openings(asked.points) if asked.points else ()
    if points:
        check_near(points, form, asked.points)
    grain = tuple(read_stowed(asked.grain, holds)) if asked.grain else ()
    wind = Wind(*asked.wind, asked.keels, asked.sharp) if asked.wind else None
    return Loaded(form, water, read_weights(asked.weights)[0], points, grain, wind, asked.lwl, names)


def _judged(ship: Loaded, asked: Asked, folder: Path, name: str):
    """Lines and tables of a hull that carries weights; her figure is saved."""
    total, given = read_weights(asked.weights)
    grain, rows = ship.grain, sheet.rows(ship)
    save_axes(folder / "righting-levers.png", name, lambda axes: draw_levers(axes, ship))
    written = {
        "weights": _weights(total, given),
        "criteria": tables.criteria(rows),
        "righting-levers": tables.levers(ship),
    }
    beam = still_water(ship.form, ship.water, extents(asked.weights, given)) if asked.strength else None
    if beam:
        strength.write_figure(folder, name, beam)
        written[strength.NAME] = strength.table(ship.form, beam)
    if grain:
        written["grain"] = _stowed(grain, ship)
    told = facts(ship)
    width = max(len(name) for name, _ in told)
    lines = [f"  {name:<{width}}  {text}" for name, text in told]
    told_of = ["", *strength.shown(beam)] if beam else []
    return [*lines, "", *aligned(rows), *_unjudged(ship), *told_of], written


def facts(ship: Loaded) -> list[tuple[str, str]]:
    """How she floats and what limits her heel, in rows of a name and a text."""
    total, (aft, fore, _), upright = ship.weights, ship.draughts, ship.upright
    rise = total.fluid_vcg - total.vcg
    trim = f"{abs(aft - fore):.3f} m by the {'stern' if aft >= fore else 'bow'}"
    rows = [
        ("weights", f"{total.mass:.5g} t at {total.lcg:.3f} m, {total.tcg:.3f} m to starboard, KG {total.vcg:.3f} m"),
        ("draught", f"aft {aft:.3f}, forward {fore:.3f} m; trim {trim}"),
        ("KB, BM, KM", f"{upright.kb:.3f}, {upright.bm:.3f}, {upright.km:.3f} m"),
        ("GM solid", f"{ship.solid_gm:.3f} m"),
        ("free surfaces", f"{total.free_surface:.4g} t m / {total.mass:.5g} t = {rise:.3f} m"),
        ("GM fluid", f"{ship.metacentric_height:.3f} m"),
        ("list", f"{_list(ship)}; judged to {ship.side}"),
        ("deck edge under", sheet.degrees(ship.deck_edge_angle, "not up to 90 deg")),
        ("downflooding", _downflooding(ship)),
        ("levers vanish", sheet.vanishing(ship.levers)),
    ]
    if ship.grain:
        moment = sum(hold.heeling for hold in ship.grain)
        rows.append(("grain", f"{moment:.5g} t m / {total.mass:.5g} t: arm {ship.assumed_arm:.3f} m upright"))
    return rows


def _downflooding(ship: Loaded) -> str:
    if ship.flooding is None:
        return "no opening is given"
    by = f", by {ship.flooded_by}" if ship.flooded_by else ""
    return sheet.degrees(ship.flooding, "not up to 90 deg") + by


def _list(ship: Loaded) -> str:
    """Her list, positive starboard down."""
    if ship.heel_angle is None:
        return "none: she comes to rest nowhere"
    why = ", a loll: her GM is negative" if ship.metacentric_height < 0.0 else ""
    return f"{sheet.degrees(abs(ship.heel_angle))} to {'port' if ship.heel_angle < 0.0 else 'starboard'}{why}"


def _unjudged(ship: Loaded) -> list[str]:
    """What was not judged and why, a sentence each."""
    lines = []
    if ship.wind is None:
        lines.append("The weather criterion was not judged: give --wind AREA LEVER.")
    elif not ship.metacentric_height > 0.0:
        lines.append(sheet.NO_PERIOD)
    if not ship.grain:
        lines.append("The Grain Code was not judged: give --grain CSV.")
    if ship.flooding is None:
        lines.append("No opening limits her levers: give --points CSV.")
    elif ship.flooding_to_the_other_side < ship.flooding:
        angle = sheet.degrees(ship.flooding_to_the_other_side)
        lines.append(
            f"Heeled to the other side an opening floods at {angle}, sooner than to {ship.side}, to which she is "
            "judged: judge that side too, with the openings mirrored."
        )
    return ["", *lines] if lines else []


def _stowed(grain: tuple[Stowed, ...], ship: Loaded) -> tables.Table:
    """Heeling moments of the holds, as a grain stability calculation lists them."""
    header = "hold", "filling", "moment m4", "factor", "stowage m3/t", "heeling moment t m"
    lines = [
        (one.name, one.filling, f"{one.moment:.1f}", f"{one.factor:.2f}", f"{one.stowage:.3f}", f"{one.heeling:.1f}")
        for one in grain
    ]
    total = ("total", "", f"{sum(one.moment for one in grain):.1f}", "", "", f"{sum(one.heeling for one in grain):.1f}")
    arms = [(f"lambda {heel:g} m", "", "", "", "", f"{float(ship.assumed(np.radians(heel))):.4f}") for heel in (0, 40)]
    return header, [*lines, total, *arms]


def _weights(total: Weights, rows: list[dict[str, object]]) -> tables.Table:
    names = "mass", "lcg", "tcg", "vcg", "fsm"
    lines = [(row["name"], *(f"{row[key]:.3f}" for key in names)) for row in rows]
    sums = total.mass, total.lcg, total.tcg, total.vcg, total.free_surface
    header = "name", "mass t", "lcg m", "tcg m", "vcg m", "fsm t m"
    return header, [*lines, ("total", *(f"{value:.3f}" for value in sums))]


def outline_at(form: Form, at: float) -> str:
    """The section at the station nearest to a place (m), as the outline of a preset's ship. Raises LabError."""
    k = int(np.argmin(np.abs(form.x - at)))
    section = form.sections[k]
    if section is None:
        raise LabError(f"--at: the hull has no section at {form.x[k]:g} m; take a place further from her ends.")
    corners = ", ".join(f'["{y:.6g} m", "{z:.6g} m"]' for y, z in section.outline)
    return f"# the section at {form.x[k]:g} m\n[ship]\noutline = [{corners}]"
