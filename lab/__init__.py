"""Cargo Shift Lab: pick an experiment on loose cargo, run it, watch it, and get a number with its error."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from lab.base.caches import provide_for_matplotlib
from lab.base.costs import importing

if TYPE_CHECKING:
    from cargolab._preset import Preset
    from lab.runs.runner import Result
    from lab.sweeps.calibration_report import Calibration
    from lab.sweeps.result import SweepResult

__version__ = "0.3.0"

provide_for_matplotlib()


def run(
    preset: str | Path | Mapping | Preset,
    out: Path | str | None = None,
    *,
    repeats: int | None = None,
    video: bool = True,
    plots: bool = True,
    quiet: bool = False,
    **overrides: object,
) -> Result:
    """Run a preset, `lab.run("tilting/quick", grains={"diameter": "4 mm"})`, and return its result with arrays.

    repeats: number of beds, each with its own seed; without `video` or `plots` these are not made. `overrides` are
    tables of the preset, or single keys with `__` for the dot: `material__friction=0.4`.
    """
    with importing():
        from lab.preset.find import screen
        from lab.preset.python.written import asked

        name, changes = asked(preset)
        given = changes | dotted(overrides, repeats)
        screen(name, given)  # before the slow imports
        from lab.runs.runner import run_preset

    return run_preset(name, given, out, video=video, plots=plots, quiet=quiet)


def sweep(
    preset: str | Path | Mapping | Preset,
    axes: Mapping[str, str | Sequence],
    out: Path | str | None = None,
    *,
    repeats: int | None = None,
    video: bool = True,
    plots: bool = True,
    quiet: bool = False,
    cluster: str | None = None,
    **overrides: object,
) -> SweepResult:
    """Run a preset at every combination of values: `lab.sweep("shaking/sway", {"motion.sway.frequency": "0.5:2:7Hz"})`.

    axes: for each key a range or list as text, as `cargolab sweep` takes it, or a sequence of values; cluster: the
    address of a Dask scheduler whose workers run the points; the other options as in `run`.
    """
    from lab.preset.python.written import asked
    from lab.sweeps.axes import screen_first

    name, changes = asked(preset)
    given = changes | dotted(overrides, repeats)
    screen_first(name, axes, given)
    from lab.sweeps.sweep import run_sweep

    return run_sweep(name, axes, given, out, video=video, plots=plots, quiet=quiet, cluster=cluster)


def resume(
    folder: Path | str, *, video: bool = True, plots: bool = True, quiet: bool = False
) -> Result | SweepResult | Calibration:
    """Continue the run, sweep or calibration in a folder that was interrupted or killed; the bits are the same."""
    with importing():
        from lab.sweeps.resume import resume_any

    return resume_any(folder, video=video, plots=plots, quiet=quiet)


def dotted(overrides: Mapping[str, object], repeats: int | None = None) -> dict[str, object]:
    """The overrides of a call as dotted keys, `__` standing for the dot."""
    given = {key.replace("__", "."): value for key, value in overrides.items()}
    return given if repeats is None else given | {"run.repeats": repeats}
