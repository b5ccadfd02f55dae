"""Encode pictures as an H.264 video, with the ffmpeg that comes with imageio-ffmpeg.

The video is written under another name and renamed when ffmpeg has ended without an error, so a file with the video's
name is always a whole video: a full disk, or the end of either process, leaves at most the unfinished one.
"""

import os
import subprocess
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from fractions import Fraction
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.files import replacing

BT709 = "scale=out_color_matrix=bt709:out_range=tv"
ENCODING = (
    *("-an", "-vcodec", "libx264", "-pix_fmt", "yuv420p", "-v", "error"),
    *("-crf", "20", "-preset", "veryfast", "-movflags", "+faststart", "-vf", BT709),
    *("-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709"),
)
LARGEST_INDEX = 2**24  # bytes read of a video's index, which has some 20 a picture


def write_video(out: Path, pictures: Iterable[np.ndarray], rate: float, comment: str = "") -> Path:
    """Write pictures (height, width, 3), u8, all of one size, as a video of `rate` pictures a second; returns `out`.

    comment: a text that is kept in the file. Raises LabError if `out` is no .mp4 file or cannot be written.
    """
    if out.suffix != ".mp4":
        raise LabError(f"{out} cannot be written: a video is an .mp4 file.")
    process = None
    with replacing(out) as part:  # the encoder of a killed process may still have the unfinished one open
        try:
            for picture in pictures:
                if process is None:
                    process = _begin(part, picture.shape, rate, comment)
                with _encoding(process, out):
                    process.stdin.write(memoryview(np.ascontiguousarray(picture)))
            with _encoding(process, out):
                process.stdin.close()
                if process.wait():
                    raise BrokenPipeError
        finally:
            if process:
                _be_done_with(process)
    return out


def join_videos(pieces: Sequence[Path], out: Path, comment: str = "") -> Path:
    """Join videos of one size and rate, as `write_video` writes them, without encoding them again; returns `out`.

    Raises LabError if `out` cannot be written.
    """
    said = pieces[0].with_suffix(".txt")
    said.write_text("".join(f"file '{piece.name}'\n" for piece in pieces), encoding="utf-8")
    joined = ("-f", "concat", "-safe", "0", "-i", f"file:{said.absolute()}", "-c", "copy", "-movflags", "+faststart")
    with replacing(out) as part:
        told = ("-metadata", f"comment={comment}", f"file:{part.absolute()}")
        made = subprocess.run([ffmpeg(), "-y", "-v", "error", *joined, *told], capture_output=True, text=True)
        if made.returncode:
            raise LabError(f"{out} cannot be written: {made.stderr.strip().splitlines()[-1:]}; make room there.")
    return out


def ffmpeg() -> str:
    from imageio_ffmpeg import get_ffmpeg_exe

    try:
        return get_ffmpeg_exe()
    except RuntimeError as error:
        raise LabError("there is no ffmpeg, which encodes the videos: install imageio-ffmpeg again.") from error


def _begin(part: Path, shape: tuple[int, ...], rate: float, comment: str) -> subprocess.Popen:
    program = ffmpeg()
    height, width, _ = shape
    rational = str(Fraction(rate).limit_denominator())
    raw = ("-f", "rawvideo", "-vcodec", "rawvideo", "-s", f"{width}x{height}", "-pix_fmt", "rgb24", "-r", rational)
    # Out of reach of a Ctrl-C, which is meant for this process; "file:", since a name may look like an option.
    return subprocess.Popen(
        [program, "-y", *raw, "-i", "-", *ENCODING, "-metadata", f"comment={comment}", f"file:{part.absolute()}"],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        process_group=0,
    )


def says(path: Path, comment: str) -> bool:
    """Whether a video has this comment. It stands in the index of an .mp4 file, which comes first in the lab's own."""
    with path.open("rb") as file:
        while len(head := file.read(8)) == 8:
            size, kind = int.from_bytes(head[:4], "big"), head[4:]
            if kind == b"moov":
                return comment.encode() in file.read(min(size, LARGEST_INDEX))
            if size < 8 or kind == b"mdat":
                return False
            file.seek(size - 8, os.SEEK_CUR)
    return False


@contextmanager
def _encoding(process: subprocess.Popen, out: Path) -> Iterator[None]:
    """Turn the end of ffmpeg before its time, a broken pipe, into a LabError."""
    try:
        yield
    except BrokenPipeError:
        raise LabError(f"{out} cannot be written: {_reason(process)}.") from None


def _be_done_with(process: subprocess.Popen) -> None:
    """End ffmpeg if it has not ended, and close the pipes."""
    process.kill()
    with suppress(OSError):
        process.stdin.close()
    process.wait()
    process.stderr.close()


def _reason(process: subprocess.Popen) -> str:
    """Why ffmpeg has ended, and what to do about it."""
    with suppress(OSError):
        process.stdin.close()
    said = process.stderr.read().decode(errors="replace").strip().splitlines()
    code = process.wait()
    if code < 0:
        return f"ffmpeg was ended by signal {-code}, maybe for want of room or memory; paint it again"
    return f"{said[-1].rstrip('.') if said else f'ffmpeg ended with code {code}'}; make room there"
