"""How an anti-roll tank is tuned: the moment of the water that flows in it, against a roll that is forced on it.

Beyond the moment of its frozen water, about the axis of roll, water that swings as one gives (Lloyd 1989, chapter 20;
Stigter 1966)

    M/φ = (c − a ω²)²/(k (1 − ω²/ω_t² + 2iζ ω/ω_t)),

whatever the numbers c, a and k. So it lags by 90° at the tank's own frequency ω_t, and tuning and damping are read from
its phase alone. For a U-tube ω_t² = 2g/∫ A₀/A ds along its
middle line, A₀ and A the breadths of wings and tube; for a rectangular tank it is that of the first wave.
"""

import numpy as np
from matplotlib.figure import Figure

from lab.measures.driven_load import transfer
from lab.preset.schema import Preset
from lab.report.plots import BELOW, BLUE, VERMILION, canvas
from lab.studies.reproduce.experiment import Found, Row
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from solvers.ship.potential.sloshing import SloshingLiquid

SETTLED = 0.4  # of a run, at its end, is looked at
AROUND = 3  # frequencies around a lag of 90 degrees, of which the slope of the phase is taken
LEAST = 4


def flowing(one: Outcome) -> complex:
    """Moment over roll (N m a metre of tank) beyond that of the frozen water, about the axis of roll."""
    recording = one.recording
    time = recording.series["time"]
    part = slice(int((1.0 - SETTLED) * len(time)), None)
    motion, preset = recording.preset.motion.roll, recording.preset
    place, volume = recording.frames["water_place"][0, 0].astype(float), recording.volume[0]
    mass = preset.water.density * preset.thickness * volume
    arm = place - np.array(motion.centre)
    turning = float((mass * (arm**2).sum(axis=1)).sum())
    height = float((mass * arm[:, 1]).sum())
    omega = 2.0 * np.pi * motion.frequency
    return complex(transfer(recording, part)[1, 0]) - omega**2 * turning - preset.run.gravity * height


def lags(outcomes: list[Outcome]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Frequencies (n,) rad/s in order, and there size (N m) and lag (deg, 0 to 360) of the moment behind roll."""
    omega = np.array([2.0 * np.pi * one.recording.preset.motion.roll.frequency for one in outcomes])
    moment = np.array([flowing(one) for one in outcomes])
    order = np.argsort(omega)
    return omega[order], np.abs(moment)[order], np.degrees(-np.angle(moment))[order] % 360.0


def tuned(omega: np.ndarray, lag: np.ndarray) -> tuple[float, float]:
    """Frequency (rad/s) of a lag of 90 degrees, and damping from the lags around it; NaN where it is not passed."""
    over = np.flatnonzero((lag[:-1] < 90.0) & (lag[1:] >= 90.0))
    if not len(over):
        return np.nan, np.nan
    k = int(over[0])
    own = float(omega[k] + (90.0 - lag[k]) / (lag[k + 1] - lag[k]) * (omega[k + 1] - omega[k]))
    near = np.argsort(np.abs(omega - own))[:AROUND]
    # tan(lag) = 2 ζ (ω/ω_t)/(1 − (ω/ω_t)²): a damping of each frequency, weighted by how far off it is
    share = omega[near] / own
    damping = 0.5 * (1.0 - share**2) / share * np.tan(np.radians(lag[near]))
    off = np.abs(share - 1.0)
    return own, float((off * damping).sum() / off.sum())


def closed_form(preset: Preset) -> float:
    """The tank's own frequency (rad/s): of a U-tube by the lengths of its middle line, else of its first wave."""
    corners, depth, g = preset.tank.corners, preset.water.depth, preset.run.gravity
    if len(corners) == LEAST:
        liquid = SloshingLiquid(float(np.ptp(corners[:, 0])), depth, (0.0, depth), preset.water.density, g)
        return float(liquid.rates[0])
    half, inner = np.unique(np.abs(corners[:, 0]))[::-1][:2]
    duct = float(np.unique(corners[:, 1])[1])
    wing = half - inner
    return float(np.sqrt(2.0 * g / (2.0 * (depth - 0.5 * duct) + wing * (half + inner) / duct)))


def rows(found: Found) -> list[Row]:
    """Tuning and damping of each tank, beside the closed form."""
    told = []
    for name, outcomes in found.items():
        omega, _, lag = lags(outcomes)
        own, damping = tuned(omega, lag)
        exact = closed_form(outcomes[0].recording.preset)
        apart = f"{100.0 * (own / exact - 1.0):+.1f} %"
        told.append(Row(f"{name}: own frequency", f"{exact:.4g} rad/s", f"{own:.4g} rad/s", apart, "", None))
        told.append(Row(f"{name}: damping, of the critical", "", f"{damping:.3f}", "", "", None))
        told += [
            Row(f"{name}: lag of its moment at {w:.3f} rad/s", "", f"{one:.0f} deg", "", "", None)
            for w, one in zip(omega, lag, strict=True)
        ]
    return told


def figure(found: Found) -> Figure:
    """Size and lag of the moment of what flows against frequency; upright lines: own frequencies by closed form."""
    drawn, (upper, lower) = canvas(SIZE, 2, 1, sharex=True)
    for colour, (name, outcomes) in zip((BLUE, VERMILION), found.items(), strict=False):
        omega, size, lag = lags(outcomes)
        upper.plot(omega, 1e-3 * size / np.degrees(1.0), "o-", color=colour, ms=4, label=name)
        lower.plot(omega, lag, "o-", color=colour, ms=4)
        for axes in (upper, lower):
            axes.axvline(closed_form(outcomes[0].recording.preset), color=colour, lw=0.8, ls="--")
    lower.axhline(90.0, color="0.6", lw=0.6)
    upper.set_ylabel("moment a degree of roll\n(kN, a metre of tank)")
    lower.set_ylabel("lag behind roll (deg)")
    lower.set_xlabel("frequency of roll (rad/s)")
    drawn.legend(loc=BELOW, ncols=2)
    return drawn
