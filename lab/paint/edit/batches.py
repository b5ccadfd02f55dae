"""Paint one long recording in batches of pictures, each by a process with its own encoder, and join them.

A process takes some seconds to begin, and beside each an encoder is at work; so there is a batch for two cores, and
none of less than `LEAST` pictures.
"""

import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from queue import SimpleQueue

from lab.base.errors import LabError
from lab.paint.encoder import join_videos
from lab.paint.process import Heard, Painter
from lab.recording import open_recording

LEAST = 150  # pictures of a batch
CORES = 2  # for a batch: its painter and its encoder

Count = Callable[[int, int], None]


def batches_for(path: Path, target: Path, wishes: Mapping[str, object], cores: int) -> int:
    """In how many batches a recording is best painted on these cores. Raises LabError."""
    if cores < 2 * CORES or (not wishes.get("png") and target.suffix != ".mp4"):
        return 1
    with open_recording(path, sound=bool(wishes.get("sound"))) as recording:
        return max(1, min(cores // CORES, len(recording.frames["time"]) // LEAST))


def paint_batches(path: Path, target: Path, count: int, wishes: Mapping[str, object], progress: Count) -> Path:
    """Paint a recording in this many batches into a video, or with the wish `png` a folder; returns it.

    wishes: arguments of `render_recording` by name. Raises LabError; then nothing is left.
    """
    from lab.paint.video import made_with

    png, rest = bool(wishes.get("png")), {name: wish for name, wish in wishes.items() if name != "png"}
    target.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=target.parent, prefix=".batches-") as room:
        pieces = [Path(room) / (f"{k}" if png else f"{k}.mp4") for k in range(count)]
        _paint(path, pieces, wishes, progress)
        return join_folders(pieces, target) if png else join_videos(pieces, target, made_with(**rest))


def join_folders(pieces: list[Path], target: Path) -> Path:
    """Move the pictures of folders into one, numbered on; the last one, which tells that all are there, at last."""
    target.mkdir(exist_ok=True)
    for old in target.glob("picture_*.png"):
        old.unlink()
    every = [picture for piece in pieces for picture in sorted(piece.glob("picture_*.png"))]
    for k, picture in enumerate(every):
        picture.replace(target / f"picture_{k:05d}.png")
    return target


def _paint(path: Path, pieces: list[Path], wishes: Mapping[str, object], progress: Count) -> None:
    heard: Heard = SimpleQueue()
    painters = [Painter(heard, cores=1) for _ in pieces]
    done, of, busy = [0] * len(pieces), [0] * len(pieces), set(range(len(pieces)))
    try:
        for k, (painter, piece) in enumerate(zip(painters, pieces, strict=True)):
            painter.paint({"path": str(path), "out": str(piece), **wishes, "piece": [k, len(pieces)]})
            painter.end()
        while busy:
            painter, answer = heard.get()
            k = painters.index(painter)
            if answer is None and k in busy:
                raise LabError(f"{path}: a process that painted it was ended, maybe for want of memory.")
            if answer and "failed" in answer:
                raise LabError(answer["failed"])
            if answer and "made" in answer:
                busy.remove(k)
            elif answer:
                done[k], of[k] = answer["done"], answer["of"]
                if all(of):
                    progress(sum(done), sum(of))
    finally:
        for k, painter in enumerate(painters):
            painter.stop() if k in busy else painter.wait()
