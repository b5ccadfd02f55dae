"""Commands on the machine: what it has, and what the lab keeps on it."""

import click

from lab.cli.options import json_option, tell, tell_json


@click.command()
@json_option
def doctor(as_json: bool) -> None:
    """Show what this machine has, and what follows for the lab.

    \b
    cargolab doctor           cores, vectors, memory, GPU, display, ffmpeg, cache, disk, extras
    cargolab doctor --json    the same for a report of an error
    A line with ~ makes runs slower; what a line with - is about, only some runs need.
    """
    from lab.doctor.machine import as_objects, examine, told, works

    findings = examine()
    if as_json:
        tell_json(as_objects(findings))
    else:
        tell(told(findings).rstrip())
    if not works():
        click.get_current_context().exit(1)


@click.command()
@click.argument("names", nargs=-1, metavar="[STORE]...")
@click.option("--clear", is_flag=True, help="Delete what these stores hold, or all.")
def cache(names: tuple[str, ...], clear: bool) -> None:
    """Show what the lab keeps between runs: compiled kernels, settled beds, hulls.

    \b
    cargolab cache                    sizes, and what deleting costs
    cargolab cache --clear beds       delete settled beds
    cargolab cache --clear            delete everything
    Results are not kept there: nothing but time is lost.
    """
    from lab.base.errors import LabError
    from lab.doctor import cache as kept

    if names and not clear:
        raise LabError("cache: name stores together with --clear; without it all are shown.")
    if clear:
        tell(f"{kept.clear(names) / 2**20:.1f} MiB deleted")
    else:
        tell(kept.told().rstrip())
