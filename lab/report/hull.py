"""`cargolab hull`: hydrostatics, cross curves and, with weights, the criteria of a hull from offsets or a surface."""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.measures.naval_levers import draw_curve
from lab.naval import sheet, tables
from lab.naval.offsets import read_offsets, rows_of, text_of
from lab.naval.surface import read_surface
from lab.naval.weights import Weights, read_weights
from lab.report.stability import SIGNS, aligned, save_axes
from solvers.machine.errors import Unavailable
from solvers.ship.naval import intact
from solvers.ship.naval.curve import Levers
from solvers.ship.naval.form import Form
from solvers.ship.water import Water

HEELS = np.radians(np.arange(-90.0, 91.0))
SURFACES = (".stl",)
DEEPEST = 0.95  # of the depth: the last draught of the tables


def read_form(path: Path, stations: int, scale: float) -> Form:
    """The hull of a file, by its ending. Raises LabError."""
    if path.suffix.lower() in SURFACES:
        return read_surface(path, stations, scale)
    return read_offsets(path)


def examine(
    path: Path, folder: Path, density: float, stations: int, scale: float, weights: Path | None, at: float | None
) -> str:
    """Write the tables of a hull, and with a file of weights her levers and criteria; returns the text to show.

    Raises LabError for files that are no hull, and weights that do not float.
    """
    form, water = read_form(path, stations, scale), Water(density)
    try:
        written = {
            "hydrostatics": tables.hydrostatics(form, water, DEEPEST * form.depth),
            "cross-curves": tables.cross_curves(form, water, DEEPEST * form.depth),
        }
        lines = [f"{path.name}: {len(form.x)} stations, {form.perpendiculars:.5g} m, depth {form.depth:.4g} m"]
        if weights is not None:
            total, rows = read_weights(weights)
            found, tables_of = _loaded(form, water, total, folder, path.name)
            lines += found
            written |= tables_of | {"weights": _weights(total, rows)}
        if at is not None:
            lines += ["", outline_at(form, at)]
    except Unavailable as error:
        raise LabError(f"{path.name}: {error}") from None
    tables.write(written, folder)
    if path.suffix.lower() in SURFACES:
        (folder / "offsets.csv").write_text(text_of(list(rows_of(form))), encoding="utf-8")
    return "\n".join([*lines, "", SIGNS])


def _loaded(form: Form, water: Water, total: Weights, folder: Path, name: str):
    """Lines and tables of a hull that carries weights."""
    level = form.floating(total.mass, water, lcg=total.lcg)
    slope = (level[-1] - level[0]) / (form.x[-1] - form.x[0])
    aft = level[0] - slope * form.x[0]
    fore, mean = aft + slope * form.perpendiculars, float(np.mean([level[0], level[-1]]))
    upright = form.hydrostatics(min(mean, form.depth), water)
    gravity = total.tcg, total.fluid_vcg
    port = Levers(HEELS, form.righting_levers(total.mass, water, HEELS, gravity, total.lcg))
    starboard = Levers(HEELS, -port.lever[::-1])
    lies = starboard.equilibrium()
    # She is judged to the side that she lists to, where her levers are less.
    side, levers = ("port", port) if lies is not None and lies < 0.0 else ("starboard", starboard)
    gm = upright.km - total.fluid_vcg
    rows = [sheet.Row("", one) for one in intact.criteria(levers, gm)]
    lines = [
        f"  weights   {total.mass:.5g} t at {total.lcg:.3f} m, {total.tcg:.3f} m to starboard, KG {total.vcg:.3f} m, "
        f"free surfaces {total.free_surface:.4g} t m",
        f"  draught   aft {aft:.3f}, forward {fore:.3f} m; trim {aft - fore:.3f} m by the stern",
        f"  KM, GM    {upright.km:.3f}, {gm:.3f} m; heel {sheet.degrees(lies)} to starboard",
        f"  levers    to {side}, the side that she is judged on",
        "",
        *aligned(rows),
    ]
    save_axes(folder / "righting-levers.png", name, lambda axes: draw_curve(axes, levers, gm, f" to {side}"))
    heel = levers.heel[levers.heel >= 0.0]
    curve = [(f"{np.degrees(h):.1f}", f"{lever:.4f}") for h, lever in zip(heel, levers.at(heel), strict=True)]
    return lines, {"criteria": tables.criteria(rows), "righting-levers": ((f"heel to {side} deg", "GZ m"), curve)}


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
