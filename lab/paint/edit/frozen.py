"""The ship of a recording with her cargo frozen as it lay at the start, to be filmed beside the one with loose cargo.

She is computed by herself (`lab.measures.ship_frozen`), for as long as the run was to last.
"""

from collections.abc import Mapping
from copy import copy
from dataclasses import replace

import numpy as np

from lab.base.errors import LabError
from lab.measures.ship_frozen import frozen_voyage
from lab.paint.footage import Bed
from lab.paint.space.scene import scene_in_space
from lab.recording import Recording

STILL = ("velocity", "spin", "water_velocity", "air_velocity")  # what is zero in frozen cargo
SHORTEST = 0.02  # s between frames where a recording has only one


class _Kept:
    """Rows that are all the first one of some data, or zero."""

    def __init__(self, data: np.ndarray, still: bool) -> None:
        self._row = np.zeros_like(data[0]) if still else data[0]

    def __getitem__(self, row: int) -> np.ndarray:
        return self._row


class _Frames:
    """Picture frames that are all like the first."""

    def __init__(self, frames: Mapping) -> None:
        self._frames, self._kept = frames, {}

    def __getitem__(self, name: str) -> _Kept:
        if name not in self._kept:
            self._kept[name] = _Kept(self._frames[name], name in STILL)
        return self._kept[name]


class _Series:
    """A series of `count` rows that are all like the first."""

    def __init__(self, series: Mapping, count: int) -> None:
        self._series, self._count = series, count

    def __getitem__(self, name: str) -> np.ndarray:
        return _repeated(self._series[name], self._count)


def frozen_bed(bed: Bed, recording: Recording, name: str) -> Bed:
    """The bed with its cargo frozen, in the ship that sails with it. Raises LabError where there is none."""
    voyage = frozen_voyage(recording)
    if voyage is None:
        raise LabError(f"{recording.path} has no ship whose cargo could be frozen: name a recording of one with cargo.")
    time, pose, end = voyage
    loose, footage = bed.footage, copy(bed.footage)
    interval = float(np.median(np.diff(loose.time))) if len(loose.time) > 1 else SHORTEST
    footage.time = np.append(np.arange(time[0], time[-1], interval), time[-1])
    worlds, frames = loose.worlds, len(footage.time)
    at = np.column_stack([np.interp(footage.time, time, part) for part in pose.T])
    footage.pose, footage.series_pose = (np.tile(rows[:, None], (1, worlds, 1)) for rows in (at, pose))
    footage.series_time, footage.ends = time, [end] * worlds
    footage.part, footage.part_turn = (_repeated(rows, frames) for rows in (loose.part, loose.part_turn))
    footage.space = scene_in_space(recording.preset, footage)
    if loose.centre_of_mass is not None:
        footage.centre_of_mass = _repeated(loose.centre_of_mass, len(time))
        footage.spilled = np.zeros((len(time), worlds))
    footage.freeze(_Frames, lambda series: _Series(series, len(time)))
    return replace(bed, footage=footage, name=name)


def _repeated(rows: np.ndarray, count: int) -> np.ndarray:
    return np.broadcast_to(rows[:1], (count, *rows.shape[1:]))
