"""How a column of grains collapses once a gate is drawn, and what the liquid below it says of its packing.

The front is where the outermost hundredth of the grains begins, on the side to which the bed spreads; L_0 is its first
distance from the wall or the edge of the column behind it.

run_out: how far the front has come at the last frame over L_0, (L − L_0)/L_0 (Lube et al. 2005; Rondon, Pouliquen &
Aussillous 2011). Error: half a mean diameter over L_0.
half_run_out_time: when the front has come half as far, between two frames by a straight line, from when the gate
begins to move. Error: half the time between two frames.
opening_pressure_NAME: the mean change of pressure at each gauge from its first sample, while the gate moves: positive
where a loose column contracts, negative where a dense one dilates. Error: standard error of the means of blocks.
Gauges in the tank that stand under the column tell of it, others of the wave that it makes.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, band
from lab.measures.gauges import key
from lab.measures.steady import BLOCKS, Steady, averaged
from lab.measures.value import Value, over_worlds
from lab.recording import Recording

OF = "grains"
OUTERMOST = 0.01  # share of the grains that lies beyond the front
LEAST = 0.5  # mean diameters: a front that comes less far has not moved
COLOURS = BLUE, VERMILION, GREEN, GREY


def applies(recording: Recording) -> bool:
    """A gate opens before grains that start in a region on the floor of a tank at rest, in the plane."""
    preset = recording.preset
    if preset.grains.region is None or preset.axes > 2 or preset.motion.parts or preset.ship is not None:
        return False
    lowest = min(z for _, z in preset.grains.region) - float(recording.outline[:, 1].min())
    return bool(_gates(recording)) and lowest < float(recording.mean_diameter.max())


def measure(recording: Recording) -> dict[str, Value]:
    """run_out (1), half_run_out_time (s) and opening_pressure_NAME (Pa)."""
    time, way, first = fronts(recording)
    size = recording.mean_diameter
    found = {
        "run_out": over_worlds(way[-1] / first, "1", uncertainties=0.5 * size / first, kind="resolution"),
        "half_run_out_time": _half(time, way, LEAST * size, min(part.start for part in _gates(recording))),
    }
    begin = min(part.start for part in _gates(recording))
    end, series = max(part.duration() for part in _gates(recording)), recording.series
    rows = np.flatnonzero((series["time"] > begin) & (series["time"] <= end))
    if not len(recording.names["gauge"]) or len(rows) < BLOCKS:
        return found
    part = Steady(slice(int(rows[0]), int(rows[-1]) + 1), BLOCKS)
    for k, name in enumerate(recording.names["gauge"]):
        pressure = series["gauge_pressure"][..., k]
        found[key("opening_pressure", name)] = averaged(pressure - pressure[0], part, "Pa")
    return found


def _gates(recording: Recording) -> list:
    """The parts that are moved once."""
    return [part for part in recording.preset.parts.values() if part.way]


def fronts(recording: Recording) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times (F,) s of the frames, the way of the front since the first (F, W) m, and its distance then (W,) m."""
    time, position = recording.frames["time"][:], recording.frames["position"]
    y = np.stack([position[frame][..., 0] for frame in range(len(time))]).astype(float)
    low, high = np.quantile(y, [OUTERMOST, 1.0 - OUTERMOST], axis=2)
    spreads_up = (high[-1] - high[0]) >= (low[0] - low[-1])
    way = np.where(spreads_up, high - high[0], low[0] - low)
    return time, way, high[0] - low[0]


def _half(time: np.ndarray, way: np.ndarray, least: np.ndarray, start: float) -> Value:
    """When half of the way (F, W) of each front is made, after `start` (s), if it is `least` (W,) m at least."""
    half, error = np.full(way.shape[1], np.nan), np.full(way.shape[1], np.nan)
    for w, (front, far) in enumerate(zip(way.T, least, strict=True)):
        beyond = np.flatnonzero(front >= 0.5 * front[-1])
        if front[-1] > far and len(beyond) and beyond[0] > 0:
            k = beyond[0]
            part = (0.5 * front[-1] - front[k - 1]) / (front[k] - front[k - 1])
            half[w], error[w] = time[k - 1] + part * (time[k] - time[k - 1]) - start, 0.5 * (time[k] - time[k - 1])
    return over_worlds(half, "s", uncertainties=error, kind="resolution", missing="the front has not moved")


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The front against time, and the change of pressure at the gauges."""
    names = recording.names["gauge"][: len(COLOURS)]
    panels = sheet.panels((1, 1) if names else (1,))
    time, way, first = fronts(recording)
    axes = panels[0][0]
    band(axes, time, 1e3 * (way + first), BLUE, "front")
    axes.set_ylabel("length of the bed (mm)")
    if names:
        axes, series = panels[1][0], recording.series
        for k, (name, colour) in enumerate(zip(names, COLOURS, strict=False)):
            pressure = series["gauge_pressure"][..., k]
            band(axes, series["time"], pressure - pressure[0], colour, f"pressure at {name}")
        axes.set_ylabel("change of pressure (Pa)")
    axes.set_xlabel("time (s)")


FIGURES = {"collapse": draw}
