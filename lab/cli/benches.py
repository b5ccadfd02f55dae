"""The commands of `cargolab bench`: cost and accuracy of the lab's results, one page each.

What they call is in the package `benchmarks` beside the lab's, which an installed lab has not.
"""

import sys
from importlib import import_module
from pathlib import Path
from types import ModuleType

import click

from lab.base.data import BENCHMARKS
from lab.base.errors import LabError
from lab.cli.options import fast_option, page_only_option, page_option


def _of(name: str) -> ModuleType:
    """A module of the benchmarks. Raises LabError where they are not beside the lab."""
    if not (BENCHMARKS / "bench.py").exists():
        raise LabError(
            "the benchmarks come with the lab's source and not with its package: clone the source, call "
            f"`make demo` in it, then `.venv/bin/cargolab bench {name}`."
        )
    if (home := str(BENCHMARKS.parent)) not in sys.path:  # also of the processes that are started from here
        sys.path.insert(0, home)
    return import_module(f"benchmarks.{name}")


@click.group()
def bench() -> None:
    """Measure cost and accuracy of the lab's results; each command writes a page with tables and figures.

    What is measured is kept beside the page with version, date and processor, and only done again where it is named or
    the code has changed. They are in the lab's source, not in its package.
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
    click.echo(_of("accuracy").BENCH.run(studies, out, fast, page_only))


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
    if not _of("stability").SUITE.run(cases, out, fast, page_only):
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
    click.echo(_of("speed").run_page(studies, out, fast, page_only))


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
    click.echo(_of("water").BENCH.run(studies, out, fast, page_only))


@bench.command()
@page_option
@fast_option
@page_only_option
def outlines(out: Path, fast: bool, page_only: bool) -> None:
    """Contact rules of irregular grains: energy error by rule and number of nodes, and cost of a step."""
    click.echo(_of("outlines").BENCH.run((), out, fast, page_only))


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
    click.echo(_of("gpu").BENCH.run(studies, out, fast, page_only))
