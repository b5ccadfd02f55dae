"""The command that writes recordings in the formats of other programs."""

from pathlib import Path

import click

from lab.cli.options import FilePath, check_recording, tell
from lab.export.names import FRAMES, NAMES


@click.command()
@click.argument("recording", type=FilePath(path_type=Path))
@click.option("--to", type=click.Choice([*NAMES]), required=True, help="The format: see docs/exporting.md.")
@click.option(
    "--out",
    type=FilePath(path_type=Path),
    metavar="PLACE",
    help="A new file, or a new folder for vtkhdf and csv.  [default: beside the recording]",
)
@click.option("--every", type=click.IntRange(min=1), default=1, metavar="N", help="One of so many frames.")
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: the first; all in netcdf]")
@click.option("--frame", type=click.Choice(FRAMES), help="Frame of reference.  [default: earth; tank in netcdf]")
@click.option("--sound", is_flag=True, help="Export a damaged recording up to the damage.")
def export(recording: Path, to: str, out: Path | None, world: int | None, sound: bool, **wishes: object) -> None:
    """Write RECORDING, a recording.h5 file or the folder of a run, for other programs.

    \b
    cargolab export renders/tilting/quick --to vtkhdf            for ParaView: a file for each thing
    cargolab export renders/sloshing/quick --to gsd --every 4    for OVITO
    cargolab export renders/ship/capsize-map --to html           a player in one file, for any browser
    cargolab export renders/tilting/quick --to csv --frame tank --out tables
    A run that goes on, or was killed, is exported as far as it came.
    """
    check_recording(recording)
    from lab.base.progress import Progress
    from lab.export.exporting import export_recording, left_out

    begun = []
    with Progress(quiet=False) as progress:

        def count(done: int, total: int) -> None:
            if not begun:  # not before, so that an error is printed as one line without a bar
                progress.start("exporting", total)
                begun.append(total)
            progress.reach(done)

        path = export_recording(recording, to, out, world=world, sound=sound, progress=count, **wishes)
    if said := left_out(recording, to, world):
        tell(f"note: {said}", err=True)
    click.echo(path)
