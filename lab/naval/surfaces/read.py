"""A hull from a surface of triangles: an STL or OBJ file, cut by planes across the ship.

The stations' volumes are compared with the surface's own, of the whole hull and up to each draught of the tables of
hydrostatics. Stations are added until they agree.

x and z stay those of the file. The base line, from which draughts are, is at the keel amidships.
"""

from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.base.surfaces import obj, stl
from lab.naval.surfaces import whole
from lab.naval.surfaces.axes import Axes, check_middle, check_size
from lab.naval.surfaces.cuts import section_at
from lab.naval.surfaces.mesh import Mesh, welded
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.section import Section

AGREE = 1e-3  # of a volume: stations and surface may differ by that
LEAST = 0.1  # of the whole: smaller volumes, at draughts that no ship floats at, may differ by AGREE of that
KEEL = 1e-4  # of the depth: a keel amidships this close to z = 0 is there
MOST = 401  # stations: no more are added
AS_IT_IS = Axes()
LEVELS = 10  # equal steps of draught at which volumes are compared


def read_surface(path: Path, stations: int, axes: Axes = AS_IT_IS) -> tuple[Form, Mesh]:
    """The hull of an STL or OBJ file by at least so many cuts at equal distances, and its closed surface, both in m.

    Raises LabError for a file that is none, a surface that is not a single closed body in the hull's axes, a cut in
    several pieces, or stations that do not agree with the surface.
    """
    mesh = closed_surface(path, axes)
    sections: dict[float, Section | None] = {}
    while True:
        form = _form(mesh, stations, sections)
        off, level = disagreement(form, mesh)
        if off <= AGREE:
            return form, mesh
        if stations >= MOST:
            _refuse(form, mesh, off, level)
        stations = min(2 * stations - 1, MOST)


def closed_surface(path: Path, axes: Axes) -> Mesh:
    """The closed surface of an STL or OBJ file in the hull's axes. Raises LabError."""
    triangles = obj.triangles_of(path) if path.suffix.lower() == ".obj" else stl.triangles_of(path)
    mesh = welded(axes.placed(triangles), path.name)
    check_size(mesh)
    if axes.mirror:
        mesh = whole.mirrored(mesh)
    if axes.close:
        mesh = whole.closed(mesh)
    mesh = whole.body(mesh)
    check_middle(mesh)
    return mesh


def disagreement(form: Form, mesh: Mesh) -> tuple[float, float]:
    """The largest difference of volumes by stations and by surface, as a share, and the level (m) up to which it is.

    The level is infinite for the whole hull.
    """
    levels = [*(form.base + form.depth * np.arange(1, LEVELS + 1) / LEVELS), np.inf]
    found = []
    for level in levels:
        own = mesh.volume if level == np.inf else mesh.below(level)
        by_stations = form.volume if level == np.inf else form.displaced(np.full(len(form.x), level))[0]
        found.append(abs(by_stations - own) / max(own, LEAST * mesh.volume))
    worst = int(np.argmax(found))
    return found[worst], levels[worst]


def _form(mesh: Mesh, stations: int, sections: dict[float, Section | None]) -> Form:
    """The hull by so many stations; `sections` keeps those that are cut."""
    places = np.linspace(mesh.low[0], mesh.high[0], stations)
    for x in places.tolist():
        if x not in sections:
            sections[x] = section_at(mesh, x)
    found = tuple(sections[x] for x in places.tolist())
    amidships = found[stations // 2]
    keel = mesh.low[2] if amidships is None else amidships.outline[:, 1].min()
    try:
        return Form(places, found, base=float(keel) if abs(keel) > KEEL * mesh.extent[2] else 0.0)
    except Unavailable as error:
        raise LabError(f"{mesh.name}: {error}") from None


def _refuse(form: Form, mesh: Mesh, off: float, level: float) -> None:
    """Raise LabError that says between which stations volumes differ most."""
    areas = np.array([_area(section, level) for section in form.sections])
    between = 0.5 * (areas[1:] + areas[:-1]) * np.diff(form.x)
    k = int(np.argmax(np.abs(between - np.diff(mesh.along(form.x, level)))))
    up_to = "" if level == np.inf else f" up to z {level:.4g} m"
    raise LabError(
        f"{mesh.name}: {len(form.x)} stations have {100.0 * off:.2g} % another volume{up_to} than the surface itself, "
        f"most of it between x {form.x[k]:.5g} and {form.x[k + 1]:.5g} m; look there for what is thinner than the "
        "stations' distance, or stands in another part."
    )


def _area(section: Section | None, level: float) -> float:
    """Area (m²) of a section up to a level (m)."""
    if section is None:
        return 0.0
    return section.area if level == np.inf else float(section.immersion(-level, 0.0).area)
