"""Paint many recordings, one process a core: those of folders, of sweeps and of patterns.

What paints is imported only when it is clear what is to be painted, so that a typing error is reported at once.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from glob import glob, has_magic
from pathlib import Path
from queue import SimpleQueue

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.paint.process import Heard, Painter
from lab.recording import FILE_NAME

Wishes = Mapping[str, object]  # arguments of `render_recording` by name


@dataclass(frozen=True)
class Job:
    """A recording to paint, its file or its folder, and the video, or the folder of pictures, to make of it."""

    path: Path
    target: Path


def find_recordings(places: Iterable[Path]) -> tuple[list[Path], dict[Path, str]]:
    """The recordings that are meant, sorted within each place and without repeats; sentences on places without one.

    places: recordings, folders of runs, folders with runs below them, such as a sweep's, and patterns of all these.
    """
    found: dict[Path, None] = {}
    empty = {}
    for place in places:
        meant = list(_meant(place))
        found |= dict.fromkeys(meant)
        if not meant:
            what = "matches no recording" if has_magic(str(place)) else "has no recording below it"
            empty[place] = f"{place} {what}: name a recording, a folder of runs or a pattern."
    return list(found), empty


def _meant(place: Path) -> Iterator[Path]:
    """The recordings that a place means, those of the usual name by their folders."""
    if place.exists() or not has_magic(str(place)):
        yield from _below(place)
        return
    for one in map(Path, sorted(glob(str(place), recursive=True))):
        if one.is_dir() or one.suffix == ".h5":
            yield from _below(one)


def _below(place: Path) -> Iterator[Path]:
    """The recordings in a folder or below it; anything else is itself."""
    if place.is_dir():
        yield from [place] if (place / FILE_NAME).exists() else sorted(file.parent for file in place.rglob(FILE_NAME))
    else:
        yield place.parent if place.name == FILE_NAME else place


def plan(recordings: Sequence[Path], out: Path | None, png: bool) -> list[Job]:
    """What to make of each recording: beside it, or in the folder `out`, named like the recordings.

    Raises LabError if `out` is a video, or if two recordings would make files of one name.
    """
    from lab.paint.video import target_of

    if len(recordings) == 1 and out and out.suffix == ".mp4":
        return [Job(recordings[0], out)]
    if out is None:
        jobs = [Job(path, target_of(path, None, png)) for path in recordings]
    elif out.suffix == ".mp4":
        raise LabError(f"{out} is one video, and {len(recordings)} recordings are meant: name a folder with --out.")
    else:
        full = [path.absolute() for path in recordings]
        top = next(folder for folder in full[0].parents if all(folder in one.parents for one in full))
        names = [str(one.relative_to(top)).removesuffix(".h5") for one in full]
        jobs = [
            Job(path, out / (f"{name}{'' if png else '.mp4'}")) for path, name in zip(recordings, names, strict=True)
        ]
    if len({job.target for job in jobs}) < len(jobs):
        raise LabError("--out: two of these recordings would make files of one name: paint them one after the other.")
    return jobs


def paint_all(jobs: Sequence[Job], wishes: Wishes, progress: Progress) -> dict[Path, str]:
    """Paint what is not painted yet, and say what is done; returns a sentence for each recording that failed.

    A video is done if it is newer than its recording and made with the same wishes by the same version. The others go
    on if one fails. Raises KeyboardInterrupt; whole videos stay.
    """
    from lab.paint.video import is_made, made_with

    png, rest = bool(wishes.get("png")), {name: wish for name, wish in wishes.items() if name != "png"}
    comment = made_with(**rest)
    left = [job for job in jobs if not is_made(job.target, _file(job.path), png, comment)]
    if len(left) < len(jobs):
        progress.say(f"{len(jobs) - len(left)} of {len(jobs)} are painted already")
    progress.begin_whole("painting", len(jobs), len(jobs) - len(left))
    return _PainterPool(left, wishes, progress).work() if left else {}


def _file(path: Path) -> Path:
    return path / FILE_NAME if path.is_dir() else path


class _PainterPool:
    """The painting processes, one a core, and the jobs that they have in hand."""

    def __init__(self, jobs: Sequence[Job], wishes: Wishes, progress: Progress) -> None:
        from solvers.machine.runtime import available_cores

        self._left, self._wishes, self._progress = iter(jobs), wishes, progress
        self._processes = min(available_cores(), len(jobs))
        self._heard: Heard = SimpleQueue()
        self._all: list[Painter] = []
        self._busy: dict[Painter, Job] = {}
        self._failed: dict[Path, str] = {}

    def work(self) -> dict[Path, str]:
        """Do all jobs; returns the sentences of those that failed."""
        try:
            for _ in range(self._processes):
                self._employ(self._begin())
            while self._busy:
                painter, answer = self._heard.get()
                if painter in self._busy:
                    self._take(painter, answer)
        finally:
            for painter in self._all:
                painter.stop() if painter in self._busy else painter.wait()
        return self._failed

    def _begin(self) -> Painter:
        self._all.append(Painter(self._heard, cores=1))
        return self._all[-1]

    def _employ(self, painter: Painter) -> None:
        """Give a painter the next job, or end it."""
        if job := next(self._left, None):
            self._busy[painter] = job
            painter.paint({"path": str(job.path), "out": str(job.target), **self._wishes})
        else:
            self._busy.pop(painter, None)
            painter.end()

    def _take(self, painter: Painter, answer: Mapping[str, object] | None) -> None:
        """An answer of a painter; None: it has ended, and another one takes its place."""
        job = self._busy[painter]
        if answer is None:
            self._lose(job, f"{job.path}: the process that painted it was ended, maybe for want of memory.")
            del self._busy[painter]
            self._employ(self._begin())
        elif "made" in answer:
            self._progress.count_one(answer["made"])
            self._employ(painter)
        elif "failed" in answer:
            self._lose(job, answer["failed"])
            self._employ(painter)

    def _lose(self, job: Job, sentence: str) -> None:
        self._failed[job.path] = sentence
        self._progress.count_one(f"{job.path} failed")
