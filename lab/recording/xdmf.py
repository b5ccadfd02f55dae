"""An XDMF file for ParaView: the grains or the water of a recording as points, their quantities as attributes.

The file itself contains only the times; all else refers to the recording's data sets (XDMF 3, xdmf.org: Model and
Format).
"""

from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree as Xml

from lab.base.errors import LabError
from lab.base.files import replacing
from lab.recording import Recording
from solvers.machine.quantity import SPACE

KINDS = {1: "Scalar", 2: "Vector", 3: "Vector"}  # by the number of components


class Points(NamedTuple):
    """What is drawn as points: the owner of its quantities, that of their places, and a stored data set of sizes."""

    owner: str
    place: str
    size: str


OF_MATTERS = {
    "grains": Points("grain", "position", "grains/radius"),
    "water": Points("water_particle", "water_position", "water/volume"),
    "air": Points("air_particle", "air_position", "air/volume"),
}


def write_xdmf(recording: Recording) -> Path:
    """Write recording.xdmf beside a recording, with a time series of points for each world. Raises LabError."""
    path = recording.path.with_suffix(".xdmf")
    try:
        with replacing(path) as part, part.open("w", encoding="utf-8") as file:
            file.writelines(_lines(recording))
    except OSError as error:
        raise LabError(f"{path} cannot be written ({error.strerror}): make room there.") from error
    return path


def _lines(recording: Recording) -> Iterator[str]:
    """The text of the file, one grid at a time, since a recording may have very many frames."""
    times = recording.frames["time"][:]
    yield '<?xml version="1.0" encoding="utf-8"?>\n<Xdmf Version="3.0">\n<Domain>\n'
    for world in range(recording.worlds):
        yield f'<Grid Name="bed {world}" GridType="Collection" CollectionType="Temporal">\n'
        for frame, time in enumerate(times):
            for matter in filter(OF_MATTERS.get, recording.content.matters):
                grid = _points(recording, matter, (frame, world), float(time))
                Xml.indent(grid)
                yield Xml.tostring(grid, encoding="unicode") + "\n"
        yield "</Grid>\n"
    yield "</Domain>\n</Xdmf>\n"


def _points(recording: Recording, matter: str, at: tuple[int, int], time: float) -> Xml.Element:
    """The particles of a matter in one world at one time; `at`: the numbers of the frame and of the world."""
    points = OF_MATTERS[matter]
    shape, _ = recording.layout(points.size)
    grid = Xml.Element("Grid", Name=matter, GridType="Uniform")
    _add(grid, "Time", Value=repr(time))
    _add(grid, "Topology", TopologyType="Polyvertex", NumberOfElements=shape[1])
    kind = "XYZ" if recording.content.axes == SPACE else "XY"  # of y, z and x, in this order
    _add_slab(_add(grid, "Geometry", GeometryType=kind), recording, f"frames/{points.place}", at)
    _add_slab(_add_values(grid, points.size.partition("/")[2], 1), recording, points.size, at[1:])
    for name, quantity in recording.frames.quantities.items():
        if quantity.per == points.owner and name != points.place:
            _add_slab(_add_values(grid, name, quantity.width), recording, f"frames/{name}", at)
    return grid


def _add_values(grid: Xml.Element, name: str, size: int) -> Xml.Element:
    return _add(grid, "Attribute", Name=name, AttributeType=KINDS[size], Center="Node")


def _add_slab(parent: Xml.Element, recording: Recording, name: str, place: tuple[int, ...]) -> None:
    """Add the slab of a data set at `place` on its leading axes and whole along the others."""
    shape, kind = recording.layout(name)
    inner = shape[len(place) :]
    slab = _add(parent, "DataItem", ItemType="HyperSlab", Dimensions=_words(inner))
    corner = (*place, *(0 for _ in inner)), (1 for _ in shape), (*(1 for _ in place), *inner)
    item = _add(slab, "DataItem", Dimensions=f"3 {len(shape)}", Format="XML")
    item.text = " ".join(_words(row) for row in corner)
    source = _add(slab, "DataItem", Dimensions=_words(shape), NumberType="Float", Precision=kind.itemsize, Format="HDF")
    source.text = f"{recording.path.name}:/{recording.stored_as(name)}"


def _add(parent: Xml.Element, tag: str, **attributes: object) -> Xml.Element:
    return Xml.SubElement(parent, tag, {name: str(value) for name, value in attributes.items()})


def _words(numbers) -> str:
    return " ".join(map(str, numbers))
