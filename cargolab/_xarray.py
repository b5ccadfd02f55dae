"""The engine "cargolab" of xarray: `xarray.open_datatree("…/recording.h5", engine="cargolab")`.

xarray loads this file whenever it lists its engines, so the lab is loaded only where a recording is opened.
"""

import os
from pathlib import Path
from typing import TYPE_CHECKING

from xarray.backends import BackendEntrypoint

if TYPE_CHECKING:
    from collections.abc import Iterable

    import xarray

    from lab.recording import Recording

SIGNATURE = b"\x89HDF\r\n\x1a\n"  # of an HDF5 file, its first bytes
FORMAT = "cargo-shift-lab"  # what the format of a recording begins with
FILE_NAME = "recording.h5"  # in a run's folder


class Engine(BackendEntrypoint):
    """Opens recordings of the lab, a file or the folder of a run, also while the run goes on.

    `group`: the node of the tree that `open_dataset` opens, the series where none is named. `sound`: leave out the rows
    from the first damaged one on.
    """

    description = "Recordings of the Cargo Shift Lab"
    open_dataset_parameters = ("filename_or_obj", "drop_variables", "group", "sound")
    supports_groups = True

    def guess_can_open(self, filename_or_obj: object) -> bool:
        """Whether it is a file that says it is a recording; nothing else of it is read."""
        if not isinstance(filename_or_obj, str | os.PathLike):
            return False
        try:
            import h5py

            path = _file(filename_or_obj)
            with path.open("rb") as file:
                if file.read(len(SIGNATURE)) != SIGNATURE:
                    return False
            with h5py.File(path, "r", locking=False) as file:
                said = file.attrs.get("format", b"")
            return bytes(said if isinstance(said, bytes) else str(said).encode()).startswith(FORMAT.encode())
        except Exception:  # any file may be asked for here, of whatever kind
            return False

    def open_dataset(
        self,
        filename_or_obj: str | os.PathLike,
        *,
        drop_variables: "str | Iterable[str] | None" = None,
        group: str | None = None,
        sound: bool = False,
    ) -> "xarray.Dataset":
        """A node of the tree. Raises cargolab.Error."""
        recording = _opened(filename_or_obj, sound)
        try:
            found = dict(_nodes(recording, drop_variables))
            name = f"/{(group or 'series').strip('/')}"
            if name not in found:
                from lab.base.errors import NotRecorded

                has = ", ".join(one.strip("/") for one in found if one != "/")
                raise NotRecorded(f"{recording.path} has no group {name.strip('/')!r}; it has {has}.")
        except BaseException:
            recording.close()
            raise
        root = found["/"].attrs
        found[name].attrs = root | found[name].attrs
        found[name].set_close(recording.close)
        return found[name]

    def open_groups_as_dict(
        self,
        filename_or_obj: str | os.PathLike,
        *,
        drop_variables: "str | Iterable[str] | None" = None,
        sound: bool = False,
    ) -> "dict[str, xarray.Dataset]":
        """All nodes by their paths. Raises cargolab.Error."""
        recording = _opened(filename_or_obj, sound)
        try:
            found = dict(_nodes(recording, drop_variables))
        except BaseException:
            recording.close()
            raise
        for node in found.values():
            node.set_close(recording.close)
        return found

    def open_datatree(
        self,
        filename_or_obj: str | os.PathLike,
        *,
        drop_variables: "str | Iterable[str] | None" = None,
        sound: bool = False,
    ) -> "xarray.DataTree":
        """The whole tree. Raises cargolab.Error."""
        import xarray

        found = self.open_groups_as_dict(filename_or_obj, drop_variables=drop_variables, sound=sound)
        tree = xarray.DataTree.from_dict(found)
        for path, node in found.items():
            tree[path].set_close(node._close)
        return tree


def _file(path: str | os.PathLike) -> Path:
    path = Path(path)
    return path / FILE_NAME if path.is_dir() else path


def _opened(path: str | os.PathLike, sound: bool) -> "Recording":
    from cargolab import _hidden

    _hidden.check()
    from lab.recording import open_recording

    return open_recording(path, sound=sound)


def _nodes(recording: "Recording", dropped: "str | Iterable[str] | None"):
    from lab.recording.tree.nodes import nodes

    left_out = {dropped} if isinstance(dropped, str) else set(dropped or ())
    for path, found in nodes(recording):
        yield path, found.drop_vars(left_out & set(found.variables))
