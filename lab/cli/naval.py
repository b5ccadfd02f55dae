"""The naval architect's commands: stability."""

from pathlib import Path

import click

from lab.cli.options import out_option, quiet_option, set_option


@click.command()
@click.argument("preset")
@set_option
@out_option("for figure, tables and page", "renders/stability/PRESET")
@quiet_option
def stability(preset: str, overrides: dict, out: Path | None, quiet: bool) -> None:
    """Judge the ship of PRESET by the International Grain Code and the 2008 IS Code, without a simulation.

    \b
    cargolab stability ship/handysize-grain
    cargolab stability ship/handysize-grain --set ship.gravity_height="9.6 m" --out limit
    """
    from lab.preset.find import load
    from lab.report.stability import judge

    text, folder = judge(load(preset, overrides), out)
    if not quiet:
        click.echo(text)
    click.echo(folder)
