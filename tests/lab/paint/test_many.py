"""Many recordings painted at once: which are meant, where the videos go, what is left out, what happens to bad ones."""

import os
import signal
import weakref

import imageio_ffmpeg
import numpy as np
import pytest
from PIL import Image

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.paint import many
from lab.paint.edit.batches import batches_for, join_folders, paint_batches
from lab.paint.encoder import join_videos, says
from lab.paint.many import Job, find_recordings, paint_all, plan
from lab.paint.process import Ending, Painter
from lab.paint.video import is_made, made_with, render_recording
from tests.oracles.synthetic import frame, recorder, sample

SMALL = {"width": 320, "height": 180}


def made(folder, frames=2):
    """A folder with a small recording."""
    with recorder(folder) as run:
        for k in range(frames):
            run.sample(sample(0.04 * k))
            run.frame(frame(0.04 * k, position=np.full((1, 4, 2), 0.02)))
    return folder


@pytest.fixture
def sweep(tmp_path):
    """A folder as a sweep leaves it: two points that can be painted, and one that is damaged between them."""
    points = [made(tmp_path / "sweep" / "points" / name) for name in ("000", "001", "002")]
    (points[1] / "recording.h5").write_bytes(b"junk")
    return tmp_path / "sweep"


def painted(places, out=None, **wishes):
    """What `cargolab render` does with several places: the sentences on those that failed, and the videos."""
    jobs = plan(find_recordings(places)[0], out, bool(wishes.get("png")))
    with Progress(quiet=True) as progress:
        return paint_all(jobs, SMALL | wishes, progress), [job.target for job in jobs]


def test_folders_sweeps_files_and_patterns_name_recordings_once(tmp_path):
    a, b, c = (made(tmp_path / "runs" / name) for name in ("a", "b", "c-2"))
    (tmp_path / "runs" / "notes.txt").write_text("not a recording")
    assert find_recordings([tmp_path / "runs"]) == ([a, b, c], {})
    assert find_recordings([c, a / "recording.h5", tmp_path / "runs"]) == ([c, a, b], {})
    assert find_recordings([tmp_path / "*" / "[ab]"])[0] == [a, b]
    assert find_recordings([tmp_path / "**" / "recording.h5"])[0] == [a, b, c]
    (tmp_path / "odd [1]").mkdir()
    assert find_recordings([made(tmp_path / "odd [1]" / "run").parent])[0] == [tmp_path / "odd [1]" / "run"]
    found, empty = find_recordings([a, tmp_path / "no*", tmp_path / "runs" / "notes.txt"])
    assert found == [a, tmp_path / "runs" / "notes.txt"] and "matches no recording" in empty[tmp_path / "no*"]


def test_videos_go_beside_their_recordings_or_into_one_folder_under_their_names(tmp_path):
    points = [made(tmp_path / "s" / "points" / name) for name in ("000", "run-0.5")]
    assert [job.target for job in plan(points, None, False)] == [point / "video.mp4" for point in points]
    out = tmp_path / "films"
    assert [job.target for job in plan(points, out, False)] == [out / "000.mp4", out / "run-0.5.mp4"]
    assert [job.target for job in plan(points, out, True)] == [out / "000", out / "run-0.5"]
    nested = [tmp_path / "s" / "points" / "000", tmp_path / "t" / "000"]
    assert [job.target for job in plan(nested, out, False)] == [out / "s/points/000.mp4", out / "t/000.mp4"]
    with pytest.raises(LabError, match="one video, and 2 recordings"):
        plan(points, tmp_path / "film.mp4", False)
    with pytest.raises(LabError, match="files of one name"):
        plan([tmp_path / "s" / "a.h5", tmp_path / "s" / "b.h5"], None, False)


def test_a_bad_recording_fails_alone_and_what_is_done_is_left_out(sweep, tmp_path, monkeypatch):
    monkeypatch.setattr("solvers.machine.runtime.available_cores", lambda: 1)
    failed, (first, second, third) = painted([sweep], tmp_path / "out")
    bad = sweep / "points" / "001"
    assert list(failed) == [bad] and "cannot be read as a recording" in failed[bad]
    assert first.exists() and third.exists() and not second.exists()
    monkeypatch.setattr(many, "Painter", None)  # nobody is asked again for those two
    assert painted([bad.parent / "000", bad.parent / "002"], tmp_path / "out")[0] == {}


@pytest.mark.parametrize("png", [False, True])
def test_only_a_whole_video_of_this_recording_with_these_wishes_counts_as_made(tmp_path, png):
    run = made(tmp_path / "run", frames=3)
    recording, target = run / "recording.h5", render_recording(run, png=png, colour="layer", **SMALL)

    def counts(**wishes):
        return is_made(target, recording, png, made_with(**SMALL, **wishes))

    assert counts(colour="layer", world=None, sound=False)
    assert not counts(colour="speed") and not counts() and not counts(colour="layer", world=0)
    last = target / "picture_00002.png" if png else target
    later = last.stat().st_mtime_ns + 1
    os.utime(recording, ns=(later, later))
    assert not counts(colour="layer")
    os.utime(recording, ns=(0, 0))
    assert counts(colour="layer")
    last.unlink()  # the others are there
    assert not counts(colour="layer")


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="kills a process")
def test_a_killed_painter_fails_one_recording_and_another_takes_its_place(sweep, monkeypatch, tmp_path):
    begun = []

    class Killed(Painter):
        """The first one is killed at once."""

        def paint(self, job):
            begun.append(job["path"])
            if len(begun) == 1:
                os.kill(self.pid, signal.SIGKILL)
            super().paint(job)

    monkeypatch.setattr(many, "Painter", Killed)
    monkeypatch.setattr("solvers.machine.runtime.available_cores", lambda: 1)
    good = [sweep / "points" / name for name in ("000", "002")]
    failed, (first, second) = painted(good)
    assert list(failed) == [good[0]] and "was ended" in failed[good[0]]
    assert not first.exists() and second.exists()
    failed, _ = painted(good)
    assert not failed and first.exists()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="looks for processes")
def test_an_interrupt_ends_the_painters_and_leaves_no_torn_video(tmp_path, monkeypatch):
    runs = [made(tmp_path / name, frames=100) for name in ("a", "b")]
    pids = []

    class Counted(many._PainterPool):
        """It is interrupted after some pictures."""

        def _take(self, painter, answer):
            if answer and answer.get("done") == 3:
                pids.extend(one.pid for one in self._all)
                raise KeyboardInterrupt
            super()._take(painter, answer)

    monkeypatch.setattr(many, "_PainterPool", Counted)
    with pytest.raises(KeyboardInterrupt), Progress(quiet=True) as progress:
        paint_all([Job(run, run / "video.mp4") for run in runs], SMALL, progress)
    assert pids and all([one.name for one in run.iterdir()] == ["recording.h5"] for run in runs)
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_signal_is_heeded_though_it_came_while_python_freed_an_object():
    before = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        ending, thing = Ending(), {1}
        ending.heed()
        seen = weakref.ref(thing, lambda _: os.kill(os.getpid(), signal.SIGTERM))
        del thing
        assert seen() is None
        with pytest.raises(KeyboardInterrupt):
            ending.heed()
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@pytest.mark.slow
def test_batches_join_to_the_pictures_of_one_process(tmp_path):
    run, pieces = made(tmp_path / "run", frames=11), range(3)
    whole = render_recording(run, tmp_path / "whole", png=True, **SMALL)
    parts = [render_recording(run, tmp_path / f"{k}", png=True, piece=(k, 3), **SMALL) for k in pieces]
    joined = join_folders(parts, tmp_path / "joined")
    assert len(list(joined.iterdir())) == 11
    for picture in whole.iterdir():
        assert (joined / picture.name).read_bytes() == picture.read_bytes(), picture.name

    films = [render_recording(run, tmp_path / f"{k}.mp4", piece=(k, 3), **SMALL) for k in pieces]
    film = join_videos(films, tmp_path / "film.mp4", "with care")
    reader = imageio_ffmpeg.read_frames(str(film))
    told, shown = next(reader), [np.frombuffer(shot, np.uint8).reshape(180, 320, 3) for shot in reader]
    assert len(shown) == 11 and told["fps"] == pytest.approx(25.0) and says(film, "with care")
    for shot, picture in zip(shown, sorted(whole.iterdir()), strict=True):
        with Image.open(picture) as image:
            assert np.abs(shot.astype(float) - np.asarray(image)).mean() < 3.0


def test_a_batch_is_for_two_cores_and_many_pictures(tmp_path):
    run = made(tmp_path / "run", frames=700)
    film, png = run / "video.mp4", {"png": True}
    assert [batches_for(run, film, {}, cores) for cores in (1, 2, 4, 6, 64)] == [1, 1, 2, 3, 4]
    assert batches_for(run, run / "film.gif", {}, 64) == 1 and batches_for(run, run / "film.gif", png, 64) == 4


@pytest.mark.slow
def test_batches_are_painted_by_processes_and_nothing_is_left_of_them(tmp_path):
    run, told = made(tmp_path / "run", frames=9), []
    film = paint_batches(run, run / "video.mp4", 2, SMALL, lambda done, total: told.append((done, total)))
    assert told[-1] == (9, 9) and is_made(film, run / "recording.h5", False, made_with(**SMALL))
    with pytest.raises(LabError, match="colour"):
        paint_batches(run, run / "other.mp4", 2, SMALL | {"colour": "none"}, lambda done, total: None)
    assert sorted(path.name for path in run.iterdir()) == ["recording.h5", "video.mp4"]
