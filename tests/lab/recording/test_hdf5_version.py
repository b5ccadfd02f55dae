"""A recording has the format of HDF5 1.10: programs with an older HDF5 than the lab's read and continue it."""

import os
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from lab.base.errors import Unusable
from lab.recording import Recorder, open_recording, superblock
from tests.oracles.synthetic import frame, recorder, sample

LAYOUT, CONTINUATION = 8, 16  # types of messages in an object's header (HDF5 File Format Specification 3.0, IV.A.2)
NEWEST = 4  # version of the layout message in HDF5 1.10 to 1.14
OLDER = os.environ.get("CARGOLAB_OLDER_PYTHON")  # a Python with the lab and an older h5py

CONTINUE = """
import sys
import h5py
from lab.recording import Recorder
from tests.oracles.synthetic import frame, sample
with h5py.File(sys.argv[1] + "/recording.h5") as file:
    names = []
    file.visit(names.append)
    for name in names:
        assert not isinstance(file[name], h5py.Dataset) or file[name][()] is not None
with Recorder(sys.argv[1], samples=3, frames=3) as run:
    for k in range(3, 6):
        run.sample(sample(0.1 * k, 2))
        run.frame(frame(0.1 * k, 2))
"""


@pytest.fixture
def folder(tmp_path) -> Path:
    """A recording that was closed and continued; of 2 beds of 4 grains, 3 rows."""
    radius = 0.001 * np.arange(1.0, 9.0).reshape(2, 4)
    with recorder(tmp_path / "run", 2, 4, radius=radius) as run:
        run.sample(sample(0.0, 2))
        run.frame(frame(0.0, 2))
    with Recorder(tmp_path / "run", samples=1, frames=1) as run:
        for k in range(1, 3):
            run.sample(sample(0.1 * k, 2))
            run.frame(frame(0.1 * k, 2))
    return tmp_path / "run"


def headers(path: Path) -> dict[str, int]:
    """Where in a file the header of each data set begins."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: item}))
        sets = {name: item for name, item in found.items() if isinstance(item, h5py.Dataset)}
        return {name: h5py.h5o.get_info(item.id).addr for name, item in sets.items()}


def messages(content: bytes, place: int) -> dict[int, int]:
    """Where the content of each type of message of an object header of version 2 is (specification, IV.A.1.b)."""
    assert content[place : place + 5] == b"OHDR\x02"
    flags, begin = content[place + 5], place + 6
    begin += (16 if flags & 0x20 else 0) + (4 if flags & 0x10 else 0)
    width = 1 << (flags & 3)
    size = int.from_bytes(content[begin : begin + width], "little")
    found, blocks = {}, [(begin + width, size)]
    head = 6 if flags & 4 else 4
    while blocks:
        at, left = blocks.pop()
        end = at + left
        while end - at >= head:
            kind, length = content[at], int.from_bytes(content[at + 1 : at + 3], "little")
            found[kind] = at + head
            if kind == CONTINUATION:
                address, whole = (int.from_bytes(content[at + k :][:8], "little") for k in (head, head + 8))
                blocks.append((address + 4, whole - 8))  # without its signature and checksum
            at += head + length
    return found


def test_data_sets_have_the_layout_of_hdf5_1_10(folder):
    path = folder / "recording.h5"
    content = path.read_bytes()
    versions = {name: content[messages(content, place)[LAYOUT]] for name, place in headers(path).items()}
    assert {"grains/radius", "preset/given", "tank/outline", "series/pose", "frames/position"} <= set(versions)
    assert max(versions.values()) <= NEWEST


def test_a_newer_format_is_not_taken_for_damage(folder):
    path = folder / "recording.h5"
    content, place = bytearray(path.read_bytes()), headers(path)["grains/radius"]
    layout = messages(content, place)[LAYOUT]
    end = next(k for k in range(layout, len(content)) if is_sealed(content[place:k]))
    content[layout] = 99
    content[place:end] = superblock.sealed(bytes(content[place : end - 4]))
    path.write_bytes(content)
    with pytest.raises(Unusable, match=r"grains/radius .* newer HDF5 .* pip install --upgrade h5py"):
        open_recording(folder)


def is_sealed(block: bytes) -> bool:
    """Whether a block ends with the checksum of what is before it."""
    return superblock.sealed(bytes(block[:-4])) == block


@pytest.mark.skipif(not OLDER, reason="CARGOLAB_OLDER_PYTHON does not name a Python with the lab and an older h5py")
def test_an_older_hdf5_reads_and_continues_a_recording(folder):
    root = Path(__file__).parents[3]
    subprocess.run([OLDER, "-c", CONTINUE, str(folder)], check=True, cwd=root)
    with open_recording(folder) as recording:
        np.testing.assert_allclose(recording.series["time"], 0.1 * np.arange(6))
        assert len(recording.frames["time"][:]) == 6
