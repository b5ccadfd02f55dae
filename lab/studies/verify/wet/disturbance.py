"""A grain that falls alone: its own law of drag, and how it disturbs the water that it sees."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import j0, j1

from lab.studies.verify.water.scenes import G
from lab.studies.verify.wet.laws import DENSITY, di_felice
from lab.studies.verify.wet.scenes import solid_area
from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.timestep import kinematic

FARTHEST, WAVES, RADII = 20.0, 500, 2000  # wave numbers up to 20/h, so many; places at which the kernel is taken
ROUNDS, LOOKS = 3, 161
SLOWEST = 1e-9  # m/s


def fallen(times: np.ndarray, pushed: Callable[[float, float], float]) -> np.ndarray:
    """Distances and speeds (2, T), m and m/s, at times (T,) s of what falls from rest with v' = `pushed`(t, v)."""
    way = lambda t, x: [x[1], pushed(t, x[1])]  # noqa: E731
    return solve_ivp(way, (0.0, times[-1]), [0.0, 0.0], t_eval=times, rtol=1e-9, atol=1e-12).y


def alone(times: np.ndarray, size: float, density: float) -> np.ndarray:
    """`fallen` of a grain by its own law: ρ_g v' = (ρ_g − ρ) g − β v, water undisturbed."""

    def pushed(_: float, v: float) -> float:
        return ((density - DENSITY) * G - di_felice(max(v, SLOWEST), 1.0, size) * v) / density

    return fallen(times, pushed)


@dataclass(frozen=True)
class Disturbance:
    """What a falling grain does to the water it sees, to the first order of the share of room that it takes there.

    A grain of volume V_g is smeared by the kernel W over the slab's thickness b. The water sees it smeared once, and
    the grain sees the water smeared once more. So it sees the porosity 1 − φ, φ = (V_g/b) ∫ Ŵ² k dk/2π. What it
    displaces flows back: to keep water's volume, u = −(V_g/b) v P, with P the projection on gradients; since sums over
    neighbours tell divergences smeared by W, the flow makes up for that, and the grain sees −½ (V_g/b) W(0) v. Its drag
    f V_g pulls water along, seen with Ŵ², and half of it at once raises a pressure that holds the grain, ½ φ f. The
    wake is that of unsteady Stokes flow about a force that moves (own derivation, in an unbounded plane); ν is of the
    artificial viscosity. Horwitz & Mani (2016) tell the same of points in Stokes flow in space.
    """

    size: float
    density: float
    water: Water
    thickness: float

    def spectrum(self) -> tuple[np.ndarray, np.ndarray]:
        """Wave numbers (K,) 1/m and the kernel's transform Ŵ there."""
        h, reach = self.water.length, self.water.reach
        r = (np.arange(RADII) + 0.5) * reach / RADII
        weight = KERNELS[self.water.kernel].printed(r, h) * 2.0 * np.pi * r * reach / RADII
        k = (np.arange(WAVES) + 0.5) * FARTHEST / (h * WAVES)
        return k, j0(np.outer(k, r)) @ weight

    @property
    def seen(self) -> float:
        """φ, the share of its surroundings that a grain itself takes, as it sees them."""
        k, shape = self.spectrum()
        return float(solid_area(self.size, self.thickness) * (shape**2 * k).sum() * (k[1] - k[0]) / (2.0 * np.pi))

    @property
    def displaced(self) -> float:
        """(V_g/b) W(0)."""
        return float(solid_area(self.size, self.thickness) * KERNELS[self.water.kernel].factors(self.water.length)[0])

    def wake(self, times: np.ndarray, way: np.ndarray, drag: np.ndarray) -> np.ndarray:
        """Speed (T,) m/s of the wake at the grain, which fell `way` (T,) m with a drag (T,) N/m³, at times (T,) s."""
        k, shape = self.spectrum()
        nu, weight = kinematic(self.water), shape**2 * k * (k[1] - k[0]) / (2.0 * np.pi)
        past, at, felt = (0.5 * (x[1:] + x[:-1]) for x in (times, way, drag))
        found = np.zeros(len(times))
        for n in range(1, len(times)):
            turns = np.outer(way[n] - at[:n], k) + 1e-9
            fades = np.exp(-nu * np.outer(times[n] - past[:n], k**2))
            found[n] = ((j1(turns) / turns * fades) @ weight * felt[:n] * np.diff(times[: n + 1])).sum()
        return solid_area(self.size, self.thickness) / DENSITY * found

    def fallen(self, times: np.ndarray) -> np.ndarray:
        """`fallen` with all this: (ρ_g + ½ (V_g/b) W(0) ρ) v' = (ρ_g − ρ) g − (1 + ½ φ) f.

        The wake is found in rounds from the track before, which change it by less each.
        """
        grid, seen, back = np.linspace(0.0, times[-1], LOOKS), self.seen, 0.5 * self.displaced
        wake = np.zeros(LOOKS)

        def drag(t: float, v: float) -> float:
            slip = max(v * (1.0 + back) - float(np.interp(t, grid, wake)), SLOWEST)
            return di_felice(slip, 1.0 - seen, self.size) * slip

        def pushed(t: float, v: float) -> float:
            return ((self.density - DENSITY) * G - (1.0 + 0.5 * seen) * drag(t, v)) / (self.density + back * DENSITY)

        for _ in range(ROUNDS):
            way, speed = fallen(grid, pushed)
            wake = self.wake(grid, way, np.array([drag(t, v) for t, v in zip(grid, speed, strict=True)]))
        return fallen(times, pushed)
