"""Drops in free space whose shape is known: strained, pulled to a point, and nearly at rest."""

from dataclasses import dataclass

import numpy as np

from lab.measures.free_flow import ellipse, swing_period
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.water.drawing import courses
from lab.studies.verify.water.scenes import (
    LATTICE,
    box,
    errors_note,
    filled,
    looks,
    order_line,
    scene,
    seen,
    simulated,
    swing,
)
from solvers.fluid.given import Pull, Water
from solvers.fluid.start.flow import stirred
from solvers.fluid.start.packing import packed

SECTION = "Water: drops"
RADIUS = 1.0  # m
ACROSS = (20, 40, 80)  # particles
SIDES = 240  # of the polygon in place of a circle: 1e-4 less area
STRAIN, SOUND, UNTIL = 100.0, 1400.0, 7.6e-3  # 1/s, m/s, s
AXES = (1.9445, 0.5143)  # m, at UNTIL
RATE, SLOW = 1.0, 0.02  # 1/s: Ω, and the strain of small swings
LOUD = 20.0  # m/s: c0 of pulled drops, 14 times their fastest water
PERIODS, A_PERIOD = 2.0, 40  # looks
EXTREMES = (0.5176, 1.9319)  # m
PERIOD = 4.827 / RATE  # s, of a start with σ0 = Ω
EACH = "particles across"
SOURCE = "two equations for the axes"
FORM = "shape to a spacing's share, compressibility (speed/c0)² ≈ 0.5 %"


@dataclass(frozen=True)
class Course:
    """Half axes along y and z (T, 2) m at times (T,) s, and the energy (T,) J lost since the first."""

    time: np.ndarray
    axes: np.ndarray
    lost: np.ndarray


def exact(strain: float, rate: float, times: np.ndarray) -> np.ndarray:
    """Half axes (T, 2) m of a drop with u = σ (y, −z), σ = `strain` at first, pulled with −Ω² r, Ω = `rate` (1/s)."""
    return RADIUS * ellipse(strain, rate, times)


def strained(count: int, strain: float, rate: float, sound: float, times: np.ndarray, alpha: float) -> Course:
    """A drop of so many particles across, its pressure at first the exact one, ρ (σ² + Ω²)(R² − r²)/2."""
    pull = Pull(rate) if rate else None
    water = Water(2.0 * RADIUS / count, sound, alpha=alpha, walls=False, pull=pull)
    turns = np.linspace(0.0, 2.0 * np.pi, SIDES, endpoint=False)
    packing = packed(RADIUS * np.stack([np.cos(turns), np.sin(turns)], axis=1), RADIUS, water)
    place = packing.points
    squeezed = 0.5 * water.density * (strain**2 + rate**2)
    drops = filled(
        place,
        water,
        lambda r: stirred(r, strain, 0.0),
        lambda r: squeezed * (RADIUS**2 - (r**2).sum(axis=1)),
    )
    drops["volume"] = packing.volume
    first, found = np.sqrt((place**2).mean(axis=0)), []
    with simulated(scene(water, drops, box(4.0, 4.0), 0.0)) as run:
        begun = run.observe()["water_total"][0]
        for time in looks(run, times):
            axes = RADIUS * np.sqrt((seen(run)[0] ** 2).mean(axis=0)) / first  # lengths grow alike in such a flow
            found.append((time, axes, 1.0 - run.observe()["water_total"][0] / begun))
    time, axes, lost = (np.array(column) for column in zip(*found, strict=True))
    return Course(time, axes, lost)


def freely(fast: bool) -> Found:
    """A drop in free flight that is strained at 100/s (Monaghan 1994, eq. 4.4; half axes at 7.6 ms by integration)."""
    counts, times = ACROSS[:1] if fast else ACROSS, np.linspace(0.0, UNTIL, 20)[1:]
    runs = [strained(count, STRAIN, 0.0, SOUND, times, 0.01) for count in counts]
    wanted, last = exact(STRAIN, 0.0, np.array([UNTIL / 2.0, runs[-1].time[-1]]))[-1], runs[-1].axes[-1]
    allowed = 0.03 if fast else 0.01
    lines = [
        Line("longer half axis at 7.6 ms", last[0], AXES[0], SOURCE, allowed, FORM, "m"),
        Line("shorter half axis at 7.6 ms", last[1], AXES[1], SOURCE, allowed, FORM, "m"),
    ]
    spacings = [2.0 * RADIUS / count for count in counts]
    note = f"""c0 = 1400 m/s, 14 times the fastest water; the exact half axes at the step nearest to 7.6 ms are
    {wanted[0]:.4f} and {wanted[1]:.4f} m."""
    notes = [note]
    for k, name in enumerate(("longer", "shorter")):
        errors = [run.axes[-1, k] / exact(STRAIN, 0.0, run.time)[-1, k] - 1.0 for run in runs]
        lines += order_line(f"the {name} half axis", spacings, errors, LATTICE)
        notes += errors_note(f"The {name} half axis", counts, EACH, errors)
    return Found(lines, notes=notes)


def pulled(fast: bool) -> Found:
    """A drop that a point pulls with −Ω² r and that is strained by σ0 = Ω at first swings for ever."""
    counts, periods = (ACROSS[:1], 1.0) if fast else (ACROSS, PERIODS)
    times = PERIOD * np.arange(1, round(periods * A_PERIOD) + 1) / A_PERIOD
    runs = [strained(count, RATE, RATE, LOUD, times, 0.002) for count in counts]
    best, spacings = runs[-1], [2.0 * RADIUS / count for count in counts]
    found = [length(run) for run in runs]
    allowed = 0.03 if fast else 0.01
    reason = FORM + "; looks 40 to a period, with a parabola through the greatest"
    loss = "viscosity α = 0.002 takes 0.4 % at 80 across, diffusion as much; both fall with the spacing"
    lines = [
        Line("period", found[-1], PERIOD, SOURCE, allowed, reason, "s"),
        Line("longest half axis", best.axes[:, 0].max(), EXTREMES[1], SOURCE, allowed, reason, "m"),
        Line("shortest half axis", best.axes[:, 0].min(), EXTREMES[0], SOURCE, allowed, reason, "m"),
        Line.off("energy lost in a period", "no losses", best.lost[-1] / periods, 0.05 if fast else 0.01, loss),
        *order_line("the period", spacings, [one / PERIOD - 1.0 for one in found], LATTICE),
        *order_line("the energy", spacings, [run.lost[-1] for run in runs], 2e-3),
    ]
    shown = {
        "Period": [one / PERIOD - 1.0 for one in found],
        "Longest half axis": [run.axes[:, 0].max() / EXTREMES[1] - 1.0 for run in runs],
        "Shortest half axis": [run.axes[:, 0].min() / EXTREMES[0] - 1.0 for run in runs],
        "Energy lost in a period": [run.lost[-1] / periods for run in runs],
    }
    notes = [note for what, errors in shown.items() for note in errors_note(what, counts, EACH, errors)]
    curves = {f"{count} across": (run.time, run.axes[:, 0]) for count, run in zip(counts, runs, strict=True)}
    curves["exact"] = (times, exact(RATE, RATE, times)[:, 0])
    caption = "Half axis along y of a drop pulled to a point, σ0 = Ω = 1/s."
    return Found(lines, [Picture("water-drop", courses(curves, ("time (s)", "half axis (m)")), caption)], notes)


def length(run: Course) -> float:
    """Period (s): from the start to where the difference of the axes, zero at first, has risen through zero again."""
    found, gap = swing_period(run.time, run.axes, RATE), run.axes[-2:, 0] - run.axes[-2:, 1]
    if np.isfinite(found):
        return found
    return float(run.time[-1] - gap[1] * (run.time[-1] - run.time[-2]) / (gap[1] - gap[0]))  # just before the end


def small(fast: bool) -> Found:
    """Small swings of such a drop have the period 2π/(√2 Ω), from the same equations linearised."""
    counts, wanted = ACROSS[:1] if fast else ACROSS, 2.0 * np.pi / (np.sqrt(2.0) * RATE)
    times, found = wanted * np.arange(1, 41) / 20.0, []
    for count in counts:
        run = strained(count, SLOW, RATE, LOUD, times, 0.002)
        gap = run.axes[:, 0] - run.axes[:, 1]
        found.append(2.0 * np.pi / swing(run.time, gap, np.sqrt(2.0) * RATE).rate)
    spacings = [2.0 * RADIUS / count for count in counts]
    errors = [one / wanted - 1.0 for one in found]
    lines = [
        Line("period", found[-1], wanted, "2π/(√2 Ω)", 0.02 if fast else 0.01, FORM, "s"),
        *order_line("the period", spacings, errors, LATTICE),
    ]
    return Found(lines, notes=errors_note("Period", counts, EACH, errors))


CASES = (
    Case("water-ellipse", SECTION, "A strained drop", freely),
    Case("water-pulled", SECTION, "A drop pulled to a point", pulled),
    Case("water-pulled-small", SECTION, "Small swings of a drop pulled to a point", small),
)
