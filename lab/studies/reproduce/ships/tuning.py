"""How an anti-roll tank is tuned: the moment of the water that flows in it, against a roll that is forced on it.

Beyond the moment of its frozen water, about the axis of roll, water that swings as one gives (Lloyd 1989, chapter 20;
Stigter 1966)

    M/φ = (c − a ω²)²/(k (1 − ω²/ω_t² + 2iζ ω/ω_t)),

with numbers c, a and k of the tank; it lags by 90° at the tank's own frequency ω_t. In time this is an oscillator
q̈ + 2ζ ω_t q̇ + ω_t² q = ω_t² (φ + r φ̈), M = G (q + r q̈). Its four numbers are fitted to the whole records of all
frequencies together, with what still swings from the beginning. For a U-tube ω_t² = 2g/∫ A₀/A ds along its middle
line, A₀ and A the breadths of wings and tube; for a rectangular tank it is that of the first wave.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.measures.driven_load import along_motion, between
from lab.measures.steady import harmonics
from lab.preset.schema import Preset
from lab.report.plots import BELOW, BLUE, VERMILION, canvas
from lab.studies.reproduce.experiment import Found, Row
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from solvers.ship.potential.sloshing import SloshingLiquid

SETTLED = 0.4  # of a run, at its end, of which points of the figure are
FIRST = 5  # samples, of which the mean moment at rest is taken
GUESS = 0.05  # damping with which the fit begins
RECTANGLE = 4  # corners


@dataclass(frozen=True)
class Swing:
    """Roll (rad) and the moment (N m a metre of tank) beyond that of the frozen water, at even times (s)."""

    time: np.ndarray
    roll: np.ndarray
    moment: np.ndarray
    frequency: float  # rad/s, of the roll

    @property
    def answer(self) -> complex:
        """Moment over roll where it has SETTLED."""
        part = slice(int((1.0 - SETTLED) * len(self.time)), None)
        pair = np.stack([self.moment, self.roll], axis=1)[part]
        moment, roll = harmonics(self.time[part], pair, self.frequency / (2.0 * np.pi), (1,))[0]
        return complex(moment / roll)


def swing(one: Outcome) -> Swing:
    """What flows in a run, about the axis of roll."""
    recording = one.recording
    motion, preset, series = recording.preset.motion.roll, recording.preset, recording.series
    time, roll = between(series["time"][:, None])[:, 0], between(series["pose"][:, :1, 2])[:, 0]
    place, volume = recording.frames["water_position"][0, 0].astype(float), recording.volume[0]
    mass = preset.water.density * preset.thickness * volume
    arm = place - np.array(motion.centre)
    turning, height = float((mass * (arm**2).sum(axis=1)).sum()), float((mass * arm[:, 1]).sum())
    gain = np.gradient(series["pose_rate"][:, 0, 2], series["time"])
    rigid = preset.run.gravity * height * np.sin(roll) - turning * between(gain[:, None])[:, 0]
    moment = along_motion(recording)[:, 0] - rigid
    return Swing(time, roll, moment - moment[1 : 1 + FIRST].mean(), 2.0 * np.pi * motion.frequency)


def oscillator(own: float, damping: float, reach: float, roll: np.ndarray, time: np.ndarray) -> np.ndarray:
    """The moment (n,) that such an oscillator gives, for G = 1."""
    push = roll + reach * np.gradient(np.gradient(roll, time), time)
    way = np.array([[0.0, 1.0], [-(own**2), -2.0 * damping * own]])
    from scipy.signal import lsim  # slow to import

    _, _, state = lsim((way, [[0.0], [own**2]], np.eye(2), np.zeros((2, 1))), push, time - time[0])
    return state[:, 0] + reach * (own**2 * push + state @ way[1])


def tuned(swings: Sequence[Swing], begin: float) -> tuple[float, float, float]:
    """Own frequency (rad/s), damping, and the share of the moment's power that the oscillator leaves over."""

    def left(numbers: np.ndarray) -> float:
        shapes = [oscillator(*numbers, one.roll[1:], one.time[1:]) for one in swings]
        found, wanted = np.concatenate(shapes), np.concatenate([one.moment[1:] for one in swings])
        size = (found @ wanted) / (found @ found)
        return float(((wanted - size * found) ** 2).sum() / (wanted**2).sum())

    from scipy.optimize import minimize  # slow to import

    best = minimize(left, (begin, GUESS, 0.0), method="Nelder-Mead", options={"xatol": 1e-4, "fatol": 1e-7})
    return float(best.x[0]), float(best.x[1]), float(best.fun)


def closed_form(preset: Preset) -> float:
    """The tank's own frequency (rad/s): of a U-tube by the lengths of its middle line, else of its first wave."""
    corners, depth, g = np.array(preset.tank.corners), preset.water.depth, preset.run.gravity
    if len(corners) == RECTANGLE:
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
        exact = closed_form(outcomes[0].recording.preset)
        own, damping, left = tuned([swing(one) for one in outcomes], exact)
        apart = f"{100.0 * (own / exact - 1.0):+.1f} %"
        told.append(Row(f"{name}: own frequency", f"{exact:.4g} rad/s", f"{own:.4g} rad/s", apart, "", None))
        told.append(Row(f"{name}: damping, of the critical", "", f"{damping:.3f}", "", "", None))
        told.append(Row(f"{name}: power of the moment that is not of one oscillator", "", f"{left:.1%}", "", "", None))
    return told


def figure(found: Found) -> Figure:
    """Size and lag of the moment of what flows against frequency; upright lines: own frequencies by closed form."""
    drawn, (upper, lower) = canvas((SIZE[0], 1.5 * SIZE[1]), 2, 1, sharex=True)
    for colour, (name, outcomes) in zip((BLUE, VERMILION), found.items(), strict=False):
        swings = [swing(one) for one in outcomes]
        omega, answer = np.array([one.frequency for one in swings]), np.array([one.answer for one in swings])
        upper.plot(omega, 1e-3 * np.radians(np.abs(answer)), "o-", color=colour, ms=4, label=name)
        lower.plot(omega, (np.degrees(-np.angle(answer)) + 90.0) % 360.0 - 90.0, "o-", color=colour, ms=4)
        for axes in (upper, lower):
            axes.axvline(closed_form(outcomes[0].recording.preset), color=colour, lw=0.8, ls="--")
    lower.axhline(90.0, color="0.6", lw=0.6)
    upper.set_ylabel("moment a degree of roll\n(kN m, a metre of tank)")
    lower.set_ylabel("lag behind roll (deg)")
    lower.set_xlabel("frequency of roll (rad/s)")
    drawn.legend(loc=BELOW, ncols=2)
    return drawn
