"""What remains of the shift when a tilted tank has come back upright (Spandonidis 2016, 5.3.4).

remaining_shift: shift of the centre of mass downhill from the settled bed, at the moment when the tank comes back to
the angle it began with, in mean grain diameters d; interpolated between samples.
kept_shift: the same divided by the largest shift until then. It is 100 % for a bed that stays where it slid to and 0
for a liquid.
Error: half the change of the shift over the last LAST of tilt before that moment: how far the bed still moved.
"""

from collections.abc import Mapping

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet, level, millimetres, note, thinned
from lab.measures.motion import is_tilt, outward_leg
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
UPRIGHT = 0.005  # of the largest tilt
LAST = 1.0  # deg


def applies(recording: Recording) -> bool:
    """The tank tilts and comes back."""
    return is_tilt(recording) and any(_upright(*loop(recording, w)[::2]) for w in range(recording.worlds))


def measure(recording: Recording) -> dict[str, Value]:
    """remaining_shift (d) and kept_shift (%)."""
    kept = np.array([_kept(*loop(recording, world)) for world in range(recording.worlds)])
    remains, error, largest = kept.T
    diameter, missing = recording.mean_diameter, "the tank does not come back upright"
    with np.errstate(divide="ignore", invalid="ignore"):
        shares = [np.where(largest > 0, 100 * part / largest, np.nan) for part in (remains, error)]
    return {
        "remaining_shift": over_worlds(
            remains / diameter, "d", uncertainties=error / diameter, kind="creep", missing=missing
        ),
        "kept_shift": over_worlds(shares[0], "%", uncertainties=shares[1], kind="creep", missing=missing),
    }


def loop(recording: Recording, world: int) -> tuple[np.ndarray, np.ndarray, int]:
    """Tilt (T,), deg, and shift downhill (T,), m, counted in the direction of the way out, and where that ends."""
    tilt = recording.series["pose"][:, world, ROLL]
    y = recording.series["centre_of_mass"][:, world, 0]
    leg = outward_leg(tilt)
    return leg.direction * np.degrees(tilt - tilt[0]), -leg.direction * (y - y[0]), leg.end


def _upright(tilt: np.ndarray, end: int) -> int | None:
    """The first row after `end` at which the tank stands upright again, at last within UPRIGHT; None without one."""
    back = tilt[end:]
    if not len(back) or back.min() > UPRIGHT * tilt.max():
        return None
    return end + int(np.argmax(back <= max(back.min(), 0.0)))


def _kept(tilt: np.ndarray, shift: np.ndarray, end: int) -> tuple[float, float, float]:
    """Shift that remains, its error, and the largest shift before (m); NaN for a tank that does not come back."""
    row = _upright(tilt, end)
    if row is None:
        return np.nan, np.nan, np.nan
    back = slice(end - 1, row + 1)
    remains, before = np.interp([0.0, LAST], tilt[back][::-1], shift[back][::-1])
    return float(remains), float(abs(remains - before) / 2), float(np.fmax.reduce(shift[: row + 1]))


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The shift against the tilt, out and back: what the bed keeps where the tank is upright again."""
    ((axes,),) = sheet.panels()
    for world, diameter in enumerate(recording.mean_diameter):
        tilt, shift, end = loop(recording, world)
        out, back = slice(end), slice(end - 1, None)
        names = (None, None) if world else ("way out", "way back")
        axes.plot(*thinned(tilt[out], shift[out] / diameter), color=BLUE, lw=1.2, alpha=0.8, label=names[0])
        axes.plot(*thinned(tilt[back], shift[back] / diameter), color=VERMILION, lw=1.2, alpha=0.8, label=names[1])
    remains = values.get("remaining_shift")
    for left in remains.worlds if remains else ():
        if left is not None:
            axes.plot(0, left, "o", color=VERMILION, ms=4, clip_on=False, zorder=3)
    axes.set_xlim(left=0)
    level(sheet, axes, remains, "remaining shift", GREEN)
    note(sheet, axes, values.get("kept_shift"), "kept of the largest shift")
    axes.axhline(0, color=GREY, lw=0.8)
    axes.set_xlabel("tilt (deg)")
    axes.set_ylabel("shift of the centre of mass\ndownhill (mean diameters)")
    millimetres(axes, 1e3 * recording.mean_diameter.mean())


FIGURES = {"hysteresis": draw}
