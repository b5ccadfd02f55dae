"""A hull read from a file, and her hydrostatics at a draught or by a displacement, with a trim."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from lab.assembly.lines.offsets import read_offsets
from lab.base.errors import LabError
from lab.naval import tables
from lab.naval.lengths import between
from lab.naval.surfaces.axes import Axes
from lab.naval.surfaces.gf import read_gf
from lab.naval.surfaces.mesh import Mesh
from lab.naval.surfaces.read import read_surface
from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form, Hydrostatics
from solvers.ship.naval.upright import draught_for, level_at
from solvers.ship.water import Water

SURFACES = ".stl", ".obj"
GEOMETRY = ".gf", ".gft"  # GHS geometry files
DEEPEST = 0.95  # of the depth: the last draught of the tables


@dataclass(frozen=True, eq=False)
class Hull:
    """A hull of stations `form` in `water`; `mesh` is her surface if that is what the file held."""

    name: str
    form: Form
    water: Water
    mesh: Mesh | None = None

    def at(self, draught: float | None = None, *, displacement: float | None = None, trim: float = 0.0) -> Hydrostatics:
        """Hydrostatics at a mean draught (m) at the perpendiculars, or for a displacement (t).

        trim (m) is the draught aft less that forward. Raises LabError for what she cannot have.
        """
        return self.form.afloat(level_at(self.form, self.draught(draught, displacement, trim), trim), self.water)

    def draught(self, draught: float | None, displacement: float | None, trim: float) -> float:
        """The mean draught (m) that is given, or that follows from a displacement (t). Raises LabError."""
        if (draught is None) == (displacement is None):
            raise LabError(f"{self.name}: give a draught (m) or a displacement (t), one of them.")
        try:
            found = draught_for(self.form, displacement, self.water, trim) if draught is None else float(draught)
            level_at(self.form, found, trim)
        except Unavailable as error:
            raise LabError(f"{self.name}: {error}") from None
        return found

    def draughts(self, step: float | None = None, trim: float = 0.0) -> np.ndarray:
        """Round draughts (m) for a table, at multiples of a step (m), up to near her deck. Raises LabError."""
        return tables.round_draughts(DEEPEST * self.form.depth - 0.5 * abs(trim), step)

    def table(self, step: float | None = None, trim: float = 0.0) -> dict[str, np.ndarray]:
        """Hydrostatics at round draughts: arrays by the names of `Hydrostatics`."""
        rows = [self.at(draught, trim=trim) for draught in self.draughts(step, trim)]
        return {name: np.array([getattr(row, name) for row in rows]) for name in vars(rows[0])}


def read_hull(
    path: Path | str,
    *,
    density: float = 1025.0,
    fair: bool = False,
    stations: int = 41,
    axes: Axes = Axes(),  # noqa: B008 (frozen)
    lbp: float | None = None,
    lwl: float | None = None,
    ap: float = 0.0,
) -> Hull:
    """The hull of a file: offsets (CSV), a surface (STL, OBJ) or a GHS geometry file (GF). Raises LabError.

    density: of the water, kg/m³; fair: fair curves between offsets; stations: fewest cuts of a surface; axes: of a
    surface. lbp, lwl, ap: see `between`.
    """
    path = Path(path)
    if path.suffix.lower() in SURFACES:
        if fair:
            raise LabError(f"{path.name}: --fair is of tables of offsets; a surface says what is between its points.")
        form, mesh = read_surface(path, stations, axes)
    elif axes != Axes():
        raise LabError(f"{path.name}: --scale, --up, --origin, --mirror and --close are for surfaces; leave them out.")
    elif path.suffix.lower() in GEOMETRY:
        if fair:
            raise LabError(f"{path.name}: --fair is of tables of offsets; a geometry file has straight lines.")
        form, mesh = read_gf(path), None
    else:
        form, mesh = read_offsets(path, fair), None
    _check_spacing(form, path.name)
    return Hull(path.name, between(form, lbp, lwl, ap), Water(density), mesh)


def _check_spacing(form: Form, name: str) -> None:
    """Raise LabError where the sum over stations gives more than the largest section all along.

    Simpson's rule lays parabolas through the stations, which overshoot where these are spaced too unevenly.
    """
    largest = max(section.area for section in form.sections if section is not None)
    if form.volume > largest * float(np.ptp(form.x)) * (1.0 + 1e-6):
        gap = int(np.argmax(np.diff(form.x)))
        raise LabError(
            f"{name}: the stations are spaced too unevenly to sum over them by Simpson's rule; give further ones "
            f"between x = {form.x[gap]:.4g} m and {form.x[gap + 1]:.4g} m."
        )
