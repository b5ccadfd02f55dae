"""The nodes of a recording's tree, as data sets of xarray: its tables, its tank and its matters."""

import json
from collections.abc import Iterator

import numpy as np
import xarray
from xarray.core.indexing import LazilyIndexedArray

from lab.recording.layout import rows_of
from lab.recording.tree.attributes import attributes
from lab.recording.tree.coordinates import Coordinates, coordinates
from lab.recording.tree.lazy import Lazy
from solvers.machine.quantity import Quantity, directions

NODES = "series", "frames"
CALLED = {"part": "part_displacement"}  # quantities that have the name of an axis, which has the names along it
OF_AXES = {"axis": "direction in the tank", "freedom": "freedom of a body", "rotation": "axis of rotation"}


def tree(recording) -> xarray.DataTree:
    """All that a recording holds (see `Recording.tree`)."""
    return xarray.DataTree.from_dict(dict(nodes(recording)))


def nodes(recording) -> Iterator[tuple[str, xarray.Dataset]]:
    """The data sets of the nodes by their paths; the root has attributes alone."""
    yield "/", xarray.Dataset(attrs=about(recording))
    for name in NODES:
        yield f"/{name}", table(recording, name)
    if recording.steering is not None:
        yield "/steering", _steering(recording)
    yield "/tank", _tank(recording)
    for name in recording.content.matters:
        yield f"/{name}", _matter(recording, name)
    if recording.parts:
        yield "/parts", _parts(recording)
    if recording.shapes is not None:
        yield "/shapes", _shapes(recording)


def about(recording) -> dict[str, object]:
    """The attributes of a recording, which any file can hold."""
    return {
        "title": str(recording.resolved.get("title", "")),
        "preset": recording.name,
        "preset_toml": recording.given,
        "created": recording.created,
        "status": recording.status,
        "version": recording.version,
        "versions": json.dumps(recording.versions),
        "step": recording.step,
        "wall_s": recording.wall_s,
    }


def table(recording, name: str, rows: slice | None = None) -> xarray.Dataset:
    """The series or the frames of a recording: all of them, read on demand, or the given rows, read now.

    What nobody has, as the places of parts in a tank without any, is left out where rows are read on demand.
    """
    held = series_or_frames(recording, name)
    variables, quantities = {}, {}
    for quantity in held.quantities.values():
        called = quantity.name if rows is not None else CALLED.get(quantity.name, quantity.name)
        values = held[quantity.name][rows] if rows is not None else _lazy(recording, name, quantity)
        if values is not None:
            variables[called] = xarray.Variable(quantity.axes, values, attributes(quantity))
            quantities[called] = quantity
    time = variables.pop("time").load()
    about_all = about(recording) if rows is not None else None
    return xarray.Dataset(variables, {"time": time, **along(recording, quantities, variables)}, about_all)


def series_or_frames(recording, name: str):
    """The table of that name."""
    return recording.series if name == "series" else recording.frames


def along(recording, quantities: dict[str, Quantity], variables: dict) -> Coordinates:
    """The coordinates of these variables along their axes, time aside."""
    axes = {axis: size for one in variables.values() for axis, size in one.sizes.items() if axis != "time"}
    found = coordinates(recording, axes)
    for name in variables:
        quantity = quantities[name]
        if quantity.components:
            found[quantity.dimension] = _components(quantity.dimension, quantity.components)
    return {name: one for name, one in found.items() if name not in variables}


def _components(axis: str, names: tuple[str, ...]) -> xarray.Variable:
    return xarray.Variable((axis,), np.array(names, dtype=str), {"long_name": OF_AXES.get(axis, "component")})


def _lazy(recording, name: str, quantity: Quantity) -> LazilyIndexedArray | None:
    """A quantity that is read on demand; None where nobody has it."""
    (shape, dtype), = rows_of([quantity], recording.sizes).values()  # fmt: skip
    return (
        LazilyIndexedArray(Lazy(series_or_frames(recording, name), quantity.name, shape, dtype))
        if 0 not in shape
        else None
    )


def _tank(recording) -> xarray.Dataset:
    """Its outline, of which each edge begins at its corner, and the grains that are fixed to its walls."""
    is_open = np.isin(np.arange(len(recording.outline)), recording.open_edges)
    metres = {"units": "m"}
    variables = {
        "outline": (("corner", "axis"), recording.outline, {"long_name": "corners of the tank", **metres}),
        "edge_is_open": (("corner",), is_open.astype(np.int8), {"long_name": "whether the edge has no wall (1)"}),
    }
    if len(recording.fixed):
        place, radius = recording.fixed[:, :2], recording.fixed[:, 2]
        variables["fixed_position"] = (("fixed", "axis"), place, {"long_name": "places of the fixed grains", **metres})
        variables["fixed_radius"] = (("fixed",), radius, {"long_name": "radii of the fixed grains", **metres})
    return xarray.Dataset(variables, {"axis": _components("axis", directions(2))})


def _parts(recording) -> xarray.Dataset:
    """The moving parts at rest, a line each."""
    variables = {
        name: ((f"{name}_point", "axis"), line, {"long_name": f"points of {name} at rest", "units": "m"})
        for name, line in recording.parts.items()
    }
    return xarray.Dataset(variables, {"axis": _components("axis", directions(2))})


def _matter(recording, name: str) -> xarray.Dataset:
    """What of each particle of a matter does not change: radius and kind of grains, else its volume."""
    if name == "grains":
        found = coordinates(recording, {"world": recording.worlds, "grain": recording.radius.shape[1]})
        if recording.shapes is not None:
            told = {"long_name": "number of the grain's outline in /shapes"}
            found["outline"] = xarray.Variable(("world", "grain"), recording.shapes.which, told)
        return xarray.Dataset({one: found.pop(one) for one in ("radius", "kind", "outline") if one in found}, found)
    axis = "point" if name == "bulk" else f"{name}_particle"
    found = coordinates(recording, {"world": recording.worlds, axis: recording.sizes[axis]})
    return xarray.Dataset({"volume": found.pop(f"{axis}_volume")}, found)


def _shapes(recording) -> xarray.Dataset:
    """The Fourier descriptors of the outlines of irregular grains."""
    contours, most = recording.shapes.contours, max(len(one.descriptors) for one in recording.shapes.contours)
    rows = {"descriptors": "Fourier descriptors", "phases": "phases of the descriptors"}
    variables = {}
    for name, said in rows.items():
        values = [np.pad(getattr(one, name), (0, most - len(one.descriptors))) for one in contours]
        unit = "rad" if name == "phases" else "1"
        variables[name] = (("outline", "harmonic"), np.array(values), {"long_name": said, "units": unit})
    variables["kind"] = (("outline",), recording.shapes.kind, {"long_name": "class of shapes of the preset"})
    return xarray.Dataset(variables)


def _steering(recording) -> xarray.Dataset:
    """What a hand set, to what and when."""
    rows = recording.steering
    time = np.array([row[0] for row in rows], dtype=float)
    told = {"name": "control that the user set", "value": "value that it was set to, in SI"}
    values = {"name": np.array([row[1] for row in rows], dtype=str), "value": np.array([r[2] for r in rows], float)}
    variables = {name: (("time",), values[name], {"long_name": said}) for name, said in told.items()}
    return xarray.Dataset(variables, {"time": (("time",), time, {"long_name": "time", "units": "s"})})
