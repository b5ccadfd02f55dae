"""Results are written beside their place and replace it whole: no link is followed, no cut file is left."""

import errno
import os
import resource

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.base.files import named, replacing, write_text
from lab.paint.video import poster
from lab.recording import open_recording
from lab.report.file import write_report
from lab.report.plots import write_plots
from lab.report.summary import write_summary
from lab.runs.checkpoint import Checkpoint
from tests.oracles.synthetic import frame, recorder, sample


@pytest.fixture
def run(tmp_path):
    folder = tmp_path / "run"
    with recorder(folder) as writer:
        for k in range(3):
            writer.sample(sample(0.1 * k))
            writer.frame(frame(0.1 * k, position=np.random.default_rng(k).uniform(0.0, 0.02, (1, 4, 2))))
    return folder


def results(folder) -> None:
    """All that the lab writes beside a recording, from a run's report to a poster."""
    with open_recording(folder) as recording:
        write_summary(recording, {}, write_plots(recording, {}, folder), folder)
    write_report(folder)
    poster(folder, width=320, height=180)
    Checkpoint({}, (".",), (0, 0)).write(folder)


def test_no_result_is_written_through_a_symbolic_link(run):
    """As they may lie in the folder of a stranger's recording; an unfinished file's place may be one, too."""
    results(run)
    made = sorted(path.name for path in run.iterdir() if path.name != "recording.h5")
    assert {"summary.md", "summary.json", "report.html", "poster.png", "checkpoint.npz"} <= {*made}
    mine = run.with_name("mine")
    mine.write_text("a letter")
    for name in made:
        (run / name).unlink()
        stem, _, ending = name.rpartition(".")
        for place in (run / name, run / f"{stem}.part.{ending}"):
            place.symlink_to(mine)
    results(run)
    assert mine.read_text() == "a letter"
    assert sorted(path.name for path in run.iterdir()) == sorted([*made, "recording.h5"])
    assert not any((run / name).is_symlink() for name in made)


def test_a_full_disk_leaves_what_was_there(run):
    writers = write_report, lambda folder: poster(folder, width=320, height=180)
    for write in writers:
        write(run)
    before = {path.name: path.read_bytes() for path in run.iterdir()}
    most = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, most[1]))  # bytes; what is longer ends as on a full disk
    try:
        for write in writers:
            with pytest.raises((LabError, OSError)):
                write(run)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, most)
    assert {path.name: path.read_bytes() for path in run.iterdir()} == before


def test_an_error_while_writing_leaves_the_old_file_and_no_other(tmp_path):
    path = tmp_path / "page.md"
    write_text(path, "old")
    with pytest.raises(OSError), replacing(path) as part:
        part.write_text("half of the n")
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert path.read_text() == "old" and list(tmp_path.iterdir()) == [path]


def test_a_pipe_is_written_to(tmp_path):
    path = tmp_path / "pipe"
    os.mkfifo(path)
    reader = os.open(path, os.O_RDONLY | os.O_NONBLOCK)
    write_text(path, "text")
    assert os.read(reader, 10) == b"text" and path.is_fifo()
    os.close(reader)


def test_an_empty_name_is_no_folder():
    with pytest.raises(LabError, match="the name is empty"):
        named("")
    assert named(".") == named("./x").parent
