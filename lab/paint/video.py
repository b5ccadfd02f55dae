"""From a recording to a video, a folder of pictures, or a poster."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import imageio.v2 as imageio
import numpy as np
from PIL import Image

from lab.errors import LabError
from lab.paint.film import Film, choose_look
from lab.paint.footage import open_footage
from solvers.runtime import initialise

FASTEST = 60.0  # pictures a second of a video
BT709 = "scale=out_color_matrix=bt709:out_range=tv"
ENCODING = (
    *("-crf", "20", "-preset", "veryfast", "-movflags", "+faststart", "-vf", BT709),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"),
)

Progress = Callable[[int, int], None]


def render_recording(
    path: Path | str,
    out: Path | str | None = None,
    *,
    colour: str | None = None,
    frame: str | None = None,
    width: int | None = None,
    height: int | None = None,
    speed: float | None = None,
    world: int | None = None,
    png: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Film a recording (its file or its run's folder) and return what was written.

    out: an .mp4 file (default: video.mp4 beside the recording), or with png a folder of PNG files
    (pictures). What is not given comes from the preset's [video]. world: one bed, from 0; None: up
    to six side by side. progress(done, of) is called after each picture. Raises LabError.
    """
    initialise()
    with open_footage(path) as footage:
        look = choose_look(footage, world, colour=colour, frame=frame, width=width, height=height, speed=speed)
        film = Film(footage, look)
        rate, stride = playback(footage.time, look.speed)
        shown = range(0, len(footage.time), stride)
        pictures = _counted(film, shown, progress)
        if png:
            return _write_folder(_target(path, out, "pictures"), pictures)
        return _write_video(_target(path, out, "video.mp4"), pictures, rate)


def poster(
    path: Path | str,
    out: Path | str | None = None,
    *,
    time: float | None = None,
    fraction: float = 1.0,
    colour: str | None = None,
    frame: str | None = None,
    width: int | None = None,
    height: int | None = None,
    world: int | None = None,
) -> Path:
    """One picture of a recording as a PNG file (default: poster.png beside it).

    The frame nearest to `time` (s), or else at this fraction of the film. Raises LabError.
    """
    initialise()
    with open_footage(path) as footage:
        look = choose_look(footage, world, colour=colour, frame=frame, width=width, height=height)
        if time is None:
            time = footage.time[0] + fraction * (footage.time[-1] - footage.time[0])
        nearest = int(np.abs(footage.time - time).argmin())
        out = _target(path, out, "poster.png")
        if out.suffix != ".png":
            raise LabError(f"{out} cannot be written: a poster is a .png file.")
        Image.fromarray(Film(footage, look).picture(nearest)).save(out)
        return out


def playback(time: np.ndarray, speed: float) -> tuple[float, int]:
    """Pictures a second of the video, and of how many frames one is shown; time (F,) in s."""
    interval = float(np.median(np.diff(time))) if len(time) > 1 else 0.04
    wanted = speed / interval
    stride = max(1, math.ceil(wanted / FASTEST - 1e-9))
    return round(wanted / stride, 3), stride


def _counted(film: Film, shown: range, progress: Progress | None) -> Iterator[np.ndarray]:
    for done, frame in enumerate(shown, start=1):
        yield film.picture(frame)
        if progress:
            progress(done, len(shown))


def _target(path: Path | str, out: Path | str | None, name: str) -> Path:
    """Where to write; its folder is made."""
    path = Path(path)
    beside = (path if path.is_dir() else path.parent) / name
    out = beside if out is None else Path(out)
    out.parent.mkdir(parents=True, exist_ok=True)
    return out


def _write_folder(folder: Path, pictures: Iterator[np.ndarray]) -> Path:
    folder.mkdir(exist_ok=True)
    for old in folder.glob("picture_*.png"):
        old.unlink()
    for k, picture in enumerate(pictures):
        Image.fromarray(picture).save(folder / f"picture_{k:05d}.png")
    return folder


def _write_video(out: Path, pictures: Iterator[np.ndarray], rate: float) -> Path:
    """H.264 in out; half a video is never left under that name."""
    if out.suffix != ".mp4":
        raise LabError(f"{out} cannot be written: a video is an .mp4 file.")
    part = out.with_suffix(".part.mp4")
    writer = imageio.get_writer(
        part,
        fps=rate,
        codec="libx264",
        quality=None,
        pixelformat="yuv420p",
        macro_block_size=2,
        ffmpeg_log_level="error",
        output_params=list(ENCODING),
    )
    try:
        for picture in pictures:
            writer.append_data(picture)
        writer.close()
        part.replace(out)
    finally:
        writer.close()
        part.unlink(missing_ok=True)
    return out
