"""The damping that the source's roll with frozen cargo implies: scans of the barge about a fixed axis, no grains."""

from collections.abc import Mapping, Sequence
from dataclasses import astuple, dataclass, replace
from math import pi

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

from lab.assembly.scene import vessels
from lab.preset.find import load
from lab.report.plots import BELOW, canvas
from lab.studies.reproduce.estimates import surely
from lab.studies.reproduce.experiment import EXACT, Kind, ReportSection, observed
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.fixed_axis import roll_together
from lab.studies.reproduce.ships.rolls import DIGITS
from solvers.ship.motion import RollDamping, Ship
from solvers.ship.outcome import outcome

PRESET = "ship/barge-roll"
INTERVAL, SETTLES = 0.04, 80.0  # s; so fine that a roll is within 0.1 deg, until its last ten periods are steady
CAPSIZED = 0.5 * pi  # rad
FREQUENCIES = np.arange(42, 62) / 10.0  # rad/s
PEAK = 36.0  # deg, of the source's frozen cargo in waves of 10 mm


@dataclass(frozen=True)
class Damping:
    """Damping of the roll: a fraction of the critical one, and a quadratic one per rad, as in the preset's [ship]."""

    linear: float = 0.0
    quadratic: float = 0.0

    @property
    def words(self) -> str:
        """For a reader."""
        parts = [f"{100.0 * self.linear:.2g} % of the critical"] * bool(self.linear)
        return " and ".join(parts + [f"{self.quadratic:.2g} per rad"] * bool(self.quadratic))


TRIED = {
    "linear": [Damping(share) for share in np.geomspace(0.003, 0.03, 8).tolist()],
    "quadratic": [Damping(0.0, share) for share in np.geomspace(0.01, 0.2, 8).tolist()],
}


@dataclass(frozen=True, eq=False)
class Response:
    """Steady amplitude (n,) deg of the roll at frequencies (n,) rad/s, from rest; not a number where she capsized."""

    frequency: np.ndarray
    amplitude: np.ndarray

    @property
    def capsized(self) -> np.ndarray:
        """Frequencies (rad/s) at which she did."""
        return self.frequency[np.isnan(self.amplitude)]

    @property
    def peak(self) -> tuple[float, float]:
        """Largest amplitude (deg), and at which frequency (rad/s)."""
        highest = int(np.nanargmax(self.amplitude))
        return float(self.amplitude[highest]), float(self.frequency[highest])


class Barge:
    """The barge of the preset with her cargo frozen, in regular waves of any of some frequencies (rad/s)."""

    def __init__(self, frequency: Sequence[float]):
        self.frequency = np.asarray(frequency, dtype=float)
        self.given = load(PRESET).resolved.ship
        unit = {"ship.damping": 1.0, "ship.quadratic_damping": 1.0, "waves.amplitude": "1 m"}
        ships = [load(PRESET, {**unit, "waves.frequency": f"{omega} rad/s"}).resolved for omega in self.frequency]
        self.ships = [vessels(one)[0].ship for one in ships]

    def responses(self, dampings: Sequence[Damping], amplitude: float) -> list[Response]:
        """To waves of an amplitude (m) with each damping."""
        ships = [self._ship(ship, damping, amplitude) for damping in dampings for ship in self.ships]
        time, rolls = roll_together(ships, self.given.heave, INTERVAL, SETTLES, CAPSIZED)
        sizes = [_steady(time, roll, ship.load.waves.frequency[0]) for roll, ship in zip(rolls.T, ships, strict=True)]
        return [Response(self.frequency, one) for one in np.reshape(sizes, (len(dampings), -1))]

    @staticmethod
    def _ship(ship: Ship, damping: Damping, amplitude: float) -> Ship:
        waves = replace(ship.load.waves, amplitude=amplitude * ship.load.waves.amplitude)
        scaled = RollDamping(damping.linear * ship.damping.linear, damping.quadratic * ship.damping.quadratic)
        return replace(ship, load=replace(ship.load, waves=waves), damping=scaled)


def _steady(time: np.ndarray, roll: np.ndarray, frequency: float) -> float:
    if not np.isfinite(roll).all():
        return np.nan
    return float(np.degrees(outcome(time, roll, frequency).amplitude))


def implied(tried: Sequence[Damping], responses: Sequence[Response], peak: float) -> Damping | None:
    """Interpolate the damping with the given peak (deg) between two of the increasing dampings tried, or None."""
    peaks = np.array([response.peak[0] for response in responses])
    above = np.flatnonzero(peaks >= peak)
    if not len(above) or above[-1] == len(tried) - 1:
        return None
    low, high = above[-1], above[-1] + 1
    share = (peaks[low] - peak) / (peaks[low] - peaks[high])
    mixed = (1.0 - share) * np.array(astuple(tried[low])) + share * np.array(astuple(tried[high]))
    return Damping(*mixed.tolist())


def safe(tried: Sequence[Damping], responses: Sequence[Response]) -> Damping | None:
    """The weakest of the increasing dampings tried from which on the barge never capsizes, or None."""
    lost = [index for index, response in enumerate(responses) if len(response.capsized)]
    first = lost[-1] + 1 if lost else 0
    return tried[first] if first < len(tried) else None


def report(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """The dampings that give the source's peak, and whether she survives the higher waves with them; needs no runs."""
    barge = Barge(FREQUENCIES)
    rows, curves = [], {}
    for name, tried in TRIED.items():
        one = implied(tried, barge.responses(tried, 0.010), PEAK)
        stands = safe(tried, barge.responses(tried, 0.019))
        if one is None:
            rows.append(observed(f"{name} damping for {PEAK:g} deg", "not named", "none", None))
            continue
        low, *higher = (barge.responses([one], amplitude)[0] for amplitude in (0.010, 0.017, 0.019))
        curves[one] = low
        rows.append(observed(f"{name} damping for {PEAK:g} deg", "not named", f"{one.words}, {_most(low)}", None))
        ends = "; ".join(f"{size} mm: {_end(one)}" for size, one in zip((17, 19), higher, strict=True))
        more = f"; none from {stands.words} on" if stands else ""
        kept = surely(not any(len(one.capsized) for one in higher))
        row = observed(f"with {one.words}, frozen", "no capsize in 17 and 19 mm", ends + more, kept, EXACT)
        rows.append(row.against(Kind.SIGN))
    ours = Damping(barge.given.damping, barge.given.quadratic_damping)
    curves[ours] = barge.responses([ours], 0.010)[0]
    near = surely(abs(curves[ours].peak[0] - PEAK) <= DIGITS.within)
    said = f"largest with {ours.words}, as run"
    rows.append(observed(said, f"{PEAK:g} deg", _most(curves[ours]), near, DIGITS.words("deg")))
    return ReportSection(rows, _figure(curves))


def _most(response: Response) -> str:
    roll, frequency = response.peak
    return f"{roll:.3g} deg at {frequency:g} rad/s"


def _end(response: Response) -> str:
    if len(response.capsized):
        return f"capsizes at {', '.join(f'{omega:g}' for omega in response.capsized)} rad/s"
    return f"rolls {_most(response)}"


def _figure(curves: Mapping[Damping, Response]) -> Figure:
    figure, axes = canvas(SIZE)
    colours = colormaps["viridis"](np.linspace(0.0, 0.75, len(curves)))
    for (damping, response), colour in zip(curves.items(), colours, strict=True):
        axes.plot(response.frequency, response.amplitude, "s--", ms=4, mfc="white", color=colour, label=damping.words)
    axes.axhline(PEAK, color="black", ls=":", lw=0.8, label="the source's peak")
    axes.set(xlabel="frequency of the waves (rad/s)", ylabel="mean amplitude of\nthe roll, frozen (deg)")
    axes.set_ylim(bottom=0.0)
    figure.legend(loc=BELOW, ncols=2)
    return figure
