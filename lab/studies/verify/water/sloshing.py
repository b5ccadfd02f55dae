"""Free sloshing of tanks: frequencies from runs, against closed forms and a finite-element eigensolver."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.water.laplace import first_mode
from lab.studies.verify.water.scenes import (
    LATTICE,
    G,
    box,
    chamfered,
    errors_note,
    looks,
    order_line,
    resting,
    simulated,
    swing,
)
from solvers.fluid.given import Water

SECTION = "Water: waves"
PERIODS, A_PERIOD = 6.0, 16  # looks
PUSH = 0.02  # largest speed of the start, of √(g d)
FAST = "0.30 m, 105 mm"
CLOSE, COARSE = 0.01, 0.02  # what is allowed at the finest spacing, and at a coarse one
WHY = "dispersion of the particles' layers, c0 = 10 √(g d), amplitude"


@dataclass(frozen=True)
class Pool:
    """A tank of a width (m) with water of a depth (m), its floor's corners cut by `cut` (m); rows of layers to try."""

    width: float
    depth: float
    rows: tuple[int, ...]
    cut: float = 0.0

    @property
    def outline(self) -> np.ndarray:
        """Its outline, half as high again as the water or more."""
        height = max(1.5 * self.depth, self.cut + self.depth)
        return chamfered(self.width, height, self.cut) if self.cut else box(self.width, height)

    @property
    def rate(self) -> float:
        """ω (1/s) of the first mode of a box: ω² = (π g/l) tanh(π d/l) (Lamb 1932, §257)."""
        k = np.pi / self.width
        return float(np.sqrt(G * k * np.tanh(k * self.depth)))


BOXES = {
    "0.90 m, 93 mm": Pool(0.90, 0.093, (8, 12, 16)),
    "0.90 m, 355.6 mm": Pool(0.90, 0.3556, (8, 12, 16)),
    "0.30 m, 52.5 mm": Pool(0.30, 0.0525, (8, 12, 16)),
    FAST: Pool(0.30, 0.105, (8, 12, 16)),
    "1.73 m, 600 mm": Pool(1.73, 0.60, (8, 12, 16)),
    "S175's tank, 13.7 m, 1.2 m": Pool(13.699, 1.2, (6, 8, 12)),
    "an FLNG's tank, 0.20 m, 360 mm": Pool(0.20, 0.36, (24, 36, 48)),
}
CHAMFERS = {
    "105 mm, chamfers of 50 mm": Pool(0.30, 0.105, (8, 12, 16), 0.05),
    "105 mm, chamfers of 40 mm": Pool(0.30, 0.105, (8, 12, 16), 0.04),
    "105 mm, chamfers of 60 mm": Pool(0.30, 0.105, (8, 12, 16), 0.06),
    "105 mm, chamfers of 75 mm": Pool(0.30, 0.105, (12, 16, 24), 0.075),
    "52.5 mm, chamfers of 45 mm": Pool(0.30, 0.0525, (12, 16, 24), 0.045),
    "52.5 mm, chamfers of 30 mm": Pool(0.30, 0.0525, (12, 16, 24), 0.03),
    "52.5 mm, chamfers of 50 mm": Pool(0.30, 0.0525, (12, 16, 24), 0.05),
}


def slosh(pool: Pool, rows: int) -> float:
    """ω (1/s) of the centre of mass after water at rest was set going with the first mode's own flow."""
    sound = 10.0 * np.sqrt(G * pool.depth)
    water = Water(pool.depth / rows, sound)
    mode = first_mode(pool.outline, pool.depth)
    start = resting(water, pool.outline, pool.depth, lambda place: PUSH * sound / 10.0 * mode.flow(place))
    times, found = np.arange(1, round(PERIODS * A_PERIOD)) * 2.0 * np.pi / (mode.rate * A_PERIOD), []
    with simulated(start) as run:
        for time in looks(run, times):
            found.append((time, run.observe()["water_centre"][0, 0]))
    return swing(*np.array(found).T, mode.rate).rate


def compared(pools: dict[str, Pool], fast: bool) -> Found:
    """Frequencies of tanks by their names, each at its own spacings; the finest decides."""
    lines, notes, allowed = [], [], COARSE if fast else CLOSE
    for name, pool in pools.items():
        rows = pool.rows[:1] if fast else pool.rows
        solved = first_mode(pool.outline, pool.depth).rate
        exact, source = (solved, "finite elements") if pool.cut else (pool.rate, "ω² = (πg/l) tanh(πd/l)")
        found = [slosh(pool, count) for count in rows]
        lines.append(Line(name, found[-1] / (2.0 * np.pi), exact / (2.0 * np.pi), source, allowed, WHY, "Hz"))
        errors = [rate / exact - 1.0 for rate in found]
        lines += order_line(f"the frequency, {name}", [pool.depth / count for count in rows], errors, LATTICE)
        notes += errors_note(name, rows, "layers", errors)
    return Found(lines, notes=notes)


def boxes(fast: bool) -> Found:
    """Free sloshing of rectangular tanks."""
    found = compared({FAST: BOXES[FAST]} if fast else BOXES, fast)
    return Found([*found.lines, *eigensolver()], notes=found.notes)


def eigensolver() -> list[Line]:
    """The finite elements on boxes, where there is a closed form."""
    found = [(name, first_mode(pool.outline, pool.depth).rate, pool.rate) for name, pool in BOXES.items()]
    reason = "80 × 50 pairs of linear triangles, second order"
    form = "closed form"
    return [
        Line(f"finite elements, {name}", rate / (2 * np.pi), exact / (2 * np.pi), form, 1e-3, reason, "Hz")
        for name, rate, exact in found
    ]


def slanted(fast: bool) -> Found:
    """Free sloshing of tanks 0.30 m wide with both corners of the floor cut off at 45°."""
    return compared(dict(list(CHAMFERS.items())[:1]) if fast else CHAMFERS, fast)


CASES = (
    Case("water-slosh-box", SECTION, "Free sloshing of rectangular tanks", boxes),
    Case("water-slosh-chamfers", SECTION, "Free sloshing of tanks with slanted corners", slanted),
)
