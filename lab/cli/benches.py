"""The commands of `cargolab bench`: cost and accuracy of the lab's results, one page each."""

import sys
from pathlib import Path

import click

from lab.cli.options import fast_option, page_option


@click.group()
def bench() -> None:
    """Measure cost and accuracy of the lab's results; each command writes a page with tables and figures."""


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
def accuracy(studies: tuple[str, ...], out: Path, fast: bool) -> None:
    """Error against cost: integrator, step, stiffness, precision, tilt rate, laws, repeats; reasons for the defaults.

    \b
    cargolab bench accuracy                an hour or two on two cores; run again, it continues
    cargolab bench accuracy stiffness rate
    """
    from lab.studies.bench.accuracy import run_page

    click.echo(run_page(studies, out, fast))


@bench.command()
@click.argument("cases", nargs=-1)
@page_option
@fast_option
def stability(cases: tuple[str, ...], out: Path, fast: bool) -> None:
    """Hard cases at the automatic step and far beyond it: correct results, or a stop with one sentence.

    \b
    cargolab bench stability
    cargolab bench stability impact column
    """
    from lab.studies.bench.stability import run_cases

    if not run_cases(cases, out, fast):
        sys.exit(1)


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
def speed(studies: tuple[str, ...], out: Path, fast: bool) -> None:
    """Grain-steps per second by grains, worlds, precision, schedule, threads; cost of a step's parts; other codes.

    \b
    cargolab bench speed
    cargolab bench speed peers          compared with LIGGGHTS and LAMMPS, where they are installed
    """
    from lab.studies.bench.speed import run_page

    click.echo(run_page(studies, out, fast))


@bench.command()
@click.argument("cases", nargs=-1)
@click.option(
    "--kills", type=click.IntRange(min=1), metavar="N", help="Number of kills for each kind of command.  [default: 50]"
)
@page_option
@fast_option
def survival(cases: tuple[str, ...], kills: int | None, out: Path, fast: bool) -> None:
    """Kill the lab at random times, take its memory and disk, give it damaged files; count how it ends.

    \b
    cargolab bench survival                   all cases; --fast: a few kills, odd folders, missing programs
    cargolab bench survival kill --kills 200
    """
    from lab.studies.bench.survival import run_cases

    if not run_cases(cases, out, fast, kills):
        sys.exit(1)


@bench.command()
@page_option
@fast_option
def outlines(out: Path, fast: bool) -> None:
    """Contact rules of irregular grains: energy error by rule and number of nodes, and cost of a step."""
    from lab.studies.bench.outlines import run_page

    click.echo(run_page(out, fast))


@bench.command()
@page_option
@fast_option
def gpu(out: Path, fast: bool) -> None:
    """Correctness against the CPU and speed on CUDA and Vulkan, where there is such a device."""
    from lab.studies.bench.gpu import run_page

    click.echo(run_page(out, fast))
