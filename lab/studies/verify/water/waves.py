"""A standing wave in a box: its rate and how it decays, against linear theory with viscosity."""

from dataclasses import dataclass

import numpy as np
from matplotlib.figure import Figure
from scipy.optimize import fsolve

from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.water.scenes import (
    LATTICE,
    G,
    Swing,
    box,
    looks,
    order_line,
    resting,
    seen,
    simulated,
    swing,
)
from solvers.fluid.given import Water
from solvers.scene import Scene

SECTION = "Water: waves"
DEPTH = WIDTH = 1.0  # m: the first mode has k H = π, a wavelength of two depths
K = np.pi / WIDTH
STEEP = 0.03  # k times the largest rise
VISCOSITY = np.sqrt(G * DEPTH) * DEPTH / 500.0  # m²/s: Reynolds number 500
SOUND = 10.0 * np.sqrt(G * DEPTH)
RATE = np.sqrt(G * K * np.tanh(K * DEPTH))  # 1/s, without viscosity
ROWS, PERIODS = (20, 40, 60), 8.0
A_PERIOD = 20  # looks


@dataclass(frozen=True)
class Wave:
    """The amplitude of the mode's velocity (T,) m/s at times (T,) s, and the oscillation that fits it."""

    time: np.ndarray
    amplitude: np.ndarray
    swing: Swing


def viscous() -> complex:
    """Growth rate s (1/s) of the mode in a viscous liquid over a floor that it slides on; −Re s is the decay.

    Vertical velocities sinh kz and sinh mz, m² = k² + s/ν, without shear on the surface, and with its normal stress
    (Lamb 1932, §349, for infinite depth; here with sinh, which a floor without shear leaves). For small ν,
    s = −2 ν k² ± iω (Lamb, §348): energy decays as exp(−4 ν k² t). The next order is that of the surface's own layer,
    a relative √(ν k²/ω)/√2; a floor and sides that water slides on have none.
    """

    def unbalanced(x: np.ndarray) -> list[float]:
        s = complex(*x) * RATE
        m = np.sqrt(K**2 + s / VISCOSITY)
        # The shares of sinh kz and of sinh mz/sinh mH, from 2 k² A sinh kH + (m² + k²) B = 0
        a, b = 1.0, -2.0 * K**2 * np.sinh(K * DEPTH) / (m**2 + K**2)
        risen = G * (a * np.sinh(K * DEPTH) + b) / s
        pressed = s / K * a * np.cosh(K * DEPTH)
        stretched = 2.0 * VISCOSITY * (a * K * np.cosh(K * DEPTH) + b * m / np.tanh(m * DEPTH))
        balance = (risen + pressed + stretched) * K / (RATE * np.cosh(K * DEPTH))
        return [balance.real, balance.imag]

    return complex(*fsolve(unbalanced, [-2.0 * VISCOSITY * K**2 / RATE, 1.0], xtol=1e-12)) * RATE


def between(lower: float, upper: float, viscosity: float) -> complex:
    """As `viscous`, of the surface between two fluids of these densities (kg/m³), each DEPTH deep, alike in ν (m²/s).

    In both there are sinh kz and sinh mz from floor and lid; at the surface velocities, shear and normal stress agree
    (Harrison 1908). Where densities are near each other, layers of shear on both sides of the surface take
    2 ρ ρ' k √(ων/2)/(ρ + ρ')² from the rate and add as much to the decay, for small ν and equal ν; waves under air have
    nearly nothing of that.
    """

    def unbalanced(x: np.ndarray) -> list[float]:
        s = complex(*x) * RATE
        m = np.sqrt(K**2 + s / viscosity)
        flow, layer = K / np.tanh(K * DEPTH), m / np.tanh(m * DEPTH)
        buoyant = (lower - upper) * G / s
        # Vertical speeds at the surface of flow and layer below, and of both above, in units of the whole below
        rows = [
            [1.0, 1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0, 1.0],
            [flow, layer, flow, layer],
            [2.0 * K**2 * lower, (m**2 + K**2) * lower, -2.0 * K**2 * upper, -(m**2 + K**2) * upper],
        ]
        below, thin, above, thin_above = np.linalg.solve(rows, [1.0, 1.0, 0.0, 0.0])
        pressed = s * flow / K**2 * (lower * below + upper * above)
        parted = lower * (flow * below + layer * thin) + upper * (flow * above + layer * thin_above)
        stretched = 2.0 * viscosity * parted
        balance = (buoyant + pressed + stretched) / (RATE * (lower + upper) / K)
        return [balance.real, balance.imag]

    inviscid = np.sqrt((lower - upper) / (lower + upper))
    return complex(*fsolve(unbalanced, [-2.0 * viscosity * K**2 / RATE, inviscid], xtol=1e-12)) * RATE


def mode(place: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of the first mode of a box, 1 at the surface at its sides."""
    y, z = place.T
    along = np.cos(K * y) * np.cosh(K * z), np.sin(K * y) * np.sinh(K * z)
    return np.stack(along, axis=1) / np.sinh(K * DEPTH)


def made(rows: int) -> Scene:
    """The wave on a level surface, with so many layers of particles."""
    spacing = DEPTH / rows
    water = Water(spacing, SOUND, alpha=8.0 * VISCOSITY / (2.0 * spacing * SOUND))
    return resting(water, box(WIDTH, 1.3 * DEPTH), DEPTH, lambda place: STEEP / K * RATE * mode(place))


def waved(rows: int) -> Wave:
    """The wave with so many layers of particles, from a level surface."""
    times, found = np.arange(1, round(PERIODS * A_PERIOD)) * 2.0 * np.pi / (RATE * A_PERIOD), []
    with simulated(made(rows)) as run:
        for time in looks(run, times):
            place, velocity = seen(run)
            shape = mode(place)
            found.append((time, (velocity * shape).sum() / (shape**2).sum()))
    time, amplitude = np.array(found).T
    later = time > 2.0 * np.pi / RATE  # when the surface's viscous layer is there
    return Wave(time, amplitude, swing(time[later], amplitude[later], RATE))


def standing(fast: bool) -> Found:
    """Period and decay of a standing wave at three spacings; the last decides."""
    rows = ROWS[1:2] if fast else ROWS
    waves, exact = [waved(count) for count in rows], viscous()
    spacings, best = [DEPTH / count for count in rows], waves[-1].swing
    source = "linear theory with viscosity"
    slack = "c0 = 10 √(g H) lowers ω by 0.1 %, steepness 0.03 by 0.01 %; the surface is known to half a spacing"
    lossy = "the surface is half a spacing thick, and diffusion and noise take energy too"
    lines = [
        Line("period", 2.0 * np.pi / best.rate, 2.0 * np.pi / RATE, "ω² = g k tanh kH", 0.01, slack, "s"),
        Line("decay of the kinetic energy", 2.0 * best.decay, -2.0 * exact.real, source, 0.05, lossy, "1/s"),
        *order_line("the period", spacings, [wave.swing.rate / exact.imag - 1.0 for wave in waves], LATTICE),
        *order_line("the decay", spacings, [-wave.swing.decay / exact.real - 1.0 for wave in waves], 0.01),
    ]
    shown = "; ".join(
        f"{count}: {100 * (exact.imag / wave.swing.rate - 1):.2f} %, {100 * (-wave.swing.decay / exact.real - 1):.1f} %"
        for count, wave in zip(rows, waves, strict=True)
    )
    lamb = 4.0 * VISCOSITY * K**2
    note = f"""Reynolds number √(g H) H/ν = 500, ν = α h c0/8, k H = π, a steepness of {STEEP:g}. Lamb's leading order,
    exp(−4 ν k² t), is a decay of {lamb:.4f}/s; the surface's viscous layer makes it
    {100 * (-2 * exact.real / lamb - 1):.1f} % of that less or more, which the reference has. Errors of period and
    decay by layers: {shown}."""
    return Found(lines, [Picture("water-wave", wave_figure(rows, waves, exact), CAPTION)], notes=[note])


CAPTION = "Amplitude of the standing wave's velocity; the lines are the envelope of linear theory with viscosity."


def wave_figure(rows: tuple[int, ...], waves: list[Wave], exact: complex) -> Figure:
    """Amplitudes against time, and the envelope of theory."""
    figure, axes = canvas((6.4, 3.0))
    for count, wave, colour in zip(rows, waves, (GREY, VERMILION, BLUE), strict=False):
        axes.plot(wave.time * RATE / (2.0 * np.pi), wave.amplitude, color=colour, label=f"{count} layers", lw=1.0)
    envelope = STEEP / K * RATE * np.exp(exact.real * waves[0].time)
    for sign in (1.0, -1.0):
        axes.plot(waves[0].time * RATE / (2.0 * np.pi), sign * envelope, color="black", ls="--", lw=0.8)
    axes.set(xlabel="periods", ylabel="velocity at the surface (m/s)")
    axes.legend()
    return figure


CASES = (Case("water-wave", SECTION, "A standing wave", standing),)
