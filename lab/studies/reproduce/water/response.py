"""A gently swayed tank of a viscous liquid against frequency: how it rises at a wall, and how it loads the tank.

By linear theory a rectangular tank of a width l and a depth d that sways by y, e^(−iωt), sets the odd modes going. The
surface rises at a place x by Σ η_n cos q(x + l/2), q = nπ/l, and the force is that of the centre of mass,

    η_n = κ_n a_n ω² y/(ω_n² − ω²),   κ_n = q tanh qd, a_n = −4 l/(nπ)²,
    m ω² (y + Σ a_n η_n/2d) = (ω² A + iω B) y,

Graham & Rodriguez (1952), see `solvers.ship.potential.sloshing`; A is the added mass, B the damping, zero without
friction. Viscosity damps the modes, to leading order by 2νq² (Lamb 1932, §348). Here it counts in full: vertical
velocities sinh qz and sinh mz, m² = q² − iω/ν, no shear at the surface, and normal stress there (Lamb, §349, with the
depth d, walls that the liquid slides along, and the push −ÿ a_n of the tank).

The first mode is read off the frequencies nearest its own: with one mode ω⁴/|η|² is a parabola in ω².
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure

from lab.measures.driven_load import transfer
from lab.measures.steady import harmonics, steady_part
from lab.preset.sections.water.liquid import depth, spacing
from lab.report.plots import BELOW, BLUE, VERMILION, canvas
from lab.studies.reproduce.estimates import Verdict
from lab.studies.reproduce.experiment import Found, ReportSection, Row
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from solvers.ship.potential.sloshing import MODES, SloshingLiquid

NEAREST = 5  # points that tell the first mode
APART = 0.12  # of the first frequency: nearer to it, loads hang on how exactly it is met
PEAK, DECAY, LOAD = 0.01, 0.10, 0.03  # relative; of the liquid's mass
ASKED = "what a sound computation is expected to give"


@dataclass(frozen=True)
class Response:
    """Complex answers (n,) over the sway at frequencies (n,) rad/s: `rise` at the wall's gauge, `load` in N/m²."""

    omega: np.ndarray
    rise: np.ndarray
    load: np.ndarray

    @property
    def added_mass(self) -> np.ndarray:
        """A (n,) kg a metre of tank."""
        return self.load.real / self.omega**2

    @property
    def damping(self) -> np.ndarray:
        """B (n,) N s/m a metre of tank."""
        return self.load.imag / self.omega


@dataclass(frozen=True)
class Tank:
    """The liquid by linear theory, its viscosity (m²/s), and the place x (m) of its gauge from the middle."""

    liquid: SloshingLiquid
    viscosity: float
    gauge: float

    def response(self, omega: np.ndarray) -> Response:
        """What theory has at frequencies (n,) rad/s."""
        n, width, deep = 2.0 * np.arange(MODES) + 1.0, self.liquid.width, self.liquid.depth
        wave, across = n * np.pi / width, -4.0 * width / (n * np.pi) ** 2
        rate = -1j * omega[:, None]
        # Of a flow with cosh qz, what the layer adds, and the rise; all over cosh qd
        thin = np.sqrt(wave**2 + rate / self.viscosity)
        layer = -2.0 * wave**2 * np.tanh(wave * deep) / (thin**2 + wave**2)
        risen = (np.tanh(wave * deep) + layer) / rate
        stretched = 2.0 * self.viscosity * (wave + layer * thin / np.tanh(thin * deep))
        held = self.liquid.gravity * risen + rate / wave + stretched
        swing = omega[:, None] ** 2 * across * risen / held
        rise = (swing * np.cos(wave * (self.gauge + 0.5 * width))).sum(axis=1)
        moved = 1.0 + (across * swing).sum(axis=1) / (2.0 * deep)
        return Response(omega, rise, self.liquid.mass * omega**2 * moved)


def tank(one: Outcome) -> Tank:
    """The tank of a run by theory."""
    preset = one.recording.preset
    deep = depth(preset)
    liquid = SloshingLiquid(preset.tank.width, deep, (0.0, deep), preset.water.density, preset.run.gravity)
    (gauge,) = preset.gauges.values()
    return Tank(liquid, preset.water.kinematic_viscosity, gauge.y)


def response(outcomes: Sequence[Outcome]) -> Response:
    """What the runs of a grid of frequencies tell, by frequency."""
    found = []
    for one in outcomes:
        recording = one.recording
        time, drive = recording.series["time"], recording.preset.motion.sway
        part = steady_part(recording, time).rows
        level = recording.series["level_depth"][part, :, 0]
        sway = recording.series["pose"][part, :, 0]
        rise, moved = (harmonics(time[part], signal, drive.frequency, (1, 2))[0, 0] for signal in (level, sway))
        load = transfer(recording, part)[1, 0] / recording.preset.thickness
        # `harmonics` has e^(iωt), theory e^(−iωt)
        found.append((2.0 * np.pi * drive.frequency, np.conj(rise / moved), np.conj(load)))
    omega, rise, load = (np.array(column) for column in zip(*sorted(found, key=lambda row: row[0]), strict=True))
    return Response(omega.real, rise, load)


def first_mode(found: Response, near: float) -> tuple[float, float]:
    """Frequency (rad/s) and decay (1/s) of the mode whose frequency is near a number (rad/s): the parabola's.

    With one mode ω⁴/|η|² = ((ω_1² − ω²)² + 4β²ω²)/c² = (x² − 2(ω_1² − 2β²) x + ω_1⁴)/c², x = ω².
    """
    nearest = np.argsort(np.abs(found.omega - near))[:NEAREST]
    square = found.omega[nearest] ** 2 / near**2
    bend, slope, level = np.polyfit(square, square**2 / np.abs(found.rise[nearest]) ** 2, 2)
    own = np.sqrt(level / bend)
    return near * np.sqrt(own), near * np.sqrt(max(own + 0.5 * slope / bend, 0.0) / 2.0)


def report(found: Found) -> ReportSection:
    """The first mode and the loads of each run beside linear theory; the verdicts are on the finest run."""
    runs = {label: response(outcomes) for label, outcomes in found.items()}
    theory = tank(next(iter(found.values()))[0])
    finest = min(found, key=lambda label: spacing(found[label][0].recording.preset))
    rows = [row for label, one in runs.items() for row in _rows(label, one, theory, label == finest)]
    return ReportSection(rows, _figure(runs, theory), _table(runs, theory))


def _rows(label: str, one: Response, theory: Tank, judged: bool) -> list[Row]:
    """A run's first mode, and its loads away from it; with verdicts, if `judged`."""
    linear, near = theory.response(one.omega), float(theory.liquid.rates[0])
    (own, decay), (exact, lost) = first_mode(one, near), first_mode(linear, near)
    rows = []
    for name, ours, wanted, unit, within in (
        ("first natural frequency", own / (2.0 * np.pi), exact / (2.0 * np.pi), "Hz", PEAK),
        ("damping of the first mode, of critical", 100.0 * decay / own, 100.0 * lost / exact, "%", DECAY),
    ):
        off = ours / wanted - 1.0
        apart, allowed = f"{100.0 * off:+.2f} %", f"{100.0 * within:g} %: {ASKED}"
        told = f"{wanted:.4g} {unit}", f"{ours:.4g} {unit}", apart, allowed
        rows.append(Row(f"{name}, {label}", *told, _verdict(abs(off) <= within) if judged else None))
    away = np.abs(one.omega / near - 1.0) > APART
    mass = theory.liquid.mass
    for name, ours, wanted in (
        ("added mass", one.added_mass, linear.added_mass),
        ("damping over frequency", one.damping / one.omega, linear.damping / one.omega),
    ):
        off = (np.abs(ours - wanted) / mass)[away].max()
        quantity = f"{name}, {100.0 * APART:.0f} % and more off that frequency, largest difference, {label}"
        told = "", f"{100.0 * off:.3g} % of the liquid's mass", "", f"{100.0 * LOAD:g} %: {ASKED}"
        rows.append(Row(quantity, *told, _verdict(off <= LOAD) if judged else None))
    return rows


def _verdict(held: bool) -> Verdict:
    return Verdict.AGREES if held else Verdict.DIFFERS


def _table(runs: dict[str, Response], theory: Tank) -> list[list[str]]:
    """By frequency, theory's numbers and each run's: rise over sway, added mass over mass, and damping."""
    heads = ["frequency", *(f"{name}, {of}" for name in ("rise", "A/m", "B (N s/m)") for of in ("theory", *runs))]
    longest = max(runs.values(), key=lambda one: len(one.omega))
    linear = theory.response(longest.omega)
    rows = [heads]
    for omega in longest.omega:
        row = [f"{omega / (2.0 * np.pi):.3g} Hz"]
        for number in (
            lambda one, k: f"{abs(one.rise[k]):.3g}",
            lambda one, k: f"{one.added_mass[k] / theory.liquid.mass:.3f}",
            lambda one, k: f"{one.damping[k]:.3g}",
        ):
            for one in (linear, *runs.values()):
                at = np.flatnonzero(np.isclose(one.omega, omega))
                row.append(number(one, at[0]) if len(at) else "")
        rows.append(row)
    return rows


def _figure(runs: dict[str, Response], theory: Tank) -> Figure:
    """Rise, added mass and damping against frequency: theory's curves, and points."""
    figure, panels = canvas((SIZE[0], 2.0 * SIZE[1]), 3, 1, sharex=True)
    ends = [end for one in runs.values() for end in (one.omega.min(), one.omega.max())]
    curve = theory.response(np.linspace(0.97 * min(ends), 1.03 * max(ends), 800))
    drawn = [(curve, {"color": "0.45", "lw": 1.2, "label": "linear theory"})]
    for (label, one), colour, mark in zip(runs.items(), (VERMILION, BLUE), "o^", strict=False):
        drawn.append((one, {"color": colour, "ls": "none", "marker": mark, "ms": 4, "label": label}))
    for one, how in drawn:
        frequency = one.omega / (2.0 * np.pi)
        panels[0].plot(frequency, np.abs(one.rise), **how)
        panels[1].plot(frequency, one.added_mass / theory.liquid.mass, **how)
        panels[2].plot(frequency, one.damping, **how)
    panels[0].set(yscale="log", ylabel="rise near the wall\nover the sway")
    panels[1].set(ylabel="added mass\nover the liquid's")
    panels[2].set(ylabel="damping, a metre\nof tank (N s/m)", xlabel="frequency of the sway (Hz)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc=BELOW, ncols=4)
    return figure
