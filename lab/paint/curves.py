"""The curves beside the picture: what is drawn against time, and in which colours."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from lab.paint import palette
from lab.paint.footage import Bed
from lab.paint.water.basins import breadth
from lab.paint.water.gauges import hues_of
from solvers.machine.quantity import ROLL

MOST_SAMPLES = 800  # points per curve of the plot
MOST_PLOTS = 2
BODY = 0.05  # of its size: a body that goes less far has no plot
TOLERANCE = 1e-9  # poses that differ by less (m, rad) count as equal


@dataclass
class Plot:
    """Curves (x, y) with their colours and the times of their points; labels: of x and y; names: in their colours."""

    labels: tuple[str, str]
    curves: list[tuple[np.ndarray, np.ndarray]] = field(default_factory=list)
    colours: list[tuple] = field(default_factory=list)
    samples: list[np.ndarray] = field(default_factory=list)
    names: list[tuple[str, tuple]] = field(default_factory=list)

    def add(self, bed: Bed, values: np.ndarray, colour: tuple, name: str = "") -> None:
        """Add a curve of a bed's values (T,) against time; its highest and lowest points stay."""
        kept = _kept(values)
        time = bed.footage.series_time[kept]
        self.curves.append((time, values[kept]))
        self.colours.append(colour)
        self.samples.append(time)
        self.names += [(name, colour)] if name else []


def plots(beds: Sequence[Bed], hues: Sequence[tuple], series: Sequence[tuple] = palette.SERIES) -> list[Plot]:
    """What is drawn of some beds, the first of which are shown and have these hues: one plot, or two.

    series: the colours of curves of the gauges of a single bed.
    """
    hue = dict(zip(beds, hues, strict=False))  # of the beds that are shown
    wet = [bed for bed in beds if bed.footage.water]
    of_gauges = _of_gauges(wet, hue, series) if wet else []
    carried = any(bed.footage.sea or bed.footage.rail for bed in beds)
    moved = [_of_motion(beds, hues)] if not wet or carried else []
    afloat = [plot for plot in (_of_a_floating_body(wet, hue), _of_rooms(wet, hue, series)) if plot] if wet else []
    return (moved + afloat + of_gauges)[:MOST_PLOTS] or [
        _of_a_body(wet, hue) or _of_a_flow(wet, hue) or _of_the_centre(wet, hue)
    ]


def _of_motion(beds: Sequence[Bed], hues: Sequence[tuple]) -> Plot:
    """The main quantity of beds of grains, of empty tanks and of ships, against time or a steady tilt."""
    afloat = any(bed.footage.sea for bed in beds)
    still = afloat or any(_is_hollow(bed) for bed in beds)
    steady = not still and all(monotonic(bed.footage.series_pose[:, bed.world, ROLL]) for bed in beds)
    label, measured = _quantity(beds)
    plot = Plot(("tilt φ (°)" if steady else "time (s)", label))
    for k in reversed(range(len(beds))):  # the beds that are shown on top
        footage, world = beds[k].footage, beds[k].world
        count = len(footage.series_time)
        kept = np.unique(np.linspace(0, count - 1, min(count, MOST_SAMPLES)).astype(int))
        time = footage.series_time[kept]
        across = np.degrees(footage.series_pose[kept, world, ROLL]) if steady else time
        plot.curves.append((across, measured(beds[k])[kept]))
        plot.colours.append(hues[k] if k < len(hues) else palette.LINE)
        plot.samples.append(time)
    return plot


def _of_gauges(beds: Sequence[Bed], hue: Mapping[Bed, tuple], series: Sequence[tuple]) -> list[Plot]:
    """The pressure and the depth at the gauges: all those of one bed, or the first one of several beds."""
    found = []
    for quantity, of in (("gauge_pressure", "gauges"), ("level_depth", "levels")):
        there = [bed for bed in beds if getattr(bed.footage.water, of)]
        if not there:
            continue
        largest = max(float(np.nanmax(np.abs(_measured(bed, quantity)), initial=0.0)) for bed in there)
        label, scale = _pressures(largest) if of == "gauges" else _depths(largest)
        plot = Plot(("time (s)", label))
        if len(beds) == 1:
            names, colours = getattr(there[0].footage.water, of), hues_of(there[0].footage.water, series)
            for k, name in reversed(list(enumerate(names))[: len(series)]):
                plot.add(there[0], scale * _measured(there[0], quantity)[:, k], colours[name], name)
            plot.names.reverse()
        else:
            for bed in reversed(there):
                plot.add(bed, scale * _measured(bed, quantity)[:, 0], hue.get(bed, palette.LINE))
        found.append(plot)
    return found


def _of_a_floating_body(beds: Sequence[Bed], hue: Mapping[Bed, tuple]) -> Plot | None:
    """How far the first floating body has turned; its heave, where that moves its corners more."""
    if not all(bed.footage.floating for bed in beds):
        return None
    name = beds[0].footage.floating[0]
    arm = 0.5 * float(np.ptp(beds[0].footage.parts[name], axis=0).max())
    ways = np.max([np.ptp(_measured(bed, "body_place")[:, 0], axis=0) for bed in beds], axis=0)
    turns = arm * ways[2] > ways[1]
    plot = Plot(("time (s)", f"heel of {name} (deg)" if turns else f"heave of {name} (mm)"))
    for bed in reversed(beds):
        place = _measured(bed, "body_place")[:, 0]
        plot.add(
            bed, np.rad2deg(place[:, 2]) if turns else 1e3 * (place[:, 1] - place[0, 1]), hue.get(bed, palette.LINE)
        )
    return plot


def _of_rooms(beds: Sequence[Bed], hue: Mapping[Bed, tuple], series: Sequence[tuple]) -> Plot | None:
    """The water in rooms that openings lead to: in each of one bed, in all together of several."""
    rooms = beds[0].footage.rooms
    if not rooms:
        return None
    plot = Plot(("time (s)", "water (kg)"))
    if len(beds) == 1:
        for (name, k), colour in reversed(list(zip(rooms.items(), series, strict=False))):
            plot.add(beds[0], _measured(beds[0], "room_water")[:, k], colour, name.partition(".")[2])
        plot.names.reverse()
    else:
        for bed in reversed(beds):
            plot.add(bed, _measured(bed, "room_water").sum(axis=-1), hue.get(bed, palette.LINE))
    return plot


def _of_a_body(beds: Sequence[Bed], hue: Mapping[Bed, tuple]) -> Plot | None:
    """The way of the first solid body in the water that moves, along the axis on which it goes farther."""
    for number, (name, line) in enumerate(beds[0].footage.parts.items()):
        way = np.ptp(beds[0].footage.part[:, beds[0].world, number], axis=0)
        if len(line) < 4 or not np.allclose(line[0], line[-1]) or way.max() < BODY * np.ptp(line, axis=0).max():
            continue
        axis = int(np.argmax(way))
        factor, unit = (1.0, "m") if way.max() >= 1.0 else (1e3, "mm")
        plot = Plot(("time (s)", f"{name} Δ{'yz'[axis]} ({unit})"))
        for bed in reversed(beds):
            moved = bed.footage.part[:, bed.world, number, axis]
            plot.curves.append((bed.footage.time, factor * (moved - moved[0])))
            plot.colours.append(hue.get(bed, palette.LINE))
            plot.samples.append(bed.footage.time)
        return plot
    return None


def _of_a_flow(beds: Sequence[Bed], hue: Mapping[Bed, tuple]) -> Plot | None:
    """The kinetic energy of water that flows at first by itself, of that at the start."""
    if not beds[0].footage.water.flows:
        return None
    plot = Plot(("time (s)", "kinetic energy (%)"))
    for bed in reversed(beds):
        energy = _measured(bed, "water_kinetic")
        plot.add(bed, 100.0 * energy / max(energy[0], 1e-300), hue.get(bed, palette.LINE))
    return plot


def _of_the_centre(beds: Sequence[Bed], hue: Mapping[Bed, tuple]) -> Plot:
    """The sideways shift of the water's centre of mass."""
    plot = Plot(("time (s)", "shift Δy (mm)"))
    for bed in reversed(beds):
        across = _measured(bed, "water_centre")[:, 0]
        plot.add(bed, 1e3 * (across - across[0]), hue.get(bed, palette.LINE))
    return plot


def _measured(bed: Bed, name: str) -> np.ndarray:
    """A quantity of a bed (T, ...)."""
    return bed.footage.measured(name)[:, bed.world]


def _pressures(largest: float) -> tuple[str, float]:
    return ("pressure (kPa)", 1e-3) if largest >= 1e3 else ("pressure (Pa)", 1.0)


def _depths(largest: float) -> tuple[str, float]:
    return ("depth (m)", 1.0) if largest >= 1.0 else ("depth (mm)", 1e3)


def _kept(values: np.ndarray) -> np.ndarray:
    """The rows of MOST_SAMPLES points or a few more that keep the peaks: of each part the lowest and the highest."""
    count = len(values)
    if count <= MOST_SAMPLES:
        return np.arange(count)
    parts = np.array_split(np.nan_to_num(values), MOST_SAMPLES // 2)
    first = np.cumsum([0, *(len(part) for part in parts[:-1])])
    extremes = [(start + part.argmin(), start + part.argmax()) for start, part in zip(first, parts, strict=True)]
    return np.unique(np.append(extremes, [0, count - 1]))


def _quantity(beds: Sequence[Bed]) -> tuple[str, Callable[[Bed], np.ndarray]]:
    """The quantity of the plot, the same for all beds: its label and a function to the values (T,) of a bed.

    The roll of ships; of empty tanks what moves; the spilled grains if there are any; else the shift of the centre of
    mass, upwards if only heave or parts can move the grains, sideways otherwise. With bulk it is in % of the width.
    """
    if any(bed.footage.sea for bed in beds):
        return _coordinate(2)
    if any(_is_hollow(bed) for bed in beds):
        ways = [np.ptp(bed.footage.series_pose[:, bed.world], axis=0) for bed in beds]
        return _coordinate(max((2, 0, 1), key=lambda axis: max(way[axis] for way in ways) > TOLERANCE))
    of_bulk = any(bed.footage.bulk is not None for bed in beds)
    if not of_bulk and any(bed.footage.spilled[:, bed.world].any() for bed in beds):
        return "spilled (%)", lambda bed: 100 * bed.footage.spilled[:, bed.world] / len(bed.radius)
    upright = not any(np.ptp(bed.footage.series_pose[:, bed.world, ::2], axis=0).any() for bed in beds)
    axis = 1 if upright else 0

    def shift(bed: Bed) -> np.ndarray:
        centre = bed.footage.centre_of_mass[:, bed.world, axis]
        unit = 0.01 * breadth(bed.footage.basins) if of_bulk else bed.diameter
        return (centre - centre[0]) / unit

    return f"shift Δ{'yz'[axis]} ({'% of width' if of_bulk else 'diameters'})", shift


def _is_hollow(bed: Bed) -> bool:
    """Whether there are neither grains nor bulk."""
    return bed.empty and bed.footage.bulk is None


def _coordinate(axis: int) -> tuple[str, Callable[[Bed], np.ndarray]]:
    """A coordinate of the pose as the quantity of the plot."""
    label, scale = (("sway (mm)", 1e3), ("heave (mm)", 1e3), ("roll φ (°)", 180.0 / np.pi))[axis]
    return label, lambda bed: scale * bed.footage.series_pose[:, bed.world, axis]


def monotonic(tilt: np.ndarray) -> bool:
    """Whether tilt (T,) in rad is monotonic and changes by more than half a degree."""
    steps = np.diff(tilt)
    one_way = bool((steps >= -TOLERANCE).all() or (steps <= TOLERANCE).all())
    return one_way and bool(np.ptp(tilt) > np.radians(0.5))
