"""The commands for many runs: sweep and calibrate."""

from pathlib import Path

import click

from lab.cli.completion import MeasureName, PresetName, Setting
from lab.cli.options import (
    arch_option,
    cluster_option,
    out_option,
    plots_option,
    quiet_option,
    repeats_option,
    set_option,
    short_overrides,
    show,
    tell,
    texts_by_key,
    video_option,
)
from lab.sweeps.axes import screen_first


@click.command()
@click.argument("preset", type=PresetName())
@click.option(
    "--set",
    "settings",
    type=Setting(),
    multiple=True,
    metavar="KEY=VALUES",
    help="Values of a key: a range FROM:TO:NUMBER, with :log for a logarithmic one, or a list; one value just sets it.",
)
@out_option("for the results", "renders/PRESET-sweep")
@repeats_option
@arch_option
@video_option
@plots_option
@cluster_option
@quiet_option
def sweep(
    preset: str,
    settings: tuple[str, ...],
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    no_video: bool,
    no_plots: bool,
    cluster: str | None,
    quiet: bool,
) -> None:
    """Run PRESET for every combination of the values of its keys.

    \b
    cargolab sweep shaking/sway --set motion.sway.frequency="0.2:1.5:14 Hz" --repeats 12
    cargolab sweep tilting/quick --set grains.diameter="2, 3, 4 mm" --set material.friction=0.1:0.5:5
    cargolab sweep shaking/sway --set run.seed=1:200:200 --cluster tcp://node1:8786
    Run again, it continues where it was interrupted.
    """
    axes = texts_by_key(settings)
    shortcuts = short_overrides(repeats, arch)
    screen_first(preset, axes, shortcuts)
    from lab.sweeps.sweep import run_sweep

    asked = {"video": not no_video, "plots": not no_plots}
    show(run_sweep(preset, axes, shortcuts, out, **asked, quiet=quiet, cluster=cluster), quiet)


@click.command()
@click.argument("preset", type=PresetName())
@click.option(
    "--target", type=MeasureName(), required=True, metavar="MEASURE=VALUE", help="The measure and its wanted value."
)
@click.option("--vary", type=Setting(), required=True, metavar="KEY=FROM:TO", help="The key to vary, and its range.")
@set_option
@out_option("for the results", "renders/PRESET-calibration")
@repeats_option
@arch_option
@cluster_option
@quiet_option
def calibrate(
    preset: str,
    target: str,
    vary: str,
    overrides: dict,
    out: Path | None,
    repeats: int | None,
    arch: str | None,
    cluster: str | None,
    quiet: bool,
) -> None:
    """Find the value of a key of PRESET at which a measure meets its target, with its interval.

    Runs at least eight beds unless --repeats is given. A target may have a standard error.

    \b
    cargolab calibrate tilting/chickpeas-quick --target "repose=30 deg" --vary friction=0.2:0.7
    cargolab calibrate tilting/chickpeas-quick --target "repose=30 ± 0.8 deg" --vary friction=0.2:0.7 --repeats 24
    cargolab calibrate shaking/sway --target "response_amplitude=2 mm" --vary "motion.sway.frequency=0.8 Hz:2 Hz"
    cargolab calibrate tilting/acetate --target "repose=25 deg" --vary friction=0.2:0.7 --cluster tcp://node1:8786
    """
    from lab.preset.find import screen

    overrides |= short_overrides(repeats, arch)
    screen(preset, overrides)
    from lab.sweeps.calibrate import calibrate as calibrated

    tell(calibrated(preset, target, vary, overrides, out, quiet=quiet, cluster=cluster).text())
