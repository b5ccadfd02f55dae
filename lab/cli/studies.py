"""The commands that list presets and check the lab's numbers: list, gallery, reproduce, verify."""

import sys
from pathlib import Path

import click

from lab.cli.options import (
    cluster_option,
    fast_option,
    json_option,
    out_option,
    page_only_option,
    page_option,
    quiet_option,
    tell,
    tell_json,
)
from lab.preset.accuracy import LEVELS

REPORTS = "granular", "shapes", "ship", "water", "coupled", "space", "wet", "flooding"


@click.command("list")
@click.argument("group", required=False, default="")
@click.option("--search", metavar="WORD", help="Only those with this word in name, title, source or what it reports.")
@json_option
def list_presets(group: str, search: str | None, as_json: bool) -> None:
    """List the presets: all, or those of a GROUP, which is the beginning of their names.

    \b
    cargolab list
    cargolab list ship
    cargolab list --search "anti-roll"
    cargolab list --json
    """
    from lab.preset.find import QUICK, listed

    found = listed(group, search or "")
    if as_json:
        tell_json(found)
        return
    quick = {one["name"] for one in found if one["quick"]}
    shown = {
        one["name"] + f"[{QUICK}]" * (one["name"] + QUICK in quick): one["title"] for one in found if not one["quick"]
    }
    width = max(map(len, shown), default=0)
    for name, title in shown.items():
        tell(f"{name:<{width}}  {title}")
    if quick:
        click.echo(f"\n[{QUICK}]: also available under that longer name, cheaper and less accurate", err=True)


@click.command()
@click.argument("cases", nargs=-1)
@click.option("--level", type=click.Choice(list(LEVELS)), help="Cases of grains at the steps of a level of accuracy.")
@page_option
@fast_option
@page_only_option
@json_option
def verify(cases: tuple[str, ...], level: str | None, out: Path, fast: bool, page_only: bool, as_json: bool) -> None:
    """Compare small scenes with closed forms, independent integrations and published numbers.

    \b
    cargolab verify                     all CASES, and a page with a table and figures; run again, it continues
    cargolab verify --fast
    cargolab verify oblique incline     these, or those whose names begin so
    cargolab verify --level draft       a page of its own
    """
    from lab.studies.verify import SUITE, suite_at
    from lab.studies.verify.scenes import at_level

    with at_level(level or "reference"):
        suite = suite_at(level) if level else SUITE
        passed = suite.run(cases, out, fast, page_only, aside=as_json)
    if as_json:
        tell_json({"passed": passed, "cases": suite.kept(cases, out, fast)})
    if not passed:
        sys.exit(1)


@click.command()
@click.argument("what", metavar="REPORT", type=click.Choice(REPORTS))
@click.argument("experiments", nargs=-1)
@click.option("--quick", is_flag=True, help="Fewer beds, faster tilts, draft accuracy: under 20 minutes on two cores.")
@out_option("of the report and of its runs", default=Path("renders/reproduce"))
@page_only_option
@cluster_option
@quiet_option
def reproduce(
    what: str, experiments: tuple[str, ...], quick: bool, out: Path, page_only: bool, cluster: str | None, quiet: bool
) -> None:
    """Run the experiments of the source and write a report: its statements, our results, differences, cost.

    \b
    cargolab reproduce granular --quick
    cargolab reproduce granular                 hours on two cores; run again, it continues
    cargolab reproduce granular tilt-fill stack these EXPERIMENTS, or those whose names begin so
    cargolab reproduce shapes --quick           those with irregular grains
    cargolab reproduce ship --quick             those with ships in waves
    cargolab reproduce water --quick            those with water in tanks
    cargolab reproduce coupled --quick          those with water in the tanks of ships
    cargolab reproduce space --quick            those with spheres in space
    cargolab reproduce wet --quick              those with water between grains
    cargolab reproduce flooding --quick         bodies that float and flood in space
    cargolab reproduce granular --cluster tcp://node1:8786
    """
    from lab.studies.reproduce import reproduce as reproduced

    click.echo(reproduced(what, experiments, out, quick, quiet, cluster, page_only))


@click.command()
@click.argument("presets", nargs=-1)
@out_option("of the page", default=Path("renders/gallery/presets"))
@click.option("--repeats", "beds", type=click.IntRange(1), default=1, show_default=True, help="Beds of each preset.")
@quiet_option
def gallery(presets: tuple[str, ...], out: Path, beds: int, quiet: bool) -> None:
    """Run every preset, or those whose names begin with PRESETS, and show them on one page: clips and numbers.

    \b
    cargolab gallery                  some hours on two cores; run again, it continues
    cargolab gallery tilting funnel
    """
    from lab.studies.gallery import make_gallery

    click.echo(make_gallery(presets, out, quiet, beds))
