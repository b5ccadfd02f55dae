"""Small scenes of water made particle by particle, and what is read off their runs."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import least_squares

from lab.preset.outline import rectangle
from lab.studies.case import Line
from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.phases.adiabatic import background
from solvers.fluid.phases.reduced_pressure import ReducedPressure
from solvers.fluid.start.air import air_above, with_air
from solvers.fluid.start.rest import at_rest
from solvers.scene import Scene
from solvers.simulation import Simulation

G = 9.81  # m/s²
# Relative errors that need not fall with the spacing at a fixed h/Δx = 2: on a square lattice the sum V Σ y² ∂²W/∂y², 2
# for an integral, is 2.02, so that water under pressure is slightly elastic, and waves in it slightly off.
LATTICE = 0.01
# A function of places (n, 2) m that gives (n, 2) or (n,) values.
Field = Callable[[np.ndarray], np.ndarray]


def box(width: float, height: float) -> np.ndarray:
    """Outline of a rectangular tank, the middle of its floor at the origin."""
    return np.array(rectangle(width, height))


def chamfered(width: float, height: float, cut: float) -> np.ndarray:
    """The same with both corners of the floor cut off at 45°, by `cut` (m) along the floor and the side."""
    half = 0.5 * width
    corners = [[cut - half, 0.0], [half - cut, 0.0], [half, cut], [half, height], [-half, height], [-half, cut]]
    return np.array(corners)


def grid(width: float, height: float, spacing: float) -> np.ndarray:
    """Places (n, 2) m of particles that fill a rectangle evenly, its lower left corner at the origin."""
    y, z = ((np.arange(round(side / spacing)) + 0.5) * spacing for side in (width, height))
    return np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)


def filled(place: np.ndarray, water: Water, velocity: Field, pressure: Field | None = None) -> np.ndarray:
    """Drops (1, n) of a `water` with a linear state at places on its lattice, from fields of m/s and Pa."""
    drops = particles(1, len(place))
    drops["position"][0], drops["volume"] = place, water.spacing**2
    set_going(drops, velocity)
    if pressure is not None:
        drops["deviation"][0] = pressure(place) / (water.density * water.sound_speed**2)
    return drops


def set_going(drops: np.ndarray, velocity: Field) -> None:
    """Give drops (1, n) the velocities (m/s) of a field."""
    drops["velocity"][0] = velocity(drops["position"][0])


def scene(water: Water, drops: np.ndarray, outline: np.ndarray, gravity: float = G, **more) -> Scene:
    """A scene of water alone."""
    return Scene(outline, (Fluid(water, drops),), gravity=gravity, **more)


def resting(water: Water, outline: np.ndarray, depth: float, velocity: Field | None = None) -> Scene:
    """A tank with a depth (m) of water under its own pressure, at rest or set going with a field of velocities."""
    drops = at_rest(outline, depth, water, G)[None]
    if velocity is not None:
        set_going(drops, velocity)
    return scene(water, drops, outline)


@contextmanager
def simulated(of: Scene) -> Iterator[Simulation]:
    """A simulation on one core."""
    run = Simulation(of, threads=1, arch="cpu")
    try:
        yield run
    finally:
        run.close()


def looks(run: Simulation, times: Sequence[float]) -> Iterator[float]:
    """Advance to each of the times (s), to the nearest step; yields the time (s) reached."""
    for time in times:
        run.advance(round(time / run.dt) - run.steps)
        yield run.time


def seen(run: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 2) m and velocities (n, 2) m/s of the first world's particles now."""
    state = run.snapshot()
    return state["water_position"][0], state["water_velocity"][0]


def kept(run: Simulation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Places, velocities (n, 2) as the solver keeps them, half a step behind the places, and masses (n,) kg/m."""
    p = run.water.particles
    y, z, v, w, mass = (values[0] for values in p.read(*p.place, *p.velocity, p.mass))
    return np.stack([y, z], axis=1), np.stack([v, w], axis=1), mass


@dataclass(frozen=True)
class Swing:
    """A damped oscillation exp(−decay t) (A cos rate t + B sin rate t) + C; both in 1/s."""

    rate: float
    decay: float

    def basis(self, time: np.ndarray) -> np.ndarray:
        """Its three parts (T, 3) at the times (T,) s."""
        envelope = np.exp(-self.decay * time)
        parts = envelope * np.cos(self.rate * time), envelope * np.sin(self.rate * time), np.ones_like(time)
        return np.stack(parts, axis=1)

    def course(self, time: np.ndarray, value: np.ndarray) -> np.ndarray:
        """The oscillation (T,) with the A, B and C that fit the values (T,) best."""
        basis = self.basis(time)
        return basis @ np.linalg.lstsq(basis, value, rcond=None)[0]


def swing(time: np.ndarray, value: np.ndarray, rate: float) -> Swing:
    """The damped oscillation that fits values (T,) best by least squares, from about a `rate` (1/s) on."""
    time, value = np.asarray(time), np.asarray(value)
    fit = least_squares(lambda x: Swing(*(x * rate)).course(time, value) - value, [1.0, 0.01], xtol=1e-12, ftol=1e-12)
    return Swing(*(fit.x * rate))


def order(spacings: Sequence[float], errors: Sequence[float]) -> float:
    """Exponent with which errors fall with the spacing, by least squares of their logarithms."""
    return float(np.polyfit(np.log(spacings), np.log(np.abs(errors)), 1)[0])


def order_line(what: str, spacings: Sequence[float], errors: Sequence[float], noise: float) -> list[Line]:
    """A line of the order of convergence, at least first; none where the finest spacing's error is below the noise.

    Second order is the scheme's inside and first that of walls and surfaces, so that an error must fall at least as the
    spacing does, but for what the noise of both ends makes of the order. One that stays or grows with refinement is
    no convergence, however small it is.
    """
    if len(errors) < 2 or abs(errors[-1]) < noise:
        return []
    reason = f"errors known to {noise:.1g}; first order is that of walls and surfaces, second that inside"
    unsure = sum(noise / abs(one) for one in (errors[0], errors[-1])) / np.log(spacings[0] / spacings[-1])
    found, name = order(spacings, errors), f"order of the error of {what}"
    return [Line(name, found, 1.0, "consistency of the scheme", float(unsure), reason, relative=False, at_least=True)]


def errors_note(what: str, counts: Sequence[int], each: str, errors: Sequence[float]) -> list[str]:
    """A note of the relative errors at several spacings, with so many particles over `each`; none of one alone."""
    if len(errors) < 2:
        return []
    shown = ", ".join(f"{100.0 * error:.2f} %" for error in errors)
    return [f"{what}, with {', '.join(map(str, counts))} {each}: {shown}."]


def of_both(water: Water, outline: np.ndarray, depth: float) -> Scene:
    """A closed tank with a depth (m) of water and air over it, at rest."""
    return scene(water, with_air(at_rest(outline, depth, water, G), air_above(outline, depth, water, G))[None], outline)


def bearing(water: Water, over: float = 0.0) -> Water:
    """A water with the background pressure that presets have, under air of a height (m)."""
    return replace(water, background=background(water.air, water, ReducedPressure.hanging(water, G, over)))
