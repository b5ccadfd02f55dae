"""The tilt at which the bed gives way, read from the shift of its centre of mass.

**Scale.** In a liquid cargo, a tilt by d(phi) shifts the centre of mass by (I/A) d(phi), as a ship's
centre of buoyancy moves by BM. Here I = L^3/12 is that of the free surface of width L and A = L h is
the area of the cargo, so I/A = L^2/(12 h); h is twice the height of the settled centre of mass. The
shift s downhill, divided by I/A, is therefore the angle by which the free surface has turned in the
tank. It is called the *give* b(phi). A bed at rest has db/dphi = 0. A surface that stays at its angle
of repose while the tank turns on has db/dphi = 1. On this scale the same thresholds hold for every
grain, tank and depth.

**Steps.** Steps are looked for on the way out only, up to where the tilt is first largest, in the
curve averaged over BIN of tilt. A step is where b rises faster than `creep + max(FLOW, 5 sigma)`.
Creep and sigma are those of the resting bed: the median and 1.4826 MAD of the rates db/dphi over
WINDOW that lie below the mean rate. The rise is detected by Page's cumulative sum (Page 1954): the
running sum of (db - limit dphi) rises by DECISION from its lowest point. That point is the onset; the
highest point before a fall by DECISION is the end. No sample is differentiated by itself, so the
result depends neither on noise nor on the sampling rate. A step that begins in the first WINDOW has
no rest before it, hence no onset, and is left out.

critical_angle: onset of the first main step. A main step has a give of at least MAIN and of at least
SHARE of the largest step's give. It is the angle of repose of Spandonidis (2016, 5.2.1 and 5.3.1):
where the surface flows on, initial reordering and heaps excluded. In wide tanks MAIN alone separates
avalanches from reordering (trial beds: a give of 2.3 to 16 deg against 0.2 to 1.1 deg). In small tanks
parts of the surface slide before the avalanche, hence SHARE; the tank must tilt well past the
avalanche, so that the largest step is recorded. A threshold in diameters would depend on the size of
the tank.
critical_step: the shift in that step (d, the mean grain diameter), creep left out.
first_slip_angle: onset of the first step at all, a give of DECISION: the first reordering or heap.
one_diameter_angle: where the shift first exceeds one d, creep included; it needs no detector.
main_steps: number of main steps.

Error of an onset: the spacing of the averaged samples, plus the tilt in which the sum rises from
the onset by DECISION. It is small for an avalanche and large where the bed begins to flow gently. The
scatter of beds is larger: see the standard deviation.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np

from lab.measures.drawing import BLUE, GREEN, POINTS, VERMILION, Sheet, band, mark, mean_label, millimetres, thinned
from lab.measures.motion import is_tilt, outward_leg
from lab.measures.value import Value, over_worlds
from lab.recording import Recording
from solvers.machine.quantity import ROLL

OF = "grains"
BIN = 0.05  # deg of tilt
WINDOW = 0.5  # deg of tilt
FLOW = 0.25  # of a liquid's rate
DECISION = 0.1  # deg of give
MAIN = 2.0  # deg of give
SHARE = 0.5  # of the largest step's give
NOISE = 8.0  # standard deviations that the sum may wander by chance
LEAST_BINS = 20


@dataclass(frozen=True)
class Step:
    """A rise of the give: where it begins and ends (deg of tilt), its height (deg of give)."""

    onset: float
    error: float
    end: float
    give: float


def applies(recording: Recording) -> bool:
    """The tank tilts."""
    return is_tilt(recording)


def measure(recording: Recording) -> dict[str, Value]:
    """critical_angle, first_slip_angle, one_diameter_angle (deg), critical_step (d), main_steps."""
    curves = [shift_curve(recording, world) for world in range(recording.worlds)]
    liquid = liquid_shift(recording)
    diameter = recording.mean_diameter
    steps = [find_steps(tilt, shift / scale) for (tilt, shift), scale in zip(curves, liquid, strict=True)]
    main = [_main(found) for found in steps]
    reached = max(tilt[-1] for tilt, _ in curves)
    shifted = [_first_beyond(tilt, shift, d) for (tilt, shift), d in zip(curves, diameter, strict=True)]
    return {
        "critical_angle": _onset(main, f"the bed does not flow up to {reached:.3g} deg"),
        "first_slip_angle": _onset(steps, f"no slip up to {reached:.3g} deg"),
        "critical_step": over_worlds(_firsts(main, "give") * liquid / diameter, "d", missing="no main step"),
        "one_diameter_angle": over_worlds(shifted, "deg", missing=f"no shift by one diameter up to {reached:.3g} deg"),
        "main_steps": over_worlds([len(found) for found in main], "1"),
    }


def _main(steps: list[Step]) -> list[Step]:
    """The steps that are avalanches."""
    least = max(MAIN, SHARE * max((step.give for step in steps), default=0.0))
    return [step for step in steps if step.give >= least]


def shift_curve(recording: Recording, world: int) -> tuple[np.ndarray, np.ndarray]:
    """Tilt (T',), deg, and shift of the centre of mass downhill (T',), m, on the way out, while there is a bed."""
    tilt = recording.series["pose"][:, world, ROLL]
    leg = outward_leg(tilt)
    y = recording.series["centre_of_mass"][: leg.end, world, 0]
    turned, shift = leg.direction * (tilt[: leg.end] - tilt[0]), -leg.direction * (y - y[0])
    left = np.isfinite(shift)  # an open tank may have lost its last grain
    return np.degrees(turned)[left], shift[left]


def liquid_shift(recording: Recording) -> np.ndarray:
    """Shift of a liquid cargo per tilt (W,), m/deg: L^2 / (12 h), see above."""
    floor, width = recording.outline[:, 1].min(), np.ptp(recording.outline[:, 0])
    depth = 2 * (recording.series["centre_of_mass"][0, :, 1] - floor)
    return np.radians(width**2 / (12 * depth))


def find_steps(tilt: np.ndarray, give: np.ndarray) -> list[Step]:
    """Steps of a curve give (T,) over a tilt (T,) that never falls, both in deg, in their order."""
    tilt, give = _averaged(tilt, give)
    if len(tilt) < LEAST_BINS:
        return []
    creep, limit = _resting(tilt, give)
    total = give - limit * tilt
    least = max(DECISION, NOISE * _noise(give))
    steps = []
    for foot, alarm, peak in _rises(total, least):
        if tilt[foot] - tilt[0] >= WINDOW:
            spacing = float(np.median(np.diff(tilt)))
            error = spacing + tilt[alarm] - tilt[foot]
            risen = give[peak] - give[foot] - creep * (tilt[peak] - tilt[foot])
            steps.append(Step(tilt[foot], error, tilt[peak], risen))
    return steps


def _averaged(tilt: np.ndarray, give: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The curve averaged over bins of tilt; a coarser one stays as it is."""
    cells = np.floor((tilt - tilt[0]) / BIN).astype(int)
    _, cell, count = np.unique(cells, return_inverse=True, return_counts=True)
    return np.bincount(cell, tilt) / count, np.bincount(cell, give) / count


def _resting(tilt: np.ndarray, give: np.ndarray) -> tuple[float, float]:
    """Creep rate of the resting bed, and the rate beyond which it flows."""
    starts = tilt[tilt <= tilt[-1] - WINDOW]
    rates = (np.interp(starts + WINDOW, tilt, give) - np.interp(starts, tilt, give)) / WINDOW
    resting = rates[rates <= rates.mean()]
    creep = float(np.median(resting))
    sigma = _spread(resting)
    return creep, creep + max(FLOW, 5 * sigma)


def _noise(give: np.ndarray) -> float:
    """Standard deviation of white noise on a smooth curve, from its second differences."""
    return _spread(np.diff(give, 2)) / np.sqrt(6)


def _spread(values: np.ndarray) -> float:
    """Standard deviation of normal numbers (n,) by the median of their distances from the median."""
    return float(np.median(np.abs(values - np.median(values))) / NormalDist().inv_cdf(0.75))


def _rises(total: np.ndarray, least: float) -> list[tuple[int, int, int]]:
    """Foot, alarm and peak of each rise of at least `least`, ended by a fall of as much or the end."""
    rises, foot, alarm, peak = [], 0, None, 0
    for k, value in enumerate(total):
        if alarm is None:
            if value <= total[foot]:
                foot = k
            elif value - total[foot] >= least:
                alarm = peak = k
        elif value >= total[peak]:
            peak = k
        elif total[peak] - value >= least:
            rises.append((foot, alarm, peak))
            foot, alarm = k, None
    if alarm is not None:
        rises.append((foot, alarm, peak))
    return rises


def _firsts(steps: list[list[Step]], name: str) -> np.ndarray:
    return np.array([getattr(found[0], name) if found else np.nan for found in steps])


def _onset(steps: list[list[Step]], missing: str) -> Value:
    """Onset of the first step of each world."""
    errors = _firsts(steps, "error")
    return over_worlds(_firsts(steps, "onset"), "deg", uncertainties=errors, kind="detector", missing=missing)


def _first_beyond(tilt: np.ndarray, shift: np.ndarray, limit: float) -> float:
    """Tilt at which the shift first exceeds the limit, interpolated; NaN if it never does."""
    beyond = np.flatnonzero(shift > limit)
    if not len(beyond) or beyond[0] == 0:
        return np.nan
    k = beyond[0]
    part = (limit - shift[k - 1]) / (shift[k] - shift[k - 1])
    return float(tilt[k - 1] + part * (tilt[k] - tilt[k - 1]))


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """The shift of the centre of mass against the tilt, with the onsets found in it."""
    ((axes,),) = sheet.panels()
    worlds, diameters = recording.worlds, recording.mean_diameter
    curves = [shift_curve(recording, world) for world in range(worlds)]
    curves = [(tilt, shift / d) for (tilt, shift), d in zip(curves, diameters, strict=True)]
    if worlds > 1:
        for world, curve in enumerate(curves):
            label = None if world else f"each of {worlds} beds"
            axes.plot(*thinned(*curve), color=BLUE, alpha=0.4, lw=0.7, label=label)
    common = np.linspace(0, min(tilt[-1] for tilt, _ in curves), POINTS)
    together = np.stack([np.interp(common, *curve) for curve in curves], axis=1)
    band(axes, common, together, BLUE, mean_label(worlds))
    mark(sheet, axes, values.get("first_slip_angle"), "first slip", GREEN, ":")
    mark(sheet, axes, values.get("critical_angle"), "critical angle", VERMILION)
    found = values["critical_angle"].worlds if "critical_angle" in values else ()
    for onset, curve in zip(found, curves, strict=False):
        if onset is not None:
            axes.plot(onset, np.interp(onset, *curve), "o", color=VERMILION, ms=3.5)
    axes.set_xlabel("tilt (deg)")
    axes.set_xlim(0, max(tilt[-1] for tilt, _ in curves))
    axes.set_ylabel("shift of the centre of mass\ndownhill (mean diameters)")
    millimetres(axes, 1e3 * diameters.mean())


FIGURES = {"shift": draw}
