"""Interrupted runs continue bit for bit, whether interrupted by the user, killed or stopped by a full disk."""

import errno
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from click.testing import CliRunner

from lab.base.errors import LabError
from lab.base.lock import only_one
from lab.base.progress import Progress
from lab.cli import main
from lab.preset.find import load
from lab.recording import Recorder, open_recording
from lab.runs.batch import Batch
from lab.runs.checkpoint import Checkpoint, read_checkpoint
from lab.runs.run import prepare
from lab.runs.runner import hint, resume_run, run_preset
from tests.oracles.synthetic import frame, recorder, sample
from tests.oracles.tampering import flipped

pytestmark = pytest.mark.usefixtures("no_plots")

ROOT = Path(__file__).parents[3]
SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 16},
    "motion": {"tilt": {"rate": "60 deg/s", "angle": "20 deg", "hold": "0.5 s"}},
    "run": {"repeats": 2, "threads": 1},
    "record": {"checkpoint_every": "0 s", "picture_rate": "50 Hz"},
}


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """The uninterrupted run; what would be there, had it been killed after a checkpoint; and its rows up to there."""
    folder, save, kept = tmp_path_factory.mktemp("whole") / "run", Batch.save, []
    cut = folder.with_name("cut")

    def noted(batch):
        save(batch)
        rows = batch._recorders[0].rows
        if rows[0] > 20 and not kept:
            kept.append(rows)
            shutil.copytree(folder, cut)

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Batch, "save", noted)
        run_preset("tilting/quick", SMALL, folder, video=False, quiet=True)
    return contents(folder), cut, kept[0]


@pytest.fixture(scope="module")
def whole(done):
    """The uninterrupted run."""
    return done[0]


def contents(folder: Path) -> dict[str, np.ndarray]:
    """Every data set of a recording."""
    found = {}

    def keep(name, item):
        if isinstance(item, h5py.Dataset):
            found[name] = item[()]

    with h5py.File(folder / "recording.h5", "r") as file:
        assert file.attrs["status"] == b"complete"
        file.visititems(keep)
    return found


def assert_same(folder: Path, whole: dict[str, np.ndarray]) -> None:
    mine = contents(folder)
    assert mine.keys() == whole.keys()
    for name, values in whole.items():
        assert np.array_equal(mine[name], values), name


def command(*arguments: object) -> subprocess.Popen:
    line = [sys.executable, "-m", "lab", *map(str, arguments)]
    return subprocess.Popen(line, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@contextmanager
def hearing_ctrl_c():
    """Workers of pytest ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def rows(folder: Path) -> tuple[int, int]:
    """Rows that a reader sees now, while the run may go on."""
    with open_recording(folder) as recording:
        return len(recording.series["time"]), len(recording.frames["time"])


@pytest.mark.slow
def test_a_repeatedly_interrupted_run_equals_the_uninterrupted_one(whole, tmp_path, monkeypatch):
    folder = tmp_path / "run"
    prepare(load("tilting/quick", SMALL), folder).make_recording()  # as if killed before its beds had settled
    assert rows(folder) == (0, 0)

    with monkeypatch.context() as patch, hearing_ctrl_c():
        patch.setattr(Progress, "reach", lambda _, done: abs(done - 0.2) < 1e-6 and signal.raise_signal(signal.SIGINT))
        done = CliRunner().invoke(main, ["resume", str(folder), "--no-video", "--quiet"])
    assert done.exit_code == 130
    said = done.stderr.strip()
    assert said == f"cargolab: interrupted at 210 ms of 933.3 ms; continue with: cargolab resume {folder}"
    with open_recording(folder) as recording:
        assert recording.status == "stopped: interrupted by the user"
    assert (folder / "summary.json").exists() and (folder / "checkpoint.npz").exists()

    interrupted = rows(folder)
    run = command("resume", folder, "--no-video")
    while run.poll() is None and rows(folder)[0] < interrupted[0] + 20:
        time.sleep(0.01)
    flushed = rows(folder)
    run.kill()
    run.communicate()
    assert run.returncode == -signal.SIGKILL
    assert rows(folder) >= flushed > interrupted

    result = resume_run(folder, video=False, quiet=True)
    assert_same(folder, whole)
    assert sorted(path.name for path in folder.iterdir()) == ["recording.h5", "summary.json", "summary.md"]
    assert "critical_angle" in result.measures
    with pytest.raises(LabError, match="is complete: there is nothing to resume"):
        resume_run(folder, quiet=True)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(24))
def test_a_run_killed_at_any_time_equals_the_uninterrupted_one(whole, tmp_path, seed):
    folder, chance = tmp_path / "run", random.Random(seed)
    run = command("run", "tilting/quick", "--no-video", "--out", folder, *as_options(SMALL))
    while not (folder / "recording.h5").exists():
        time.sleep(0.001)
    for _ in range(chance.randrange(1, 6)):
        time.sleep(chance.uniform(0.0, 12.0))
        seen = rows(folder)
        run.kill()
        run.communicate()
        assert rows(folder) >= seen
        run = command("resume", folder, "--no-video")
    run.communicate()
    assert run.returncode in (0, 2)  # 2: it was complete already
    assert_same(folder, whole)


def as_options(table: dict) -> list[str]:
    """--set options of nested tables."""
    flat = [(f"{a}.{b}", value) for a, inner in table.items() for b, value in inner.items()]
    tilt = [(f"motion.tilt.{c}", value) for c, value in table["motion"]["tilt"].items()]
    return [word for key, value in [*flat, *tilt] if key != "motion.tilt" for word in ("--set", f"{key}={value}")]


def test_nothing_recorded_is_lost_if_resuming_fails(tmp_path, monkeypatch):
    with recorder(tmp_path) as run:
        for k in range(5):
            run.sample(sample(float(k)))
    with monkeypatch.context() as patch, pytest.raises(LabError, match="cannot be written"):
        patch.setattr(os, "posix_fallocate", fails(errno.ENOSPC), raising=False)
        patch.setattr(shutil, "disk_usage", fails(errno.ENOSPC))
        Recorder(tmp_path, samples=5)
    with open_recording(tmp_path) as recording:
        assert recording.complete
        np.testing.assert_array_equal(recording.series["time"], range(5))


def test_a_continued_recording_has_all_complete_rows_and_overwrites_repeated_ones(tmp_path):
    with recorder(tmp_path, parts={"b": [(0, 0), (1, 1)], "a": [(0, 0), (2, 2)]}, fixed=[(0, 0, 1)]) as run:
        for k in range(6):
            run.sample(sample(float(k), kinetic=[7.0]))
            run.frame(frame(float(k), part=np.full((1, 2, 2), k)))
        run.wall_s = 3.0
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file["series/overlap"].resize(5, axis=0)  # a row torn by a kill
    with Recorder(tmp_path, samples=3, frames=6) as run:
        assert run.rows == (3, 6) and run.wall_s == 3.0
        run.sample(sample(3.0, kinetic=[8.0]))
        run.flush()
        with open_recording(tmp_path) as recording:
            assert recording.status == "running"
            assert list(recording.parts) == ["b", "a"]
            np.testing.assert_array_equal(recording.fixed, [(0, 0, 1)])
            np.testing.assert_array_equal(recording.series["time"], range(5))
            np.testing.assert_array_equal(recording.series["kinetic"][:, 0], [7, 7, 7, 8, 7])
            np.testing.assert_array_equal(recording.frames["part"][:][:, 0, 1, 0], range(6))


def test_a_recording_shorter_than_its_checkpoint_is_not_continued(tmp_path):
    recorder(tmp_path).close()
    with pytest.raises(LabError, match="has fewer rows than its checkpoint"):
        Recorder(tmp_path, samples=1)


def test_resuming_does_not_copy_the_recording(tmp_path, monkeypatch):
    prepare(load("tilting/quick", SMALL), tmp_path).make_recording()
    before = (tmp_path / "recording.h5").stat().st_ino
    found = []

    def go_on(run, *_):
        Recorder(run.folder).close("stopped: enough")
        found.extend((path.name, path.stat().st_ino) for path in tmp_path.iterdir())

    monkeypatch.setattr("lab.runs.runner._complete", go_on)
    resume_run(tmp_path, quiet=True)
    assert found == [("recording.h5", before)]


def test_a_checkpoint_is_complete_or_the_previous_one(tmp_path, monkeypatch):
    first = Checkpoint({"a": np.arange(3.0), "n": np.array(4)}, ("points/001",), (3, 1), ("Beware.",), ("So be it.",))
    first.write(tmp_path)
    with monkeypatch.context() as patch, pytest.raises(LabError, match=r"checkpoint\.npz cannot be written"):
        patch.setattr(os, "fsync", fails(errno.ENOSPC))
        Checkpoint({}, (), (9, 9)).write(tmp_path)
    kept = read_checkpoint(tmp_path)
    assert (kept.runs, kept.rows) == (first.runs, first.rows)
    assert (kept.warnings, kept.notes) == (first.warnings, first.notes)
    np.testing.assert_array_equal(kept.state["a"], first.state["a"])
    assert kept.state["n"] == 4
    assert [path.name for path in tmp_path.iterdir()] == ["checkpoint.npz"]


def damages(content: bytes, chance: random.Random):
    """The content with bits turned, bytes replaced, or a part missing, again and again."""
    for k in range(2000):
        changed, place = bytearray(content), chance.randrange(len(content))
        if k % 3 == 0:
            changed[place] ^= 1 << chance.randrange(8)
        elif k % 3 == 1:
            changed[place : place + 16] = chance.choice([chance.randbytes(16), bytes(16)])
        else:
            del changed[place : place + chance.choice([1, 100, len(content)])]
        yield bytes(changed)


def test_a_damaged_checkpoint_is_refused_in_one_sentence(tmp_path):
    whole = Checkpoint({"a": np.arange(30.0), "b": np.ones((3, 2), "i4")}, ("points/001",), (3, 1))
    whole.write(tmp_path)
    path = tmp_path / "checkpoint.npz"
    refused = 0
    for content in damages(path.read_bytes(), random.Random(4)):
        path.write_bytes(content)
        try:
            kept = read_checkpoint(tmp_path)
        except LabError as error:
            assert "checkpoint.npz" in str(error) and "start the run again" in str(error)
            refused += 1
            continue
        assert (kept.runs, kept.rows, kept.state.keys()) == (whole.runs, whole.rows, whole.state.keys())
        for name, values in whole.state.items():
            np.testing.assert_array_equal(kept.state[name], values)
    assert refused > 1500


CUTS = {"units": (0, 10**9, 17), "schedule": (3,), "vectors": (10**9, 3), "room": (3,)}


@pytest.mark.parametrize(("name", "number"), [(name, number) for name, cuts in CUTS.items() for number in cuts])
def test_a_checkpoint_that_asks_for_another_cut_is_refused(done, tmp_path, name, number):
    """Its units a world, schedule, lanes and room for contacts decide how large arrays are."""
    _, cut, _ = done
    folder = shutil.copytree(cut, tmp_path / "run")
    kept = read_checkpoint(folder)
    replace(kept, state={**kept.state, f"run.{name}": np.array(number)}).write(folder)
    with pytest.raises(LabError, match="its checkpoint is of another scene: start the run again"):
        resume_run(folder, video=False, quiet=True)


@pytest.mark.slow  # that a damaged row is told is in `tests/lab/recording/test_damage.py`
def test_a_run_with_damage_after_its_checkpoint_continues_with_the_same_bits(done, tmp_path):
    """A flipped bit is written over where its row comes again; before the checkpoint it is said."""
    whole, cut, (rows, frames) = done
    folder = shutil.copytree(cut, tmp_path / "run")
    before = (folder / "recording.h5").read_bytes()
    flip(folder, "series/kinetic", rows - 1)
    with pytest.raises(
        LabError, match=f"series/kinetic is damaged from row {rows - 1} of {rows}, before its checkpoint"
    ):
        resume_run(folder, video=False, quiet=True)
    (folder / "recording.h5").write_bytes(before)
    with open_recording(folder) as found:
        last = {name: values[-1] for name, values in found.series.items()}
    longer = Recorder(folder, samples=rows, frames=frames)
    longer.sample(last)  # rows that will come again
    longer.sample(last)
    longer.close("running")
    flip(folder, "series/kinetic", rows + 1)
    resume_run(folder, video=False, quiet=True)
    assert_same(folder, whole)


def flip(folder: Path, name: str, row: int) -> None:
    """Flip a bit of a row of a data set, behind HDF5's back."""
    path = folder / "recording.h5"
    with h5py.File(path, swmr=True) as file:  # as a kill leaves it
        data = file[name]
        chunk = data.id.get_chunk_info(row // data.chunks[0])
        at = chunk.byte_offset + row % data.chunks[0] * int(np.prod(data.shape[1:])) * data.dtype.itemsize
    path.write_bytes(flipped(path.read_bytes(), 8 * at + 3))


def test_runs_that_cannot_be_resumed_are_reported(tmp_path):
    with pytest.raises(LabError, match="does not exist"):
        resume_run(tmp_path, quiet=True)
    folder = tmp_path / "run"
    run = prepare(load("tilting/quick", SMALL), folder)
    run.make_recording()
    with Recorder(folder) as writer:
        writer.sample(sample(0.0, worlds=2))
    with open_recording(folder) as recording:
        assert recording.complete
    with h5py.File(folder / "recording.h5", "r+") as file:
        file.attrs["status"] = "running"
    with pytest.raises(LabError, match="has no checkpoint to resume from: start the run again"):
        resume_run(folder, quiet=True)
    (folder / "checkpoint.npz").write_text("hello")
    with pytest.raises(LabError, match=r"checkpoint\.npz is damaged"):
        resume_run(folder, quiet=True)
    with only_one(folder), pytest.raises(LabError, match="in use by another run"):
        resume_run(folder, quiet=True)


def test_an_interrupted_user_is_told_how_to_continue(tmp_path):
    with pytest.raises(LabError, match=r"^the disk is full\.$"), hint(tmp_path):
        raise LabError("the disk is full.")
    with pytest.raises(KeyboardInterrupt, match=r"^interrupted before the run began$"), hint(tmp_path):
        raise KeyboardInterrupt
    folder = tmp_path / "my run"
    recorder(folder).close()
    Checkpoint({}, (), (0, 0)).write(folder)
    how = f"continue with: cargolab resume '{folder}'$"
    with pytest.raises(LabError, match=f"^the disk is full; {how}"), hint(folder):
        raise LabError("the disk is full.")
    with pytest.raises(KeyboardInterrupt, match=f"^interrupted; {how}"), hint(folder):
        raise KeyboardInterrupt


def fails(number: int):
    def fail(*_, **__):
        raise OSError(number, os.strerror(number))

    return fail


FULL = """
import sys, resource
from tests.oracles.synthetic import frame, recorder
from lab.cli import main
from lab.base.errors import LabError

if sys.argv[2] == "quota":
    resource.setrlimit(resource.RLIMIT_FSIZE, (40_000_000, 40_000_000))
k = 0
try:
    with recorder(sys.argv[1], count=20_000, flush_every=0.0) as run:
        while k < 1000:
            run.frame(frame(float(k), count=20_000))
            k += 1
except LabError as error:
    print(k, error)
"""


def fill(folder: Path, how: str) -> tuple[int, str]:
    """Record until nothing more can be written: frames recorded, and what was said."""
    paths = {"PYTHONPATH": str(ROOT)}
    line = [sys.executable, "-c", FULL, folder, how]
    done = subprocess.run(line, env=os.environ | paths, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stderr == "", done.stderr
    count, _, sentence = done.stdout.strip().partition(" ")
    return int(count), sentence


def assert_kept(folder: Path, count: int, reason: str) -> None:
    with open_recording(folder) as recording:
        time = recording.frames["time"][:]
        assert 10 < count - 1 <= len(time)
        np.testing.assert_array_equal(time, np.arange(len(time)))
        assert recording.status.startswith("stopped: ") and reason in recording.status


@pytest.mark.skipif(sys.platform != "linux", reason="needs a limit on the size of files")
def test_an_exceeded_quota_gives_one_sentence_and_a_valid_recording(tmp_path):
    count, sentence = fill(tmp_path / "run", "quota")
    assert sentence == f"{tmp_path / 'run'} cannot be written (File too large): make room there."
    assert_kept(tmp_path / "run", count, "File too large")


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 40 MB, where one may be mounted."""
    folder = tmp_path / "disk"
    folder.mkdir()
    line = ["mount", "-t", "tmpfs", "-o", "size=40m", "tmpfs", folder]
    if not shutil.which("mount") or subprocess.run(line, capture_output=True, check=False).returncode:
        pytest.skip("no file system can be mounted here")
    yield folder
    subprocess.run(["umount", folder], check=True)


def test_a_full_disk_gives_one_sentence_and_a_valid_recording(small_disk):
    count, sentence = fill(small_disk / "run", "disk")
    assert sentence == f"{small_disk / 'run'} cannot be written (No space left on device): make room there."
    assert_kept(small_disk / "run", count, "No space left")
