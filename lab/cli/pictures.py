"""The commands for pictures: view, a window in which an experiment runs, and render, a video."""

from pathlib import Path

import click

from lab.base.errors import LabError
from lab.cli.options import ColourOption, out_option, set_option
from lab.preset.units import quoted


@click.command()
@click.argument("preset", required=False)
@set_option
@out_option("for the recording", "renders/view/PRESET")
@click.option(
    "--size", default="1280x720", show_default=True, metavar="WIDTHxHEIGHT", help="Size of the window in pixels."
)
@click.option(
    "--window",
    type=click.Choice(["auto", "ggui", "gui"]),
    default="auto",
    help="GGUI needs Vulkan; gui is drawn by the processor.  [default: the first that opens]",
)
def view(preset: str | None, overrides: dict, out: Path | None, size: str, window: str) -> None:
    """Run PRESET live in a window: tilt and shake the tank, change friction, rewind, keep the result.

    \b
    cargolab view                                         choose one in the window
    cargolab view tilting/quick
    cargolab view shaking/sway-quick --set grains.diameter="4 mm" --size 1920x1080
    cargolab run --replay renders/view/tilting/quick      the same again, without a window
    """
    from lab.preset.find import load

    pixels = _pixels(size)
    if preset:
        load(preset, overrides)
    from lab.view.windows import open_window

    if folder := open_window(preset, overrides, pixels, out, window):
        click.echo(folder)


def _pixels(text: str) -> tuple[int, int]:
    """Width and height from 1280x720."""
    width, _, height = text.lower().partition("x")
    if not (width.isdigit() and height.isdigit() and 640 <= int(width) <= 7680 and 360 <= int(height) <= 4320):
        raise LabError(f"--size {quoted(text)[1:-1]}: write it like --size 1280x720; at least 640x360.")
    return int(width), int(height)


@click.command()
@click.argument("recording", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="An .mp4 file, or with --png a folder.  [default: beside the recording]",
)
@click.option("--colour", cls=ColourOption)
@click.option("--frame", help="Frame of reference: tank or earth.")
@click.option("--width", type=int, help="Width in pixels.")
@click.option("--height", type=int, help="Height in pixels.")
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: side by side]")
@click.option("--png/--mp4", default=False, help="Single pictures, or a video (the default).")
@click.option("--sound", is_flag=True, help="Paint a damaged recording up to the damage.")
def render(recording: Path, out: Path | None, png: bool, **look: object) -> None:
    """Paint the video of RECORDING (a recording.h5 or the folder of a run) again.

    \b
    cargolab render renders/tilting/quick --colour displacement --out shift.mp4
    cargolab render renders/tilting/quick --frame earth --world 2
    cargolab render renders/tilting/quick --png --out pictures
    """
    from lab.base.progress import Progress
    from lab.paint.video import render_recording

    with Progress(quiet=False) as progress:

        def count(done: int, total: int) -> None:
            if done == 1:  # not before, so that an error is printed as one line without a bar
                progress.start("painting", total)
            progress.reach(done)

        path = render_recording(recording, out, png=png, progress=count, **look)
    click.echo(path)
