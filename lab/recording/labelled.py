"""The arrays of a recording as xarray data sets, with named axes, units and labels."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import xarray


def labelled(recording, frames: slice | None = None) -> "xarray.Dataset":
    """The series of a recording, or the given frames, read now (see `Recording.labelled`)."""
    from lab.recording.tree.nodes import table  # with xarray, which loads slowly and few callers need

    return table(recording, "series", slice(None)) if frames is None else table(recording, "frames", frames)
