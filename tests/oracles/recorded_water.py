"""Synthetic recordings of water, with known results."""

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from lab.preset.merge import merged
from lab.preset.schema import Preset, resolve
from lab.recording import Recorder, new_recording
from lab.recording.layout import names_of, rows_of, sizes_of, tables_of
from tests.oracles.synthetic import box

POOL = """
format = 3
title = "a pool"
[tank]
width = "1 m"
height = "0.5 m"
[water]
depth = "0.2 m"
spacing = "20 mm"
[gauges.P1]
place = ["-500 mm", "100 mm"]
[gauges.L-1]
kind = "level"
y = "-480 mm"
[gauges.P2]
place = ["500 mm", "100 mm"]
[run]
duration = "10 s"
"""
DROPS = 6


def pool(**overrides: object) -> Preset:
    """The preset of a pool with two gauges of pressure and one of level, and tables over it."""
    return resolve(merged(tomllib.loads(POOL), overrides))


def record_pool(
    folder: Path,
    time: Sequence[float],
    series: Mapping[str, np.ndarray],
    frames: Mapping[str, np.ndarray] | None = None,
    preset: Preset | None = None,
    **options: object,
) -> Path:
    """Record rows (T, 1, …) of the series by name at time (T,), and frames (F, 1, …); what is not given is zero."""
    preset = preset or pool()
    volume = np.full((1, DROPS), 4e-4)
    new_recording(
        folder,
        preset="pool",
        given=POOL,
        resolved=preset,
        radius=np.zeros((1, 0)),
        volume=volume,
        outline=box(1.0, 0.5),
        step=1e-3,
        **options,
    )
    tables, sizes = (
        tables_of(preset, False),
        sizes_of(names_of(preset, options.get("parts", ())), np.zeros((1, 0)), volume),
    )
    zero = {
        table: {name: np.zeros(shape) for name, (shape, _) in rows_of(quantities, sizes).items()}
        for table, quantities in tables.items()
    }
    with Recorder(folder) as recorder:
        for k, now in enumerate(time):
            recorder.sample(zero["series"] | {"time": now} | {name: rows[k] for name, rows in series.items()})
        for k in range(len(next(iter(frames.values()))) if frames else 0):
            recorder.frame(zero["frames"] | {"time": float(k)} | {name: rows[k] for name, rows in frames.items()})
    return folder
