"""What a run records, and how it is filmed."""

from dataclasses import dataclass
from typing import Annotated, Literal

from lab.base.errors import LabError
from solvers.machine.marks import Interval, Unit

COLOURS = ("speed", "displacement", "layer", "size", "kind", "shape", "spin")  # what `lab.paint.colours` paints

Rate = Annotated[float, Unit("Hz"), Interval(gt=0, le=1e6)]


@dataclass(frozen=True)
class Record:
    """Sampling rates of series and frames, wall-clock time between checkpoints, and whether XDMF is written."""

    series_rate: Rate = 100.0
    picture_rate: Rate = 25.0
    checkpoint_every: Annotated[float, Unit("s"), Interval(ge=0)] = 60.0
    xdmf: bool = False


@dataclass(frozen=True)
class Video:
    """The picture's size in pixels, colouring of the grains, frame of reference, playback speed."""

    width: Annotated[int, Interval(ge=320, le=7680)] = 1280
    height: Annotated[int, Interval(ge=180, le=4320)] = 720
    colour: Literal[*COLOURS] = "speed"
    frame: Literal["tank", "earth"] = "tank"
    speed: Annotated[float, Interval(gt=0)] = 1.0


def check_video(video: Video) -> None:
    """Raise LabError for picture sizes that the video codec cannot encode."""
    for name in ("width", "height"):
        if getattr(video, name) % 2:
            raise LabError(f"video.{name}: must be even for H.264 (got {getattr(video, name)}).")
