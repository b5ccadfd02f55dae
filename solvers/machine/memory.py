"""Direct access to fields in the processor's memory.

Taichi compiles one kernel for each field that is read, one for each that is written and one for each that is filled: a
third of the set-up time of a simulation. Here one kernel gets the address of the first field, and Taichi knows the
offsets of the others.
"""

import ctypes
from collections.abc import Sequence
from functools import partial

import numpy as np
import taichi as ti

KINDS = {ti.i32: np.int32, ti.f32: np.float32, ti.f64: np.float64}
OPENED = ("to_numpy", "from_numpy", "fill")


def lay_open(fields: Sequence[ti.Field], across: Sequence[bool], nested: Sequence[bool]) -> None:
    """Read and write the dense fields of one tree on the processor directly from now on.

    `across` marks fields whose first index is contiguous, `nested` those declared axis by axis. Fields must be closed
    before their memory is freed.
    """
    levels = [2 if inner else 1 for inner in nested]
    nodes = [field.parent(level) for field, level in zip(fields, levels, strict=True)]
    offsets = [node._offset_bytes_in_parent_cell for node in nodes]
    start = First(fields[0]).address() - offsets[0]
    for field, crossed, offset in zip(fields, across, offsets, strict=True):
        view = _view(field, start + offset, crossed)
        field.to_numpy, field.from_numpy, field.fill = view.copy, partial(_put, view), view.fill


def close(fields: Sequence[ti.Field]) -> None:
    """Let Taichi read and write the fields again; unlike a direct view, it knows when they have been freed."""
    for field in fields:
        for name in OPENED:
            vars(field).pop(name, None)


@ti.data_oriented
class First:
    """A field and a kernel that returns the address of its first element."""

    def __init__(self, field: ti.Field):
        self.field = field.get_scalar_field(0) if _size(field) else field
        self.origin = [0] * len(field.shape)

    @ti.kernel
    def address(self) -> ti.u64:
        """Address of the first element."""
        return ti.get_addr(self.field, self.origin)


def _size(field: ti.Field) -> tuple[int, ...]:
    """Shape of one element: (n,) for a field of n-vectors, () for a scalar field."""
    return (field.n,) if hasattr(field, "n") else ()


def _view(field: ti.Field, address: int, across: bool) -> np.ndarray:
    """The memory of a field as an array of its shape, with a last axis for the components of vectors."""
    kind, shape = np.dtype(KINDS[field.dtype]), (*field.shape[:: -1 if across else 1], *_size(field))
    memory = (ctypes.c_char * (int(np.prod(shape)) * kind.itemsize)).from_address(address)
    whole = np.frombuffer(memory, kind).reshape(shape)
    return whole.swapaxes(0, 1) if across else whole


def _put(view: np.ndarray, values: np.ndarray) -> None:
    if values.shape != view.shape:
        raise ValueError(f"{values.shape} does not fit into a field of {view.shape}")
    view[:] = values
