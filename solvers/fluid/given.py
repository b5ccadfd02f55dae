"""What a scene says of its water: the liquid, the particles' size, the models by name, and the gauges."""

from dataclasses import dataclass, replace
from typing import Annotated, ClassVar

import numpy as np

from solvers.fluid.inflow.inlet import Inlet
from solvers.machine.marks import Doc, EachWorld, Interval, NotOfBed, Unit
from solvers.machine.quantity import PLANE
from solvers.tank.given import Given


# A particle as it starts: position (m) and velocity over the earth (m/s) in the tank's axes, density deviation s = ρ/ρ0
# − 1, volume (m³, in the plane m²), and whether it is air. A motion that starts abruptly finds the water at rest.
def particles(*shape: int, axes: int = PLANE) -> np.ndarray:
    """An array of particles of water at the origin, at rest, without pressure or volume."""
    vectors = [("position", float, axes), ("velocity", float, axes)]
    return np.zeros(shape, np.dtype([*vectors, ("deviation", float), ("volume", float), ("gas", bool)]))


@dataclass(frozen=True)
class Gauge:
    """A pressure gauge in a wall: its middle, its length, and how fast it responds; in space a disc in a face.

    It shows the mean over its length or disc, through a first-order low-pass filter with the time constant `response`.
    """

    place: Annotated[tuple[float, float], Unit("m"), Doc("Middle of the sensor on the wall, y and z in the tank.")]
    length: Annotated[float, Unit("m"), Interval(ge=0), Doc("Length of the sensor along the wall.")] = 0.0
    response: Annotated[float, Unit("s"), Interval(ge=0), Doc("Time constant of the sensor.")] = 0.0
    x: Annotated[float, Unit("m"), Doc("Where its middle is along x, in space.")] = 0.0
    radius: Annotated[float, Unit("m"), Interval(ge=0), Doc("Radius of its disc, in space.")] = 0.0


@dataclass(frozen=True)
class Level:
    """A gauge of the water's depth above the floor at a place `y`, in space also `x` (m), of the tank's own axes."""

    y: Annotated[float, Unit("m"), Doc("Where the depth is measured, along the tank's floor.")]
    x: Annotated[float, Unit("m"), Doc("Where it is measured along x, in space.")] = 0.0


@dataclass(frozen=True)
class DampingZone:
    """A beach: from `start` to `end` (m), along y, water is damped, at the end at this `rate` (1/s)."""

    start: float
    end: float
    rate: float


@dataclass(frozen=True)
class Pull:
    """A force towards a fixed point, −`rate`² (r − centre) per mass (Monaghan & Rafiee 2013, eq. 4.1)."""

    rate: float  # 1/s
    centre: tuple[float, float] = (0.0, 0.0)  # m


@dataclass(frozen=True)
class Air:
    """The air in a tank with water, the second phase of its fluid; SI units.

    `density` ρ_a (kg/m³) of air that is not compressed, `sound_speed` c_a (m/s), which until `stiff_from` (s) is
    `soft_speed`; `alpha` the strength of its artificial viscosity or `kinematic` ν (m²/s) that of laminar flow,
    `tension` (N/m) of the surface between the phases, `interface` the name of what acts between them, and `cohesion`
    the pressure X (Pa) of that which has one; `reduced`: the height (m) of the surface at rest, if pressures are over
    those of this fluid at rest (`solvers.fluid.phases.reduced_pressure`), else None.
    """

    density: float = 1.2
    sound_speed: float = 10.0
    alpha: float = 0.01
    kinematic: float = 0.0
    tension: float = 0.0
    interface: str = "weighted"
    cohesion: float = 0.0
    soft_speed: float = 0.0
    stiff_from: float = 0.0
    reduced: float | None = None


@dataclass(frozen=True)
class Water:
    """The liquid of a scene and the models that compute it; SI units.

    `spacing` Δx (m) of the particles and `smoothing` h/Δx; `density` ρ0 (kg/m³); `sound_speed` c0 (m/s) of the weakly
    compressible liquid. `kernel`, `state`, `diffusion` and `viscosity` are names of the registries. `delta` is the
    strength δ of the diffusion of density; `alpha` that of the artificial viscosity, or `kinematic` ν (m²/s) that of
    laminar flow. `slip`: water slides freely along walls, else it sticks to them. `gap`: the gap (m) between the end
    walls, before and behind, that hold it back, too (`solvers.fluid.terms.end_walls`), 0: there are none. `full`: the
    tank has no free surface, so that walls may pull, and `background` is the pressure (Pa) that all of the fluid bears
    besides (Adami, Hu & Adams 2012, eq. 6: χ). `shifting`: the name of how particles are shifted to even their
    distances, for water of up to the `speed` (m/s). `walls`: whether the tank's outline holds the water; without, it
    moves freely in space. `edges`: those of the outline, by their first corners, whose force is told. `periodic`: axes,
    "y" or "z", along which space repeats itself with the tank's width or height, so that it has no walls there.
    `start`: the name of how water at rest is laid, "packed" or as a "lattice". `air`: what fills the tank besides,
    None: nothing. `model`: "sph", or "linear", "frozen" or "level", for which see `solvers.liquid`: linear waves have
    the share `swing_damping` of the critical damping. `added_mass`: "layer" or "none", whether a ship has the added
    mass of the wall particles on her own side. `damping`: the zones that take waves.
    """

    spacing: float
    sound_speed: float
    density: float = 1000.0
    smoothing: float = 2.0
    kernel: str = "wendland-c2"
    state: str = "linear"
    diffusion: str = "antuono"
    delta: float = 0.1
    viscosity: str = "artificial"
    alpha: float = 0.01
    kinematic: float = 0.0
    slip: bool = True
    gap: float = 0.0
    full: bool = False
    background: float = 0.0
    shifting: str = "none"
    speed: float = 0.0
    walls: bool = True
    periodic: tuple[str, ...] = ()
    pull: Pull | None = None
    gauges: tuple[Gauge, ...] = ()
    levels: tuple[Level, ...] = ()
    edges: tuple[int, ...] = ()
    start: str = "packed"
    model: str = "sph"
    swing_damping: float = 0.0
    added_mass: str = "none"
    air: Air | None = None
    damping: tuple[DampingZone, ...] = ()

    @property
    def softened(self) -> "Water":
        """As it is at the start, until its air is stiff; itself if its air does not change."""
        air = self.air
        if air is None or air.stiff_from <= 0.0:
            return self
        return replace(self, air=replace(air, sound_speed=air.soft_speed, stiff_from=0.0))

    @property
    def length(self) -> float:
        """Smoothing length h (m)."""
        return self.smoothing * self.spacing

    @property
    def reach(self) -> float:
        """Radius (m) of the kernels' support, 2h."""
        return 2.0 * self.length


@dataclass(frozen=True, eq=False)
class Fluid(Given):
    """The fluid of a scene: its `water`, the `particles` (W, n) as they start, and its steps.

    Those of air come last. `in_tanks`: how many particles are in each tank of a world, by their numbers one after the
    other; (): all are in the first. Fluid of different tanks never meets, though they may overlap in the plane. A step
    of the fluid is `substeps` steps of the scene, more than 1 in ships alone, and while its air is soft
    `soft_multiple`. Of each tank the last ones, so many as are `waiting`, are not there at the start: they enter
    through the `inlets`.
    """

    simple: ClassVar = False  # its kernels are long

    water: Water
    particles: Annotated[np.ndarray, EachWorld(lambda fluid: fluid.count), NotOfBed()]
    in_tanks: tuple[int, ...] = ()
    substeps: Annotated[int, NotOfBed()] = 1
    soft_multiple: Annotated[int, NotOfBed()] = 1
    waiting: Annotated[tuple[int, ...], NotOfBed()] = ()
    inlets: Annotated[tuple[Inlet, ...], NotOfBed()] = ()

    @property
    def worlds(self) -> int:
        """Number of worlds, W."""
        return len(self.particles)

    @property
    def count(self) -> int:
        """Number of particles in a world."""
        return self.particles.shape[1]

    @property
    def present(self) -> np.ndarray:
        """Which particles (n,) are there at the start."""
        found, fills = np.ones(self.count, dtype=bool), self.fills(len(self.waiting))
        for end, wait in zip(np.cumsum(fills), self.waiting, strict=False):
            found[end - wait : end] = False
        return found

    @property
    def wet(self) -> int:
        """How many of them are water; they come first."""
        return self.count - int(self.particles["gas"][0].sum())

    @property
    def moved(self) -> int:
        """How many of them are moved one by one: none of a liquid that is frozen, linear or level."""
        return self.count if self.water.model == "sph" else 0

    @property
    def softened(self) -> "Fluid":
        """As it is at the start, until its air is stiff."""
        return replace(self, water=self.water.softened)

    def fills(self, tanks: int) -> tuple[int, ...]:
        """How many particles are in each of so many tanks."""
        return self.in_tanks or (self.count, *[0] * (tanks - 1))

    def areas(self, tanks: int) -> np.ndarray:
        """Area (m²) of the fluid that is in each of so many tanks at the start, (W, tanks)."""
        fills, waiting = self.fills(tanks), self.waiting or (0,) * tanks
        rows = zip(np.cumsum(fills), fills, waiting, strict=True)
        parts = [self.particles["volume"][:, end - fill : end - wait].sum(axis=1) for end, fill, wait in rows]
        return np.stack(parts, axis=1)
