import errno
import json
import os
import random
import signal
import time
from multiprocessing import get_context
from pathlib import Path

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.recording import BUFFER_BYTES, Recorder, older, open_recording, superblock
from tests.oracles.synthetic import frame, recorder, sample

FRAMES = "3 times (record.picture_rate, run.duration) × 2 beds (run.repeats)"
FORKS = get_context("forkserver")  # writers that begin at once: what they import has been imported
FORKS.set_forkserver_preload(["lab.recording", "tests.oracles.synthetic"])


def test_written_data_are_read_back(tmp_path):
    radius = np.array([[0.001, 0.002, 0.003], [0.002, 0.002, 0.005]])
    resolved = {"title": "Füllung", "motion": {"tilt": {"rate": 0.1, "angle": 0.5}}}
    with recorder(tmp_path / "new", 2, 3, radius=radius, resolved=resolved) as run:
        pose = np.zeros((2, 3))
        for k in range(3):
            pose[:] = k
            run.sample(sample(0.1 * k, 2, pose=pose, kinetic=[k, 2 * k]))
        run.frame(frame(0.0, 2, 3, spin=radius))
        run.wall_s, run.grain_steps = 2.5, 600
    with open_recording(tmp_path / "new") as recording:
        assert recording.complete
        assert recording.name == "tilting/acetate"
        assert (recording.preset.title, recording.preset.motion.tilt.rate) == ("Füllung", 0.1)
        assert recording.given.startswith("title = ")
        assert (recording.wall_s, recording.grain_steps, recording.step) == (2.5, 600, 1e-5)
        assert recording.versions["numpy"] == np.__version__
        assert recording.machine["cores"] >= 1
        assert recording.worlds == 2
        np.testing.assert_array_equal(recording.radius, radius)
        np.testing.assert_allclose(recording.mean_diameter, [0.004, 0.006])
        assert recording.outline.shape == (4, 2)
        np.testing.assert_allclose(recording.series["time"], [0.0, 0.1, 0.2])
        np.testing.assert_array_equal(recording.series["pose"][:, 1, 2], [0, 1, 2])
        np.testing.assert_array_equal(recording.series["kinetic"], [[0, 0], [1, 2], [2, 4]])
        assert recording.frames["position"].shape == (1, 2, 3, 2)
        np.testing.assert_array_equal(recording.frames["spin"][-1], radius.astype("f4"))
        with pytest.raises(IndexError):
            recording.frames["spin"][1]


def write(folder, standing, under_way) -> None:
    """Record as fast as can be until the process is killed; tells `under_way` once many rows are written."""
    k = standing
    if (folder / "recording.h5").exists():  # of one that was killed
        run = Recorder(folder, samples=k, frames=(k + 3) // 4, flush_every=0.01)
    else:
        run = recorder(folder, count=500, flush_every=0.01)
    while True:
        run.grain_steps = 1000 * k
        run.sample(sample(float(k), kinetic=[float(k)], pose=[[float(k)] * 3]))
        if k % 4 == 0:
            run.frame(frame(float(k), count=500, angle=[[float(k)] * 500]))
        if k == standing + 2000:
            under_way.set()
        k += 1


def start_writer(folder, standing=0):
    """A process that records behind so many rows of what is there, and what tells that it is under way."""
    under_way = FORKS.Event()
    writer = FORKS.Process(target=write, args=(folder, standing, under_way), daemon=True)
    writer.start()
    return writer, under_way


def started_writer(folder):
    """A process that has recorded many rows and goes on."""
    writer, under_way = start_writer(folder)
    assert under_way.wait(60)
    return writer


def kill(writer) -> None:
    """End a process as a power cut would."""
    writer.kill()
    writer.join()


def assert_whole(folder) -> int:
    """Check that every row is as recorded; returns the number of rows."""
    with open_recording(folder) as recording:
        count = len(recording.series["time"])
        frames = recording.frames["time"][:]
        np.testing.assert_array_equal(recording.series["time"], np.arange(count))
        np.testing.assert_array_equal(recording.series["kinetic"][:, 0], np.arange(count))
        np.testing.assert_array_equal(recording.series["pose"][:, 0, 2], np.arange(count))
        np.testing.assert_array_equal(frames, 4 * np.arange(len(frames)))
        np.testing.assert_array_equal(recording.frames["angle"][:][:, 0, -1], frames)
        return count


@pytest.mark.parametrize(
    ("ask", "said"),
    [
        (
            lambda r: r.frames["position"][:, 2],
            f"has no [:, 2]; it is {FRAMES} × 4 grains (grains.count) × 2.",
        ),
        (lambda r: r.frames["position"][3], f"frames/position has no [3]; it is {FRAMES}"),
        (lambda r: r.frames["part"][:, 0, 0], f"{FRAMES} × 0 parts (parts.NAME) × 2."),
        (lambda r: r.frames["pose"]["y"], f"frames/pose has no [y]; it is {FRAMES} × 3."),
        (
            lambda r: r.frames["force"],
            'no "force" in its frames, but time, pose, part, part_turn, position, velocity, angle, spin; ',
        ),
        (lambda r: r.frames["waves"][:, 0], "`cargolab view` records it, of a ship in waves."),
        (lambda r: r.frames["kinetic"][:, 0], "it is in the series (record.series_rate)."),
        (lambda r: r.series["position"], "it is in the frames (record.picture_rate)."),
        (lambda r: r.series["ship_works"][:, 0], "a preset with a table [ship] records it."),
    ],
)
def test_missing_data_are_reported_in_one_sentence(tmp_path, ask, said):
    with recorder(tmp_path, 2) as run:
        for k in range(3):
            run.sample(sample(float(k), 2))
            run.frame(frame(float(k), 2))
    with open_recording(tmp_path) as recording, pytest.raises(LabError) as refused:
        ask(recording)
    assert said in str(refused.value) and "recording.h5" in str(refused.value)


def test_frames_are_indexed_as_arrays(tmp_path):
    with recorder(tmp_path, 2) as run:
        for k in range(3):
            run.frame(frame(float(k), 2, position=np.arange(16.0).reshape(2, 4, 2) + k))
    with open_recording(tmp_path) as recording:
        column = recording.frames["position"]
        whole = column[:]
        for index in (0, -1, slice(None), slice(1, None), (slice(None), 0), (slice(None), -1, 2), (1, 1, slice(2), 0)):
            assert np.array_equal(column[index], whole[index]), index
        assert len(list(column)) == 3
        assert "force" not in recording.frames and recording.frames.get("force") is None


def test_a_killed_run_is_read_up_to_its_last_flush(tmp_path):
    writer = started_writer(tmp_path)
    with open_recording(tmp_path) as live:
        assert len(live.series["time"]) > 0
    kill(writer)
    count = assert_whole(tmp_path)
    assert count > 1500
    with open_recording(tmp_path) as recording:
        assert recording.status == "running"
        assert 1500 * 1000 < recording.grain_steps < 1000 * count


def test_reading_the_file_of_a_killed_writer_clears_its_flag(tmp_path):
    writer, path = started_writer(tmp_path), tmp_path / "recording.h5"
    open_recording(tmp_path).close()
    with pytest.raises(OSError, match="already open for write"):  # it lives
        h5py.File(path)
    kill(writer)
    with pytest.raises(OSError, match="already open for write"):
        h5py.File(path)
    count = assert_whole(tmp_path)
    with h5py.File(path) as file:
        np.testing.assert_array_equal(file["series/time"][:count], np.arange(count))
    content = path.read_bytes()
    assert len(content) - len(content.rstrip(b"\0")) < 2**21  # what was reserved is given back


def test_a_read_only_file_of_a_killed_writer_is_read(tmp_path):
    writer, path = started_writer(tmp_path), tmp_path / "recording.h5"
    kill(writer)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Path, "open", lambda *_, **__: fail_to_write())
        assert assert_whole(tmp_path) > 1500
    with pytest.raises(OSError, match="already open for write"):
        h5py.File(path)


def fail_to_write():
    raise OSError(errno.EROFS, "Read-only file system")


def test_data_beyond_the_recorded_end_of_a_killed_file_are_not_overwritten(tmp_path):
    writer, path = started_writer(tmp_path), tmp_path / "recording.h5"
    kill(writer)
    with path.open("r+b") as file:  # as if the end had been about to be written
        head = file.read(superblock.SIZE)
        file.seek(0)
        file.write(superblock.amended(head, superblock.WRITING, superblock.end(head) // 2))
    begin = assert_whole(tmp_path) - 50
    with Recorder(tmp_path, samples=begin, frames=(begin + 3) // 4) as run:
        for k in range(begin, begin + 3000):
            run.sample(sample(float(k), kinetic=[float(k)], pose=[[float(k)] * 3]))
            if k % 4 == 0:
                run.frame(frame(float(k), count=500, angle=[[float(k)] * 500]))
    assert assert_whole(tmp_path) == begin + 3000


def kill_and_go_on(folder, kills: int, chance: random.Random) -> int:
    """Kill a writer, and others that continue its file, at random times; returns the rows at the end."""
    count, path = 0, folder / "recording.h5"
    for _ in range(kills):
        before = changed(path)
        writer, _ = start_writer(folder, max(0, count - 50))
        while writer.is_alive() and changed(path) == before:
            time.sleep(0.0002)
        time.sleep(chance.choice([0.0, 0.001, 0.02, 0.3, 1.0]) * chance.random())
        kill(writer)
        assert writer.exitcode == -signal.SIGKILL
        if chance.random() < 0.7:  # else the next one finds it as it was left
            kept = assert_whole(folder)
            assert kept >= count
            count = kept
    return count


def changed(path) -> int:
    """When a file was changed last, in ns; 0 where there is none."""
    return path.stat().st_mtime_ns if path.exists() else 0


def test_a_recording_survives_kills_of_processes_that_continue_it(tmp_path):
    kill_and_go_on(tmp_path / "run", 6, random.Random(1))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(20))
def test_a_recording_survives_any_kills(tmp_path, seed):
    assert kill_and_go_on(tmp_path / "run", 20, random.Random(seed)) > 200


def test_rows_are_kept_in_memory_between_flushes(tmp_path):
    with recorder(tmp_path, flush_every=3600.0) as run:
        for k in range(10):
            run.sample(sample(float(k)))
        with open_recording(tmp_path) as recording:
            assert len(recording.series["time"]) == 0
        run.flush()
        with open_recording(tmp_path) as recording:
            assert len(recording.series["time"]) == 10


def test_a_full_buffer_is_written_at_once(tmp_path):
    count = BUFFER_BYTES // 24 // 3 + 1
    with recorder(tmp_path, count=count, flush_every=3600.0) as run:
        for k in range(3):
            run.frame(frame(float(k), count=count))
        with open_recording(tmp_path) as recording:
            assert len(recording.frames["time"]) == 3


def test_a_failed_run_records_why_it_stopped(tmp_path):
    with pytest.raises(ZeroDivisionError), recorder(tmp_path) as run:
        run.sample(sample(0.0))
        raise ZeroDivisionError("Grain 7 left the hold at 1.2 s.\nmore")
    with open_recording(tmp_path) as recording:
        assert recording.status == "stopped: Grain 7 left the hold at 1.2 s."
        assert len(recording.series["time"]) == 1


def test_a_long_status_is_cut_and_a_reader_sees_it_change(tmp_path):
    run = recorder(tmp_path)
    with open_recording(tmp_path) as recording:
        assert recording.status == "running"
        run.close("stopped: " + "ä" * 500)
    with open_recording(tmp_path) as recording:
        assert recording.status == "stopped: " + "ä" * 245


def test_an_interrupted_run_records_that(tmp_path):
    with pytest.raises(KeyboardInterrupt), recorder(tmp_path):
        raise KeyboardInterrupt
    with open_recording(tmp_path) as recording:
        assert recording.status == "stopped: interrupted by the user"


def test_tables_end_with_their_shortest_array(tmp_path):
    with recorder(tmp_path) as run:
        for k in range(5):
            run.sample(sample(float(k)))
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file["series/overlap"].resize(3, axis=0)
    with open_recording(tmp_path) as recording:
        assert {len(values) for values in recording.series.values()} == {3}


def test_a_wrong_row_is_refused(tmp_path):
    with recorder(tmp_path) as run:
        with pytest.raises(ValueError, match="kinetic"):
            run.sample(sample(0.0, kinetic=np.zeros(2)))
        with pytest.raises(ValueError, match="overlap"):
            run.sample({"time": 0.0})


def test_a_second_recording_does_not_overwrite_the_first(tmp_path):
    recorder(tmp_path).close()
    with pytest.raises(LabError, match="already holds a recording"):
        recorder(tmp_path)


def test_a_folder_that_cannot_be_written_is_named(tmp_path):
    (tmp_path / "taken").touch()
    with pytest.raises(LabError, match=r"taken.*choose another folder"):
        recorder(tmp_path / "taken")
    with pytest.raises(LabError, match="/proc/nowhere"):
        recorder("/proc/nowhere")


def test_a_full_disk_stops_the_run_and_keeps_what_was_written(tmp_path, monkeypatch):
    def full(*_):
        raise OSError(errno.ENOSPC, "No space left on device")

    sentence = f"{tmp_path.name} cannot be written .No space left on device.: make room there"
    with pytest.raises(LabError, match=sentence), recorder(tmp_path, count=100_000) as run:
        run.sample(sample(0.0))
        run.flush()
        monkeypatch.setattr(os, "posix_fallocate", full, raising=False)
        for k in range(9):  # more than what was reserved
            run.frame(frame(float(k), count=100_000))
            run.flush()
    monkeypatch.undo()
    with open_recording(tmp_path) as recording:
        np.testing.assert_array_equal(recording.series["time"], [0.0])
        assert 0 < len(recording.frames["time"]) < 9
        assert "No space left on device" in recording.status


def test_a_closed_recording_has_no_unused_reserved_space(tmp_path):
    with recorder(tmp_path) as run:
        run.sample(sample(0.0))
    size = (tmp_path / "recording.h5").stat().st_size
    assert size < 2**20
    Recorder(tmp_path, samples=1).close()
    assert (tmp_path / "recording.h5").stat().st_size < 1.2 * size


def test_a_disk_that_fails_while_writing_is_named(tmp_path, monkeypatch):
    def fail(*_, **__):
        raise OSError(errno.EIO, "long words of HDF5")

    run = recorder(tmp_path)
    run.sample(sample(0.0))
    with monkeypatch.context() as patch, pytest.raises(LabError, match=f"{tmp_path.name} cannot be written"):
        patch.setattr(h5py.Dataset, "resize", fail)
        run.flush()
    run.close()


def make_foreign(path):
    with h5py.File(path, "w") as file:
        file["x"] = 1


def make_older(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "cargo-shift-lab 1"


def make_incomplete(path):
    recorder(path.parent).close()
    with h5py.File(path, "r+") as file:
        del file["series/elastic"]


def make_short(path):
    recorder(path.parent).close()
    path.write_bytes(path.read_bytes()[:1000])


def make_bad_preset(path):
    recorder(path.parent).close()
    with h5py.File(path, "r+") as file:
        del file["preset/resolved"]
        file["preset/resolved"] = json.dumps({})[:1]


@pytest.mark.parametrize(
    ("make", "complaint"),
    [
        (lambda path: None, "does not exist"),
        (lambda path: path.write_text("hello"), "another kind of file"),
        (make_foreign, "not a recording of this lab"),
        (make_older, "another version"),
        (make_incomplete, "damaged"),
        (make_bad_preset, "damaged"),
        (make_short, "truncated"),
    ],
)
def test_other_files_are_refused_in_one_sentence(tmp_path, make, complaint):
    make(tmp_path / "recording.h5")
    with pytest.raises(LabError, match=complaint) as caught:
        open_recording(tmp_path)
    assert str(tmp_path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_grains_recorded_before_parts_turned_are_read_and_gone_on_with(tmp_path):
    """A recording of format 3 has no turn of parts: it opens without, and a frame of today's fits on it."""
    with recorder(tmp_path) as run:
        run.frame(frame(0.0))
        run.sample(sample(0.0))
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        file.attrs["format"] = older.WITH_OTHER_NAMES
        del file["frames/part_turn"]
        checks = file["checks/frames"]
        kept = [name != b"part_turn" for name in checks.attrs["columns"]]
        attributes, rows = dict(checks.attrs), checks[:][:, kept]
        del file["checks/frames"]
        file.create_dataset("checks/frames", data=rows, maxshape=(None, rows.shape[1]), chunks=(1, rows.shape[1]))
        file["checks/frames"].attrs.update(attributes | {"columns": attributes["columns"][kept]})
    with open_recording(tmp_path) as found:
        assert "part_turn" not in found.frames and found.frames["part"].shape == (1, 1, 0, 2)
    with Recorder(tmp_path, samples=1, frames=1) as run:
        run.frame(frame(0.5))
    with open_recording(tmp_path) as found:
        assert found.frames["time"][:].tolist() == [0.0, 0.5]
