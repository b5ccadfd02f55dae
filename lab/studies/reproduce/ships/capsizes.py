"""What would capsize the barge as in the source: readings of its equation of roll, scanned without grains.

The source's barge rolls most below its natural frequency, so its righting lever must soften, and it capsizes with cargo
that has slid; ours does neither. Two readings could explain it, alone or together: another lever, and cargo that is
counted twice.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from math import pi, radians

import numpy as np
from matplotlib.figure import Figure

from lab.assembly.scene import vessels
from lab.preset.find import load
from lab.report.plots import BELOW, canvas
from lab.studies.reproduce.estimates import surely
from lab.studies.reproduce.experiment import EXACT, Kind, ReportSection, Row, observed
from lab.studies.reproduce.figures import leading_number
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships.rolls import DIGITS, FREQUENCY, PEAK, SIZE
from lab.studies.reproduce.ships.sliding_heap import HeapShip, box_heap, roll_with_heap, softening_lever
from solvers.ship.hydrostatics import metacentric_height, righting_levers
from solvers.ship.motion import RollDamping
from solvers.ship.outcome import CYCLES

PRESET = "ship/barge-roll"
CARGO = 23.9  # kg/m of the preset's bed, by its grains of 6 mm
VANISHING = radians(70.0)  # where the softening lever does: then 36 deg swing at 4.4/4.9 of the natural frequency
NATURAL = 2.0 * pi * 0.78  # rad/s, of the source's free roll
REPOSES = np.radians([17.0, 19.0, 21.0, 23.0, 25.0])  # of our beds and the source's first critical angle
INTERVAL, LASTS = 0.02, 60.0  # s: a roll is then within 0.1 deg
CAPSIZED = 0.5 * pi
FREQUENCIES = np.arange(40, 56) / 10.0  # rad/s
STEP = 0.1  # rad/s, of these
STEPS = f"{STEP:g} rad/s: the step of the scan"
AMPLITUDES = np.array([10.0, 15.0, 17.0, 19.0, 21.0, 25.0, 30.0])  # mm
SEEN = {17.0: (4.5,), 19.0: (4.4, 4.5, 4.6, 4.7)}  # mm and rad/s: where the source's capsizes


@dataclass(frozen=True, eq=False)
class Scan:
    """Results for ships in waves of all amplitudes (a,) mm and frequencies (f,) rad/s.

    `amplitude` (a, f) deg of the last cycles, NaN if none stayed upright, and `capsized` (a, f), the share of the
    angles of repose with which the ship capsized.
    """

    amplitudes: np.ndarray
    frequencies: np.ndarray
    amplitude: np.ndarray
    capsized: np.ndarray

    @property
    def peak(self) -> tuple[float, float]:
        """Largest amplitude (deg) in the lowest waves, and at which frequency (rad/s)."""
        highest = int(np.nanargmax(self.amplitude[0]))
        return float(self.amplitude[0, highest]), float(self.frequencies[highest])

    def lost(self, size: float) -> np.ndarray:
        """Frequencies (rad/s) at which she capsized in waves of an amplitude (mm) with half the reposes or more."""
        return self.frequencies[self.capsized[self.amplitudes == size][0] >= 0.5]


@cache
def box_barge() -> HeapShip:
    """The preset's, without damping, of any inertia."""
    resolved = load(PRESET).resolved
    given, ship = resolved.ship, vessels(resolved)[0].ship
    section, loading, water = ship.load.section, ship.body.loading, ship.load.water
    rolls = np.radians(np.linspace(-120.0, 120.0, 481))
    levers = righting_levers(section, loading, water, rolls)
    hold = np.ptp(resolved.tank.corners, axis=0)
    heap = box_heap(*hold, resolved.grains.depth, given.hold[1] - given.about[1], CARGO, REPOSES[-1])
    return HeapShip(
        loading.mass * water.gravity,
        metacentric_height(section, loading, water),
        lambda roll: np.interp(roll, rolls, levers),
        1.0,
        water.gravity,
        RollDamping(),
        heap,
    )


@dataclass(frozen=True, eq=False)
class Reading:
    """A lever, the barge's own or one that softens, and whether the cargo counts twice."""

    softens: bool
    twice: bool

    @property
    def words(self) -> str:
        """For a reader."""
        lever = "softening lever" if self.softens else "box's lever"
        return f"{lever}, cargo counted {'twice' if self.twice else 'once'}"

    @cached_property
    def ship(self) -> HeapShip:
        """The ship with the source's natural frequency while her loose cargo does not move."""
        barge, given = box_barge(), load(PRESET).resolved.ship
        lever = softening_lever(barge.height, VANISHING) if self.softens else barge.lever
        one = replace(barge, lever=lever, twice=self.twice).tuned(NATURAL)
        linear = 2.0 * given.damping * NATURAL * one.inertia
        return replace(one, damping=RollDamping(linear, given.quadratic_damping * one.inertia))

    @property
    def frozen(self) -> HeapShip:
        """The same ship with frozen cargo, counted once."""
        return replace(self.ship, heap=None, twice=False)

    @cached_property
    def scans(self) -> tuple[Scan, Scan]:
        """The scans with loose and with frozen cargo."""
        return scan(self.ship, AMPLITUDES, FREQUENCIES), scan(self.frozen, AMPLITUDES, FREQUENCIES)


def scan(ship: HeapShip, amplitudes: np.ndarray, frequencies: np.ndarray) -> Scan:
    """A ship in all waves, which meet her at once, as the source's do."""
    size, omega = (grid.ravel() for grid in np.meshgrid(amplitudes, frequencies, indexing="ij"))
    found = [one.reshape(len(amplitudes), -1) for one in swung(ship, size, omega)]
    return Scan(amplitudes, frequencies, *found)


def swung(
    ship: HeapShip, size: np.ndarray, omega: np.ndarray, soft_start: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Mean amplitude (k,) deg over the reposes, and the share of them with which she capsized.

    From rest in waves of amplitudes (k,) mm and frequencies (k,) rad/s, all at once.
    """
    count = len(REPOSES) if ship.heap else 1
    if ship.heap:
        ship = replace(ship, heap=replace(ship.heap, repose=np.repeat(REPOSES, len(size))))
    size, omega = np.tile(size, count), np.tile(omega, count)
    time, rolls = roll_with_heap(ship, 1e-3 * size, omega, INTERVAL, LASTS, CAPSIZED, soft_start)
    last = rolls[time > LASTS - CYCLES * 2.0 * pi / omega.min()]
    found = 0.5 * np.degrees(last.max(axis=0) - last.min(axis=0)).reshape(count, -1)
    lost = np.isnan(found)
    return np.ma.masked_array(found, lost).mean(axis=0).filled(np.nan), lost.mean(axis=0)


def report(found: Mapping[str, Sequence[Outcome]]) -> ReportSection:
    """Where each reading rolls most and capsizes, and how far the heap stands for the grains of the runs."""
    rows, maps = [], {}
    for reading in READINGS:
        loose, frozen = reading.scans
        rows += _rows(reading.words, loose, frozen)
        maps[reading.words] = loose
    rows.append(_heap_beside_grains(found))
    return ReportSection(rows, _figure(maps))


def _rows(words: str, loose: Scan, frozen: Scan) -> list[Row]:
    roll, frequency = frozen.peak
    first, stands, at = _first(loose), _first(frozen), loose.lost(19.0)
    ours = f"from {first:g} mm on" if first else "none up to 30 mm"
    kept = f"from {stands:g} mm on" if stands else "none up to 30 mm"
    fails = any(
        len(loose.lost(size)) for size in SEEN if size in loose.amplitudes
    )  # else that frozen cargo does not capsize her tells nothing
    held = surely(stands is None or stands > 19.0) if fails else None
    kept += "" if fails else "; not judged, loose cargo does not in 17 and 19 mm, either"
    there = len(at) > 0 and max(abs(at[0] - SEEN[19.0][0]), abs(at[-1] - SEEN[19.0][-1])) < 1.5 * STEP
    return [
        observed(
            f"{words}: frequency of the frozen peak in 10 mm",
            "4.4 rad/s",
            f"{frequency:g} rad/s",
            surely(abs(frequency - 4.4) < 1.5 * STEP),
            STEPS,
        ),
        observed(
            f"{words}: roll at that peak",
            f"{PEAK[0]:g} deg",
            f"{roll:.3g} deg",
            surely(abs(roll - PEAK[0]) <= DIGITS.within),
            DIGITS.words("deg"),
        ),
        observed(f"{words}: loose capsizes", "from 17 mm on", ours, surely(first == 17.0), EXACT),
        observed(
            f"{words}: loose capsizes in 19 mm", "at 4.4 to 4.7 rad/s", _where(at), surely(there), f"ends {STEPS}"
        ),
        observed(f"{words}: frozen capsizes", "not in 17 and 19 mm", kept, held, EXACT).against(Kind.SIGN),
    ]


def _first(scanned: Scan) -> float | None:
    """The lowest waves (mm) that capsize her."""
    return next((float(size) for size in scanned.amplitudes if len(scanned.lost(size))), None)


def _where(frequencies: np.ndarray) -> str:
    if not len(frequencies):
        return "not"
    low, high = frequencies[0], frequencies[-1]
    return f"at {low:g} rad/s" if low == high else f"at {low:g} to {high:g} rad/s"


def _heap_beside_grains(found: Mapping[str, Sequence[Outcome]]) -> Row:
    """The reading that the runs have, in their waves, with their soft start; batches go by their amplitudes."""
    steady = [
        (leading_number(name), leading_number(one.setting[FREQUENCY]), one["roll_amplitude"].value)
        for name, runs in found.items()
        for one in runs
        if one["roll_amplitude"].value is not None
    ]
    quantity = f"{READINGS[0].words}: heap and grains differ by"
    if not steady:
        return observed(quantity, "", "no run", None)
    size, omega, rolls = np.array(steady).T
    heap, _ = swung(READINGS[0].ship, size, omega, load(PRESET).resolved.waves.soft_start)
    apart = np.abs(heap - rolls)
    said = f"{apart.mean():.2g} deg on average, {apart.max():.2g} at most ({len(steady)} runs)"
    return observed(quantity, "", said, None)


def _figure(maps: Mapping[str, Scan]) -> Figure:
    """Share of the reposes with which loose cargo capsizes her, over the waves; crosses: the source's."""
    figure, panels = canvas(SIZE, 2, 2, sharex=True, sharey=True)
    for axes, (words, scanned) in zip(panels.flat, maps.items(), strict=True):
        levels = np.arange(len(scanned.amplitudes))
        drawn = axes.pcolormesh(scanned.frequencies, levels, scanned.capsized, vmin=0.0, vmax=1.0, cmap="Blues")
        seen = [(omega, level) for level, size in enumerate(scanned.amplitudes) for omega in SEEN.get(size, ())]
        axes.plot(*np.transpose(seen), "X", color="black", mfc="white", ms=7, label="the source's capsizes")
        axes.set_yticks(levels, [f"{size:g}" for size in scanned.amplitudes])
        axes.set_title(words.replace(", ", ",\n"), fontsize="small")
    for axes in panels[1]:
        axes.set_xlabel("frequency of the waves (rad/s)")
    figure.supylabel("amplitude of the waves (mm)", fontsize="medium")
    figure.colorbar(drawn, ax=panels, label="share of the reposes, 17 to 25 deg,\nwith which she capsizes", shrink=0.8)
    figure.legend(handles=[axes.lines[0]], loc=BELOW)
    return figure


READINGS = [Reading(softens, twice) for softens in (False, True) for twice in (False, True)]
