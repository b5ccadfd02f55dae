"""The commands for pictures: view, a window in which an experiment runs; render, a video; poster, sheet and beside."""

from collections.abc import Callable
from pathlib import Path

import click

from lab.base.errors import LabError
from lab.cli.completion import PresetName
from lab.cli.options import ColourOption, FilePath, check_recording, out_option, set_option, tell
from lab.preset.units import quoted


@click.command()
@click.argument("preset", type=PresetName(), required=False)
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


STYLE = {
    "frame": "Frame of reference: tank or earth.",
    "theme": "Colours of the page: light or dark.",
    "cargo": "What the grains look like: wheat, iron-ore, coal …",
    "overlay": "What is drawn over the grains: none, trails or forces.",
    "inset": "What is shown larger beside the tank: none, surface or impact.",
    "azimuth": "In space, how far to the right the camera stands, e.g. '30 deg'.",
    "elevation": "In space, how steeply it looks down, e.g. '20 deg'.",
    "orbit": "In space, how often it goes round during the film.",
    "cut": "In space, leaves out what is in front of this x, e.g. '0 mm'.",
    "slice": "In space, shows a slice of this thickness, e.g. '20 mm'.",
}


def style_options(command: Callable) -> Callable:
    """The options of all commands that paint: colour, size, and the style of [video]."""
    for name, says in reversed(STYLE.items()):
        command = click.option(f"--{name}", help=says)(command)
    for name in ("height", "width"):
        command = click.option(f"--{name}", type=int, help=f"{name.capitalize()} in pixels.")(command)
    return click.option("--colour", cls=ColourOption)(command)


@click.command()
@click.argument("recordings", type=FilePath(path_type=Path), nargs=-1, required=True)
@click.option(
    "--out",
    type=FilePath(path_type=Path),
    metavar="PLACE",
    help="An .mp4, .gif or .webp file, or with --png a folder; of several recordings a folder.  "
    "[default: beside each recording]",
)
@style_options
@click.option("--speed", type=float, help="Playback speed; 1 is as in nature.")
@click.option(
    "--hero", is_flag=True, help="1920x1080 at 60 pictures a second, slow at the event, ends with the result."
)
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: side by side]")
@click.option("--png/--mp4", default=False, help="Single pictures, or a video (the default).")
@click.option("--sound", is_flag=True, help="Paint a damaged recording up to the damage.")
def render(recordings: tuple[Path, ...], out: Path | None, **wishes: object) -> None:
    """Paint the videos of RECORDINGS again: recording.h5 files, folders of runs or of sweeps, and patterns of these.

    \b
    cargolab render renders/tilting/quick --colour displacement --out shift.mp4
    cargolab render renders/tilting/quick --frame earth --world 2
    cargolab render renders/tilting/quick --png --out pictures
    cargolab render renders/ship/capsize-map --hero --theme dark
    cargolab render renders/sloshing/quick --out waves.webp --width 480 --height 480
    cargolab render renders/shaking/sway-sweep --out films          each point of a sweep
    cargolab render "renders/**/barge*" --width 1920 --height 1080  all that match
    A long one is painted in batches on all cores; several are painted side by side, one process a core. Run again,
    it leaves out videos that are newer than their recording and were made with the same options. If one cannot be
    painted, the others are, and it exits with 2.
    """
    from lab.paint.many import find_recordings

    found, empty = find_recordings(recordings)
    if len(recordings) == 1 and found in ([recordings[0]], [recordings[0].parent]):
        _render_one(recordings[0], out, wishes)
    else:
        _render_many(found, empty, out, wishes)


def _render_one(recording: Path, out: Path | None, wishes: dict) -> None:
    check_recording(recording)
    from lab.base.progress import Progress
    from lab.paint.edit.batches import batches_for, paint_batches
    from lab.paint.video import render_recording, target_of
    from solvers.machine.runtime import available_cores

    target = target_of(recording, out, bool(wishes["png"]))
    batches, begun = batches_for(recording, target, wishes, available_cores()), []
    with Progress(quiet=False) as progress:

        def count(done: int, total: int) -> None:
            if not begun:  # not before, so that an error is printed as one line without a bar
                progress.start("painting", total)
                begun.append(total)
            progress.reach(done)

        if batches > 1:
            path = paint_batches(recording, target, batches, wishes, count)
        else:
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
        tell(sentence, err=True)
    if failed:
        raise LabError(f"{len(failed)} of {len(jobs) + len(empty)} were not painted: see above.")


@click.command()
@click.argument("recording", type=FilePath(path_type=Path))
@click.option("--out", type=FilePath(path_type=Path), help="A .png file.  [default: poster.png beside the recording]")
@click.option("--time", type=float, help="Time in s.  [default: the end]")
@click.option("--event", is_flag=True, help="The moment at which most happens.")
@click.option("--world", type=int, help="One of the repeats, from 0.  [default: side by side]")
@style_options
def poster(recording: Path, out: Path | None, event: bool, **wishes: object) -> None:
    """Paint one picture of RECORDING.

    \b
    cargolab poster renders/ship/capsize-map --theme dark --width 3840 --height 2160
    cargolab poster renders/sloshing/quick --event --inset impact
    """
    check_recording(recording)
    from lab.paint.video import poster as paint
    from lab.paint.video import telling_time

    if event:
        wishes["time"] = telling_time(recording, wishes["world"])
    click.echo(paint(recording, out, **wishes))


@click.command()
@click.argument("recording", type=FilePath(path_type=Path))
@click.option("--out", type=FilePath(path_type=Path), help="A .png file.  [default: sheet.png beside the recording]")
@click.option("--world", type=int, help="One of the repeats, from 0.")
@style_options
def sheet(recording: Path, out: Path | None, **wishes: object) -> None:
    """Paint six telling moments of RECORDING, and its whole curve, in one picture.

    \b
    cargolab sheet renders/tilting/quick
    cargolab sheet renders/ship/capsize-map --width 1080 --height 1080 --out sheet.png
    """
    check_recording(recording)
    from lab.paint.video import contact_sheet

    click.echo(contact_sheet(recording, out, **wishes))


@click.command()
@click.argument("recordings", type=FilePath(path_type=Path), nargs=-1, required=True)
@click.option(
    "--out", type=FilePath(path_type=Path), required=True, help="An .mp4, .gif or .webp file, or .png: the end alone."
)
@click.option("--caption", multiple=True, help="A name for each recording, in turn.  [default: those of the folders]")
@click.option("--title", help="Title of the picture.  [default: that of the first recording]")
@click.option("--speed", type=float, help="Playback speed; 1 is as in nature.")
@click.option("--frozen", is_flag=True, help="After each ship the same one with her cargo frozen.")
@style_options
def beside(recordings: tuple[Path, ...], out: Path, caption: tuple[str, ...], **wishes: object) -> None:
    """Film RECORDINGS side by side, such as variants of one experiment, in one scale and one time.

    \b
    cargolab beside renders/ship/barge-3dof renders/ship/barge-empty --caption loose --caption empty --out both.mp4
    cargolab beside renders/ship/capsize-map-quick --frozen --out frozen.mp4
    """
    if caption and len(caption) != len(recordings):
        raise LabError(f"--caption: {len(caption)} for {len(recordings)} recordings; give one for each, or none.")
    for recording in recordings:
        check_recording(recording)
    from lab.paint.video import render_grid

    alone = len(recordings) == 1 and bool(wishes["frozen"])
    names = caption or ([""] if alone else [path.name for path in recordings])
    click.echo(render_grid(recordings, names, out, **wishes))
