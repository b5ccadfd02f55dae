"""Recordings from strangers: no other file is read, and no memory is taken that their size does not warrant."""

import json
import resource
import shutil
from functools import partial
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.base.trust import check_state
from lab.preset.find import load
from lab.recording import Outlines, Recorder, new_recording, open_recording
from lab.recording.layout import GROUPS
from lab.runs.checkpoint import Checkpoint, read_checkpoint
from lab.runs.run import prepare
from solvers.grains.shapes.contour import Contour
from tests.lab.preset.test_malformed import SMALL, call, copied, refused
from tests.oracles.recorded_water import DROPS, POOL, pool
from tests.oracles.synthetic import frame, sample


@pytest.fixture(scope="module")
def sound(tmp_path_factory) -> Path:
    """The folder of a run that was cut short, with its checkpoint."""
    folder = tmp_path_factory.mktemp("sound") / "run"
    prepare(load("tilting/quick", SMALL), folder).make_recording()
    with Recorder(folder) as run:
        for k in range(4):
            run.sample(sample(0.01 * k))
            run.frame(frame(0.01 * k, count=3, position=np.full((1, 3, 2), 0.004)))
        run.close("stopped: interrupted by the user")
    Checkpoint({"numbers": np.arange(5), "origin": np.array(0.0)}, (".",), (4, 4), ("Beware.",)).write(folder)
    return folder


def again(file: h5py.File, name: str, **made: object) -> None:
    """Replace a data set of a recording with one made differently from the lab's."""
    old = file[name]
    settings = {"shape": old.shape, "dtype": old.dtype} | made
    del file[name]
    file.create_dataset(name, **settings)


def link_elsewhere(file, name="frames/position"):
    at = Path(file.filename).with_name("other.h5")
    with h5py.File(at, "w") as other:
        other["x"] = np.zeros(file[name].shape, file[name].dtype)
    del file[name]
    file[name] = h5py.ExternalLink(str(at), "x")


def link_group_elsewhere(file):
    at = Path(file.filename).with_name("other.h5")
    with h5py.File(at, "w") as other:
        file.copy("tank", other)
    del file["tank"]
    file["tank"] = h5py.ExternalLink(str(at), "tank")


def preset_elsewhere(file):
    link_elsewhere_any(file, "preset/given")


def link_elsewhere_any(file, name):
    at = Path(file.filename).with_name("other.h5")
    with h5py.File(at, "w") as other:
        file.copy(name, other, "x")
    del file[name]
    file[name] = h5py.ExternalLink(str(at), "x")


def stored_elsewhere(file, name="grains/radius"):
    at = Path(file.filename).with_name("secret.bin")
    at.write_bytes(file[name][()].tobytes())
    again(file, name, external=[(str(at), 0, h5py.h5f.UNLIMITED)])


def virtual(file, name="series/time"):
    at = Path(file.filename).with_name("other.h5")
    with h5py.File(at, "w") as other:
        other["x"] = file[name][()]
    layout = h5py.VirtualLayout(file[name].shape, file[name].dtype)
    layout[:] = h5py.VirtualSource(at, "x", shape=file[name].shape)
    del file[name]
    file.create_virtual_dataset(name, layout)


def vast(name, axis=0, chunks=None, **how):
    def change(file):
        shape = list(file[name].shape)
        shape[axis] = 10**12
        again(file, name, shape=tuple(shape), chunks=chunks and tuple(max(1, n) for n in (chunks, *shape[1:])), **how)

    return change


def whole_series_vast(file):
    for name in list(file["series"]):
        vast(f"series/{name}", chunks=1)(file)


def whole_frames_vast(file):
    for name in list(file["frames"]):
        vast(f"frames/{name}", chunks=None if name in ("part", "part_turn") else 1)(file)


def squeezed(file, length=5_000_000):
    """Zeros that a filter has made small: a GB of rows in some MB."""
    del file["series/time"]
    file.create_dataset("series/time", (length,), "f8", chunks=(2**20,), compression="gzip", fillvalue=0.0)
    file["series/time"][:] = 0.0
    for name in set(file["series"]) - {"time"}:
        shape = (length, *file[f"series/{name}"].shape[1:])
        again(file, f"series/{name}", shape=shape, chunks=(2**14, *shape[1:]), compression="gzip")


def vast_chunks(file):
    """Pieces of 3 GB, each of which a reader or a copy makes room for."""
    for name in list(file["series"]):
        shape = file[f"series/{name}"].shape
        rest = int(np.prod(shape[1:], dtype=int)) * 8
        again(file, f"series/{name}", maxshape=(None, *shape[1:]), chunks=(3 * 2**30 // rest, *shape[1:]))


def same_again_and_again(file):
    """Parts that are one and the same line of 8 MB."""
    file["tank/parts/p0"] = np.zeros((500_000, 2))
    for k in range(1, 900):
        file[f"tank/parts/p{k}"] = file["tank/parts/p0"]


def text_again_and_again(file):
    """References to one text instead of numbers."""
    again(file, "tank/open_edges", shape=(200_000,), dtype=h5py.string_dtype())
    file["tank/open_edges"][:1] = "x" * 60_000


def words_for_numbers(file):
    again(file, "grains/radius", dtype=h5py.string_dtype())


def arrays_for_numbers(file):
    again(file, "grains/radius", dtype=np.dtype(("f8", (10**7,))))


def attribute_of_many(file):
    file.attrs["versions"] = np.array(["{}"] * 1000, dtype=h5py.string_dtype())


def long_text(file):
    del file["preset/resolved"]
    file["preset/resolved"] = "[" * 35_000_000


def deep_text(file):
    del file["preset/resolved"]
    file["preset/resolved"] = "[" * 200_000 + "]" * 200_000


def cyclic(file):
    file["tank/parts/gate"] = file["tank"]


def soft(file):
    file.move("grains", "elsewhere")
    file["grains"] = h5py.SoftLink("/elsewhere")


MISCHIEF = {
    "frames-link": link_elsewhere,
    "series-link": lambda file: link_elsewhere(file, "series/pose"),
    "group-link": link_group_elsewhere,
    "preset-link": preset_elsewhere,
    "stored-elsewhere": stored_elsewhere,
    "outline-stored-elsewhere": lambda file: stored_elsewhere(file, "tank/outline"),
    "virtual": virtual,
    "virtual-radius": lambda file: virtual(file, "grains/radius"),
    "vast-radius": vast("grains/radius"),
    "vast-radius-chunked": vast("grains/radius", chunks=1),
    "vast-worlds-gzip": vast("grains/radius", chunks=1, compression="gzip"),
    "vast-kind": vast("grains/kind", chunks=1),
    "vast-outline": vast("tank/outline", chunks=1),
    "vast-fixed": vast("tank/fixed", chunks=1),
    "vast-edges": vast("tank/open_edges", chunks=1),
    "vast-series": whole_series_vast,
    "vast-frames": whole_frames_vast,
    "squeezed": squeezed,
    "vast-chunks": vast_chunks,
    "hard-links": same_again_and_again,
    "text-references": text_again_and_again,
    "words": words_for_numbers,
    "arrays": arrays_for_numbers,
    "attributes": attribute_of_many,
    "long-json": long_text,
    "deep-json": deep_text,
    "cycle": cyclic,
    "soft-link": soft,
}


@pytest.fixture
def little_memory():
    """3 GB more than there is now: what takes more fails, and Taichi can start."""
    used = int(Path("/proc/self/statm").read_text().split()[0]) * resource.getpagesize()
    before = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (used + 3 * 2**30, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_AS, before)


@pytest.mark.parametrize("name", MISCHIEF)
def test_a_manipulated_recording_is_refused(sound, tmp_path, name, little_memory):
    folder = copied(sound, tmp_path / "run")
    with h5py.File(folder / "recording.h5", "r+") as file:
        MISCHIEF[name](file)
    assert "recording.h5" in refused(call("render", folder))


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> Path:
    """The folder of a recording with all groups that the lab writes: of each matter, of parts, shapes and steering."""
    wet = {"water": {"depth": "0.1 m"}, "air": {}}
    preset, folder = pool(**wet), tmp_path_factory.mktemp("whole") / "run"
    volume, contour = np.full((1, DROPS), 4e-4), Contour(1.0, np.array([0.1, 0.05]), np.zeros(2))
    new_recording(
        folder,
        preset="all",
        given=POOL,
        resolved=preset,
        radius=np.full((1, 3), 1e-3),
        volume=volume,
        air=volume,
        bulk=volume,
        parts={"gate": np.array([(0.0, 0.0), (0.0, 0.2)])},
        shapes=Outlines((contour,), np.zeros(1), np.zeros((1, 3))),
        outline=np.array([(-0.5, 0.0), (0.5, 0.0), (0.5, 0.5), (-0.5, 0.5)]),
        step=1e-4,
        steered=True,
    )
    return folder


def data_sets(folder: Path) -> list[str]:
    found = []
    with h5py.File(folder / "recording.h5", "r") as file:
        file.visititems(lambda name, item: found.append(name) if isinstance(item, h5py.Dataset) else None)
    return found


def test_all_that_the_lab_writes_is_checked_before_it_is_read(whole, tmp_path):
    """Each data set of each group as a link to another file, and as one of a size that its file cannot have."""
    paths = data_sets(whole)
    assert {path.partition("/")[0] for path in paths} == set(GROUPS)
    for path in paths:
        vastly = [vast(path)] * (not path.startswith("preset/"))  # these are one text
        for change in (partial(link_elsewhere_any, name=path), *vastly):
            folder = copied(whole, tmp_path / "run")
            with h5py.File(folder / "recording.h5", "r+") as file:
                change(file)
            with pytest.raises(LabError, match=r"is a link, possibly to another file|declares .* GB, far more"):
                open_recording(folder)
            shutil.rmtree(folder)


def test_nothing_of_another_file_is_copied(sound, tmp_path):
    folder = copied(sound, tmp_path / "run")
    with h5py.File(folder / "recording.h5", "r+") as file:
        stored_elsewhere(file, "tank/outline")
    refused(call("resume", folder, "--quiet"))
    assert not list(folder.glob("*.part*"))


def test_an_array_larger_than_half_the_memory_is_not_read(sound, monkeypatch):
    monkeypatch.setattr("lab.base.trust.machine_memory", lambda: 100)
    with open_recording(sound) as recording:
        assert recording.frames["angle"][0].shape == (1, 3)
        with pytest.raises(LabError, match=r"frames/position has .*GB, too much for this machine's memory"):
            recording.frames["position"][:]


# ---- checkpoints


def bomb(path, shape=(10**12,), kind="<f8"):
    """A checkpoint with an array that is said to be larger than it is."""
    with np.load(path) as file:
        arrays = dict(file)
    head = BytesIO()
    np.lib.format.write_array_header_1_0(head, {"descr": kind, "fortran_order": False, "shape": shape})
    np.savez(path, **arrays)
    with ZipFile(path, "a") as archive:
        archive.writestr("state/bomb.npy", head.getvalue())


def squeezed_archive(path):
    with np.load(path) as file:
        arrays = dict(file)
    np.savez_compressed(path, **arrays, **{"state/zeros": np.zeros(10**7)})


def pickled(path):
    with np.load(path) as file:
        arrays = dict(file)
    np.savez(path, **arrays, **{"state/object": np.array([{}], dtype=object)})


def changed(**said):
    def change(path):
        with np.load(path) as file:
            arrays = dict(file)
        about = json.loads(str(arrays.pop("about"))) | said
        np.savez(path, about=np.array(json.dumps(about)), **arrays)

    return change


CHECKPOINTS = {
    "vast": bomb,
    "squeezed": squeezed_archive,
    "pickled": pickled,
    "negative": lambda path: bomb(path, (-3,)),
    "runs-outside": changed(runs=["../../outside"]),
    "runs-absolute": changed(runs=["/etc"]),
    "runs-none": changed(runs=[]),
    "runs-text": changed(runs="abc"),
    "runs-numbers": changed(runs=[1]),
    "rows-texts": changed(rows=["a", "b"]),
    "rows-negative": changed(rows=[-4, -4]),
    "rows-halves": changed(rows=[0.5, 0.5]),
    "warnings-tables": changed(warnings=[{}]),
    "notes-number": changed(notes=7),
}


@pytest.mark.parametrize("name", CHECKPOINTS)
def test_a_manipulated_checkpoint_is_refused(sound, tmp_path, name, little_memory):
    folder = copied(sound, tmp_path / "run")
    CHECKPOINTS[name](folder / "checkpoint.npz")
    refused(call("resume", folder, "--quiet"))
    with pytest.raises(LabError):
        read_checkpoint(folder)


STATES = {
    "room": ("numbers", [0, 10**7, 0, 0, 1, 0]),
    "room-odd": ("numbers", [0, 3, 0, 0, 1, 0]),
    "steps": ("numbers", [-1, 1, 0, 0, 1, 0]),
    "few": ("numbers", [0]),
    "halves": ("numbers", [0.5, 1.0, 0.0, 0.0, 1.0, 0.0]),
    "grains": ("number", [[10**9, 1, 2]]),
    "same-grains": ("number", [[0, 0, 0]]),
    "other-grains": ("number", [[0, 1, 2, 3]]),
}


@pytest.mark.parametrize("name", STATES)
def test_a_state_of_other_grains_is_refused(name):
    key, values = STATES[name]
    state = {"numbers": np.array([0, 1, 0, 0, 1, 0]), "number": np.array([[2, 0, 1]])}
    check_state(state, 1, 3)
    check_state(state | {"numbers": np.array([0, 1, -500, 0, 1, 0])}, 1, 3)  # as after settling
    with pytest.raises((ValueError, IndexError)):
        check_state(state | {key: np.array(values)}, 1, 3)
