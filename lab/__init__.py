"""Cargo Shift Lab: pick an experiment on loose cargo, run it, watch it, and get a number with its error."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from lab.runner import Result


def run(
    preset: str, out: Path | str | None = None, *, video: bool = True, quiet: bool = False, **overrides: object
) -> Result:
    """Run a preset, `lab.run("tilting/quick", grains={"diameter": "4 mm"})`, and return its result with arrays.

    `overrides` are tables of the preset, or single keys with `__` for the dot: `run__repeats=12`.
    """
    from lab.runner import run_preset

    dotted = {key.replace("__", "."): value for key, value in overrides.items()}
    return run_preset(preset, dotted, out, video=video, quiet=quiet)
