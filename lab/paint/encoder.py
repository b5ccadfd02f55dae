"""Encode pictures as an H.264 video, with the ffmpeg that comes with imageio-ffmpeg.

The video is written under another name and renamed when ffmpeg has ended without an error, so a file with the video's
name is always a whole video: a full disk, or the end of either process, leaves at most the unfinished one.
"""

import subprocess
from collections.abc import Iterable
from contextlib import suppress
from fractions import Fraction
from pathlib import Path

import numpy as np

from lab.base.errors import LabError

BT709 = "scale=out_color_matrix=bt709:out_range=tv"
ENCODING = (
    *("-an", "-vcodec", "libx264", "-pix_fmt", "yuv420p", "-v", "error"),
    *("-crf", "20", "-preset", "veryfast", "-movflags", "+faststart", "-vf", BT709),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"),
)


def write_video(out: Path, pictures: Iterable[np.ndarray], rate: float) -> Path:
    """Write pictures (height, width, 3), u8, all of one size, as a video of `rate` pictures a second; returns `out`.

    Raises LabError if `out` is no .mp4 file or cannot be written.
    """
    if out.suffix != ".mp4":
        raise LabError(f"{out} cannot be written: a video is an .mp4 file.")
    part, process = unfinished(out), None
    part.unlink(missing_ok=True)  # the encoder of a killed process may still have it open
    try:
        for picture in pictures:
            if process is None:
                process = _begin(part, picture.shape, rate)
            process.stdin.write(memoryview(np.ascontiguousarray(picture)))
        _end(process)
        part.replace(out)
    except BrokenPipeError:
        raise LabError(f"{out} cannot be written ({_reason(process)}): make room there.") from None
    finally:
        if process and process.poll() is None:
            process.kill()
            process.communicate()
        part.unlink(missing_ok=True)
    return out


def unfinished(out: Path) -> Path:
    """The name of a video until it is complete."""
    return out.with_suffix(".part.mp4")


def _begin(part: Path, shape: tuple[int, ...], rate: float) -> subprocess.Popen:
    from imageio_ffmpeg import get_ffmpeg_exe

    try:
        program = get_ffmpeg_exe()
    except RuntimeError as error:
        raise LabError("there is no ffmpeg, which encodes the videos: install imageio-ffmpeg again.") from error
    height, width, _ = shape
    rational = str(Fraction(rate).limit_denominator())
    raw = ("-f", "rawvideo", "-vcodec", "rawvideo", "-s", f"{width}x{height}", "-pix_fmt", "rgb24", "-r", rational)
    # Out of reach of a Ctrl-C, which is meant for this process; "file:", since a name may look like an option.
    return subprocess.Popen(
        [program, "-y", *raw, "-i", "-", *ENCODING, f"file:{part.absolute()}"],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        process_group=0,
    )


def _end(process: subprocess.Popen) -> None:
    """Let ffmpeg finish the file. Raises BrokenPipeError if it does not succeed."""
    process.stdin.close()
    if process.wait():
        raise BrokenPipeError


def _reason(process: subprocess.Popen) -> str:
    """Why ffmpeg has ended, in words."""
    with suppress(OSError):
        process.stdin.close()
    said = process.stderr.read().decode(errors="replace").strip().splitlines()
    code = process.wait()
    if code < 0:
        return f"ffmpeg was ended by signal {-code}"
    return said[-1].rstrip(".") if said else f"ffmpeg ended with code {code}"
