"""What the painter needs of a recording: an open HDF5 file, frames read one at a time."""

import json
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import h5py
import numpy as np

from lab.errors import LabError

FORMAT = "cargo-shift-lab 1"
FILE_NAME = "recording.h5"
NEEDED = (
    "grains/radius",
    "tank/outline",
    *(f"series/{name}" for name in ("time", "pose", "centre_of_mass")),
    *(f"frames/{name}" for name in ("time", "pose", "position", "velocity", "angle")),
)


class Footage:
    """F frames and T samples of W worlds with n grains each.

    time (F,) s, pose (F, W, 3) m, m, rad; series_time (T,), series_pose (T, W, 3), centre_of_mass (T, W, 2) m;
    radius (W, n) m; outline (m, 2) m; diameter: the mean, m; settings: the preset's [video]; title: the preset's.
    """

    def __init__(self, file: h5py.File, path: Path) -> None:
        missing = [name for name in NEEDED if name not in file]
        if missing:
            raise LabError(f"{path} has no /{missing[0]}: record the run again.")
        self._frames = file["frames"]
        self.radius = file["grains/radius"][:]
        self.outline = file["tank/outline"][:]
        self.diameter = 2 * float(self.radius.mean())
        self.time = self._frames["time"][: self._whole("frames", file)]
        self.pose = self._frames["pose"][: len(self.time)]
        samples = self._whole("series", file)
        self.series_time = file["series/time"][:samples]
        self.series_pose = file["series/pose"][:samples]
        self.centre_of_mass = file["series/centre_of_mass"][:samples]
        preset = json.loads(file["preset/resolved"].asstr()[()]) if "preset" in file else {}
        self.settings = preset.get("video") or {}
        self.title = preset.get("title") or str(file.attrs.get("preset", path.stem))
        if not len(self.time):
            raise LabError(f"{path} holds no picture frames yet: let the run get further.")

    @property
    def worlds(self) -> int:
        """How many beds were recorded side by side."""
        return len(self.radius)

    def position(self, frame: int, world: int) -> np.ndarray:
        """Grain positions (n, 2) in the tank frame, m."""
        return self._frames["position"][frame, world].astype(float)

    def speed(self, frame: int, world: int) -> np.ndarray:
        """Grain speeds (n,) relative to the tank, m/s."""
        return np.hypot(*self._frames["velocity"][frame, world].astype(float).T)

    def angle(self, frame: int, world: int) -> np.ndarray:
        """Grain angles (n,) in the tank frame, rad."""
        return self._frames["angle"][frame, world].astype(float)

    @staticmethod
    def _whole(group: str, file: h5py.File) -> int:
        """Rows that every data set of the group has: a run killed while writing leaves some a row short."""
        return min(len(file[name]) for name in NEEDED if name.startswith(f"{group}/"))


@contextmanager
def open_footage(path: Path | str) -> Iterator[Footage]:
    """Open a recording, given as its file or its folder.

    Raises LabError when there is none, it cannot be read, is not one of ours, or has no frames.
    """
    path = Path(path)
    path = path / FILE_NAME if path.is_dir() else path
    if not path.is_file():
        raise LabError(f"{path} does not exist: name a recording or the folder of a run.")
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise LabError(
            f"{path} cannot be read as a recording: it is cut short, still being written, or another kind of file."
        ) from error
    with file:
        if str(file.attrs.get("format", "")) != FORMAT:
            raise LabError(f"{path} is not a recording of this lab ('{FORMAT}'): name another file.")
        yield Footage(file, path)
