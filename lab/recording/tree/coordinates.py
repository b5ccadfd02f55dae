"""The coordinates along the axes of a recording's arrays: who is meant, where it is, and how large."""

from collections.abc import Collection, Iterator, Mapping

import numpy as np
import xarray

from lab.preset.kept.content import KINDS_OF_GAUGES
from solvers.machine.quantity import PLANE

Coordinates = dict[str, xarray.Variable]
GAUGES = dict(zip(("gauge", "level", "edge"), KINDS_OF_GAUGES, strict=True))  # axes of gauges, and their kinds
PARTICLES = {"water_particle": "volume", "air_particle": "air_volume", "point": "bulk_volume"}


def coordinates(recording, axes: Mapping[str, int]) -> Coordinates:
    """The coordinates along `axes`, which have such lengths: numbers or names, and what is known of each one."""
    found: Coordinates = {}
    for axis in axes:
        if axis == "world":
            found |= _of_worlds(recording)
        elif axis == "grain":
            found |= _of_grains(recording)
        elif axis in PARTICLES:
            found |= _of_particles(recording, axis)
        elif axis in recording.names:
            found[axis] = words(axis, recording.names[axis], _said(axis))
            found |= _places(recording, axis)
    return {name: one for name, one in found.items() if set(one.dims) <= axes.keys()}


def words(axis: str, names: Collection[str], said: str) -> xarray.Variable:
    """A coordinate of names."""
    return xarray.Variable((axis,), np.array(list(names), dtype=str), {"long_name": said})


def kinds(recording) -> list[str]:
    """The names of the kinds of grains, by their numbers; the preset's own material comes first."""
    named = recording.resolved.get("kinds") or {}
    return ["material", *map(str, named)]


def _of_worlds(recording) -> Coordinates:
    """Beds by number, each with the seed that it was filled with."""
    numbers = np.arange(recording.worlds)
    seed = int((recording.resolved.get("run") or {}).get("seed", 1))
    return {
        "world": xarray.Variable(("world",), numbers, {"long_name": "bed"}),
        "seed": xarray.Variable(("world",), seed + numbers, {"long_name": "seed of the bed"}),
    }


def _of_grains(recording) -> Coordinates:
    names = kinds(recording)
    told = {"long_name": "kind of the grain", "flag_values": np.arange(len(names), dtype=np.uint8)}
    sizes = {"long_name": "radius of the grain", "units": "m"}
    return {
        "grain": xarray.Variable(
            ("grain",), np.arange(recording.radius.shape[1]), {"long_name": "number of the grain"}
        ),
        "radius": xarray.Variable(("world", "grain"), recording.radius, sizes),
        "kind": xarray.Variable(("world", "grain"), recording.kind, told | {"flag_meanings": " ".join(names)}),
    }


def _of_particles(recording, axis: str) -> Coordinates:
    """Particles by number, each with its volume; in the plane that is an area."""
    volumes = getattr(recording, PARTICLES[axis])
    said = axis.replace("_particle", "") if axis != "point" else "bulk"
    told = {"long_name": f"volume of the {said} that it stands for", "units": _volume_unit(recording)}
    numbers = {"long_name": f"number of the {axis.replace('_', ' ')}"}
    return {
        axis: xarray.Variable((axis,), np.arange(volumes.shape[1]), numbers),
        f"{axis}_volume": xarray.Variable(("world", axis), volumes, told),
    }


def _volume_unit(recording) -> str:
    """The unit of a particle's volume: an area in the plane."""
    return "m^2" if recording.content.axes == PLANE else "m^3"


def _said(axis: str) -> str:
    return f"gauge of {GAUGES[axis]}" if axis in GAUGES else axis


def _places(recording, axis: str) -> Coordinates:
    """Where gauges are, in the tank, as far as the preset says; NaN where it does not."""
    told = recording.resolved.get("gauges") or {}
    rows = [dict(_place(told.get(name) or {})) for name in recording.names[axis]] if axis in GAUGES else []
    known = sorted({name for row in rows for name in row})
    return {
        f"{axis}_{name}": xarray.Variable(
            (axis,),
            np.array([row.get(name, np.nan) for row in rows], dtype=float),
            {"long_name": f"{name} of the {_said(axis)} in the tank", "units": "m"},
        )
        for name in known
    }


def _place(gauge: Mapping) -> Iterator[tuple[str, float]]:
    if gauge.get("place") is not None:
        yield from zip("yz", map(float, gauge["place"]), strict=True)
    for name in "yx":
        if gauge.get(name) is not None:
            yield name, float(gauge[name])
