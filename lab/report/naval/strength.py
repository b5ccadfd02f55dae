"""Longitudinal strength of a hull in still water: its table, its figure, and the sentences beside them."""

from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np

from lab.base.errors import LabError
from lab.measures.drawing import BLUE, GREY, VERMILION
from lab.naval import tables
from lab.report.page import save_figure
from lab.report.plots import BELOW, STYLE, canvas
from solvers.ship.naval.form import Form
from solvers.ship.naval.whole_hull.strength import Beam

NAME = "strength"
MEGA = 1e3  # kN in MN
SIGN = "Loads are positive downward and summed forward from the aft end; a hogging moment is positive (IACS UR S11)."


def table(form: Form, beam: Beam) -> tables.Table:
    """Weight, buoyancy, load, shear and moment at her stations; at a weight's end or place, forward of it."""
    x = np.unique(np.concatenate([form.x, beam.x[[0, -1]]]))
    curves = beam.weight, beam.buoyancy, beam.load, beam.shear, beam.moment
    k = np.searchsorted(beam.x, x)
    lines = [(f"{at:.3f}", *(f"{curve[one]:.1f}" for curve in curves)) for at, one in zip(x, k, strict=True)]
    return ("x m", "weight kN/m", "buoyancy kN/m", "load kN/m", "shear kN", "moment kN m"), lines


def shown(beam: Beam) -> list[str]:
    """The largest values with their places, what was left open at the forward end, and the sign."""
    told = ["Longitudinal strength in still water:"]
    rows = (
        ("largest shear force", "shear", 1.0, "kN"),
        ("least shear force", "shear", -1.0, "kN"),
        ("largest hogging moment", "moment", 1.0, "kN m"),
        ("largest sagging moment", "moment", -1.0, "kN m"),
    )
    for name, curve, way, unit in rows:
        value, place = beam.most(curve, way)
        none = way * value <= 1e-6 * float(np.abs(getattr(beam, curve)).max() or 1.0)
        told.append(f"  {name:<22}  " + ("none" if none else f"{value:,.0f} {unit} at {place:.2f} m".replace(",", " ")))
    told.append(
        f"  open at the fore end    {beam.open_shear:.3g} kN, {beam.open_moment:.3g} kN m: taken out by the length"
    )
    if beam.points:
        names = ", ".join(one.name for one in beam.points)
        told.append(f"  at a point, without extent: {names}. Give aft and forward, or their moment is too large.")
    return [*told, f"  {SIGN}"]


def write_figure(folder: Path, name: str, beam: Beam, file: str = NAME) -> Path:
    """Weight, buoyancy and load above, shear force and bending moment below. Raises LabError where it cannot."""
    with matplotlib.rc_context(STYLE):
        figure, panels = canvas((6.4, 6.4), rows=3, sharex=True)
        above, middle, below = np.ravel(panels)
        above.plot(beam.x, beam.weight, color=VERMILION, label="weight")
        above.plot(beam.x, beam.buoyancy, color=BLUE, label="buoyancy")
        above.plot(beam.x, beam.load, color=GREY, label="load: weight less buoyancy")
        above.set_ylabel("kN/m")
        _mark_points(above, beam.points)
        middle.plot(beam.x, beam.shear / MEGA, color="black")
        middle.set_ylabel("shear (MN)")
        below.plot(beam.x, beam.moment / MEGA, color="black")
        below.set_ylabel("moment (MN m),\nhogging positive")
        below.set_xlabel("x (m)")
        for axes in (above, middle, below):
            axes.axhline(0.0, color=GREY, lw=0.8)
        above.set_title(name, parse_math=False)
        figure.legend(loc=BELOW, ncols=2)
        try:
            return save_figure(folder / f"{file}.png", figure)
        except OSError as error:
            raise LabError(f"{folder} cannot be written ({error.strerror}): choose another folder.") from error


def _mark_points(axes, points: Sequence) -> None:
    """A mark on the axis for each weight at a point."""
    if points:
        axes.plot([one.centre for one in points], [0.0] * len(points), "v", color=VERMILION, label="weights at a point")
