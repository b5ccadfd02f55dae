"""A bed as a file: the grains of a run's last picture, as `grains.bed` reads them."""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import write_text
from lab.preset.bed_file import MOTION, NEEDED
from lab.recording import Recording, open_recording
from solvers.grains.bed.filling import clear_of_walls

INSIDE = 0.9  # of a radius off all walls: nearer ones have left the tank


def write_bed(folder: Path, out: Path, world: int = 0, moving: bool = False) -> tuple[int, int]:
    """Write the grains of a bed in the last picture of a run to a CSV file; returns how many, and how many it has not.

    moving: with their velocities in the tank. Grains that have left the tank are not in it. Raises LabError for a run
    without a picture of round grains of one kind, or without that bed.
    """
    with open_recording(folder) as recording:
        _check(recording, world)
        frames, radius = recording.frames, np.asarray(recording.radius[world])
        time = float(frames["time"][-1])
        columns = [*np.asarray(frames["position"][-1][world], dtype=float).T, radius]
        names = list(NEEDED)
        if moving:
            turning = np.asarray(frames["spin"][-1][world]) if "spin" in frames else np.zeros(len(radius))
            columns += [*np.asarray(frames["velocity"][-1][world], dtype=float).T, turning]
            names += MOTION
        rows = np.column_stack(columns)
        known = np.isfinite(rows).all(axis=1)
        hold = np.array(recording.preset.hold.corners)
        kept = known & clear_of_walls(np.where(known[:, None], rows[:, :2], 0.0), hold, INSIDE * radius)
        head = f"# {recording.name}, bed {world}, {time:.6g} s after its start; m, m/s, rad/s"
    lines = [head, ",".join(names), *(",".join(f"{x:.9g}" for x in row) for row in rows[kept])]
    write_text(out, "\n".join(lines) + "\n")
    return int(kept.sum()), int((~kept).sum())


def _check(recording: Recording, world: int) -> None:
    preset, where = recording.preset, recording.path
    if preset.grains is None or not len(recording.frames["time"]):
        raise LabError(f"{where} has no picture of grains: a bed is written from a run with grains.")
    if preset.tank.solid is not None:
        raise LabError(f"{where} is in space: a bed file lists grains of the plane alone.")
    if preset.shapes or preset.kinds:
        what = "irregular grains" if preset.shapes else "grains of several kinds"
        raise LabError(f"{where}: a bed file lists round grains of one kind, and these are {what}.")
    if not 0 <= world < recording.worlds:
        raise LabError(f"--world: {where} has beds 0 to {recording.worlds - 1} (got {world}).")
