"""Checks of files from unknown sources, made before memory is allocated or another file is opened.

HDF5 can link to other files, store or assemble data sets from parts of them, and declare data sets of any size in a few
bytes; numpy's archives can also declare more than they hold. The lab writes none of that, so all of it is refused. Bugs
in HDF5 itself are not covered: use a recent version.
"""

import os
from collections.abc import Collection, Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from zipfile import ZIP_STORED, ZipFile, ZipInfo

import h5py
import numpy as np

from lab.base.errors import Unusable
from lab.base.memory import SHARE, machine_memory

ATTRIBUTES = ("format", "preset", "status", "created", "versions", "machine", "step", "wall_s", "grain_steps")
BEYOND = 1e15  # larger than any SI number in a recording
MOST_MEMBERS = 1000  # of a group
UNWRITTEN = 2**26  # bytes that data sets may have beyond what the file holds: rows that a killed run did not write
MOST_ROOM = 1024  # largest number of contacts per grain, many times that of a grain in a bed at rest
LARGEST_CHUNK = 2**26  # bytes
LONGEST_ATTRIBUTE = 2**20  # bytes
LONGEST_TEXT = 2**25  # characters: a preset with 100 000 listed grains has some 12 million
SAME_SIZE = (h5py.h5z.FILTER_SHUFFLE, h5py.h5z.FILTER_FLETCHER32)  # filters that do not compress


def check_recording(file: h5py.File, groups: Collection[str], deeper: Collection[str]) -> dict[str, h5py.Dataset]:
    """The data sets in some groups of an HDF5 file, and in groups `deeper` in these, by path; no others may be read.

    Raises Unusable if they refer to other files, or declare more data than the file's size allows.
    """
    for name in ATTRIBUTES:
        if name in file.attrs:
            _check_attribute(file, name)
    known = sorted(set(groups) & set(file))
    found = {path: data for name in known for path, data in _data_sets(file, name, deeper)}
    total = sum(_checked_bytes(file, data) for data in found.values())
    if total > os.stat(file.filename).st_size + UNWRITTEN:
        raise Unusable(f"{file.filename} declares {_size(total)}, far more than it holds: do not use this file.")
    return found


def format_of(file: h5py.File) -> str:
    """The `format` attribute of a file. Raises Unusable as `check_recording`."""
    if "format" in file.attrs:
        _check_attribute(file, "format")
    return str(_decoded(file.attrs.get("format")))


def attributes(file: h5py.File) -> dict[str, object]:
    """The attributes of a recording by name, ignoring all others in the file; texts are decoded."""
    found = {name: file.attrs[name] for name in ATTRIBUTES if name in file.attrs}
    return {name: _decoded(value) for name, value in found.items()}


def attribute_words(data: h5py.Dataset, name: str) -> list[str]:
    """The text, or the texts, of an attribute of a data set. Raises KeyError, Unusable or ValueError."""
    held = data.attrs.get_id(name)
    if len(held.shape) > 1 or held.dtype.kind != "S" or _bytes(held.shape, held.dtype) > LONGEST_ATTRIBUTE:
        raise Unusable(
            f"{data.file.filename}: the attribute {name} of {data.name[1:]} is not a text: do not use this file."
        )
    words = np.empty(held.shape, held.dtype)
    if words.size:
        held.read(words)
    return [_decoded(word) for word in np.atleast_1d(words).tolist()]


def text(data: h5py.Dataset) -> str:
    """A data set with a single text. Raises Unusable if it is longer than any preset."""
    if h5py.check_string_dtype(data.dtype) is None:
        raise ValueError(f"{data.name[1:]} is not a text")
    found = _decoded(data[()] if data.shape == () else data[0])
    if len(found) > LONGEST_TEXT:
        raise Unusable(f"{data.file.filename}: {data.name[1:]} is longer than any preset: do not use this file.")
    return found


def check_room(data: h5py.Dataset, rows: int) -> None:
    """Raise Unusable if `rows` rows of a data set do not fit into this machine's memory."""
    needed = rows * _bytes(data.shape[1:], data.dtype)
    if needed > SHARE * machine_memory():
        where = f"{data.file.filename}: {data.name[1:]}"
        raise Unusable(f"{where} has {_size(needed)}, too much for this machine's memory: read it on a larger one.")


def check_archive(path: Path) -> None:
    """Raise Unusable if an archive of arrays, as `numpy.savez` writes it, is smaller than the arrays it declares."""
    with ZipFile(path) as archive:
        members = archive.infolist()
        sound = len(members) <= MOST_MEMBERS and all(member.compress_type == ZIP_STORED for member in members)
        held = sum(member.file_size for member in members)
        if not sound or held > path.stat().st_size or not all(_is_whole(archive, member) for member in members):
            raise Unusable(f"{path} declares more than it holds: start the run again.")


def check_progress(runs: object, rows: Sequence, messages: Sequence) -> None:
    """Raise ValueError unless a checkpoint's runs are below its folder, its rows are counts and its messages texts."""
    named = isinstance(runs, list) and runs and all(isinstance(run, str) for run in runs)
    if not named or any(PurePosixPath(run).is_absolute() or ".." in PurePosixPath(run).parts for run in runs):
        raise ValueError("its runs are not in its folder")
    if not all(isinstance(count, int) and count >= 0 for count in rows):
        raise ValueError("its numbers of rows are invalid")
    if not all(isinstance(texts, list) and all(isinstance(text, str) for text in texts) for texts in messages):
        raise ValueError("its warnings or notes are not texts")


def finite(array: np.ndarray, axes: int, columns: int | None = None) -> bool:
    """Whether an array has finite numbers and this many axes, the last one with `columns` entries."""
    fits = array.ndim == axes and columns in (None, array.shape[-1]) and array.dtype.kind in "fiu"
    return bool(fits and (np.abs(array) < BEYOND).all())


def of_texts(table: object) -> bool:
    """Whether something is a table of texts, or an empty one."""
    return isinstance(table, dict) and all(isinstance(text, str) for text in table.values())


def wide(outline: np.ndarray) -> bool:
    """Whether an outline has an extent along both axes."""
    return bool((np.ptp(outline, axis=0) > 0.0).all())


def check_state(state: Mapping[str, np.ndarray], worlds: int, count: int) -> None:
    """Raise ValueError if the state of worlds of `count` grains asks for too much memory or refers to other grains.

    The simulation itself refuses invalid indices in its contact lists (`State.write`).
    """
    from solvers.time.kept import numbers_in  # loads Taichi, which a recording does not need

    numbers = numbers_in(state)
    room = numbers["room"]
    counts = [number for name, number in numbers.items() if name != "unkicked"]  # that is negative after settling
    if min(counts) < 0 or not 1 <= room <= MOST_ROOM or room & (room - 1):
        raise ValueError("its numbers are invalid")
    order = state["number"] if count else np.zeros((worlds, 0))
    if order.shape != (worlds, count) or not np.array_equal(np.sort(order), np.tile(np.arange(count), (worlds, 1))):
        raise ValueError("its grains are not those of the scene")


def _is_whole(archive: ZipFile, member: ZipInfo) -> bool:
    """Whether an array of an archive has as many bytes as its header says."""
    with archive.open(member) as file:
        np.lib.format.read_magic(file)
        shape, _, kind = np.lib.format.read_array_header_1_0(file)
        return not kind.hasobject and min(shape, default=0) >= 0 and _bytes(shape, kind) <= member.file_size


def _data_sets(file: h5py.File, name: str, deeper: Collection[str]) -> Iterator[tuple[str, h5py.Dataset]]:
    """The data sets of a group with their paths. Raises Unusable for links and for groups that are not `deeper`."""
    for path, item in _members(file, name):
        if path in deeper and isinstance(item, h5py.Group):
            yield from _data_sets(file, path, ())
        elif isinstance(item, h5py.Dataset):
            yield path, item
        else:
            raise Unusable(f"{file.filename}: {path} is not a data set: do not use this file.")


def _members(file: h5py.File, name: str) -> Iterator[tuple[str, h5py.Group | h5py.Dataset]]:
    group = _linked(file, name)
    if not isinstance(group, h5py.Group) or len(group) > MOST_MEMBERS:
        raise Unusable(f"{file.filename}: {name} is not a group of a recording: do not use this file.")
    for key in group:
        yield f"{name}/{key}", _linked(file, f"{name}/{key}")


def _linked(file: h5py.File, name: str) -> h5py.Group | h5py.Dataset:
    """The group or data set of that name in this file. Raises Unusable if it is a link or damaged."""
    try:
        if isinstance(file.get(name, getlink=True), h5py.HardLink):
            return file[name]
    except (OSError, RuntimeError, KeyError) as error:
        if "bad version number" in str(error):  # not damage: headers have checksums
            known = f"it was written by a newer HDF5 than the {h5py.version.hdf5_version} here"
            raise Unusable(f"{file.filename}: {name} cannot be read, {known}: pip install --upgrade h5py.") from error
        raise Unusable(f"{file.filename}: {name} is damaged: record the run again.") from error
    raise Unusable(f"{file.filename}: {name} is a link, possibly to another file: do not use this file.")


def _checked_bytes(file: h5py.File, data: h5py.Dataset) -> int:
    """Size of a data set in bytes. Raises Unusable unless it is plain numbers or one text, stored in this file."""
    where, settings = f"{file.filename}: {data.name[1:]}", data.id.get_create_plist()
    if data.is_virtual or data.external:
        raise Unusable(f"{where} is stored in another file: do not use this file.")
    filters = {settings.get_filter(k)[0] for k in range(settings.get_nfilters())}
    if not filters <= set(SAME_SIZE):
        raise Unusable(f"{where} is compressed, unlike the lab's own files: unpack it with h5repack -f NONE.")
    is_text = data.shape in ((), (1,)) and h5py.check_string_dtype(data.dtype) is not None
    if not is_text and data.dtype.kind not in "fiuS":
        raise Unusable(f"{where} has values of another type than the lab writes: do not use this file.")
    chunk = _bytes(data.chunks, data.dtype) if data.chunks else 0
    if chunk > max(LARGEST_CHUNK, _bytes(data.shape[1:], data.dtype)):
        raise Unusable(f"{where} has chunks of {_size(chunk)}, larger than the lab writes: do not use this file.")
    return _bytes(data.shape or (), data.dtype)


def _check_attribute(file: h5py.File, name: str) -> None:
    found = file.attrs.get_id(name)
    if found.shape != () or found.get_storage_size() > LONGEST_ATTRIBUTE:
        raise Unusable(f"{file.filename}: its attribute {name} is not one value: do not use this file.")


def _bytes(shape: tuple[int, ...], kind: np.dtype) -> int:
    """Size of an array in bytes, in Python integers, which do not overflow."""
    size = kind.itemsize
    for length in shape:
        size *= int(length)
    return size


def _decoded(value: object) -> object:
    """Bytes decoded as a text, without an incomplete last character; any other value as it is."""
    return value.decode(errors="ignore") if isinstance(value, bytes) else value


def _size(count: int) -> str:
    return f"{count / 1e9:.3g} GB"
