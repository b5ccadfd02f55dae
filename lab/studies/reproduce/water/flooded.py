"""Bodies and hulls let go in water in space: how they swing, sink, heel and fill."""

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome

COLOURS = BLUE, VERMILION, GREEN
Y, Z, ROLL = 0, 1, -1  # components of a place in space


def places(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) s, and the place (T, 6) of the first body, from its place at the start."""
    series = one.recording.series
    place = series["body_place"][:, 0, 0]
    return series["time"][:], place - place[0]


def extremes(time: np.ndarray, height: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """When a height turns, and what it is there, by a parabola through three samples; the start is the first."""
    rise = np.diff(height)
    turns = 1 + np.flatnonzero(rise[1:] * rise[:-1] < 0.0)
    before, at, after = height[turns - 1], height[turns], height[turns + 1]
    off = 0.5 * (before - after) / (before - 2.0 * at + after)
    when = time[turns] + off * np.median(np.diff(time))
    return np.append(time[0], when), np.append(height[0], at - 0.25 * (before - after) * off)


def swing(one: Outcome, number: float) -> float:
    """How far it goes from one turn to the next, the first from its release, over the height of release."""
    sphere = one.recording.preset.parts["sphere"]
    release = sphere.points[0][1] - one.recording.preset.water.depth
    time, place = places(one)
    _, heights = extremes(time, place[:, Z])
    return _at(np.abs(np.diff(heights)), int(number) - 1) / release


def swing_end(one: Outcome, number: float) -> float:
    """When (s) a swing ends."""
    time, place = places(one)
    return _at(extremes(time, place[:, Z])[0], int(number))


def _at(values: np.ndarray, number: int) -> float:
    return float(values[number]) if number < len(values) else np.nan


def heave_off(one: Outcome, after: float) -> float:
    """How far (spacings) it is from where it was drawn to float, at most, from a time (s) on."""
    time, place = places(one)
    return float(np.abs(place[time >= after, Z]).max() / one.recording.preset.water.spacing)


def roll_at_most(one: Outcome, _: object) -> float:
    """The largest roll (deg)."""
    return float(np.degrees(np.abs(places(one)[1][:, ROLL]).max()))


def heel_then(one: Outcome, when: float) -> float:
    """The heel (deg) at a time (s), positive to −y; NaN after the end."""
    time, place = places(one)
    return float(np.degrees(np.interp(when, time, place[:, ROLL]))) if time[-1] >= when - 0.01 else np.nan


def sway_then(one: Outcome, when: float) -> float:
    """The sway (mm) at a time (s); NaN after the end."""
    time, place = places(one)
    return float(1e3 * np.interp(when, time, place[:, Y])) if time[-1] >= when - 0.01 else np.nan


def inside_then(one: Outcome, when: float) -> float:
    """The water (kg) in the first room at a time (s); NaN after the end."""
    series = one.recording.series
    return float(np.interp(when, series["time"], series["room_water"][:, 0, 0]))


def deck_under(one: Outcome, _: object) -> float:
    """When (s) the middle of the deck is under the water; NaN if it is not.

    The water is as high as what is not in the hull makes it: by the volume of the hull under it less what is inside.
    """
    preset, (time, place) = one.recording.preset, places(one)
    part, tank = preset.parts["cabin"], preset.tank
    top = max(z for _, z in part.points) + place[:, Z]
    volume = part.solved().shape.volume
    inside = one.recording.series["room_water"][:, 0, 0] / preset.water.density
    level = preset.water.depth + (volume - inside) / (tank.width * tank.along)
    under = np.flatnonzero(top < level)
    return float(time[under[0]]) if len(under) else np.nan


NUMBERS = {
    "swing": ("1", swing),
    "swing_end": ("s", swing_end),
    "heave_off": ("1", heave_off),
    "roll_at_most": ("deg", roll_at_most),
    "heel_then": ("deg", heel_then),
    "sway_then": ("mm", sway_then),
    "inside_then": ("kg", inside_then),
    "deck_under": ("s", deck_under),
}


def figure(found: Found) -> Figure:
    """Heave and heel of the first body of each run."""
    drawing, axes = canvas(SIZE)
    beside = axes.twinx()
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        time, place = places(outcomes[0])
        axes.plot(time, 1e3 * place[:, Z], color=colour, lw=1.2, label=f"{label}, heave")
        beside.plot(time, np.degrees(place[:, ROLL]), color=colour, lw=0.8, ls="--", label=f"{label}, roll")
    axes.set(xlabel="time (s)", ylabel="heave (mm)")
    beside.set(ylabel="roll (deg)")
    lines = [*axes.get_lines(), *beside.get_lines()]
    drawing.legend(handles=lines, loc=BELOW, ncols=2)
    return drawing
