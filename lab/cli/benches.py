"""The commands of `cargolab bench`: cost and accuracy of the lab's results, one page each."""

import sys
from pathlib import Path

import click

from lab.cli.options import fast_option, page_only_option, page_option


@click.group()
def bench() -> None:
    """Measure cost and accuracy of the lab's results; each command writes a page with tables and figures.

    What is measured is kept beside the page with version, date and processor, and only done again where it is named or
    the code has changed.
    """


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
@page_only_option
def accuracy(studies: tuple[str, ...], out: Path, fast: bool, page_only: bool) -> None:
    """Error against cost: integrator, step, stiffness, precision, tilt rate, laws, repeats; reasons for the defaults.

    \b
    cargolab bench accuracy                an hour or two on two cores; run again, it continues
    cargolab bench accuracy stiffness rate
    """
    from lab.studies.bench.accuracy import BENCH

    click.echo(BENCH.run(studies, out, fast, page_only))


@bench.command()
@click.argument("cases", nargs=-1)
@page_option
@fast_option
@page_only_option
def stability(cases: tuple[str, ...], out: Path, fast: bool, page_only: bool) -> None:
    """The longest stable step of each integrator under each law of contact, beside the derived one.

    \b
    cargolab bench stability
    cargolab bench stability map-verlet
    """
    from lab.studies.bench.stability import SUITE

    if not SUITE.run(cases, out, fast, page_only):
        sys.exit(1)


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
@page_only_option
def speed(studies: tuple[str, ...], out: Path, fast: bool, page_only: bool) -> None:
    """Grain-steps per second by grains, worlds, precision, schedule, threads; cost of a step's parts; other codes.

    \b
    cargolab bench speed
    cargolab bench speed peers          compared with LIGGGHTS and LAMMPS, where they are installed
    """
    from lab.studies.bench.speed import run_page

    click.echo(run_page(studies, out, fast, page_only))


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
@page_only_option
def water(studies: tuple[str, ...], out: Path, fast: bool, page_only: bool) -> None:
    """Water: particle-steps and simulated seconds a second beside DualSPHysics, where it is installed; errors of both.

    \b
    cargolab bench water
    cargolab bench water accuracy
    """
    from lab.studies.bench.water import BENCH

    click.echo(BENCH.run(studies, out, fast, page_only))


@bench.command()
@page_option
@fast_option
@page_only_option
def outlines(out: Path, fast: bool, page_only: bool) -> None:
    """Contact rules of irregular grains: energy error by rule and number of nodes, and cost of a step."""
    from lab.studies.bench.outlines import BENCH

    click.echo(BENCH.run((), out, fast, page_only))


@bench.command()
@click.argument("studies", nargs=-1)
@page_option
@fast_option
@page_only_option
def gpu(studies: tuple[str, ...], out: Path, fast: bool, page_only: bool) -> None:
    """Correctness against the CPU and speed on CUDA and Vulkan, where there is such a device.

    \b
    cargolab bench gpu
    cargolab bench gpu cuda-water
    """
    from lab.studies.bench.gpu import BENCH

    click.echo(BENCH.run(studies, out, fast, page_only))
