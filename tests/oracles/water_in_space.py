"""Water in space for tests: boxes of it, and the step in plain numpy."""

import numpy as np

from lab.studies.verify.plain_water import PlainWater, kernel
from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.rest import at_rest
from solvers.fluid.walls.prism_layers import layers_of
from solvers.scene import Scene
from solvers.tank.solids.solid import Prism
from tests.oracles.water import GRAVITY, box


def pool(sides: tuple[int, int, int], rows: int, spacing: float, **changes) -> Scene:
    """A tank so many spacings wide, high and long with `rows` of water at rest; changes of the scene or its water."""
    width, height, along = (count * spacing for count in sides)
    depth, sound = rows * spacing, changes.pop("sound_speed", 10.0 * np.sqrt(GRAVITY * rows * spacing))
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    water = Water(**{"spacing": spacing, "sound_speed": sound, "smoothing": 1.5, "start": "lattice"} | of_water)
    solid = changes.pop("solid", Prism(along, "x" in water.periodic))
    drops = at_rest(box(width, height), depth, water, GRAVITY, along=along)
    return Scene(box(width, height), (Fluid(water, drops[None]),), solid=solid, gravity=GRAVITY, **changes)


class PlainWaterInSpace(PlainWater):
    """As `PlainWater` in the plane, in a box of which walls are where the solver lays them."""

    def __init__(self, scene: Scene):
        self.water, self.gravity = scene.fluid.water, np.array([0.0, -scene.gravity, 0.0])
        laid = layers_of(scene, self.water)
        self.wall, self.wall_volume = laid.points, laid.volumes
        corners, half = scene.outline, 0.5 * scene.solid.along
        self.lower, self.upper = np.append(corners.min(axis=0), -half), np.append(corners.max(axis=0), half)
        off = self.wall - np.clip(self.wall, self.lower, self.upper)
        self.normal = off / np.linalg.norm(off, axis=1)[:, None]
        foot = self.wall - off
        edges = np.minimum(foot - self.lower, self.upper - foot) + 1e9 * (np.abs(self.normal) > 0.5)
        away = np.hypot(edges.min(axis=1), np.linalg.norm(off, axis=1))
        inside = (np.count_nonzero(np.abs(off) > 0.0, axis=1) == 1) & (away > 1.5 * self.water.reach)
        self.is_straight = inside.astype(float)[:, None]
        self.felt, self.speed = np.tile(self.gravity, (len(self.wall), 1)), np.zeros_like(self.wall)

    def along_walls(self, r, mass, s) -> np.ndarray:
        """What is taken from the walls' push: no wall particle pushes along its face in sum."""
        volume = self.volume(mass, s)
        _, _, value, gradient = self.between(r, self.wall)
        seen = np.maximum(volume @ value, 1e-30)[:, None]
        steep = np.einsum("i,iwa->wa", volume, gradient)
        along = steep - (steep * self.normal).sum(axis=1, keepdims=True) * self.normal
        strength = (self.wall_volume * self.wall_pressure(r, mass, s))[:, None] * self.is_straight * along / seen
        return volume[:, None] * (value @ strength)

    def closing(self, r, u, s, mass, pressed) -> np.ndarray:
        """As in the plane; wall particles slide square to their normals."""
        volume = self.volume(mass, s)
        _, _, value, gradient = self.between(r, self.wall)
        seen = volume @ value
        mean = (volume * value.T) @ u / np.maximum(seen, 1e-30)[:, None] - self.speed
        slides = mean - (mean * self.normal).sum(axis=1, keepdims=True) * self.normal
        over = u[:, None] - self.speed - slides
        closed = np.where(pressed & (seen > 0.0), volume @ (over * gradient).sum(axis=2), 0.0)
        return value @ (self.wall_volume * closed / np.maximum(seen, 1e-30))

    def over(self, fullness: np.ndarray) -> np.ndarray:
        """By what share a fullness is over that of a cubic lattice."""
        n = np.arange(-4.0, 5.0)
        apart = np.sqrt(sum(one**2 for one in np.meshgrid(n, n, n))).ravel()
        return fullness / (-(kernel(apart, self.water.smoothing, 3)[1] * apart**2).sum() / 3.0) - 1.0


class EarthWaterInSpace(PlainWaterInSpace):
    """The same over the earth, in the earth's axes, where `moved(points, t)` are the tank's points (n, 3) m then.

    Velocities and accelerations of walls are differences of these in time.
    """

    def __init__(self, scene: Scene, moved, plane: float):
        super().__init__(scene)
        self.moved, self.inside, self.plane = moved, (self.wall, self.normal), plane

    def stand(self, time: float, step: float = 1e-4) -> None:
        """Put the walls where they are at a time (s)."""
        (wall, normal), h = self.inside, step
        before, self.wall, after = (self.moved(wall, time + more) for more in (-h, 0.0, h))
        self.normal = self.moved(wall + normal, time) - self.wall
        self.speed = (after - before) / (2.0 * h)
        self.felt = self.gravity - (after - 2.0 * self.wall + before) / h**2

    def step(self, r, u, s, mass, time: float, dt: float, packing: float, ramp: float) -> tuple[np.ndarray, ...]:
        """Places, velocities, half a step behind, and density deviations a step of dt (s) after a time (s)."""
        self.stand(time)
        push, slope, _ = self.push(r, u, s, mass)
        pressed = self.wall_pressure(r, mass, s) > 0.0
        full, lacking = self.void_indicator(r, mass, s, self.plane)
        u = u + dt * (push + self.gravity)
        middle = r + 0.5 * dt * u
        self.stand(time + 0.5 * dt)
        s = s + dt * (self.rate(middle, u, s, mass, slope, pressed) + self.keeping(full, lacking, s))
        relief = self.water.sound_speed / self.water.length * np.clip((packing - full) / ramp, 0.0, 1.0)
        return middle + 0.5 * dt * u, u, s / (1.0 + dt * relief)
