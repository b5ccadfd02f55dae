"""Export a recording: what is asked for, where it goes, and that it is whole or not there."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from lab.base.errors import LabError
from lab.base.files import named, replacing, unfinished
from lab.base.turn import in_turn
from lab.export.csv import write_csv
from lab.export.gsd import write_gsd
from lab.export.html import write_html
from lab.export.names import FRAMES, NAMES
from lab.export.netcdf import write_netcdf
from lab.export.stage import Stage
from lab.export.vtkhdf import write_vtkhdf
from lab.export.xyz import write_xyz
from lab.paint.footage import Footage
from lab.preset.units import quoted
from lab.recording import Recording, open_recording

WRITERS = {"vtkhdf": write_vtkhdf, "gsd": write_gsd, "xyz": write_xyz, "csv": write_csv, "html": write_html}
Progress = Callable[[int, int], None]


@in_turn
def export_recording(
    path: Path | str,
    to: str,
    out: Path | str | None = None,
    *,
    every: int = 1,
    world: int | None = None,
    frame: str | None = None,
    sound: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Write a recording (its file or its run's folder) in a format; returns the path of the file or folder.

    to: one of `lab.export.names.NAMES`. out: the file or folder, which must not exist (default: beside the recording).
    every: each so many frames, from the first on. world: one of the repeats, from 0 (default: the first, but all where
    the format keeps the recording as it is). frame: of reference, earth or tank (default: earth; the tank where the
    format keeps the recording as it is). sound: only the rows before the first damaged one. progress(done, total) is
    called after each picture. Raises LabError.
    """
    _check(to, every, frame)
    with open_recording(path, sound=sound) as recording:
        if world is not None and not 0 <= world < recording.worlds:
            raise LabError(f"world: {recording.path} has the repeats 0 to {recording.worlds - 1} (got {world}).")
        target = recording.folder / NAMES[to].place if out is None else named(out)
        with _new(target, NAMES[to].folder) as place:
            _write(recording, to, place, every, world, frame, progress or (lambda done, total: None))
    return target


def left_out(path: Path | str, to: str, world: int | None) -> str:
    """A sentence on the worlds of a recording that an export leaves out; empty if it has all."""
    with open_recording(path) as recording:
        count = recording.worlds
    if NAMES[to].keeps or world is not None or count == 1:
        return ""
    return f"this is repeat 0 of {count}: --world K exports another."


def _check(to: str, every: int, frame: str | None) -> None:
    """Raise LabError for what there is not."""
    if to not in NAMES:
        raise LabError(f"to: choose one of {', '.join(NAMES)} (got {quoted(str(to))}).")
    if isinstance(every, bool) or not isinstance(every, int) or every < 1:
        raise LabError(f"every: a whole number from 1 on is needed (got {quoted(str(every))}).")
    if frame is not None and frame not in FRAMES:
        raise LabError(f"frame: choose one of {', '.join(FRAMES)} (got {quoted(str(frame))}).")
    if frame == "earth" and NAMES[to].keeps:
        raise LabError(f"frame: {to} holds places in the tank's axes, with the tank's pose beside them; leave it out.")


def _write(
    recording: Recording, to: str, place: Path, every: int, world: int | None, frame: str | None, progress: Progress
) -> None:
    if NAMES[to].keeps:
        write_netcdf(recording, every, world, place, lambda done: progress(done, 1))
        return
    footage = Footage(recording)
    try:
        stage = Stage(recording, footage, world or 0, (frame or FRAMES[0]) == "earth")
        rows = range(0, len(stage.time), every)
        WRITERS[to](stage, rows, place, lambda done: progress(done, len(rows)))
    finally:
        footage.close()


@contextmanager
def _new(target: Path, folder: bool) -> Iterator[Path]:
    """A place for a new file or folder, which gets its name once it is whole. Raises LabError."""
    if target.exists() or target.is_symlink():
        raise LabError(f"{target} exists: remove it, or name another place with --out.")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        if not folder:
            with replacing(target) as part:
                yield part
            return
        part = unfinished(target)
        shutil.rmtree(part, ignore_errors=True)  # of a process that was killed
        part.mkdir()
        try:
            yield part
            part.replace(target)
        except BaseException:
            with suppress(OSError):
                shutil.rmtree(part)
            raise
    except OSError as error:
        reason = error.strerror or str(error)
        raise LabError(f"{target} cannot be written ({reason}): name another place with --out.") from error
