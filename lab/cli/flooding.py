"""The commands on flooding by formula: flood and cross-flooding."""

from pathlib import Path

import click

from lab.cli.options import json_option, out_option, quiet_option, read_overrides, tell, tell_json

POSITIVE = click.FloatRange(0, min_open=True)
DEVICE = (POSITIVE, POSITIVE, POSITIVE)


@click.command()
@click.argument("case")
@click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    callback=read_overrides,
    help="Change a key of the case; repeat for more.",
)
@click.option("--no-video", is_flag=True, help="Do not paint the film of levels.")
@out_option("for page, tables and film", "renders/flood/CASE")
@quiet_option
@json_option
def flood(case: str, overrides: dict, no_video: bool, out: Path | None, quiet: bool, as_json: bool) -> None:
    """Flood the ship of CASE through her openings: when and how far she heels, whether she floats, capsizes or sinks.

    CASE is a TOML file with the tables hull, ship, rooms, openings and run, or one of the lab's own: cabin-bottom,
    cabin-side, wing-tank. It takes seconds: water goes by formula, she lies at rest with what is in her, or heaves and
    rolls where the case has a table motion. The page is flood.html, the film levels.mp4.

    \b
    cargolab flood wing-tank
    cargolab flood cabin-side --set ship.vcg="57 mm" --out loll
    cargolab flood barge.toml --no-video --json
    """
    from lab.naval.flooding.case import load_case

    loaded = load_case(case, overrides)
    from lab.naval.flooding.results import compute
    from lab.report.flooding import page

    results = compute(loaded)
    folder = page.write(loaded, results, out, not no_video)
    if as_json:
        from lab.naval.flooding.tables import all_of
        from lab.naval.tables import objects

        found = {name: objects(table) for name, table in all_of(results).items()}
        tell_json({"folder": str(folder), **page.numbers(results), **found})
        return
    if not quiet:
        tell(page.describe(loaded, results))
    click.echo(folder)


@click.command("cross-flooding")
@click.option("--volume", type=POSITIVE, required=True, help="Water that fills the room on the other side, m3.")
@click.option("--head", type=POSITIVE, required=True, help="Head when it begins, m.")
@click.option("--last", type=click.FloatRange(0), default=0.0, show_default=True, help="Head when it ends, m.")
@click.option(
    "--device",
    type=DEVICE,
    multiple=True,
    metavar="AREA K SHARE",
    help="A duct, pipe or valve that the flow passes: area (m2), sum of its k, and the volume through it over that "
    "through the first one (1 if all passes); repeat for those behind it.",
)
@click.option(
    "--girders",
    type=(POSITIVE, POSITIVE, click.IntRange(1), click.IntRange(1, 2)),
    metavar="AREA LENGTH COUNT MANHOLES",
    help="A double bottom as the duct: area of its manholes (m2), distance of girders (m), number of spaces between "
    "them, manholes in each girder.",
)
@click.option("--beside", type=(POSITIVE, POSITIVE), multiple=True, metavar="AREA K", help="A duct beside these.")
@click.option("--heel", type=(POSITIVE, POSITIVE), metavar="VOLUME HEAD", help="What is left from a heel on the way.")
@click.option("--gravity", type=POSITIVE, default=9.81, show_default=True, help="m/s2.")
@json_option
def cross_flooding(as_json: bool, **asked) -> None:
    """Time of cross-flooding by IMO resolution MSC.362(92), by its formula and by integration.

    \b
    cargolab cross-flooding --volume 120 --head 4 --last 1 --device 0.5 2.5 1
    cargolab cross-flooding --volume 120 --head 4 --girders 0.36 2.4 5 1
    cargolab cross-flooding --volume 120 --head 4 --device 0.5 2.5 1 --device 0.3 1.2 1 --beside 0.2 1.8
    """
    from lab.naval.flooding.crossing import Asked, told

    lines, found = told(Asked(**asked))
    if as_json:
        tell_json(found)
        return
    tell("\n".join(lines))
