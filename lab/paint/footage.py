"""A recording as the painter looks at it: frame by frame, bed by bed."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from lab.errors import LabError
from lab.recording import Recording, open_recording


class Footage:
    """F frames and T samples of W worlds with n grains each.

    time (F,) s, pose (F, W, 3) m, m, rad; series_time (T,), series_pose (T, W, 3), centre_of_mass (T, W, 2) m;
    radius (W, n) m; outline (m, 2) m; diameter: the mean of all grains, m; settings: the preset's [video]; title.
    Raises LabError when there is no frame or no sample.
    """

    def __init__(self, recording: Recording) -> None:
        series, frames = recording.series, recording.frames
        if not len(frames["time"]) or not len(series["time"]):
            raise LabError(f"{recording.path} holds no picture frames yet: let the run get further.")
        self.time, self.pose = frames["time"][:], frames["pose"][:]
        self.series_time, self.series_pose = series["time"], series["pose"]
        self.centre_of_mass = series["centre_of_mass"]
        self.radius, self.outline = recording.radius, recording.outline
        self.diameter = float(recording.mean_diameter.mean())
        self.settings = recording.preset.get("video") or {}
        self.title = recording.preset.get("title") or recording.name
        self._frames = frames
        self._read: dict[str, tuple[int, np.ndarray]] = {}  # the frame last read of each quantity

    @property
    def worlds(self) -> int:
        """W, the beds recorded side by side."""
        return len(self.radius)

    def position(self, frame: int, world: int) -> np.ndarray:
        """Grain positions (n, 2) in the tank frame, m."""
        return self._grains("position", frame, world)

    def speed(self, frame: int, world: int) -> np.ndarray:
        """Grain speeds (n,) relative to the tank, m/s."""
        return np.hypot(*self._grains("velocity", frame, world).T)

    def angle(self, frame: int, world: int) -> np.ndarray:
        """Grain angles (n,) in the tank frame, rad."""
        return self._grains("angle", frame, world)

    def _grains(self, name: str, frame: int, world: int) -> np.ndarray:
        if self._read.get(name, (None,))[0] != frame:
            self._read[name] = frame, self._frames[name][frame].astype(float)
        return self._read[name][1][world]


@contextmanager
def open_footage(path: Path | str) -> Iterator[Footage]:
    """Open a recording, given as its file or its run's folder; raises LabError (see Recording and Footage)."""
    with open_recording(path) as recording:
        yield Footage(recording)
