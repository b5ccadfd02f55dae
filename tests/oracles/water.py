"""Water in plain numpy: lattices, scenes, and a step by double sums over all particles, without lists or blocks."""

import numpy as np

from solvers.fluid.given import EXCESS, VOLUME, Water, Y, Z
from solvers.fluid.walls.layers import layers
from solvers.scene import Scene
from solvers.simulation import Simulation

GRAVITY = 9.81


def box(width: float, height: float) -> np.ndarray:
    """Outline of a rectangular tank, its origin in the middle of the floor."""
    half = 0.5 * width
    return np.array([[-half, 0.0], [half, 0.0], [half, height], [-half, height]])


def lattice(width: float, depth: float, spacing: float, sound: float, left: float | None = None) -> np.ndarray:
    """Drops (1, n, 6) of a column of water at rest under gravity, from `left` (m) on, by default in the middle."""
    y = (np.arange(round(width / spacing)) + 0.5) * spacing + (-0.5 * width if left is None else left)
    z = (np.arange(round(depth / spacing)) + 0.5) * spacing
    grid = np.stack(np.meshgrid(y, z, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = np.zeros((1, len(grid), 6))
    drops[0, :, [Y, Z]] = grid.T
    drops[0, :, EXCESS] = GRAVITY * (depth - grid[:, 1]) / sound**2
    drops[0, :, VOLUME] = spacing**2
    return drops


def still(width: float, height: float, depth: float, rows: int, **changes) -> Scene:
    """A tank with `rows` layers of water at rest; changes of the scene or of its water."""
    spacing, sound = depth / rows, changes.pop("sound_speed", 10.0 * np.sqrt(GRAVITY * depth))
    of_water = {name: changes.pop(name) for name in list(changes) if name in Water.__dataclass_fields__}
    drops = changes.pop("drops", None)
    drops = lattice(width, depth, spacing, sound) if drops is None else drops
    water = Water(**{"spacing": spacing, "sound_speed": sound} | of_water)
    given = {"radius": np.zeros((len(drops), 0)), "outline": box(width, height), "gravity": GRAVITY}
    return Scene(**{**given, "water": water, "drops": drops, **changes})


def again(run: Simulation, scene: Scene) -> Simulation:
    """The same simulation with the water of another scene that differs in nothing else: it has its kernels already.

    The numbers of the water's models may differ, too, and with them the step, but where a ship or an axle has it.
    """
    if run.carrier.answers:
        assert run.dt < 1.01 * scene.time_step()
    else:
        run.dt, run.longest_step = scene.time_step(), scene.longest_step(1.0)
    if scene.water != run.scene.water:
        stiffening = run.water.stiffening
        stiffening.soft = stiffening.stiff = stiffening.now = scene.water
    run.scene, run.water.drops = scene, scene.drops
    run.alter(gravity=scene.gravity)
    run.start_clock()
    run.place(np.zeros((1, 0, 2)))
    return run


def kernel(distance: np.ndarray, length: float) -> tuple[np.ndarray, np.ndarray]:
    """Wendland's C2 kernel as printed, W(r), and W'(r)/r by its derivative, in the plane."""
    q = np.minimum(distance / length, 2.0)
    factor = 7.0 / (4.0 * np.pi * length**2)
    value = factor * (1.0 - 0.5 * q) ** 4 * (2.0 * q + 1.0)
    slope = factor * (-2.0 * (1.0 - 0.5 * q) ** 3 * (2.0 * q + 1.0) + 2.0 * (1.0 - 0.5 * q) ** 4)
    return value, slope / (length * np.maximum(distance, 1e-12))


class PlainWater:
    """The equations of a tank at rest with free slip, linear state, Antuono's diffusion and artificial viscosity."""

    liquid: np.ndarray | float = 1.0  # 1 for water, 0 for air

    def __init__(self, scene: Scene):
        self.water, self.gravity = scene.water, np.array([0.0, -scene.gravity])
        rows = int(np.ceil(scene.water.reach / scene.water.spacing))
        self.wall, self.wall_volume, _ = layers(scene.outline, scene.water.spacing, rows)
        off = self.wall - np.clip(self.wall, scene.outline.min(axis=0), scene.outline.max(axis=0))  # of a box
        self.along = np.stack([-off[:, 1], off[:, 0]], axis=1) / np.linalg.norm(off, axis=1)[:, None]
        away = np.linalg.norm(self.wall[:, None] - scene.outline, axis=2).min(axis=1)
        self.straight = self.along * (away > 1.5 * scene.water.reach)[:, None]

    def volume(self, mass: np.ndarray, s: np.ndarray) -> np.ndarray:
        """V = m/ρ."""
        return mass / (self.water.density * (1.0 + s))

    def between(self, r: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """r_j − r_i, its square, W and ∇_i W for all pairs."""
        apart = others[None] - r[:, None]
        square = (apart**2).sum(axis=2)
        value, slope = kernel(np.sqrt(square), self.water.length)
        return apart, square, value, -slope[..., None] * apart

    def wall_pressure(self, r: np.ndarray, mass: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Adami, Hu & Adams (2012), eq. 27, weighted with volumes and without pull."""
        volume = self.volume(mass, s)
        apart, _, value, _ = self.between(self.wall, r)
        pressure = self.water.density * self.water.sound_speed**2 * s
        total = (volume * value).sum(axis=1)
        lever = -(apart @ self.gravity) * mass + volume * pressure
        return np.where(total > 1e-6, np.maximum((value * lever).sum(axis=1), 0.0) / np.maximum(total, 1e-30), 0.0)

    def push(self, r, u, s, mass) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Accelerations without gravity, renormalised gradients of s, and the walls' forces on each particle."""
        water, volume = self.water, self.volume(mass, s)
        pressure = water.density * water.sound_speed**2 * s
        apart, square, _, gradient = self.between(r, r)
        pairs = -(pressure[:, None] + pressure[None]) * volume[:, None] * volume[None]
        pi = ((u[None] - u[:, None]) * apart).sum(axis=2) / (square + 1e-6 * water.length**2)
        viscous = water.alpha * water.length * water.sound_speed * water.density * volume[:, None] * volume[None] * pi
        force = ((pairs + viscous)[..., None] * gradient).sum(axis=1)
        _, _, _, at_wall = self.between(r, self.wall)
        push = np.maximum(pressure, 0.0)[:, None] + self.wall_pressure(r, mass, s)[None]
        walls = -((push * volume[:, None] * self.wall_volume[None])[..., None] * at_wall).sum(axis=1)
        walls += self.along_walls(r, mass, s)
        matrix = np.einsum("j,ija,ijb->iab", volume, apart, gradient)
        raw = np.einsum("j,ij,ija->ia", volume, s[None] - s[:, None], gradient)
        regular = np.linalg.eigvalsh(matrix)[:, 0] > 0.05
        slope = np.zeros_like(r)
        slope[regular] = np.linalg.solve(matrix[regular], raw[regular][..., None])[..., 0]
        return (force + walls) / mass[:, None], slope, walls

    def along_walls(self, r, mass, s) -> np.ndarray:
        """What is taken from that, so that the dummies' own pressures do not push along straight walls in sum."""
        volume = self.volume(mass, s) * self.liquid
        _, _, value, gradient = self.between(r, self.wall)
        seen = np.maximum(volume @ value, 1e-30)
        leans = (np.einsum("i,iwa->wa", volume, gradient) * self.straight).sum(axis=1) / seen
        strength = self.wall_volume * self.wall_pressure(r, mass, s) * leans
        return volume[:, None] * (value @ (strength[:, None] * self.straight))

    def closing(self, r, u, s, mass, pressed) -> np.ndarray:
        """Minus what dummies that are `pressed` add to the divergence: the adjoint of their pressures' forces.

        They slide with the mean velocity of the water, square to the shortest line to the tank.
        """
        volume = self.volume(mass, s) * self.liquid
        _, _, value, gradient = self.between(r, self.wall)
        seen = volume @ value
        mean = (volume * value.T) @ u / np.maximum(seen, 1e-30)[:, None]
        over = u[:, None] - (mean * self.along).sum(axis=1, keepdims=True) * self.along
        closed = np.where(pressed & (seen > 0.0), volume @ (over * gradient).sum(axis=2), 0.0)
        return self.liquid * (value @ (self.wall_volume * closed / np.maximum(seen, 1e-30)))

    def fullness(self, r: np.ndarray, mass: np.ndarray, s: np.ndarray, plane: float) -> tuple[np.ndarray, np.ndarray]:
        """½ Σ V (−W'/r) r² + b |Σ V ∇W| over water and dummies, b being `plane` (m), and its second part alone."""
        both, volume = np.concatenate([r, self.wall]), np.append(self.volume(mass, s), self.wall_volume)
        apart, _, _, gradient = self.between(r, both)
        trace = (apart * gradient).sum(axis=2) @ volume
        lacking = plane * np.linalg.norm(np.einsum("j,ija->ia", volume, gradient), axis=1)
        return 0.5 * trace + lacking, lacking

    def keeping(self, fullness: np.ndarray, lacking: np.ndarray, s: np.ndarray) -> np.ndarray:
        """Rate of s by which the density follows the room that is taken, in packed water away from the surface."""
        deep = np.where(fullness > 0.93, np.maximum(1.0 - lacking / 0.1, 0.0), 0.0)
        return (
            0.01
            * self.water.delta
            * self.water.sound_speed
            / self.water.length
            * deep
            * (1.0 + s)
            * self.over(fullness)
        )

    def over(self, fullness: np.ndarray) -> np.ndarray:
        """By what share a fullness is over that of a square lattice."""
        n = np.arange(-8.0, 9.0)
        apart = np.hypot(n[:, None], n[None]).ravel()
        lattice = -0.5 * (kernel(apart, self.water.smoothing)[1] * apart**2).sum()
        return fullness / lattice - 1.0

    def rate(self, r, u, s, mass, slope, pressed) -> np.ndarray:
        """Rate of s, in the middle of a step at whose start dummies were `pressed`."""
        water, volume = self.water, self.volume(mass, s)
        apart, _, _, gradient = self.between(r, r)
        flow = ((u[None] - u[:, None]) * gradient).sum(axis=2) @ volume
        _, _, _, at_wall = self.between(r, self.wall)
        flow += (-u[:, None] * at_wall).sum(axis=2) @ self.wall_volume
        flow -= self.closing(r, u, s, mass, pressed)
        more = 2.0 * (s[None] - s[:, None]) - ((slope[:, None] + slope[None]) * apart).sum(axis=2)
        eta = -kernel(np.linalg.norm(apart, axis=2), water.length)[1]
        return -(1.0 + s) * flow + water.delta * water.length * water.sound_speed * (more * eta) @ volume
