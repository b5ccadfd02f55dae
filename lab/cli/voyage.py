"""The command voyage: whether a cargo shifts in a ship in a sea."""

from pathlib import Path

import click

from lab.cli.options import json_option, out_option, quiet_option, read_overrides, tell, tell_json

POSITIVE = click.FloatRange(0, min_open=True)


@click.command()
@click.argument("preset")
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
@click.option(
    "--set",
    "overrides",
    multiple=True,
    metavar="KEY=VALUE",
    callback=read_overrides,
    help="Change a key of the preset; repeat for more.",
)
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
