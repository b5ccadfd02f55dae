"""The naval architect's commands: stability, hull, lewis, hydrodynamics, report."""

from pathlib import Path

import click

from lab.base.errors import LabError
from lab.cli.completion import PresetName
from lab.cli.options import (
    FilePath,
    check_files,
    check_recording,
    json_option,
    out_option,
    quiet_option,
    set_option,
    tell,
    tell_json,
)


@click.command()
@click.argument("preset", type=PresetName())
@set_option
@out_option("for figure, tables and page", "renders/stability/PRESET")
@quiet_option
@json_option
def stability(preset: str, overrides: dict, out: Path | None, quiet: bool, as_json: bool) -> None:
    """Judge the ship of PRESET by the International Grain Code and the 2008 IS Code, without a simulation.

    \b
    cargolab stability ship/handysize-grain
    cargolab stability ship/handysize-grain --set ship.gravity_height="9.6 m" --out limit
    """
    from lab.preset.find import load

    loaded = load(preset, overrides)
    from lab.report.stability import judge

    text, folder, found = judge(loaded, out)
    if as_json:
        from lab.naval.tables import objects

        tell_json({"folder": str(folder), **{name: objects(table) for name, table in found.items()}})
        return
    if not quiet:
        tell(text)
    click.echo(folder)


TABLE = FilePath(path_type=Path, dir_okay=False)


@click.command()
@click.argument("file", type=FilePath(path_type=Path))
@click.option("--weights", type=TABLE, metavar="CSV", help="Weights: name, mass, lcg, tcg, vcg, fsm, aft, forward.")
@click.option("--points", type=TABLE, metavar="CSV", help="Openings and the deck's edge: name, kind, x, y, z.")
@click.option("--holds", type=TABLE, metavar="CSV", help="Holds: hold, aft, forward, z, half_breadth.")
@click.option("--grain", type=TABLE, metavar="CSV", help="Grain: name, filling, stowage, and moment or level.")
@click.option(
    "--wind",
    type=(click.FloatRange(0, 5e4), click.FloatRange(0, 100)),
    metavar="AREA LEVER",
    help="Area exposed to wind (m2), and the height of its centre above half the draught (m).",
)
@click.option("--keels", type=click.FloatRange(0, 1e6), default=0.0, help="Area of bilge and bar keels, m2.")
@click.option("--sharp", is_flag=True, help="Her bilges are sharp.")
@click.option(
    "--density", type=click.FloatRange(500, 2000), default=1025.0, show_default=True, help="Of the water, kg/m3."
)
@click.option(
    "--stations", type=click.IntRange(3, 1001), default=41, show_default=True, help="Fewest cuts of a surface."
)
@click.option(
    "--scale", type=click.FloatRange(1e-4, 1e4), default=1.0, show_default=True, help="Metres in a surface's unit."
)
@click.option("--up", type=click.Choice(["y", "z"]), default="z", help="The axis that is up in a surface's file.")
@click.option(
    "--origin",
    type=(float, float, float),
    default=(0.0, 0.0, 0.0),
    metavar="X Y Z",
    help="Place in a surface's file that becomes the origin: m, z up.",
)
@click.option("--mirror", is_flag=True, help="A surface is half a hull: add the other side.")
@click.option("--close", is_flag=True, help="Close a surface's flat holes, as a deck or a transom.")
@click.option("--fair", is_flag=True, help="Fair curves between the offsets of a station, in place of straight lines.")
@click.option(
    "--lbp", type=click.FloatRange(0, 1e3, min_open=True), metavar="M", help="Her length between perpendiculars, m."
)
@click.option(
    "--ap", type=float, default=0.0, show_default=True, help="Place x of the aft perpendicular, m; with --lbp."
)
@click.option(
    "--lwl",
    type=click.FloatRange(0, 1e3, min_open=True),
    metavar="M",
    help="Her length in the waterline, m, for the weather criterion; as her stations show it without.",
)
@click.option(
    "--draught",
    type=click.FloatRange(0, 1e3, min_open=True),
    multiple=True,
    metavar="M",
    help="Hydrostatics at this mean draught, m; repeat for more.  [default: round draughts]",
)
@click.option(
    "--displacement",
    type=click.FloatRange(0, 1e7, min_open=True),
    multiple=True,
    metavar="T",
    help="Hydrostatics at the draught of this displacement, t; repeat for more.",
)
@click.option("--trim", type=click.FloatRange(-1e3, 1e3), default=0.0, metavar="M", help="By the stern, m.")
@click.option(
    "--step", type=click.FloatRange(0, 1e3, min_open=True), metavar="M", help="Between the round draughts, m."
)
@click.option(
    "--at", type=float, metavar="X", help="Also print the section at X (m) as the outline of a preset's ship."
)
@click.option(
    "--units",
    type=click.Choice(["metric", "imperial"]),
    default="metric",
    help="Of the tables of a ship file.",
)
@click.option(
    "--strength",
    is_flag=True,
    help="Shear force and bending moment along her in still water; with --weights.",
)
@click.option("--limiting-kg", is_flag=True, help="The largest KG that passes each criterion, at these draughts.")
@click.option(
    "--kg-trim",
    type=click.FloatRange(-1e3, 1e3),
    multiple=True,
    metavar="M",
    help="Limiting KG with this trim by the stern, m; repeat for more.  [default: --trim]",
)
@out_option("for tables and figure", "renders/hull/NAME")
@json_option
def hull(file: Path, units: str, out: Path | None, as_json: bool, **asked) -> None:
    """Hydrostatics and cross curves of the hull in FILE; with --weights her draughts, levers and criteria.

    FILE is a table of station, z, half_breadth in m (x forward from the aft perpendicular, z from the keel, rows of a
    station from the keel up), or a matrix of stations and waterlines, or a closed surface as STL (x forward, y to
    starboard, z up, y = 0 in her middle), whose axes are kept in all that is given and written; draughts are from her
    keel amidships. Masses are in t, fsm in t m, stowage in m3/t, moments of grain in m4; filling is partly-filled,
    filled or filled-as-loaded; kind is opening or deck. With --weights she is judged by the IS Code, with --wind by its
    weather criterion, with --grain by the Grain Code, with --points up to the angle of downflooding.

    FILE may be a ship file, ship.toml, or the folder with it: her tanks, holds, weights and loading conditions, which
    are judged side by side. ship/handysize is one that comes with the lab.

    \b
    cargolab hull ship/handysize --units imperial
    cargolab hull wigley.csv
    cargolab hull wigley.csv --step 0.25
    cargolab hull ship.csv --draught 8.5 --displacement 32000 --trim 0.6
    cargolab hull ship.csv --limiting-kg --kg-trim 0 --kg-trim 1.5
    cargolab hull barge.stl --scale 0.001 --weights weights.csv
    cargolab hull ship.csv --weights departure.csv --points openings.csv --holds holds.csv --grain grain.csv \\
        --wind 1500 10
    """
    from lab.naval.ship_file.reading import is_ship_file

    of_ship = is_ship_file(file)
    check_files(None if of_ship else file, *(asked[name] for name in ("weights", "points", "holds", "grain")))
    if units != "metric" and not of_ship:
        raise LabError("--units: is of ship files; a table of offsets or a surface is told in metres.")
    from lab.naval.tables import objects
    from lab.report.hull import Asked, examine
    from lab.report.ship_file.examine import examine as examine_ship

    folder = out or Path("renders/hull") / file.stem
    if of_ship:
        text, found = examine_ship(file, folder, Asked(**asked), units)
    else:
        text, found = examine(file, folder, Asked(**asked))
    if as_json:
        tell_json({"folder": str(folder), **{name: objects(table) for name, table in found.items()}})
        return
    tell(text)
    click.echo(folder)


@click.command()
@click.argument("file", type=FilePath(path_type=Path, dir_okay=False))
@click.option("--length", type=float, required=True, help="Between perpendiculars, m.")
@click.option("--breadth", type=float, required=True, help="Moulded, m.")
@click.option("--draught", type=float, required=True, help="Even, m.")
@click.option("--depth", type=float, required=True, help="From keel to deck, m.")
@click.option("--block", type=float, required=True, help="Block coefficient.")
@click.option("--kb", type=float, help="Centre of buoyancy above the keel, m; or --plane.")
@click.option("--plane", type=float, help="Waterplane coefficient, in place of --kb.")
@click.option("--midship", type=float, help="Midship coefficient; without it by Kerlen.")
def lewis(file: Path, **particulars: float | None) -> None:
    """Write a hull of Lewis sections with a ship's particulars to FILE, a CSV of offsets, where no lines are free.

    \b
    cargolab lewis s175.csv --length 175 --breadth 25.4 --draught 9.5 --depth 15.4 --block 0.569 --kb 5.207
    cargolab hull s175.csv
    """
    from lab.naval.lewis import write_lewis

    tell(write_lewis(file, particulars))


@click.command()
@click.argument("preset", type=PresetName())
@set_option
@out_option("for tables and figures", "renders/hydrodynamics/PRESET")
def hydrodynamics(preset: str, overrides: dict, out: Path | None) -> None:
    """Compare the hydrodynamic coefficients of PRESET's ship: of her section, of strips, of her hull in space.

    Added mass, damping and excitation in beam waves for each metre of her length, with the checks of Haskind and of
    energy, and her roll by linear theory with the water in her tanks. In space with the extra ship3d.

    \b
    cargolab hydrodynamics ship/barge-two-tanks
    """
    from lab.preset.find import load

    loaded = load(preset, overrides)
    from lab.studies.hydrodynamics import compare

    text, folder = compare(loaded, out)
    tell(text)
    click.echo(folder)


@click.command()
@click.argument("folder", type=FilePath(path_type=Path))
@click.option("--pdf", is_flag=True, help="Write it as PDF, too; needs WeasyPrint (the extra `pdf`).")
def report(folder: Path, pdf: bool) -> None:
    """Write one self-contained page on the run in FOLDER for the file: report.html, to be printed on A4.

    \b
    cargolab report renders/ship/handysize-grain --pdf
    """
    check_recording(folder)
    from lab.report.file import write_report

    for path in write_report(folder, pdf):
        click.echo(path)
