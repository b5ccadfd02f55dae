"""Beds whose grains are listed one by one in a CSV file."""

from dataclasses import dataclass

import numpy as np

from lab.base.errors import LabError
from lab.preset.fields import Table
from lab.preset.units import show
from solvers.tank.outline import clear_of_walls
from solvers.tank.solids.solid import Solid

NEEDED = ("y", "z", "radius")
MOTION = ("vy", "vz", "omega")
IN_SPACE = ("x", "vx", "omega_y", "omega_z")  # omega is the spin about x, there as in the plane
KIND = "kind"
OPTIONAL = (*MOTION, *IN_SPACE, KIND)
MOST = 100_000
SMALLEST = 1e-7  # m, of a radius
FASTEST = 1e6  # m/s or rad/s: larger numbers are probably in another unit
# Overlap of two grains, or of a grain and a wall, in radii of the smaller: of grains as stiff as their material, and at
# most, of softer ones. A given force presses Hertz's contacts of moduli times s together s^(-2/3) times as deep.
DEEPEST, DEEPEST_OF_ALL = 0.01, 0.05


@dataclass(frozen=True, eq=False)
class ListedGrains:
    """The n grains of a file, in SI and in space: `place` and `velocity` (n, 3) y, z, x; `radius` (n,).

    `spin` (n, 3) is that about y, z and x. `kind` (n,) numbers the kinds: 0 is [material], then come those of [kinds];
    None where the file does not tell.
    """

    place: np.ndarray
    radius: np.ndarray
    velocity: np.ndarray
    spin: np.ndarray
    kind: np.ndarray | None
    columns: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.radius)

    @property
    def move(self) -> bool:
        """Whether any of them moves."""
        return bool(np.any(self.velocity) or np.any(self.spin))


def listed(table: Table) -> ListedGrains:
    """The grains of a file."""
    zero = (0.0,) * len(table.columns["y"])

    def rows(*names: str) -> np.ndarray:
        return np.column_stack([table.columns.get(name, zero) for name in names])

    kind = np.array(table.columns[KIND]) if KIND in table.columns else None
    radius = np.array(table.columns["radius"])
    spin = rows("omega_y", "omega_z", "omega")
    return ListedGrains(rows("y", "z", "x"), radius, rows("vy", "vz", "vx"), spin, kind, tuple(table.columns))


def check_radii(grains: ListedGrains) -> None:
    """Raise LabError for radii that no grain has."""
    radius = grains.radius
    wrong = np.flatnonzero(radius < SMALLEST)
    if len(wrong):
        least = "greater than 0" if radius[wrong[0]] <= 0.0 else f"at least {SMALLEST:g} m"
        raise LabError(f"grains.bed: the radius in row {wrong[0] + 1} must be {least} (got {radius[wrong[0]]:g}).")


def check_listed_kinds(grains: ListedGrains, kinds: int) -> None:
    """Raise LabError for kinds of grains that the preset, with so many beside [material], does not have."""
    if grains.kind is None:
        return
    wrong = np.flatnonzero(~np.isin(grains.kind, np.arange(kinds + 1)))
    if len(wrong):
        known = "0, as there are no [kinds]" if not kinds else f"a number from 0 to {kinds}"
        raise LabError(f"grains.bed: the kind in row {wrong[0] + 1} must be {known} (got {grains.kind[wrong[0]]:g}).")


def check_listed(grains: ListedGrains, tank, moving: bool, scale: float = 1.0) -> None:
    """Raise LabError for grains that no bed can have.

    They are outside the `tank`, overlap by more than 1 % of a radius, or more the softer they are made by
    the factor `scale` on their moduli, or have velocities though they are to settle first (`moving` false).
    """
    if tank.solid is None and (beyond := [name for name in IN_SPACE if name in grains.columns]):
        raise LabError(f"grains.bed: column {beyond[0]} is of scenes in space; give tank.along, or leave it out.")
    _check(grains, np.array(tank.corners), tank.solid, min(DEEPEST_OF_ALL, DEEPEST * scale ** (-2.0 / 3.0)))
    if not moving and grains.move:
        raise LabError(
            "grains.bed: its grains move, but settle first; say run.settle = false or leave their velocities and spins "
            "out."
        )


def _check(grains: ListedGrains, outline: np.ndarray, solid: Solid | None, deepest: float) -> None:
    """Raise LabError for invalid grains. Messages count grains from 1, as rows below the header."""
    position, radius = grains.place, grains.radius
    wrong = np.flatnonzero(np.abs(np.column_stack([grains.velocity, grains.spin])).max(axis=1) > FASTEST)
    if len(wrong):
        raise LabError(f"grains.bed: the grain in row {wrong[0] + 1} is too fast; look at its numbers and their units.")
    with np.errstate(over="ignore", invalid="ignore"):  # absurdly large positions
        wrong = np.flatnonzero(~inside(position, outline, (1.0 - deepest) * radius, solid))
    if len(wrong):
        place = ", ".join(show(x, "m") for x in position[wrong[0]][: 2 if solid is None else 3])
        raise LabError(f"grains.bed: the grain in row {wrong[0] + 1}, at {place}, is not inside the tank.")
    _check_overlaps(position, radius, deepest, solid.period if solid else None)


def inside(place: np.ndarray, outline: np.ndarray, reach: np.ndarray, solid: Solid | None) -> np.ndarray:
    """Which places (n, 3) m, y, z, x, are in a tank, `reach` (n,) m from its walls; a `solid` in space."""
    if solid is None:
        return clear_of_walls(place[:, :2], outline, reach)
    return solid.clear(place, outline, reach)


def _check_overlaps(position: np.ndarray, radius: np.ndarray, deepest: float, period: float | None) -> None:
    from scipy.spatial import cKDTree  # slow to import, and only such files need it

    order = np.argsort(radius)
    if period:
        position = np.column_stack([position[:, :2], position[:, 2] % period])
    tree = cKDTree(position[order], boxsize=[0.0, 0.0, period] if period else None)
    for rank, i in enumerate(order):  # only against smaller grains, so its own size bounds the search
        near = order[[k for k in tree.query_ball_point(position[i], 2.0 * radius[i]) if k < rank]]
        apart = position[near] - position[i]
        if period:
            apart[:, 2] -= period * np.round(apart[:, 2] / period)
        overlap = radius[i] + radius[near] - np.linalg.norm(apart, axis=1)
        deep = near[overlap > deepest * radius[near]]
        if len(deep):
            first, second = sorted((int(i), int(deep.min())))
            raise LabError(f"grains.bed: the grains in rows {first + 1} and {second + 1} overlap.")
