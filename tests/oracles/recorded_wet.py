"""Synthetic recordings of wet cargo, with known results."""

import tomllib
from collections.abc import Callable, Mapping
from pathlib import Path

import numpy as np

from lab.preset.merge import merged
from lab.preset.schema import Preset, resolve
from lab.recording import Recorder, new_recording
from lab.recording.layout import names_of, rows_of, sizes_of, tables_of
from tests.oracles.synthetic import box

COLUMNS, LINES, SIZE, WIDTH = 24, 12, 4e-3, 0.096  # of a square lattice of grains, m
GRAINS, WATER = 2500.0, 1000.0  # kg/m³
POROSITY, DEPTH = 1.0 - np.pi / 6.0, LINES * SIZE  # of that bed, m
MOISTURE = 0.4
WET = f"""
format = 3
title = "a wet bed"
[tank]
width = "{WIDTH} m"
height = "0.2 m"
[material]
density = "{GRAINS} kg/m^3"
young = "50 GPa"
poisson = 0.25
friction = 0.3
restitution = 0.8
[grains]
diameter = "{SIZE} m"
count = {COLUMNS * LINES}
[water]
moisture = "{100 * MOISTURE} %"
spacing = "8 mm"
[run]
duration = "10 s"
"""
AREA = MOISTURE / (1.0 - MOISTURE) * GRAINS / WATER * np.pi / 6.0 * WIDTH * DEPTH  # of the water, m²
ACROSS, UP = 12, 10  # particles of water


def wet(**overrides: object) -> Preset:
    """The preset of a small wet bed, and tables over it."""
    return resolve(merged(tomllib.loads(WET), overrides))


def lattice() -> np.ndarray:
    """The grains (n, 2), m, of a square lattice, row by row from the floor."""
    y = (np.arange(COLUMNS) - 0.5 * (COLUMNS - 1)) * SIZE
    z = (np.arange(LINES) + 0.5) * SIZE
    return np.stack(np.meshgrid(z, y, indexing="ij"), axis=-1).reshape(-1, 2)[:, ::-1]


def drops(height: float) -> np.ndarray:
    """The particles of water (n, 2), m, in even rows up to a height (m)."""
    y = ((np.arange(ACROSS) + 0.5) / ACROSS - 0.5) * WIDTH
    z = (np.arange(UP) + 0.5) / UP * height
    return np.stack(np.meshgrid(z, y, indexing="ij"), axis=-1).reshape(-1, 2)[:, ::-1]


def record_wet(
    folder: Path,
    time: np.ndarray,
    frame: Callable[[float], Mapping[str, np.ndarray]],
    preset: Preset | None = None,
    series: Mapping[str, np.ndarray] | None = None,
) -> Path:
    """Record frames at time (F,), each what `frame` says at a time, (n, …) by name; series (F, …) at the same times.

    What is not given is zero; grains lie in the lattice, and water of the bed's porosity up to where it reaches.
    """
    preset, still = preset or wet(), {}
    height = AREA / POROSITY / WIDTH
    still = {"position": lattice(), "water_position": drops(height), "water_porosity": np.full(ACROSS * UP, POROSITY)}
    radius, volume = np.full((1, COLUMNS * LINES), 0.5 * SIZE), np.full((1, ACROSS * UP), AREA / (ACROSS * UP))
    given = {"radius": radius, "volume": volume, "outline": box(WIDTH, 0.2), "step": 1e-3}
    new_recording(folder, preset="wet", given=WET, resolved=preset, **given)
    tables, sizes = tables_of(preset, False), sizes_of(names_of(preset), radius, volume)
    zero = {
        table: {name: np.zeros(shape) for name, (shape, _) in rows_of(quantities, sizes).items()}
        for table, quantities in tables.items()
    }
    with Recorder(folder) as recorder:
        for k, now in enumerate(time):
            told = {name: rows[k][None] for name, rows in (series or {}).items()}
            recorder.sample(zero["series"] | {"time": now} | told)
            shown = {name: values[None] for name, values in (still | dict(frame(now))).items()}
            pose = {"pose": told["pose"]} if "pose" in told else {}
            recorder.frame(zero["frames"] | {"time": now} | pose | shown)
    return folder
