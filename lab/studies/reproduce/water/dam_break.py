"""A dam break beside measured fronts and the wall pressures of a hundred repeats.

Lobovský et al. (2014), J. Fluids Struct. 48, 407: a column of H = 300 mm, 2 H long. Lengths are in H, times in √(H/g),
pressures in ρ g H. Our column has no gate: it is free at once.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.preset.sections.water.liquid import spacing
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn

FITTED = 1.0, 3.3  # H beyond the column, of the line through the front; the wall is at 3.37
PLATEAU = 3.5, 4.5  # √(H/g)
ARRIVED = 0.2  # ρ g H
AVERAGE = 0.010  # s: hits of a few particles are shorter
WALL = 1010.0 / 300.0  # H from the column's end
FIRST = 0.6  # √(H/g) after the arrival in which the first peak is sought
HEIGHTS = np.array([3.0, 15.0, 30.0, 80.0])  # mm over the floor, of the sensors on the wall
FRONTS, PRESSURES = "dam_break_fronts/front_lobovsky_H0.300m.csv", "lobovsky_dam_break/pressure_sensor{}.csv"
COLOURS = BLUE, VERMILION, GREEN


@dataclass(frozen=True)
class Break:
    """A dam break in H, √(H/g), ρ g H.

    The front's speed and when it is at the wall; from when sensor 1 shows it; first peaks and largest means over 10 ms
    at sensors 1 and 2; the means over PLATEAU at sensors 1 to 4, and of the wall up to the highest of them.
    """

    front: float
    wall: float
    arrival: float
    peak: float
    second: float
    mean: float
    second_mean: float
    plateau: float
    plateau_2: float
    plateau_3: float
    plateau_4: float
    lowest_wall: float


class Scales:
    """The units of a run: length m, time s, pressure Pa; the column's end m."""

    def __init__(self, one: Outcome):
        preset = one.recording.preset
        corners = np.array(preset.water.region)
        self.length = float(np.ptp(corners[:, 1]))
        self.end = float(corners[:, 0].max())
        self.time = (self.length / preset.run.gravity) ** 0.5
        self.pressure = preset.water.density * preset.run.gravity * self.length


def front_course(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times and places of the front: the foremost particle and half a spacing, beyond the column's end."""
    recording, unit = one.recording, Scales(one)
    places = recording.frames["water_position"]
    foremost = [np.nanmax(places[k][0, :, 0].astype(float)) for k in range(len(recording.frames["time"]))]
    ahead = np.array(foremost) + 0.5 * spacing(recording.preset) - unit.end
    return recording.frames["time"][:] / unit.time, ahead / unit.length


def front_speed(time: np.ndarray, place: np.ndarray) -> float:
    """Slope of the line through the front's places within FITTED, before it reaches the wall; NaN of fewer than two."""
    upto = int(np.argmax(place > FITTED[1])) or len(place)
    within = place[:upto] > FITTED[0]
    if within.sum() < 2:
        return np.nan
    return float(np.polyfit(time[:upto][within], place[:upto][within], 1)[0])


def find_break(one: Outcome) -> Break:
    """The numbers of a run; NaN for what it did not reach."""
    series, unit = one.recording.series, Scales(one)
    time = series["time"] / unit.time
    pressure, highest = (series[name][:, 0] / unit.pressure for name in ("gauge_pressure", "gauge_peak"))
    arrival = _first(time, highest[:, 0] > ARRIVED)
    first = (time >= arrival) & (time <= arrival + FIRST)
    late = (time >= PLATEAU[0]) & (time <= PLATEAU[1])
    samples = max(1, round(AVERAGE / (series["time"][1] - series["time"][0])))
    share = np.full(samples, 1.0 / samples)
    peaks = means = (np.nan, np.nan)
    if first.sum() >= samples:
        peaks = [float(highest[first, k].max()) for k in (0, 1)]
        means = [float(np.convolve(pressure[first, k], share, "valid").max()) for k in (0, 1)]
    course = front_course(one)
    wall = _first(course[0], course[1] >= WALL - spacing(one.recording.preset) / unit.length)
    plateaus = pressure[late].mean(axis=0) if time[-1] >= PLATEAU[1] else np.full(len(HEIGHTS), np.nan)
    return Break(front_speed(*course), wall, arrival, *peaks, *means, *plateaus.tolist(), over_wall(plateaus))


def over_wall(pressures: Sequence[float]) -> float:
    """Mean of the wall's lowest 80 mm of pressures at the HEIGHTS of the sensors.

    By straight lines between them; below the lowest as there.
    """
    heights = np.concatenate([[0.0], HEIGHTS])
    return float(np.trapezoid([pressures[0], *pressures], heights) / heights[-1])


def _first(time: np.ndarray, reached: np.ndarray) -> float:
    return float(time[np.argmax(reached)]) if reached.any() else np.nan


def _part(name: str) -> Callable[[Outcome, object], float]:
    return lambda one, _: getattr(find_break(one), name)


NUMBERS = {f"break_{one.name}": ("1", _part(one.name)) for one in fields(Break)}


def figure(found: Found, speeds: Sequence[float], plateau: Sequence[float]) -> Figure:
    """Fronts beside lines of `speeds`, √(gH), pressures at sensor 1 beside the range of its `plateau`, ρgH, and means.

    The means are those over PLATEAU at all sensors.
    """
    runs = {label: outcomes[0] for label, outcomes in found.items()}
    drawing, (fronts, pressures, means) = canvas((SIZE[0] + 3.0, 3.6), 1, 3)
    _draw_fronts(fronts, runs, speeds)
    _draw_pressures(pressures, runs, plateau)
    _draw_means(means, runs)
    handles, labels = fronts.get_legend_handles_labels()
    more = pressures.get_legend_handles_labels()
    drawing.legend([*handles, more[0][0]], [*labels, more[1][0]], loc=BELOW, ncols=3)
    return drawing


def _draw_fronts(axes: Axes, runs: dict[str, Outcome], speeds: Sequence[float]) -> None:
    for (label, one), colour in zip(runs.items(), COLOURS, strict=False):
        time, place = front_course(one)
        axes.plot(time[place <= FITTED[1]], place[place <= FITTED[1]], color=colour, label=label)
    middle = np.array([1.2, 2.6])
    for speed, style in zip(speeds, (":", "--"), strict=False):
        axes.plot(middle, 0.6 + speed * (middle - middle[0]), color="0.5", ls=style, lw=1.0, label=f"{speed} √(gH)")
    if (measured := drawn(axes, FRONTS)) is not None:
        axes.plot(*measured, "o", ms=2.5, color="black", label="measured")
    axes.set(xlabel="t √(g/H)", ylabel="front beyond the column (H)", xlim=(0.0, 3.0), ylim=(0.0, 4.2))


def _draw_pressures(axes: Axes, runs: dict[str, Outcome], plateau: Sequence[float]) -> None:
    axes.axhspan(*plateau, color=GREY, alpha=0.3, lw=0, label="95 % of the repeats from 3.5 to 4.5")
    for (_, one), colour in zip(runs.items(), COLOURS, strict=False):
        series, unit = one.recording.series, Scales(one)
        axes.plot(series["time"] / unit.time, series["gauge_pressure"][:, 0, 0] / unit.pressure, color=colour, lw=0.8)
    if (measured := drawn(axes, PRESSURES.format(1))) is not None:
        axes.fill_between(measured[0], measured[1], measured[3], color="0.5", alpha=0.4, lw=0)
        axes.plot(measured[0], measured[2], color="black", lw=0.9)
    axes.set(xlabel="t √(g/H)", ylabel="pressure at sensor 1 (ρgH)", xlim=(2.2, 4.6), ylim=(-0.1, 4.0))


def _draw_means(axes: Axes, runs: dict[str, Outcome]) -> None:
    """Means over PLATEAU at the sensors, the measured ones with 95 % of the repeats where both levels are known."""
    for (_, one), colour in zip(runs.items(), COLOURS, strict=False):
        found = find_break(one)
        places = found.plateau, found.plateau_2, found.plateau_3, found.plateau_4
        axes.plot(places, HEIGHTS, "o-", ms=3, lw=0.9, color=colour)
    for k, height in enumerate(HEIGHTS, 1):
        if (measured := drawn(axes, PRESSURES.format(k))) is None:
            break
        late = (measured[0] >= PLATEAU[0]) & (measured[0] <= PLATEAU[1])
        low, middle, *high = measured[1:, late].mean(axis=1)
        ends = [[middle - low], [high[0] - middle if high else 0.0]]
        axes.errorbar(middle, height, xerr=ends, fmt="o", ms=4, capsize=2.5, color="black")
    axes.set(xlabel="mean from 3.5 to 4.5 (ρgH)", ylabel="height of the sensor (mm)", xlim=(0.0, 1.2))
