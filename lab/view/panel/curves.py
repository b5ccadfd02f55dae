"""The curves of the small plot over the view, one function each, up to the frame that is shown."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from lab.paint.water.gauges import hues_of
from lab.view.footage import LiveFootage
from solvers.machine.quantity import ROLL

MOST_POINTS = 130  # two pixels apart
FARTHEST = 90.0  # deg of heel


@dataclass(frozen=True)
class Drawing:
    """Curves (x, y) with labelled axes, each drawn up to a number of its points, where a dot marks the present.

    colours: by default those of a series; names: of curves, each with a colour.
    """

    across: str
    upwards: str
    curves: Sequence[tuple[np.ndarray, np.ndarray]]
    counts: Sequence[int]
    colours: Sequence[tuple] = ()
    names: Sequence[tuple[str, tuple]] = ()


def _in_time(label: str, name: str, scaled: Callable[[np.ndarray, LiveFootage], np.ndarray]):
    """A quantity of the frames against time, one number of it."""

    def draw(footage: LiveFootage, frame: int) -> Drawing:
        rows = np.unique(np.linspace(0, len(footage) - 1, MOST_POINTS).astype(int))
        curve = footage.time[rows], scaled(footage.curve(name, rows), footage)
        return Drawing("time (s)", label, [curve], [int(np.searchsorted(rows, frame, "right"))])

    return draw


def levers(footage: LiveFootage, frame: int) -> Drawing:
    """Righting-arm curve GZ of a ship with her cargo frozen as it lay at the start, and her present heel on it."""
    heel, lever = footage.levers
    shown = np.degrees(heel) <= FARTHEST
    heel, lever = np.degrees(heel)[shown], 1e3 * lever[shown]
    now = min(abs(np.degrees(footage.row(frame, "pose")[ROLL])), FARTHEST)
    point = np.array([now]), np.interp([now], heel, lever)
    return Drawing("heel (°)", "righting lever GZ (mm)", [(heel, lever), point], [len(heel), 1])


def _shift(values: np.ndarray, footage: LiveFootage) -> np.ndarray:
    return (values - values[0])[:, 0] / footage.bed.diameter


def _at_gauges(label: str, name: str, of: str, scale: float):
    """A quantity at each of the gauges against time, in the colours of their marks."""

    def draw(footage: LiveFootage, frame: int) -> Drawing:
        rows = np.unique(np.linspace(0, len(footage) - 1, MOST_POINTS).astype(int))
        hues, time, values = hues_of(footage.water), footage.time[rows], scale * footage.curve(name, rows)
        names = [(gauge, hues[gauge]) for gauge in getattr(footage.water, of)]
        count = int(np.searchsorted(rows, frame, "right"))
        curves = [(time, values[:, k]) for k in range(len(names))]
        return Drawing("time (s)", label, curves, [count] * len(names), [hue for _, hue in names], names)

    return draw


CURVES: dict[str, Callable[[LiveFootage, int], Drawing]] = {
    "shift": _in_time("shift Δy (diameters)", "centre_of_mass", _shift),
    "turn": _in_time("tilt or roll φ (°)", "pose", lambda values, _: np.degrees(values[:, ROLL])),
    "levers": levers,
    "energy": _in_time("kinetic energy (mJ)", "kinetic", lambda values, _: 1e3 * values),
    "contacts": _in_time("contacts", "contacts", lambda values, _: values),
    "pressures": _at_gauges("pressure (kPa)", "gauge_peak", "gauges", 1e-3),
    "depths": _at_gauges("depth (mm)", "level_depth", "levels", 1e3),
    "water": _in_time("shift of the water Δy (mm)", "water_centre", lambda values, _: 1e3 * (values - values[0])[:, 0]),
}
OF_GRAINS, OF_SHIPS, OF_WATER = {"shift", "energy", "contacts"}, {"levers"}, {"pressures", "depths", "water"}


def offered_curves(footage: LiveFootage | None) -> tuple[str, ...]:
    """The names of the curves of this experiment, and the choice of no curve."""
    left_out = set()
    if footage is None or footage.sea is None:
        left_out |= OF_SHIPS
    if footage is not None and footage.bed.empty:
        left_out |= OF_GRAINS
    if footage is None or footage.water is None:
        left_out |= OF_WATER
    else:
        there = {"pressures": footage.water.gauges, "depths": footage.water.levels}
        left_out |= {name for name, gauges in there.items() if not gauges}
    return (*(name for name in CURVES if name not in left_out), "nothing")
