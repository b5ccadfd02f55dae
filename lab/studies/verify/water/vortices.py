"""Flows of a viscous liquid with a closed form: Taylor and Green's vortices, and a channel that starts to flow."""

import numpy as np

from lab.studies.case import Case, Found, Line, Picture, Table
from lab.studies.verify.water.drawing import profiles
from lab.studies.verify.water.scenes import (
    box,
    filled,
    grid,
    looks,
    order_line,
    scene,
    seen,
    simulated,
)
from solvers.fluid.given import Water
from solvers.fluid.start.flow import vortex_pressure
from solvers.fluid.start.flow import vortices as vortices_in

SECTION = "Water: viscous flow"
SIDE, SPEED, REYNOLDS = 1.0, 1.0, 100.0  # m, m/s
BOX = SIDE, SIDE
NU = SIDE * SPEED / REYNOLDS
K = 2.0 * np.pi / SIDE
ACROSS, UNTIL = (40, 60, 100), 0.5  # particles; s
WEIGHTLESS = 1e-12  # m/s²: the scene wants some gravity

HALF, CHANNEL, PULL = 0.5, 0.05, 0.4  # m, half a channel's width; m²/s; m/s²
FASTEST = PULL * HALF**2 / (2.0 * CHANNEL)
COLUMNS, TIMES = (10, 20, 40), (0.5, 1.0, 2.0, 10.0)  # s
FOURIER = 40


def swirl(place: np.ndarray) -> np.ndarray:
    """Velocities (n, 2) of Taylor and Green's vortices, 1 at most."""
    return vortices_in(place, BOX)


def decayed(count: int) -> float:
    """Error of the vortices' amplitude, in shares of it, at UNTIL with so many particles across."""
    water = Water(
        SIDE / count,
        10.0 * SPEED,
        viscosity="laminar",
        kinematic=NU,
        walls=False,
        periodic=("y", "z"),
        full=True,
        shifting="delta-plus",
        speed=SPEED,
    )
    drops = filled(
        grid(*BOX, water.spacing), water, lambda r: SPEED * swirl(r), lambda r: 1000.0 * vortex_pressure(r, BOX)
    )
    outline = SIDE * np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
    with simulated(scene(water, drops, outline, WEIGHTLESS)) as run:
        (time,) = looks(run, [UNTIL])
        place, velocity = seen(run)
    shape = swirl(place)
    amplitude = (velocity * shape).sum() / (shape**2).sum()
    return amplitude / (SPEED * np.exp(-2.0 * K**2 * NU * time)) - 1.0


def vortices(fast: bool) -> Found:
    """Decay of Taylor and Green's vortices, u ∝ exp(−8 π² ν t/L²) (Taylor & Green 1937), at Reynolds number 100."""
    counts = ACROSS[:1] if fast else ACROSS
    errors = [decayed(count) for count in counts]
    allowed = 0.05 if fast else 0.02
    reason = "the lattice breaks up where the flow parts, which takes energy; 5 % at 40 across"
    lines = [
        Line("amplitude, of the exact one", 1.0 + errors[-1], 1.0, "exp(−8π²νt/L²)", allowed, reason),
        *order_line("the amplitude", [SIDE / count for count in counts], errors, 2e-3),
    ]
    rows = [(str(count), f"{100 * error:.2f} %") for count, error in zip(counts, errors, strict=True)]
    note = f"Amplitude projected on the exact flow at {UNTIL:g} L/U, δ+ shifting, c0 = 10 U."
    return Found(lines, notes=[note], tables=[Table(("particles across", "error"), rows)])


def channel(across: np.ndarray, time: float) -> np.ndarray:
    """Velocity (m/s) at places across a channel from −HALF to HALF that a force PULL set going at time zero.

    G (h² − y²)/2ν − Σ 2 G (−1)^n/(ν h m³) cos(m y) exp(−ν m² t), m = (2n + 1) π/2h (Morris, Fox & Zhu 1997, eq. 23).
    """
    flow = PULL * (HALF**2 - across**2) / (2.0 * CHANNEL)
    for n in range(FOURIER):
        m = (2 * n + 1) * np.pi / (2.0 * HALF)
        part = np.cos(m * across) * np.exp(-CHANNEL * m**2 * time)
        flow = flow - 2.0 * PULL * (-1) ** n / (CHANNEL * HALF * m**3) * part
    return flow


def flowing(count: int) -> list[tuple[float, np.ndarray, np.ndarray]]:
    """Time (s), places (n,) m across and velocities (n,) m/s along a channel, at TIMES, with particles across."""
    spacing = 2.0 * HALF / count
    water = Water(
        spacing,
        10.0 * FASTEST,
        viscosity="laminar",
        kinematic=CHANNEL,
        slip=False,
        periodic=("z",),
        full=True,
    )
    place = grid(2.0 * HALF, HALF, spacing) - [HALF, 0.0]
    found = []
    with simulated(scene(water, filled(place, water, np.zeros_like), box(2.0 * HALF, HALF), PULL)) as run:
        for time in looks(run, TIMES):
            place, velocity = seen(run)
            found.append((time, place[:, 0], -velocity[:, 1]))
    return found


def poiseuille(fast: bool) -> Found:
    """A channel with walls that the liquid sticks to, from rest to Poiseuille's parabola."""
    counts = COLUMNS[:1] if fast else COLUMNS
    runs, lines, errors = [flowing(count) for count in counts], [], []
    allowed = 0.04 if fast else 0.01
    reason = "second order; 4 % with 10 particles across"
    for run in runs:
        errors.append([np.sqrt(((v - channel(y, t)) ** 2).mean()) / FASTEST for t, y, v in run])
    for k, time in enumerate(TIMES):
        source = "the parabola" if k == len(TIMES) - 1 else "Fourier series"
        name = f"velocity at {time:g} s, r.m.s. of the fastest"
        lines.append(Line.off(name, source, errors[-1][k], allowed, reason))
    spacings = [2.0 * HALF / count for count in counts]
    for k in (1, len(TIMES) - 1):
        lines += order_line(f"the velocity at {TIMES[k]:g} s", spacings, [one[k] for one in errors], 5e-4)
    caption = "Velocity across the channel as it starts to flow, of particles (points) and exact (lines)."
    figure = profiles(runs[-1], channel, HALF)
    return Found(lines, [Picture("water-channel", figure, caption)])


CASES = (
    Case("water-vortices", SECTION, "Taylor and Green's vortices", vortices),
    Case("water-channel", SECTION, "A channel that starts to flow", poiseuille),
)
