"""The second process that films a run: the same video as without it, and a video in any case."""

import os
import signal

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.paint.beside import Beside
from lab.runs import runner
from lab.runs.runner import report
from tests.oracles.synthetic import frame, preset, recorder, sample

pytestmark = pytest.mark.skipif(os.name != "posix", reason="ends processes by signals")


def made(folder, frames=3):
    """A folder with a small recording."""
    with recorder(folder, resolved=preset() | {"video": {"width": 320, "height": 180}}) as run:
        for k in range(frames):
            run.sample(sample(0.04 * k))
            run.frame(frame(0.04 * k, position=np.full((1, 4, 2), 0.02)))
    return folder


def filmed(folder, beside):
    """The bytes of the video in the report on a run."""
    with Progress(quiet=True) as progress:
        report(folder, progress, video=True, plots=False, beside=beside)
    return (folder / "video.mp4").read_bytes()


def test_the_second_process_makes_the_same_video(tmp_path, monkeypatch):
    alone = filmed(made(tmp_path / "alone"), None)
    monkeypatch.setattr("lab.paint.video.render_recording", None)  # not in this process
    with Beside(1) as beside:
        assert filmed(made(tmp_path / "run"), beside) == alone


def test_if_the_second_process_is_killed_the_first_makes_the_video(tmp_path):
    with Beside(1) as beside:
        os.kill(beside._painter.pid, signal.SIGKILL)
        assert len(filmed(made(tmp_path / "run"), beside)) > 1000


def test_what_cannot_be_filmed_is_one_sentence(tmp_path):
    with Beside(1) as beside:
        beside.begin(made(tmp_path / "run", frames=0))
        with pytest.raises(LabError, match="has no picture frames yet"):
            beside.finish(lambda done, total: None)


@pytest.mark.parametrize(("cores", "apart"), [(2, True), (1, False)])
def test_a_single_core_gets_no_second_process(cores, apart, monkeypatch):
    monkeypatch.setattr(runner, "available_cores", lambda: cores)
    monkeypatch.setattr("lab.paint.beside.Painter", lambda *_, **__: None)
    assert isinstance(runner._second_process(True), Beside) == apart
    assert not isinstance(runner._second_process(False), Beside)


def test_a_run_goes_on_without_a_second_process_where_there_is_no_room_for_one(monkeypatch):
    def full(*_, **__):
        raise BlockingIOError("Resource temporarily unavailable")

    monkeypatch.setattr(runner, "available_cores", lambda: 2)
    monkeypatch.setattr("lab.paint.beside.Painter", full)
    with runner._second_process(True) as beside:
        assert beside is None
