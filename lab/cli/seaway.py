"""The commands on a ship in a seaway: roll-damping, extremes and voyage."""

from pathlib import Path

import click

from lab.base.errors import LabError
from lab.cli.completion import PresetName
from lab.cli.options import (
    FilePath,
    check_files,
    json_option,
    out_option,
    quiet_option,
    set_option,
    tell,
    tell_json,
)

LENGTH = click.FloatRange(0, 1e3, min_open=True)
SHARE = click.FloatRange(0, 1, min_open=True)
POSITIVE = click.FloatRange(0, min_open=True)
SECONDS = click.FloatRange(0, 1e3, min_open=True)


@click.command("roll-damping")
@click.argument("file", type=FilePath(path_type=Path, dir_okay=False), required=False)
@click.option("--length", type=LENGTH, metavar="M", help="Between perpendiculars; without FILE.")
@click.option("--breadth", type=LENGTH, metavar="M", help="In the waterline; without FILE.")
@click.option("--draught", type=LENGTH, metavar="M", help="Even.")
@click.option("--block", type=SHARE, help="Block coefficient; without FILE.")
@click.option("--midship", type=SHARE, help="Midship coefficient; without FILE.")
@click.option("--kg", type=LENGTH, metavar="M", help="Centre of gravity above the keel line.")
@click.option("--gm", type=LENGTH, metavar="M", help="Metacentric height; without FILE.")
@click.option("--period", type=SECONDS, metavar="S", help="Natural period of roll.")
@click.option("--gyradius", type=LENGTH, metavar="M", help="Gyradius in roll with added mass, in place of --period.")
@click.option("--keels", type=(LENGTH, LENGTH), metavar="BREADTH LENGTH", help="Of each of two bilge keels, m.")
@click.option("--radius", type=LENGTH, metavar="M", help="Of the bilges.  [default: by the midship coefficient]")
@click.option(
    "--amplitude", type=click.FloatRange(0, 40, min_open=True), multiple=True, metavar="DEG", help="Repeat for more."
)
@click.option(
    "--density", type=click.FloatRange(500, 2000), default=1025.0, show_default=True, help="Of the water, kg/m3."
)
@click.option("--sea", type=(LENGTH, SECONDS), metavar="HS TP", help="Roll in this JONSWAP sea from abeam, m and s.")
@click.option("--peakedness", type=click.FloatRange(1, 7), default=3.3, show_default=True, help="Of the sea.")
@click.option(
    "--hours", type=click.FloatRange(0, 1e3, min_open=True), default=3.0, show_default=True, help="In the sea."
)
@click.option(
    "--decay",
    type=FilePath(path_type=Path, dir_okay=False),
    metavar="CSV",
    help="The record of a decay test, columns time s and roll deg or roll rad, in place of all above.",
)
@out_option("for tables and figures", "renders/roll-damping/NAME")
@json_option
def roll_damping(
    file: Path | None, amplitude: tuple, decay: Path | None, out: Path | None, as_json: bool, **asked
) -> None:
    """Roll damping of a ship without speed by Ikeda's components with bilge keels, or from a decay test.

    FILE holds the lines of her hull, as for `cargolab hull`; without it eddies and waves are by formulas for cargo
    ships. Two of --period, --gm and --gyradius say how she rolls, one of them with FILE.

    \b
    cargolab roll-damping presets/ship/s175.csv --draught 9.5 --kg 9.52 --period 20 --keels 0.4 43.75
    cargolab roll-damping presets/ship/s175.csv --draught 9.5 --kg 9.52 --period 20 --sea 4 12
    cargolab roll-damping --length 175 --breadth 25.4 --draught 9.5 --block 0.58 --midship 0.95 --kg 9.48 \\
        --gm 1 --period 20 --keels 0.4 43.75
    cargolab roll-damping --decay decay.csv
    """
    check_files(file, decay)
    from lab.naval.tables import objects

    name = next((one.stem for one in (decay, file) if one), "particulars")
    folder = out or Path("renders/roll-damping") / name
    if decay:
        if given := next((key for key, value in (("FILE", file), *asked.items()) if _said(key, value)), None):
            raise LabError(f"--decay: tells the damping by itself; leave out {_option(given)}.")
        from lab.report.rolling.decay import examine as of_decay

        text, tables, numbers = of_decay(decay, folder)
    else:
        from lab.naval.rolling.damping import Asked
        from lab.report.rolling.damping import examine

        text, tables, numbers = examine(
            Asked(file=file, **asked, **({"amplitudes": amplitude} if amplitude else {})), folder
        )
    if as_json:
        tell_json({"folder": str(folder), **numbers, **{name: objects(table) for name, table in tables.items()}})
        return
    tell(text)
    click.echo(folder)


@click.command()
@click.argument("records", type=FilePath(path_type=Path), nargs=-1, required=True)
@click.option("--hours", type=click.FloatRange(0, 1e5, min_open=True), default=3.0, show_default=True)
@click.option(
    "--block",
    type=click.FloatRange(0, min_open=True),
    metavar="S",
    help="Length of the blocks whose largest rolls are taken.  [default: that of the shortest record]",
)
@out_option("for table and figure", "renders/extremes/NAME")
@json_option
def extremes(records: tuple[Path, ...], hours: float, block: float | None, out: Path | None, as_json: bool) -> None:
    """The largest roll in some hours, from RECORDS of it, by Gumbel and by Weibull, with intervals.

    RECORDS are folders of runs of a ship in random seas, each with a seed of its own, or tables (CSV) of time s and
    roll deg or roll rad. Where they are too few or too short it says so and tells nothing.

    \b
    cargolab extremes renders/seed-*
    cargolab extremes roll.csv --block 600
    """
    from lab.naval.tables import objects
    from lab.report.rolling.extremes import examine

    folder = out or Path("renders/extremes") / records[0].stem
    text, tables = examine(records, hours, block, folder)
    if as_json:
        tell_json({"folder": str(folder), **{name: objects(table) for name, table in tables.items()}})
        return
    tell(text)
    click.echo(folder)


def _said(key: str, value: object) -> bool:
    """Whether an option is given that has nothing by itself."""
    return value is not None and key not in ("density", "peakedness", "hours")


def _option(key: str) -> str:
    return key if key.isupper() else f"--{key}"


@click.command()
@click.argument("preset", type=PresetName())
@click.option("--height", type=POSITIVE, required=True, help="Significant wave height, m.")
@click.option("--period", type=POSITIVE, required=True, help="Peak period, s.")
@click.option("--hours", type=POSITIVE, default=3.0, show_default=True, help="How long the sea lasts.")
@click.option("--span", type=POSITIVE, default=600.0, show_default=True, help="Seconds run round its worst group.")
@click.option("--seeds", type=click.IntRange(2, 1000), default=20, show_default=True, help="How many such seas.")
@click.option("--list", "limit", type=POSITIVE, default=5.0, show_default=True, help="List that counts, deg.")
@click.option("--grains", metavar="PRESET", help="The same hold with grains, to check the worst sea.")
@click.option(
    "--size", "sizes", multiple=True, metavar="LENGTH", help="Diameter of these grains; repeat, coarse first."
)
@set_option
@click.option("--no-video", is_flag=True, help="Do not film the worst sea.")
@click.option("--cost", "only_cost", is_flag=True, help="Tell what it costs, and run nothing.")
@out_option("for runs and page", "renders/voyage/PRESET")
@quiet_option
@json_option
def voyage(
    preset: str,
    height: float,
    period: float,
    hours: float,
    span: float,
    seeds: int,
    limit: float,
    grains: str | None,
    sizes: tuple[str, ...],
    overrides: dict,
    no_video: bool,
    only_cost: bool,
    out: Path | None,
    quiet: bool,
    as_json: bool,
) -> None:
    """Does the cargo of PRESET shift in her ship in this sea? Counts seas after which she lists.

    PRESET is a ship's with bulk or grains. Each seed is a sea of so many hours, abeam, of which the span round its
    worst group is run, loose and frozen; shares have Wilson's interval. The page is voyage.html. The same command
    goes on with what was interrupted.

    \b
    cargolab voyage ship/handysize-grain-bulk --height 9 --period 14 --cost
    cargolab voyage ship/handysize-grain-bulk --height 9 --period 14 --seeds 12
    cargolab voyage ship/handysize-grain-bulk --height 9 --period 14 \\
        --grains ship/handysize-grain --size "0.5 m" --size "0.35 m"
    """
    from lab.voyage.asked import Voyage

    asked = Voyage(preset, height, period, hours, span, seeds, limit, overrides)
    from lab.voyage import page
    from lab.voyage.voyage import costs, sail

    if only_cost or not quiet:
        tell(costs(asked), err=not only_cost)
    if only_cost:
        return
    found = sail(asked, out, grains=grains, sizes=sizes, video=not no_video, quiet=quiet or as_json)
    if as_json:
        tell_json({"page": str(found.page), **{key: str(text) for key, text in page.facts(asked, found.judged)}})
        return
    if not quiet:
        tell(page.describe(asked, found.judged))
    click.echo(found.page)
