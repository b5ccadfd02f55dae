"""The superblock of HDF5 files is read and written as HDF5 does it."""

import h5py

from lab.recording import superblock


def head_of(path) -> bytes:
    return path.read_bytes()[: superblock.SIZE]


def test_superblocks_of_hdf5_are_valid_and_damaged_ones_are_not(tmp_path):
    with h5py.File(tmp_path / "a.h5", "w", libver="latest") as file:
        file["x"] = range(10)
    head = head_of(tmp_path / "a.h5")
    assert superblock.is_sound(head) and not superblock.is_marked(head)
    assert superblock.end(head) == (tmp_path / "a.h5").stat().st_size
    assert not superblock.is_sound(head[:40])
    for place in range(superblock.SIZE):
        assert not superblock.is_sound(head[:place] + bytes([head[place] ^ 4]) + head[place + 1 :])


def test_hdf5_accepts_a_changed_superblock(tmp_path):
    path = tmp_path / "a.h5"
    with h5py.File(path, "w", libver="latest") as file:
        file["x"] = range(10)
        file.flush()
        file.swmr_mode = True
        file.flush()
        marked = head_of(path)
    closed = head_of(path)
    assert superblock.is_sound(marked) and superblock.is_marked(marked) and not superblock.is_marked(closed)
    assert superblock.amended(closed, superblock.WRITING, superblock.end(marked)) == marked
    assert superblock.amended(marked, 0, superblock.end(closed)) == closed
    longer = superblock.amended(closed, 0, superblock.end(closed) + 1000)
    with path.open("r+b") as file:
        file.write(longer)
        file.truncate(superblock.end(longer))
    with h5py.File(path) as file:
        assert list(file["x"]) == list(range(10))
