"""The masses on springs of each tank of a scene, and how its liquid moves with them."""

from dataclasses import dataclass

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.body import Body, frozen
from solvers.ship.potential.springs import BoxLiquid
from solvers.tank.tank import Tank

UPRIGHT = 1e-9  # of a tank's size: how far its corners may be off a rectangle's


@dataclass(frozen=True, eq=False)
class Modes:
    """The liquid of the tank of a number, per metre of its slab, in the tank's axes.

    `water` is the frozen liquid, `body` the rigid body that it makes together with masses that do not slide: the same
    but for its moment of inertia. The masses `mass` (k,) kg/m stand over the `middle` (m) of the floor at heights
    `height` (k,) m and swing at `frequency` (k,) rad/s with the `damping`, a fraction of the critical.
    """

    tank: int
    water: Body
    body: Body
    middle: float = 0.0
    mass: np.ndarray = ()
    height: np.ndarray = ()
    frequency: np.ndarray = ()
    damping: float = 0.0
    box: BoxLiquid | None = None
    floor: float = 0.0

    def moved(self, points: np.ndarray) -> np.ndarray:
        """By how much points (n, 2) m of the liquid move for each mass that moves by one metre, (n, 2, k).

        A wave of the elevation a sin κy over the floor's middle, κ = nπ/l, shifts the liquid's mass by m_n s =
        ρ a ∫ y sin κy dy, and moves its points by a (−cos κy cosh κz, sin κy sinh κz)/sinh κh, z from the floor up.
        """
        found = np.zeros((len(points), 2, len(self.mass)))
        for k in range(len(self.mass)):
            kappa = self.box.wave_numbers[k]
            y, z = points[:, 0] - self.middle, points[:, 1] - self.floor
            rise = self._rise(k)
            deep = np.sinh(kappa * self.box.depth)
            found[:, 0, k] = -rise * np.cos(kappa * y) * np.cosh(kappa * z) / deep
            found[:, 1, k] = rise * np.sin(kappa * y) * np.sinh(kappa * z) / deep
        return found

    def _rise(self, k: int) -> float:
        """Amplitude a of the wave of mode k for a mass that moves by one metre: m_n = ρ a 2 sin(κl/2)/κ²."""
        kappa = self.box.wave_numbers[k]
        return float(self.mass[k] * kappa**2 / (2.0 * self.box.density * np.sin(0.5 * kappa * self.box.width)))

    def level(self, y: float, way: np.ndarray) -> np.ndarray:
        """Depth (W,) m at a place y (m) with the masses moved by (W, modes) m."""
        depth = self.box.depth if self.box else self.water.centre[1] * 2.0
        found = np.full(len(way), depth)
        for k in range(len(self.mass)):
            found += way[:, k] * self._rise(k) * np.sin(self.box.wave_numbers[k] * (y - self.middle))
        return found


def modes_of(scene) -> list[Modes]:
    """Those of each tank of a scene (`solvers.scene.Scene`) that has water. Raises Unavailable."""
    ends, found, liquid = np.cumsum([0, *scene.fills]), [], scene.fluid.water
    for number, tank in enumerate(scene.tanks):
        particles = scene.fluid.particles[0, ends[number] : ends[number + 1]]
        if len(particles):
            density = liquid.density
            water = frozen(*particles["position"].T, density * particles["volume"], particles["volume"])
            found.append(
                _swinging(scene, number, tank, water)
                if scene.fluid.water.model == "linear"
                else Modes(number, water, water)
            )
    return found


def _swinging(scene, number: int, tank: Tank, water: Body) -> Modes:
    """The liquid of a box-shaped tank by linear potential theory."""
    low, high = tank.outline.min(axis=0), tank.outline.max(axis=0)
    box = np.array([low, [high[0], low[1]], high, [low[0], high[1]]])
    size = float((high - low).max())
    if len(tank.outline) != 4 or not all(
        np.abs(box - corner).max(axis=1).min() < UPRIGHT * size for corner in tank.outline
    ):
        raise Unavailable('water.model: "linear" is for box-shaped tanks; take "sph" or "frozen".')
    width = float(high[0] - low[0])
    depth = water.mass / scene.fluid.water.density / width
    liquid = BoxLiquid(width, depth, scene.fluid.water.density, scene.gravity)
    body = Body(water.mass, water.centre, liquid.turning)
    own = liquid.masses, float(low[1]) + liquid.heights, liquid.frequencies
    return Modes(
        number,
        water,
        body,
        float(0.5 * (low[0] + high[0])),
        *own,
        scene.fluid.water.swing_damping,
        liquid,
        float(low[1]),
    )
