"""State: arrays by name, each with named axes, in one Taichi field tree.

Each owner declares its arrays under its own name:

    own = arrays.under("clock")
    self.step, self.status = own.integers((Axis("world", worlds),), "step", "status")

makes the arrays "clock.step" and "clock.status". Checkpoints, resume, growing, reordering and leaving a world out use
these names and axes. Four axis names have a general meaning: along "world", "unit" and "block" the worlds are
consecutive, and entries along "grain" follow the grains when they are renumbered.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.machine import memory, runtime
from solvers.machine.wide import Lanes

OF_WORLDS = ("world", "unit", "block")


@dataclass(frozen=True)
class Axis:
    """An axis of an array: a word for what its entries are, and their number."""

    name: str
    length: int


Axes = tuple[Axis, ...]


def world_axis(axes: Axes) -> int | None:
    """Number of the axis along which the worlds are consecutive; None for an array common to all worlds."""
    return next((k for k, axis in enumerate(axes) if axis.name in OF_WORLDS), None)


def of_world(values: np.ndarray, axes: Axes, worlds: int, w: int) -> np.ndarray:
    """The part of world w in an array, as a view; the whole array if it is common to all worlds."""
    along = world_axis(axes)
    return values if along is None else np.split(values, worlds, axis=along)[w]


def without_worlds(values: np.ndarray, axes: Axes, worlds: int, out: slice) -> np.ndarray:
    """An array of `worlds` worlds without some of them; the whole array if it is common to all worlds."""
    along = world_axis(axes)
    if along is None:
        return values
    size = values.shape[along] // worlds
    return np.delete(values, slice(out.start * size, out.stop * size), axis=along)


@dataclass(frozen=True)
class Array:
    """A declared field; the last axis of a vector field is that of the components.

    across: the first axis is contiguous. kept: the field is part of a simulation's saved state. base (length of the
    first axis,): `read` subtracts it and `write` adds it. below: the entries are indices less than this. blocks: the
    last axis is declared to Taichi by itself.
    """

    field: ti.Field
    axes: Axes
    across: bool = False
    kept: bool = True
    base: np.ndarray | None = None
    below: int | None = None
    blocks: bool = False

    @property
    def shape(self) -> tuple[int, ...]:
        """Lengths of the axes."""
        return tuple(axis.length for axis in self.axes)

    @property
    def offset(self) -> np.ndarray | int:
        """The base, in the shape in which `read` subtracts it."""
        return 0 if self.base is None else self.base.astype(np.int32).reshape(-1, *[1] * (len(self.shape) - 1))


def roomy(wanted: int, usual: int) -> int:
    """Length of an axis with room for `wanted` entries: the `usual` length, or the least power of two that is enough.

    Kernels are compiled for the shapes of arrays: scenes whose arrays have the same few lengths share them.
    """
    return max(usual, 1 << max(0, wanted - 1).bit_length())


def padded(values: np.ndarray, length: int) -> np.ndarray:
    """Values with zeros after them along the first axis, `length` in all."""
    return np.concatenate([values, np.zeros((length - len(values), *values.shape[1:]), values.dtype)])


class Scope:
    """Declares arrays of a state whose names begin with that of their owner."""

    def __init__(self, state: "State", owner: str):
        self._state, self._owner = state, owner
        self.place, self.real, self.exact = state.place, state.real, state.exact

    def under(self, owner: str) -> "Scope":
        """The scope in which an owner declares its arrays."""
        return Scope(self._state, f"{self._owner}{owner}.")

    def reals(self, axes: Axes, *names: str, kind=None, kept: bool = True) -> list[ti.Field]:
        """Fields of floats, of type `real` or of another `kind` such as `self.place`."""
        return [self._declare(name, Array(ti.field(kind or self.real), axes, kept=kept)) for name in self._free(names)]

    def integers(
        self, axes: Axes, *names: str, across: bool = False, kept: bool = True, below: int | None = None, base=None
    ) -> list[ti.Field]:
        """Fields of 32-bit integers; indices into other arrays are `below`, and saved from their row's `base` on."""
        return [
            self._declare(name, Array(ti.field(ti.i32), axes, across, kept, base, below)) for name in self._free(names)
        ]

    def vectors(
        self, axes: Axes, *names: str, across: bool = False, kept: bool = True, wide: bool = False
    ) -> list[ti.Field | Lanes]:
        """Fields of vectors of reals, with the components along the last axis; `wide`: for kernels on real vectors."""
        if wide:
            return [Lanes(field) for field in self.wide(axes, *names, kept=kept)]
        size = axes[-1].length
        return [
            self._declare(name, Array(ti.Vector.field(size, self.real), axes, across, kept))
            for name in self._free(names)
        ]

    def wide(self, axes: Axes, *names: str, kind=None, kept: bool = True) -> list[ti.Field]:
        """Fields (…, lanes) of floats stored block by block, for kernels on real vectors (`machine.wide`)."""
        return [
            self._declare(name, Array(ti.field(kind or self.real), axes, kept=kept, blocks=True))
            for name in self._free(names)
        ]

    def integer_vectors(
        self, axes: Axes, *names: str, across=False, base: np.ndarray | None = None, below=None, wide=False
    ) -> list[ti.Field | Lanes]:
        """Fields of vectors of 32-bit integers; `read` and `write` count from `base`, one number per row."""
        found = []
        for name in self._free(names):
            field = ti.field(ti.i32) if wide else ti.Vector.field(axes[-1].length, ti.i32)
            found.append(self._declare(name, Array(field, axes, across and not wide, True, base, below, wide)))
        return [Lanes(field) for field in found] if wide else found

    def holding(self, name: str, values: np.ndarray, axes: str = "", kind=None, kept: bool = False) -> ti.Field:
        """A field with these initial values, of type `real` or of another `kind`; `axes` are the axes' names."""
        lengths = zip(axes.split(), values.shape, strict=True)
        whole = tuple(Axis(*axis) for axis in lengths)
        [name] = self._free([name])
        field = self._declare(name, Array(ti.field(kind or self.real), whole, kept=kept))
        self._state.hold(field, values)
        return field

    def _free(self, names: Iterable[str]) -> Iterator[str]:
        """Yield each name before its array is made; raises ValueError if it is taken."""
        for name in names:
            if f"{self._owner}{name}" in self._state.arrays:
                raise ValueError(f"two arrays are named {self._owner}{name}")
            yield name

    def _declare(self, name: str, array: Array) -> ti.Field:
        self._state.declare(f"{self._owner}{name}", array)
        return array.field


class State(Scope):
    """Fields of one simulation by their names, in one Taichi field tree.

    It is one tree because a kernel reloads a pointer in its inner loops for each tree that it touches (three times
    slower with a tree for each field), and because Taichi holds at most 512 trees and frees none by itself. Fields lie
    in memory in the order of their declaration; `finish` then makes and fills them, before another state is begun. The
    last index is contiguous, or the first with `across`. `kept` arrays make up the state of a simulation; the rest is
    scratch or given by the scene.
    """

    def __init__(self, precision: str = "f64"):
        kinds = runtime.PRECISIONS[precision]
        self.place, self.real = kinds.place, kinds.real
        # Sums and times have 64 bits whatever the grains have, if the device supports it.
        self.exact = ti.f32 if runtime.running_arch() == "vulkan" else ti.f64
        self.arrays: dict[str, Array] = {}
        self._builder = ti.FieldsBuilder()
        self._contents: list[tuple[ti.Field, np.ndarray]] = []
        self._tree = None
        super().__init__(self, "")

    @property
    def fields(self) -> list[ti.Field]:
        """The fields in the order of their declaration."""
        return [array.field for array in self.arrays.values()]

    def declare(self, name: str, array: Array) -> None:
        """Add a field to the tree, under a name."""
        within = array.axes[:-1] if hasattr(array.field, "n") else array.axes
        shape = tuple(axis.length for axis in within)
        if array.across:
            self._builder.dense(ti.j, shape[1]).dense(ti.i, shape[0]).place(array.field)
        elif array.blocks:
            first, last = ((ti.i, ti.j), (ti.ij, ti.k))[len(shape) - 2]
            self._builder.dense(first, shape[:-1]).dense(last, shape[-1]).place(array.field)
        else:
            self._builder.dense((ti.i, ti.ij, ti.ijk)[len(shape) - 1], shape).place(array.field)
        self.arrays[name] = array

    def hold(self, field: ti.Field, values: np.ndarray) -> None:
        """Set the initial values of a declared field."""
        self._contents.append((field, np.ascontiguousarray(values, dtype=np.float64)))

    def finish(self) -> None:
        """Allocate the declared fields: zero, or with the values given to `holding`."""
        self._tree = self._builder.finalize()
        runtime.take_in(self)
        if runtime.running_arch() == "cpu":
            layouts = [(array.across, array.across or array.blocks) for array in self.arrays.values()]
            memory.lay_open(self.fields, *zip(*layouts, strict=True))
        for field, values in self._contents:
            field.from_numpy(values.astype(memory.KINDS[field.dtype]))
        self._contents = []

    @property
    def bytes(self) -> int:
        """Memory of the declared fields, bytes."""
        sizes = (np.dtype(memory.KINDS[array.field.dtype]).itemsize for array in self.arrays.values())
        return sum(int(np.prod(array.shape)) * size for array, size in zip(self.arrays.values(), sizes, strict=True))

    def axes(self) -> dict[str, Axes]:
        """The axes of the arrays that `read` returns."""
        return {name: array.axes for name, array in self._kept()}

    def read(self) -> dict[str, np.ndarray]:
        """Contents of the kept arrays by name, without scratch arrays and constants."""
        return {name: array.field.to_numpy() - array.offset for name, array in self._kept()}

    def write(self, contents: Mapping[str, np.ndarray]) -> None:
        """Restore what `read` returned from the same declarations. Raises KeyError for a missing array.

        Every index must lie in the array that it points into, since a kernel would access other memory otherwise. An
        index vector, or a field with a base, may hold invalid entries that are not in use, in a world that was read
        under another number: these are set to zero. An invalid index in another field raises ValueError, as a wrong
        shape does, before anything is written.
        """
        for last in (False, True):  # twice, so that they do not all stand in memory once more
            for name, array in self._kept():
                checked = self._checked(name, array, contents[name])
                if last:
                    array.field.from_numpy(checked)

    @staticmethod
    def _checked(name: str, array: Array, values: np.ndarray) -> np.ndarray:
        if values.shape != array.shape:
            raise ValueError(f"array {name} has the shape {values.shape} and not {array.shape}")
        places, below = np.ascontiguousarray(values + array.offset), array.below
        if below is None or not places.size or 0 <= places.min() <= places.max() < below:
            return places
        if not hasattr(array.field, "n") and not array.blocks and array.base is None:
            raise ValueError(f"array {name} has numbers that are no places")
        return np.where((places >= 0) & (places < below), places, 0).astype(places.dtype)

    def take_over(self, smaller: "State") -> None:
        """Copy the contents of the same arrays in another state; along an axis that has grown the rest is kept.

        Raises ValueError if the names of arrays or axes differ.
        """
        for (name, array), (old_name, old) in zip(self.arrays.items(), smaller.arrays.items(), strict=True):
            if name != old_name or [axis.name for axis in array.axes] != [axis.name for axis in old.axes]:
                raise ValueError(f"array {name} does not take over from {old_name}")
            held = old.field.to_numpy()
            if array.axes != old.axes:
                held, part = array.field.to_numpy(), held
                held[tuple(slice(size) for size in part.shape)] = part
            array.field.from_numpy(held)

    def reorder(self, name: str, order: Mapping[int, np.ndarray]) -> None:
        """Reorder the entries along an axis in some worlds, in all arrays that have it: `order[w]` are the old places.

        Entries beyond those in `order[w]` stay.
        """
        for array in self.arrays.values():
            names = [axis.name for axis in array.axes]
            if name in names:
                values = array.field.to_numpy()
                rows = np.moveaxis(values, (names.index("world"), names.index(name)), (0, 1))
                for w, old in order.items():
                    rows[w, : len(old)] = rows[w, old]
                array.field.from_numpy(values)

    def _kept(self) -> list[tuple[str, Array]]:
        return [(name, array) for name, array in self.arrays.items() if array.kept]

    def release(self) -> None:
        """Free the memory; the fields must not be used afterwards."""
        if self._tree is not None and runtime.let_go(self):
            memory.close(self.fields)
            self._tree.destroy()
        self._tree = None
