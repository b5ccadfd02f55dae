"""A ship's roll damping by Ikeda's components: from the lines of her hull, or from her particulars alone."""

from dataclasses import dataclass
from math import degrees, pi, sqrt
from pathlib import Path

import numpy as np

from lab.base.errors import LabError
from lab.naval.hull import Hull, read_hull
from lab.naval.tables import Table
from solvers.machine.errors import Unavailable
from solvers.ship.damping import components as parts
from solvers.ship.damping.components import FITTED, NAMES, Particulars, Slice
from solvers.ship.damping.keels import Keels
from solvers.ship.potential.strips import abeam, strips
from solvers.ship.water import Water

NEEDED = "length", "breadth", "draught", "block", "midship"
DRY = 1e-3  # of the draught and the breadth: a smaller section counts as dry


@dataclass(frozen=True)
class Asked:
    """What is asked: a hull's `file` with `draught` and `kg`, or the five particulars with `kg`; lengths in m.

    Of `period` (s), `gm` and `gyradius` (with added mass) two say how she rolls; with a file GM is known.
    `keels`: breadth and length; `amplitudes` in deg; `sea`: significant height (m) and peak period (s).
    """

    file: Path | None = None
    length: float | None = None
    breadth: float | None = None
    draught: float | None = None
    block: float | None = None
    midship: float | None = None
    kg: float | None = None
    keels: tuple[float, float] | None = None
    radius: float | None = None
    gm: float | None = None
    period: float | None = None
    gyradius: float | None = None
    amplitudes: tuple[float, ...] = (2.5, 5.0, 10.0, 15.0, 20.0, 25.0)
    density: float = 1025.0
    sea: tuple[float, float] | None = None
    peakedness: float = 3.3
    hours: float = 3.0


@dataclass(frozen=True, eq=False)
class Rolling:
    """A ship that rolls with a natural `frequency` (rad/s) and a `gm` (m); `hull` and `level` (m) if she has lines."""

    ship: Particulars
    frequency: float
    gm: float
    slices: tuple[Slice, ...] = ()
    hull: Hull | None = None
    waterplane: float = 0.0

    @property
    def mass(self) -> float:
        """Displacement (kg)."""
        one = self.ship
        return one.density * one.length * one.breadth * one.draught * one.block

    @property
    def spring(self) -> float:
        """C44 (N m/rad)."""
        return self.mass * self.ship.gravity * self.gm

    @property
    def inertia(self) -> float:
        """Inertia in roll with added mass (kg m²)."""
        return self.spring / self.frequency**2

    def share(self, damping: np.ndarray | float) -> np.ndarray | float:
        """ζ, the share of critical damping, of a damping (N m s)."""
        return damping / (2.0 * self.inertia * self.frequency)

    def table(self, frequency: np.ndarray):
        """Potential flow of her whole hull by strips in beam waves, about her centre of gravity."""
        form = self.hull.form
        found = strips(form, form.base + self.ship.draught, self.hull.water, frequency, form.base + self.ship.axis)
        return abeam(found, 1.0)


@dataclass(frozen=True, eq=False)
class Damping:
    """B44 (n, 5) N m s at `amplitudes` (n,) rad by NAMES.

    `linear` B₁ (N m s) and `quadratic` B₂ (N m s²) are those of all but the waves; `off` is their largest misfit, a
    share, from 2.5 to 25 deg.
    """

    rolling: Rolling
    amplitudes: np.ndarray
    parts: np.ndarray
    linear: float
    quadratic: float
    off: float

    @property
    def total(self) -> np.ndarray:
        """B44 (n,) N m s."""
        return self.parts.sum(axis=1)

    def table(self) -> Table:
        """Components in MN m s, their shares, B̂ and ζ at each amplitude."""
        header = ("amplitude deg", *(f"{name} MN m s" for name in NAMES), "total MN m s", "keels %", "B hat", "zeta")
        unit, shares = self.rolling.ship.unit, self.rolling.share(self.total)
        rows = []
        for turn, row, total, share in zip(self.amplitudes, self.parts, self.total, shares, strict=True):
            keels = 100.0 * row[3:].sum() / total if total else 0.0
            numbers = (f"{1e-6 * value:.4g}" for value in (*row, total))
            rows.append((f"{degrees(turn):.4g}", *numbers, f"{keels:.0f}", f"{total / unit:.4g}", f"{share:.4f}"))
        return header, rows


def prepare(asked: Asked) -> Rolling:
    """The ship that is asked about. Raises LabError for what is missing or cannot be."""
    if asked.kg is None:
        raise LabError("--kg: missing; the height of her centre of gravity above the keel line, m.")
    found = _of_lines(asked) if asked.file else _of_particulars(asked)
    ship = found.ship
    if ship.keels and ship.keels.length > ship.length:
        raise LabError(f"--keels: {ship.keels.length:g} m are longer than the ship; give breadth, then length, in m.")
    if ship.keels and ship.keels.breadth > 0.1 * ship.breadth:
        raise LabError("--keels: broader than a tenth of the ship; give breadth, then length, in m.")
    if ship.radius is not None and ship.radius > min(0.5 * ship.breadth, ship.draught):
        raise LabError("--radius: more than the draught or half the breadth; give that of the bilges, m.")
    return found


def compute(asked: Asked, rolling: Rolling) -> Damping:
    """Her damping at the amplitudes asked for. Raises LabError where the formulas do not reach."""
    ship, frequency = rolling.ship, rolling.frequency
    angles = np.radians(sorted(set(asked.amplitudes)))
    waves = None
    try:
        if rolling.hull:
            waves = float(rolling.table(np.array([frequency])).damping[0, 2, 2])
        found = parts.components(ship, frequency, angles, rolling.slices, waves)
        fitted = parts.components(ship, frequency, FITTED, rolling.slices, waves)
    except Unavailable as error:
        raise LabError(f"roll damping: {error}") from None
    viscous = fitted.sum(axis=1) - fitted[:, parts.WAVES]
    return Damping(rolling, angles, found, *parts.linear_quadratic(frequency, FITTED, viscous))


def _of_particulars(asked: Asked) -> Rolling:
    """A ship without lines."""
    if missing := [name for name in NEEDED if getattr(asked, name) is None]:
        raise LabError(f"--{missing[0]}: missing; give a file of her hull, or {', '.join(f'--{n}' for n in NEEDED)}.")
    gm, frequency = _motion(asked, asked.gm)
    keels = Keels(*asked.keels) if asked.keels else None
    numbers = (getattr(asked, name) for name in NEEDED)
    return Rolling(Particulars(*numbers, asked.kg, keels, asked.radius, asked.density), frequency, gm)


def _of_lines(asked: Asked) -> Rolling:
    """A ship with lines, upright at an even draught."""
    for name in ("length", "breadth", "block", "midship", "gm"):
        if getattr(asked, name) is not None:
            raise LabError(f"--{name}: the file of her hull tells it; leave it out.")
    if asked.draught is None:
        raise LabError("--draught: missing; her even draught, m.")
    hull = read_hull(asked.file, density=asked.density)
    one = hull.at(asked.draught)
    gm = one.km - hull.form.base - asked.kg
    if gm <= 0.0:
        raise LabError(
            f"--kg: at {asked.kg:g} m her GM is {gm:.3g} m, below zero; she has no period of roll; lower it."
        )
    gm, frequency = _motion(asked, gm)
    keels = Keels(*asked.keels) if asked.keels else None
    length = hull.form.perpendiculars
    particulars = (length, one.breadth, asked.draught, one.block, min(one.midship, 1.0), asked.kg)
    ship = Particulars(*particulars, keels, asked.radius, asked.density)
    return Rolling(ship, frequency, gm, _slices(hull, asked.draught), hull, one.waterplane)


def _motion(asked: Asked, gm: float | None) -> tuple[float, float]:
    """GM (m) and natural frequency (rad/s): T = 2π k/√(g GM). Raises LabError unless two of the three are given."""
    gravity = Water().gravity
    if asked.period and asked.gyradius and gm is None:
        gm = (2.0 * pi * asked.gyradius / asked.period) ** 2 / gravity
    elif asked.gyradius and asked.period:
        raise LabError("--gyradius: follows from GM and --period; leave one of the two out.")
    if gm is not None and asked.period:
        return gm, 2.0 * pi / asked.period
    if gm is not None and asked.gyradius:
        return gm, sqrt(gravity * gm) / asked.gyradius
    need = "--period or --gyradius" if asked.file else "two of --period, --gm and --gyradius"
    raise LabError(f"--period: missing; give {need}, the gyradius with added mass (0.35 to 0.40 of the breadth).")


def _slices(hull: Hull, draught: float) -> tuple[Slice, ...]:
    """Her sections under water."""
    form, found = hull.form, []
    for weight, section in zip(form.weights, form.sections, strict=True):
        if section is None:
            continue
        level = form.base + draught
        deep = level - float(section.outline[:, 1].min())
        breadth = float(section.waterplane(-level, 0.0).breadth)
        area = float(section.immersion(-level, 0.0).area)
        if deep > DRY * draught and breadth > DRY * draught and area > 0.0:
            found.append(Slice(float(weight), breadth, deep, area))
    return tuple(found)
