"""Flipped bits and incomplete writes: damage is reported and never read as data, flushed rows are kept."""

import random
from itertools import count
from pathlib import Path

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.paint.video import render_recording
from lab.recording import Recorder, layout, new_recording, open_recording
from lab.recording.checks import Checks
from lab.recording.layout import GROUPS, names_of, rows_of, sizes_of, tables_of
from tests.lab.preset.test_malformed import call, refused
from tests.oracles.recorded_water import POOL, pool
from tests.oracles.synthetic import frame, recorder, sample
from tests.oracles.tampering import flipped, used

ROWS, A_FRAME, GRAINS = 40, 4, 6


def record(folder: Path, rows: int = ROWS, **options: object) -> Recorder:
    """A recorder with that many samples and every fourth time a frame, all numbers by chance."""
    chance = np.random.default_rng(5)
    run = recorder(folder, 2, GRAINS, **options)
    for k in range(rows):
        run.sample({name: chance.random(np.shape(zero)) for name, zero in sample(0.0, 2).items()} | {"time": 0.1 * k})
        if k % A_FRAME == 0:
            row = {name: chance.random(np.shape(zero)) for name, zero in frame(0.0, 2, GRAINS).items()}
            run.frame(row | {"time": 0.1 * k})
    return run


def record_wet(folder: Path) -> None:
    """As `record`, of water and air over it, with gauges."""
    chance, preset, volume = (
        np.random.default_rng(6),
        pool(water={"depth": "0.1 m"}, air={}),
        np.full((1, GRAINS), 4e-4),
    )
    sizes = sizes_of(names_of(preset), np.zeros((1, 0)), volume, volume)
    series, frames = (rows_of(tables_of(preset, steered=False)[name], sizes) for name in ("series", "frames"))
    new_recording(
        folder,
        preset="pool",
        given=POOL,
        resolved=preset,
        radius=np.zeros((1, 0)),
        volume=volume,
        air=volume,
        outline=np.array([(-0.5, 0.0), (0.5, 0.0), (0.5, 0.5), (-0.5, 0.5)]),
        step=1e-4,
    )
    with Recorder(folder) as run:
        for k in range(ROWS):
            run.sample({name: chance.random(shape) for name, (shape, _) in series.items()} | {"time": 0.1 * k})
            if k % A_FRAME == 0:
                run.frame({name: chance.random(shape) for name, (shape, _) in frames.items()} | {"time": 0.1 * k})


@pytest.fixture(scope="module")
def recorded(tmp_path_factory) -> dict[str, Path]:
    """A recording with parts and fixed grains, and one of water and air, in small chunks."""
    home = tmp_path_factory.mktemp("whole")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(layout, "CHUNK_ROWS", 16)
        record(home / "grains", fixed=[[0.0, 0.0, 0.01]], open_edges=[1]).close()
        record_wet(home / "water and air")
    return {folder.name: folder / "recording.h5" for folder in home.iterdir()}


@pytest.fixture(scope="module")
def whole(recorded) -> Path:
    """The one of grains."""
    return recorded["grains"]


def contents(path: Path) -> dict[str, object]:
    """All that a recording gives, as bytes and texts."""
    with open_recording(path) as found:
        tables = {"series": found.series, "frames": found.frames}
        arrays = {f"{name}/{key}": table[key][:].tobytes() for name, table in tables.items() for key in table}
        fixed = "radius", "kind", "volume", "air_volume", "outline", "fixed"
        arrays |= {name: getattr(found, name).tobytes() for name in fixed}
        said = "name", "given", "preset", "status", "created", "versions", "machine", "step", "wall_s", "open_edges"
        return arrays | {name: getattr(found, name) for name in (*said, "grain_steps", "parts", "quantities")}


def damaged(path: Path, folder: Path, bits: list[int]) -> Path:
    """A copy of a file with these bits flipped."""
    content = path.read_bytes()
    for bit in bits:
        content = flipped(content, bit)
    copy = folder / "recording.h5"
    copy.write_bytes(content)
    return copy


def bit_of(path: Path, name: str, row: int) -> int:
    """A bit in the first number of a row of a data set."""
    with h5py.File(path) as file:
        data = file[name]
        chunk = data.id.get_chunk_info(row // data.chunks[0])
        return 8 * (chunk.byte_offset + row % data.chunks[0] * int(np.prod(data.shape[1:])) * data.dtype.itemsize) + 3


@pytest.mark.parametrize(
    ("kind", "times"),
    [("grains", 1), *(pytest.param(kind, 8, marks=pytest.mark.slow) for kind in ("grains", "water and air"))],
)
def test_a_flipped_bit_is_reported_and_never_read(recorded, tmp_path, kind, times):
    """So many times 25 of all bits that hold numbers or texts, and 5 of the rest of the file."""
    whole = recorded[kind]
    expected, chance = contents(whole), random.Random(11)
    places = used(whole).tolist()
    bits = [8 * chance.choice(places) + chance.randrange(8) for _ in range(25 * times)]
    everywhere = [chance.randrange(8 * whole.stat().st_size) for _ in range(5 * times)]
    caught = []
    for bit in bits + everywhere:
        path = damaged(whole, tmp_path, [bit])
        try:
            found = contents(path)
        except LabError as error:
            assert str(path) in str(error) and "\n" not in str(error)
            caught.append(bit)
            if bit in bits:
                assert any(f"{group}/" in str(error) for group in GROUPS)
        else:
            assert found == expected, bit
    assert len(set(bits) & set(caught)) == len(set(bits))


@pytest.mark.parametrize("kind", ["grains", "water and air"])
def test_a_file_that_was_cut_is_refused(recorded, tmp_path, kind):
    content, path, chance = recorded[kind].read_bytes(), tmp_path / "recording.h5", random.Random(3)
    for length in (0, 1, 100, *(chance.randrange(len(content)) for _ in range(20)), len(content) - 1):
        path.write_bytes(content[:length])
        with pytest.raises(LabError, match="cannot be read as a recording"):
            open_recording(tmp_path)


def test_rows_before_the_damage_can_be_read_and_painted(whole, tmp_path):
    path = damaged(whole, tmp_path, [bit_of(whole, "frames/position", 6)])
    said = f"{path}: frames/position is damaged from row 6 of 10 (2.4 s): the rows before can be painted"
    with open_recording(path) as found, open_recording(whole) as before:
        assert found.frames["velocity"][:].tobytes() == before.frames["velocity"][:].tobytes()
        assert found.frames["position"][5].tobytes() == before.frames["position"][5].tobytes()
        for rows in (6, slice(None), slice(4, 8), -4):
            with pytest.raises(LabError) as error:
                found.frames["position"][rows]
            assert said in str(error.value)
    assert said in refused(call("render", path))
    with open_recording(path, sound=True) as found, open_recording(whole) as before:
        assert len(found.frames["position"]) == 6 and found.series.rows == ROWS
        assert found.frames["position"][:].tobytes() == before.frames["position"][:6].tobytes()
    pictures = render_recording(path, tmp_path / "pictures", png=True, width=320, height=180, sound=True)
    assert len(list(pictures.glob("*.png"))) > 1


def test_with_a_damaged_first_row_nothing_can_be_painted(whole, tmp_path):
    path = damaged(whole, tmp_path, [bit_of(whole, "series/pose", 0)])
    said = r"series/pose is damaged from row 0 of 40 \(0 s\): record"
    with open_recording(path) as found, pytest.raises(LabError, match=said):
        found.series["pose"]


def test_a_run_continues_only_if_the_damage_is_after_its_checkpoint(whole, tmp_path):
    path = damaged(whole, tmp_path, [bit_of(whole, "series/pose", 30), bit_of(whole, "frames/spin", 8)])
    with pytest.raises(LabError, match="series/pose is damaged from row 30 of 31, before its checkpoint: start"):
        Recorder(tmp_path, samples=31, frames=8)
    with pytest.raises(LabError, match="frames/spin is damaged from row 8 of 9, before its checkpoint"):
        Recorder(tmp_path, samples=30, frames=9)
    with open_recording(whole) as before, Recorder(tmp_path, samples=30, frames=8) as run:
        for k in range(30, ROWS):
            run.sample({name: values[k] for name, values in before.series.items()})
        for k in range(8, 10):
            run.frame({name: values[k] for name, values in before.frames.items()})
    found, expected = contents(path), contents(whole)
    assert {name for name in expected if found[name] != expected[name]} <= {"status"}


def test_an_incomplete_write_loses_no_flushed_row(tmp_path):
    """Chunks are written again as rows are added: whatever part of that reached the file, the rows before stand."""
    path, chance = tmp_path / "run" / "recording.h5", random.Random(3)
    with record(tmp_path / "run", 20, flush_every=3600.0) as run:
        run.flush()
        early, standing = path.read_bytes(), used(path)
        for k in range(20, 37):
            run.sample(sample(0.1 * k, 2, kinetic=[k, k]))
            run.frame(frame(0.1 * k, 2, GRAINS, angle=np.full((2, GRAINS), k)))
        run.flush()
        late = path.read_bytes()
    path.write_bytes(early)
    with open_recording(path) as before:
        expected = {name: values.tobytes() for name, values in before.series.items()}
        moved = {name: before.frames[name][:].tobytes() for name in before.frames}
    changed = np.flatnonzero(np.frombuffer(early, "u1") != np.frombuffer(late, "u1")[: len(early)])
    rows = changed[changed > standing.min()]
    for _ in range(20):
        torn = np.frombuffer(early, "u1").copy()
        reached = chance.choice(rows.tolist())
        chunk = slice(reached // 4096 * 4096, reached)  # a write that ended there, from the start of its page
        new = np.frombuffer(late, "u1")[chunk].copy()
        keep = ~np.isin(np.arange(chunk.start, chunk.stop), rows)
        new[keep] = torn[chunk][keep]
        torn[chunk] = new
        path.write_bytes(torn.tobytes())
        try:
            with open_recording(path) as found:
                assert found.series.rows >= 20 and found.frames.rows >= 5
                for name, values in expected.items():
                    assert found.series[name][:20].tobytes() == values
                for name, values in moved.items():
                    assert found.frames[name][:5].tobytes() == values
        except LabError as error:  # HDF5's own structures lie there, too
            assert "metadata" in str(error) or "damaged" in str(error)


def test_incomplete_rows_after_the_last_flush_are_ignored(tmp_path):
    path = tmp_path / "recording.h5"
    record(tmp_path).close()
    with h5py.File(path, "r+") as file:
        file["checks/series"].attrs["rows"] = 30
        file["series/elastic"][34, 1] += 1.0
    with open_recording(path) as found:
        assert {len(values) for values in found.series.values()} == {34} and found.frames.rows == 10
    with h5py.File(path, "r+") as file:
        file["checks/series"].attrs["rows"] = 35
    with open_recording(path) as found, pytest.raises(LabError, match="elastic is damaged from row 34 of 40"):
        found.series["elastic"]


def test_a_reader_waits_for_a_writer_that_is_at_these_rows(tmp_path, monkeypatch):
    asked, agree = count(), Checks.agree
    with record(tmp_path) as run:
        run.flush()
        with open_recording(tmp_path) as live:
            monkeypatch.setattr(Checks, "agree", lambda *rows: next(asked) > 2 and agree(*rows))
            assert len(live.series["pose"]) == ROWS and next(asked) == 4
    monkeypatch.setattr(Checks, "agree", lambda *_: next(asked) < 0)
    before = next(asked)
    with open_recording(tmp_path) as closed, pytest.raises(LabError, match="damaged"):
        closed.series["pose"]
    assert next(asked) < before + 100


def test_damaged_arrays_and_texts_are_named(whole, tmp_path):
    for name in ("grains/radius", "preset/resolved", "tank/outline", "grains/kind"):
        path = damaged(whole, tmp_path, [bit_of(whole, name, 0)])
        with pytest.raises(LabError, match=f"{name} is damaged, and without it"):
            open_recording(path)
        assert f"{name} is damaged" in refused(call("resume", tmp_path, "--quiet"))
