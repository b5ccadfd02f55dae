"""A bed as a file: the grains of a run's last picture, as `grains.bed` reads them."""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import write_text
from lab.preset.bed_file import inside
from lab.recording import Recording, open_recording

INSIDE = 0.9  # of a radius off all walls: nearer ones have left the tank


def write_bed(folder: Path, out: Path, world: int = 0, moving: bool = False) -> tuple[int, int]:
    """Write the grains of a bed in the last picture of a run to a CSV file; returns how many, and how many it has not.

    moving: with their velocities in the tank. Grains that have left the tank are not in it. Raises LabError for a run
    without a picture of round grains, or without that bed.
    """
    with open_recording(folder) as recording:
        _check(recording, world)
        frames, radius = recording.frames, np.asarray(recording.radius[world])
        time, hold = float(frames["time"][-1]), recording.preset.hold
        place = np.asarray(frames["position"][-1][world], dtype=float)
        columns = {**_named(("y", "z", "x"), place), "radius": radius}
        if moving:
            columns |= _named(("vy", "vz", "vx"), frames["velocity"][-1][world])
            spin = np.asarray(frames["spin"][-1][world]) if "spin" in frames else np.zeros(len(radius))
            columns |= {"omega": spin} if spin.ndim == 1 else _named(("omega_y", "omega_z", "omega"), spin)
        if recording.preset.kinds:
            columns["kind"] = recording.kind[world]
        names, rows = list(columns), np.column_stack(list(columns.values()))
        known = np.isfinite(rows).all(axis=1)
        seen = np.zeros((len(place), 3))
        seen[:, : place.shape[1]] = np.where(known[:, None], place, 0.0)
        kept = known & inside(seen, np.array(hold.corners), INSIDE * radius, hold.solid)
        head = f"# {recording.name}, bed {world}, {time:.6g} s after its start; m, m/s, rad/s"
    lines = [head, ",".join(names), *(",".join(f"{x:.9g}" for x in row) for row in rows[kept])]
    write_text(out, "\n".join(lines) + "\n")
    return int(kept.sum()), int((~kept).sum())


def _named(names: tuple[str, ...], vectors: np.ndarray) -> dict[str, np.ndarray]:
    """Columns of vectors (n, axes) by name, in the plane the first two."""
    return dict(zip(names, np.asarray(vectors, dtype=float).T, strict=False))


def _check(recording: Recording, world: int) -> None:
    preset, where = recording.preset, recording.path
    if preset.grains is None or not len(recording.frames["time"]):
        raise LabError(f"{where} has no picture of grains: a bed is written from a run with grains.")
    if preset.shapes:
        raise LabError(f"{where}: a bed file lists round grains, and these are irregular.")
    if not 0 <= world < recording.worlds:
        raise LabError(f"--world: {where} has beds 0 to {recording.worlds - 1} (got {world}).")
