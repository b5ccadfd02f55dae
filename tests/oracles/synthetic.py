"""Synthetic recordings for the tests, with known results."""

from copy import deepcopy
from functools import cache
from pathlib import Path

import numpy as np

from lab.preset.find import load
from lab.preset.merge import merged
from lab.preset.recorded import from_table, to_table
from lab.recording import Recorder, new_recording
from lab.recording.layout import frames_of, rows_of, series_of
from solvers.machine.quantity import PLANE

GRAINS = ("grains",)
WIDTH, DEPTH, DIAMETER = 0.180, 0.060, 0.003  # m


def box(width: float = WIDTH, height: float = 0.15) -> np.ndarray:
    """Outline (4, 2) of a rectangular tank."""
    half = width / 2
    return np.array([(-half, 0), (half, 0), (half, height), (-half, height)])


def preset(**motion: dict) -> dict:
    """A preset with such motions, as the lab writes it down."""
    plain = deepcopy(_plain())
    said = {"title": "Acetate grains in a tank", "source": "Spandonidis 2016, 5.4", "reports": "24 deg"}
    return plain | said | {"motion": {"soft_start": 0.0, **motion}, "based_on": ""}


@cache
def _plain() -> dict:
    return to_table(load("tilting/acetate", {"contact.stiffness_scale": 1, "run.duration": "1 s"}).resolved)


def recorder(folder: Path, worlds: int = 1, count: int = 4, **options: object) -> Recorder:
    """An open recorder of a small scene; options of `new_recording` and of `Recorder`.

    `resolved` is a preset as the lab writes it down; what it does not say is as in `preset`.
    """
    writing = {name: options.pop(name) for name in ("flush_every", "buffer") if name in options}
    settings = {
        "preset": "tilting/acetate",
        "given": 'title = "Acetate grains in a tank"\n',
        "resolved": preset(),
        "radius": np.full((worlds, count), DIAMETER / 2),
        "outline": box(),
        "step": 1e-5,
    }
    asked = {**settings, **options}
    new_recording(folder, **asked | {"resolved": from_table(merged(preset(), asked["resolved"], alternatives={}))})
    return Recorder(folder, **writing)


def sample(time: float, worlds: int = 1, axes: int = PLANE, faces: int = 0, **values: object) -> dict:
    """A row of the series, in space of a tank with so many faces; quantities that are not given are zero."""
    shapes = _of_series(worlds, axes, faces)
    return {**{name: np.zeros(shape) for name, shape in shapes.items()}, "time": time, **values}


@cache
def _of_series(worlds: int, axes: int, faces: int) -> dict[str, tuple]:
    return _shapes(series_of(False, GRAINS, in_space=faces > 0), worlds, axes=axes, faces=faces)


@cache
def _of_frames(worlds: int, count: int, parts: int, axes: int) -> dict[str, tuple]:
    return _shapes(frames_of(False, GRAINS), worlds, count, parts, axes)


def _shapes(quantities: tuple, worlds: int, count: int = 0, parts: int = 0, axes: int = PLANE, faces: int = 0) -> dict:
    sizes = {"world": worlds, "grain": count, "part": parts, "face": faces}
    return {name: shape for name, (shape, _) in rows_of([one.within(axes) for one in quantities], sizes).items()}


def of_a_ship(worlds: int = 1, **values: object) -> dict:
    """The additional quantities of a row for a ship; values that are not given are zero, events did not happen."""
    return {"ship_works": np.zeros((worlds, 4)), "capsized": [-1.0] * worlds, "flooded": [-1.0] * worlds, **values}


def frame(time: float, worlds: int = 1, count: int = 4, axes: int = PLANE, **values: object) -> dict:
    """A picture frame without parts, or with those whose places `part` gives; what is not given is zero."""
    parts = np.shape(values["part"])[1] if "part" in values else 0
    zero = {name: np.zeros(shape) for name, shape in _of_frames(worlds, count, parts, axes).items()}
    return {**zero, "time": time, **values}


def record(
    folder: Path,
    time: np.ndarray,
    *,
    pose: np.ndarray,
    centre: np.ndarray,
    frames: list[dict] | None = None,
    kinetic: np.ndarray | None = None,
    status: str = "complete",
    **options: object,
) -> Path:
    """Record a motion: time (T,), pose (T, 3), the same in all worlds, and centre of mass (T, W, 2)."""
    worlds = centre.shape[1]
    kinetic = np.zeros(centre.shape[:2]) if kinetic is None else kinetic
    writer = recorder(folder, worlds, **options)
    writer.wall_s, writer.grain_steps = 12.5, 25_000_000
    parted = "part_load" in writer.series
    loads = {"part_load": np.zeros((worlds, len(options["parts"]), 3))} if parted else {}
    for k, now in enumerate(time):
        moved = {"pose": np.tile(pose[k], (worlds, 1)), "centre_of_mass": centre[k]}
        writer.sample(sample(now, worlds, kinetic=kinetic[k], **moved, **loads))
    for row in frames or [frame(0.0, worlds)]:
        writer.frame(row)
    writer.close(status)
    return folder
