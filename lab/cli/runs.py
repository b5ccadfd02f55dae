"""The commands for one run: run, resume, explain."""

from contextlib import ExitStack
from pathlib import Path

import click

from lab.base.costs import importing
from lab.base.errors import LabError
from lab.cli.completion import PresetName
from lab.cli.options import (
    FilePath,
    arch_option,
    check_recording,
    json_option,
    out_option,
    plots_option,
    quiet_option,
    repeats_option,
    set_option,
    short_overrides,
    show,
    tell,
    tell_json,
    video_option,
)


@click.command()
@click.argument("preset", type=PresetName(), required=False)
@set_option
@click.option(
    "--replay",
    type=FilePath(path_type=Path),
    metavar="DIR",
    help="Instead of a preset: a recording of `cargolab view`, repeated bit for bit.",
)
@out_option("for the results", "renders/PRESET")
@repeats_option
@arch_option
@video_option
@plots_option
@quiet_option
def run(
    preset: str | None,
    overrides: dict,
    replay: Path | None,
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    no_video: bool,
    no_plots: bool,
    quiet: bool,
) -> None:
    """Run PRESET: a name from `cargolab list`, or your own .toml file.

    \b
    cargolab run tilting/quick
    cargolab run tilting/quick --set grains.diameter="4 mm" --repeats 12
    cargolab run shaking/roll --set motion.roll.centre='["0 mm", "0 mm"]' --out centre0
    cargolab run my.toml --repeats 12 --no-video --no-plots     the numbers alone
    cargolab run --replay renders/view/tilting/quick
    """
    overrides |= short_overrides(repeats, arch)
    if replay is not None:
        if preset is not None or overrides:
            raise LabError("--replay: repeats a recording as it was; leave out the preset and all changes.")
        check_recording(replay)
        from lab.view.replay import replay as replayed

        show(replayed(replay, out, video=not no_video, plots=not no_plots, quiet=quiet), quiet)
        return
    if preset is None:
        raise LabError("run: which preset? `cargolab list` shows all.")
    with ExitStack() as stack:
        with importing():
            from lab.preset.find import load

            load(preset, overrides)  # before the slow imports, so that a typing error is reported at once
            from lab.paint.beside import cores_here, second_process

            beside = None if no_video else stack.enter_context(second_process(cores_here()))
            from lab.runs.runner import run_preset

        asked = {"video": not no_video, "plots": not no_plots, "quiet": quiet}
        show(run_preset(preset, overrides, out, **asked, beside=beside), quiet)


@click.command()
@click.argument("folder", type=FilePath(path_type=Path))
@video_option
@plots_option
@quiet_option
def resume(folder: Path, no_video: bool, no_plots: bool, quiet: bool) -> None:
    """Continue the run, sweep or calibration in FOLDER that was killed, interrupted or stopped.

    \b
    cargolab resume renders/tilting/quick
    """
    with importing():
        from lab.sweeps.resume import resume_any

    show(resume_any(folder, video=not no_video, plots=not no_plots, quiet=quiet), quiet)


@click.command()
@click.argument("folder", type=click.Path(path_type=Path))
@click.option(
    "--out",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="A .csv file.  [default: bed.csv in FOLDER]",
)
@click.option("--world", type=int, default=0, show_default=True, help="One of the repeats, from 0.")
@click.option("--moving", is_flag=True, help="With the grains' velocities; else they are at rest.")
def bed(folder: Path, out: Path | None, world: int, moving: bool) -> None:
    """Write the bed of the last picture of the run in FOLDER to a file, from which other runs start.

    \b
    cargolab bed renders/tilting/quick --out slid.csv
    and in a preset:   [grains]            [run]
                       bed = "slid.csv"    settle = false
    """
    check_recording(folder)
    from lab.runs.bed_file import write_bed

    place = out or (folder if folder.is_dir() else folder.parent) / "bed.csv"
    count, left = write_bed(folder, place, world, moving)
    click.echo(f"{place}: {count} grains" + f"; {left} have left the tank and are not in it" * bool(left))


@click.command()
@click.argument("preset", type=PresetName())
@set_option
@json_option
def explain(preset: str, overrides: dict, as_json: bool) -> None:
    """Explain PRESET: what it simulates, which models it uses and what it will cost.

    \b
    cargolab explain shaking/sway
    cargolab explain shaking/sway --set motion.sway.frequency="0.8 Hz"
    """
    from lab.preset.find import load

    loaded = load(preset, overrides)  # before the slow imports, here and in other commands
    if as_json:
        from lab.report.explain import as_objects

        tell_json(as_objects(loaded))
        return
    from lab.report.explain import explain as explained

    tell(explained(loaded))
