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
@click.argument("recordings", type=click.Path(path_type=Path), nargs=-1, required=True)
@click.option(
    "--out",
    type=click.Path(path_type=Path),
    metavar="PLACE",
    help="An .mp4 file, or with --png a folder; of several recordings a folder.  [default: beside each recording]",
)
@click.option("--colour", cls=ColourOption)
@click.option("--frame", help="Frame of reference: tank or earth.")
@click.option("--width", type=int, help="Width in pixels.")
@click.option("--height", type=int, help="Height in pixels.")
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: side by side]")
@click.option("--png/--mp4", default=False, help="Single pictures, or a video (the default).")
@click.option("--sound", is_flag=True, help="Paint a damaged recording up to the damage.")
def render(recordings: tuple[Path, ...], out: Path | None, **wishes: object) -> None:
    """Paint the videos of RECORDINGS again: recording.h5 files, folders of runs or of sweeps, and patterns of these.

    \b
    cargolab render renders/tilting/quick --colour displacement --out shift.mp4
    cargolab render renders/tilting/quick --frame earth --world 2
    cargolab render renders/tilting/quick --png --out pictures
    cargolab render renders/shaking/sway-sweep --out films          each point of a sweep
    cargolab render "renders/**/barge*" --width 1920 --height 1080  all that match
    Several are painted side by side, one process a core. Run again, it leaves out videos that are newer than their
    recording and were made with the same options. If one cannot be painted, the others are, and it exits with 2.
    """
    from lab.paint.many import find_recordings

    found, empty = find_recordings(recordings)
    if len(recordings) == 1 and found in ([recordings[0]], [recordings[0].parent]):
        _render_one(recordings[0], out, wishes)
    else:
        _render_many(found, empty, out, wishes)


def _render_one(recording: Path, out: Path | None, wishes: dict) -> None:
    from lab.base.progress import Progress
    from lab.paint.video import render_recording

    with Progress(quiet=False) as progress:

        def count(done: int, total: int) -> None:
            if done == 1:  # not before, so that an error is printed as one line without a bar
                progress.start("painting", total)
            progress.reach(done)

        path = render_recording(recording, out, progress=count, **wishes)
    click.echo(path)


def _render_many(found: list[Path], empty: dict[Path, str], out: Path | None, wishes: dict) -> None:
    from lab.base.progress import Progress
    from lab.paint.many import paint_all, plan

    if not found:
        raise LabError(next(iter(empty.values())))
    jobs = plan(found, out, bool(wishes["png"]))
    with Progress(quiet=False) as progress:
        failed = empty | paint_all(jobs, wishes, progress)
    for job in jobs:
        if job.path not in failed:
            click.echo(job.target)
    for sentence in failed.values():
        click.echo(sentence, err=True)
    if failed:
        raise LabError(f"{len(failed)} of {len(jobs) + len(empty)} were not painted: see above.")
