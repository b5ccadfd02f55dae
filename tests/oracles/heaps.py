"""Made-up heaps of spheres in a box for the tests of pictures in space; no solver had a part."""

from dataclasses import dataclass, field

import numpy as np

from lab.paint.cargo.looks import Stowage
from lab.paint.footage import Bed
from lab.paint.space.scene import SpaceScene
from lab.paint.space.walls import prism
from lab.preset.sections.video import Video

WIDTH, HEIGHT, ALONG = 0.30, 0.20, 0.15  # m, of the box
BOX = np.array([(-0.5 * WIDTH, 0.0), (0.5 * WIDTH, 0.0), (0.5 * WIDTH, HEIGHT), (-0.5 * WIDTH, HEIGHT)])


def heap(diameter: float, slope: float = 0.3, depth: float = 0.08, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 3) and radii (n,) m of spheres under a sloping surface: a lattice with gaps, shaken a little."""
    random = np.random.default_rng(seed)
    lines = [np.arange(-0.5 * WIDTH, 0.5 * WIDTH, diameter), np.arange(0.0, HEIGHT, 0.86 * diameter)]
    lines.append(np.arange(-0.5 * ALONG, 0.5 * ALONG, diameter))
    y, z, x = (axis.ravel() + 0.5 * diameter for axis in np.meshgrid(*lines, indexing="ij"))
    layer = np.round(z / (0.86 * diameter)) % 2
    place = np.column_stack([y + 0.4 * diameter * layer, z, x + 0.4 * diameter * layer])
    place += random.normal(0.0, 0.08 * diameter, place.shape)
    half = np.array([0.5 * WIDTH, HEIGHT, 0.5 * ALONG]) - 0.5 * diameter
    inside = (np.abs(place) <= half).all(axis=1) & (place[:, 1] < depth + slope * place[:, 0])
    place = place[inside]
    return place, 0.5 * diameter * random.choice([0.85, 1.0], len(place))


@dataclass
class MadeFootage:
    """A footage of spheres in a box in space, one world; position (F, n, 3) m, and how the box stands, (F, 6)."""

    position: np.ndarray
    radius: np.ndarray
    stance: np.ndarray
    time: np.ndarray
    open_edges: tuple[int, ...] = (2,)
    velocity: np.ndarray | None = None
    settings: Video = field(default_factory=Video)
    title: str = "Spheres in a box"

    def __post_init__(self) -> None:
        still = (np.zeros((len(self.time), 1, 0, 3)),) * 2
        self.space = SpaceScene.of(prism(BOX, ALONG, self.open_edges), [], (self.stance[:, None],) * 2, still)
        self.pose = self.series_pose = self.stance[:, None, [0, 1, 5]]
        self.series_time, self.outline, self.worlds = self.time, BOX, 1
        self.centre_of_mass = self.position.mean(axis=1)[:, None]
        self.spilled = np.zeros((len(self.time), 1))
        self.radius, self.kind = self.radius[None], np.zeros((1, len(self.radius)), dtype=int)
        self.kinds, self.shapes, self.shape_names = ["the rest"], None, ["disc"]
        self.cargo, self.matters, self.water, self.hold = Stowage(by_kind=("chickpeas",)), ("grains",), None, None
        self.bulk = None
        self.fixed, self.parts, self.bodies, self.rooms, self.floating = np.zeros((0, 4)), {}, [], {}, ()
        self.sea, self.rail, self.ends, self.basins = None, None, [None], []
        self.drive, self.protrudes = "tilt at 3°/s", bool(self.open_edges)
        if self.velocity is None:
            self.velocity = np.zeros_like(self.position)

    def grains(self, name: str, frame: float, world: int) -> np.ndarray:
        """The values of each grain in a frame; spins and angles are zero."""
        found = {"position": self.position, "velocity": self.velocity}.get(name)
        return np.zeros(len(self.radius[0])) if found is None else found[round(float(frame))]

    @property
    def bed(self) -> Bed:
        """The only bed."""
        return Bed(self, 0, "")


def tilted(diameter: float = 0.006, frames: int = 3, roll: float = -0.35, **more: object) -> MadeFootage:
    """A heap in a box that tilts to this roll (rad) about x through its origin."""
    place, radius = heap(diameter)
    share = np.linspace(0.0, 1.0, frames)
    stance = np.zeros((frames, 6))
    stance[:, 5] = roll * share
    return MadeFootage(np.tile(place, (frames, 1, 1)), radius, stance, 4.0 * share, **more)
