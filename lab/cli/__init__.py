"""The command `cargolab`, one file per family of commands. They import late, so that `--help` stays fast."""

import click

from lab import __version__
from lab.cli.benches import bench
from lab.cli.errors import Commands
from lab.cli.exports import export
from lab.cli.flooding import cross_flooding, flood
from lab.cli.machine import cache, doctor
from lab.cli.naval import hull, hydrodynamics, lewis, report, stability
from lab.cli.options import plugins_option
from lab.cli.pictures import beside, poster, render, sheet, view
from lab.cli.presets import cargoes, outline, schema
from lab.cli.runs import bed, explain, resume, run
from lab.cli.seaway import extremes, roll_damping, voyage
from lab.cli.studies import gallery, list_presets, reproduce, verify
from lab.cli.sweeps import calibrate, sweep


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(__version__, prog_name="cargolab", message="%(prog)s %(version)s", help="Show the version.")
def main() -> None:
    """Experiments on loose cargo: run one, watch it, get a number with its error.

    \b
    cargolab list                    list the experiments
    cargolab run tilting/quick       run one, with video, plot and summary
    cargolab view tilting/quick      run one live in a window and steer it
    cargolab explain tilting/quick   show what it simulates and what it will cost
    cargolab stability SHIP          judge her by the codes, without a run
    cargolab flood CASE              let water into her rooms, by formula
    cargolab sweep shaking/sway ...  run one for many values of its keys
    cargolab voyage SHIP ...         whether her cargo shifts in a sea, over many seeds
    cargolab export DIR --to html    give it to others: a player, or ParaView, OVITO, tables
    cargolab resume DIR              continue an interrupted run or sweep
    """


for command in (
    bed,
    bench,
    beside,
    cache,
    calibrate,
    cargoes,
    cross_flooding,
    doctor,
    explain,
    export,
    extremes,
    flood,
    gallery,
    hull,
    hydrodynamics,
    lewis,
    list_presets,
    outline,
    poster,
    render,
    report,
    reproduce,
    resume,
    roll_damping,
    run,
    schema,
    sheet,
    stability,
    sweep,
    verify,
    view,
    voyage,
):
    main.add_command(command)

for command in (bed, beside, calibrate, explain, poster, render, report, resume, run, sheet, sweep, view):
    plugins_option(command)
