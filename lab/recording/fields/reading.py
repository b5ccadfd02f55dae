"""Fields of a recording, or of a running simulation, as labelled data."""

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from lab.assembly.grains import grain_masses
from lab.base.errors import LabError, NotRecorded
from lab.recording.fields.grains import coarse_grained
from lab.recording.fields.grid import Grid, grid_over, lucy
from solvers.grains.pressing import Pressing
from solvers.machine.quantity import DIRECTIONS, PLANE

if TYPE_CHECKING:
    from collections.abc import Mapping

    import xarray

    from lab.preset.schema import Preset
    from solvers.simulation import Simulation

USUAL = 1.5  # mean diameters: the half width of Lucy's function, where none is given
FINE = 0.5  # of the half width: the usual distance of nodes
TOLD = {
    "solid": ("1", "share of the place that grains fill"),
    "porosity": ("1", "share of the place between grains"),
    "density": ("kg/m^3", "density of the bed"),
    "velocity": ("m/s", "velocity of the bed, relative to the tank"),
    "stress": ("Pa", "stress carried by contacts, pressing positive"),
    "kinetic_stress": ("Pa", "stress of the agitation of grains"),
    "pressure": ("Pa", "mean pressure carried by contacts"),
}


@dataclass(frozen=True)
class Bed:
    """A bed at one time: `preset`, `time` (s), number of the `world`, outline (m, 2) m of the tank, and of n grains
    place and velocity (n, axes), radius (n,) m, of outlines that of the disc of equal area, kind (n,) and the contacts.
    """

    preset: "Preset"
    time: float
    world: int
    outline: np.ndarray
    place: np.ndarray
    velocity: np.ndarray
    radius: np.ndarray
    kind: np.ndarray
    pressing: Pressing


def recorded_bed(recording, frame: int, world: int) -> Bed:
    """The bed of a frame. Raises NotRecorded without grains or without such a frame or bed."""
    contacts = recording.contacts(frame, world)
    radius, frames = np.asarray(recording.radius[world]), recording.frames
    velocity = frames["velocity"][frame][world].astype(float)
    kind, place = np.asarray(recording.kind[world], dtype=int), contacts.position
    where = contacts.time, world, np.asarray(recording.outline)
    return Bed(recording.preset, *where, place, velocity, radius, kind, contacts.pressing)


def bed_now(preset: "Preset", simulation: "Simulation", seen: "Mapping[str, np.ndarray]", world: int) -> Bed:
    """The bed of a world of a running simulation, of which a snapshot was `seen`."""
    grains = simulation.scene.grains
    if grains is None or not 0 <= world < simulation.scene.worlds:
        raise NotRecorded(f"fields: there are no grains in bed {world}.")
    radius = grains.radius[world]
    kind = np.zeros(len(radius), dtype=int) if grains.kind is None else np.asarray(grains.kind[world], dtype=int)
    place, velocity = seen["position"][world].astype(float), seen["velocity"][world].astype(float)
    where = simulation.time, world, np.asarray(simulation.scene.outline)
    return Bed(preset, *where, place, velocity, radius, kind, simulation.pressing(world))


def fields_of(bed: Bed, spacing: float | None, width: float | None) -> "xarray.Dataset":
    """The fields of a bed on a grid over its tank (see `coarse_grained`).

    width (m): the half width of Lucy's function, by default USUAL mean diameters; its reach is twice that. spacing (m)
    of the nodes, by default half a width. Raises LabError for sizes that make no grid.
    """
    import xarray

    axes, diameter = bed.place.shape[1], 2.0 * float(bed.radius.mean())
    width = USUAL * diameter if width is None else float(width)
    spacing = FINE * width if spacing is None else float(spacing)
    if not (0.0 < spacing < np.inf and 0.0 < width < np.inf):
        raise LabError(f"fields: width and spacing are lengths in m, greater than 0 (got {width:g} and {spacing:g}).")
    try:
        grid = _grid(bed, spacing)
    except ValueError as error:
        raise LabError(f"fields: {error}; take a larger spacing.") from None
    size = np.pi * bed.radius**2 if axes == PLANE else 4.0 / 3.0 * np.pi * bed.radius**3
    mass = grain_masses(bed.preset, bed.radius, bed.kind)
    thick = bed.preset.thickness if axes == PLANE else 1.0
    found = coarse_grained(grid, 2.0 * width, bed.place, bed.velocity, mass, size, bed.pressing, thick)
    found = dict(found) | {"porosity": 1.0 - found["solid"]}
    names = DIRECTIONS[:axes]
    dims = {0: names, 1: (*names, "axis"), 2: (*names, "axis", "across")}
    data = {
        name: xarray.Variable(dims[found[name].ndim - axes], found[name], {"units": unit, "long_name": label})
        for name, (unit, label) in TOLD.items()
    }
    along = {name: xarray.Variable(name, grid.along(k), {"units": "m"}) for k, name in enumerate(names)}
    about = {"time": bed.time, "world": bed.world, "width": width, "function": "Lucy (1977)", "reach": 2.0 * width}
    return xarray.Dataset(data, {**along, "axis": list(names), "across": list(names)}, about)


def _grid(bed: Bed, spacing: float) -> Grid:
    """The grid over the tank in the plane; along it in space over the grains."""
    low, high = bed.outline.min(axis=0), bed.outline.max(axis=0)
    if bed.place.shape[1] > PLANE:
        known = bed.place[np.isfinite(bed.place).all(axis=1), PLANE:]
        reach = bed.radius.max()
        low, high = np.append(low, known.min(axis=0) - reach), np.append(high, known.max(axis=0) + reach)
    return grid_over(low, high, spacing)


def water_at(recording, points: np.ndarray, frame: int, world: int) -> "xarray.Dataset":
    """Pressure (Pa) and velocity (m/s) of water at points (k, axes) m in the tank's frame, NaN where there is none.

    The mean over particles with weights V_i φ(r − r_i), φ of a reach of two distances of particles (Shepard 1968).
    Raises NotRecorded without particles of water.
    """
    import xarray

    frames = recording.frames
    if "water_position" not in frames.quantities:
        raise NotRecorded(f"{recording.path}: it has no particles of water.")
    place = frames["water_position"][frame][world].astype(float)
    axes, points = place.shape[1], np.atleast_2d(np.asarray(points, dtype=float))
    if points.shape[1] != axes:
        raise LabError(f"water_at: points need {axes} coordinates each, {', '.join(DIRECTIONS[:axes])} in m.")
    volume = np.asarray(recording.volume[world])
    known = np.isfinite(place).all(axis=1) & (volume > 0.0)
    place, volume = place[known], volume[known]
    reach = 2.0 * float(np.median(volume)) ** (1.0 / axes)
    pressure = frames["water_pressure"][frame][world].astype(float)[known]
    velocity = frames["water_velocity"][frame][world].astype(float)[known]
    found = np.full((len(points), 1 + axes), np.nan)
    for k, point in enumerate(points):
        apart = np.sqrt(((place - point) ** 2).sum(axis=1))
        near = apart < reach
        weight = volume[near] * lucy(apart[near], reach, axes)
        if weight.sum() > 0.0:
            found[k] = weight @ np.column_stack([pressure[near], velocity[near]]) / weight.sum()
    names = DIRECTIONS[:axes]
    data = {
        "pressure": xarray.Variable("place", found[:, 0], {"units": "Pa", "long_name": "pressure of the water"}),
        "velocity": xarray.Variable(("place", "axis"), found[:, 1:], {"units": "m/s", "long_name": "its velocity"}),
    }
    at = {name: xarray.Variable("place", points[:, k], {"units": "m"}) for k, name in enumerate(names)}
    about = {"time": float(frames["time"][frame]), "world": world, "reach": reach}
    return xarray.Dataset(data, {**at, "axis": list(names)}, about)
