"""Random pairs of grains, and kernels that evaluate the contact rules for all of them at once."""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.pose import posed, towards
from solvers.grains.shapes.rules.nodes import Nodes
from solvers.grains.shapes.rules.tracked import MINIMUM, SADDLE, Places, Tracked
from solvers.grains.shapes.tables import Tables
from solvers.machine import runtime
from solvers.machine.state import Axis, State
from tests.oracles.axes import axes
from tests.oracles.crossing import Placed

ROOM = 8  # contacts of a pair


@dataclass
class Pairs:
    """Shape numbers (n, 2), scales (n, 2), angles (n, 2) and places (n, 2, 2), of the first and the second grain."""

    shape: np.ndarray
    scale: np.ndarray
    angle: np.ndarray
    place: np.ndarray

    def placed(self, outlines: list[Contour], k: int) -> list[Placed]:
        """Both grains of pair k."""
        return [
            Placed(outlines[self.shape[k, n]].scaled(self.scale[k, n]), *self.place[k, n], self.angle[k, n])
            for n in range(2)
        ]

    def swapped(self) -> "Pairs":
        """The first in place of the second."""
        return Pairs(self.shape[:, ::-1], self.scale[:, ::-1], self.angle[:, ::-1], self.place[:, ::-1])

    def turned(self, angle: float) -> "Pairs":
        """All turned about the origin."""
        matrix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        return Pairs(self.shape, self.scale, self.angle + angle, self.place @ matrix.T)

    def mirrored(self, mirror: np.ndarray) -> "Pairs":
        """y → −y, where `mirror[k]` is the number of the mirror image of shape k."""
        return Pairs(mirror[self.shape], self.scale, -self.angle, self.place * [-1.0, 1.0])


def random_pairs(outlines: list[Contour], count: int, seed: int, gap: tuple[float, float]) -> Pairs:
    """Pairs at random angles whose polar radii towards each other leave so much of their sum between them."""
    random = np.random.default_rng(seed)
    shape = random.integers(0, len(outlines), (count, 2))
    scale, angle = random.uniform(0.5, 2.0, (count, 2)), random.uniform(-np.pi, np.pi, (count, 2))
    way = random.uniform(-np.pi, np.pi, count)
    reach = np.array(
        [
            [scale[k, n] * float(outlines[shape[k, n]].polar(way[k] + n * np.pi - angle[k, n])) for n in range(2)]
            for k in range(count)
        ]
    )
    distance = reach.sum(axis=1) * (1.0 + random.uniform(*gap, count))
    first = random.uniform(-1.0, 1.0, (count, 2))
    second = first + distance[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1)
    return Pairs(shape, scale, angle, np.stack([first, second], axis=1))


@ti.data_oriented
class Asked:
    """The contact rules for these outlines, evaluated for `count` pairs per kernel call."""

    def __init__(self, outlines: list[Contour], count: int, nodes: int = 100, precision: str = "f64"):
        runtime.initialise(1, precision=precision)
        arrays = State(precision)
        self.tables = Tables(arrays, outlines)
        self.nodes, self.tracked = Nodes(arrays, self.tables, outlines, nodes), Tracked(self.tables)
        self.shape, self.node = arrays.integers(axes(count, 2), "shape", "node")
        (self.scale,) = arrays.reals(axes(count, 2), "scale")
        (self.turn,) = arrays.reals(axes(count, 2, 2), "turn")
        (self.apart,) = arrays.reals(axes(count, 2), "apart")
        self.places = Places(arrays, Axis("unit", count), ROOM)
        (self.number,) = arrays.integers(axes(count), "number")
        (self.found,) = arrays.reals(axes(count, ROOM, 10), "found")
        (self.shallow,) = arrays.reals(axes(count, ROOM), "shallow")
        arrays.finish()
        self.arrays = arrays

    def load(self, pairs: Pairs) -> None:
        """Take these pairs."""
        self.shape.from_numpy(np.ascontiguousarray(pairs.shape, dtype=np.int32))
        self.scale.from_numpy(np.ascontiguousarray(pairs.scale))
        self.turn.from_numpy(np.stack([np.cos(pairs.angle), np.sin(pairs.angle)], axis=-1))
        self.apart.from_numpy(np.ascontiguousarray(pairs.place[:, 0] - pairs.place[:, 1]))

    def by_nodes(self, pairs: Pairs) -> np.ndarray:
        """Overlap, normal and point (n, 5) by the discrete rule, of all nodes."""
        self.node.fill(0)
        return self.by_nodes_beside(pairs, True)

    def by_nodes_beside(self, pairs: Pairs, all_nodes: bool = False) -> np.ndarray:
        """The same for the nodes of the previous call and their neighbours."""
        self.load(pairs)
        self._by_nodes(int(all_nodes))
        return self.found.to_numpy()[:, 0, :5]

    def scanned(self, pairs: Pairs, skin: float) -> tuple[np.ndarray, np.ndarray]:
        """How many contacts each pair has (n,), and what they are (n, ROOM, 10)."""
        self.load(pairs)
        self._scan(skin)
        return self.number.to_numpy(), self.found.to_numpy()

    def saddles(self) -> np.ndarray:
        """Overlaps (n, ROOM) at the saddles before the contacts that were scanned last, 0 where there is none."""
        return self.shallow.to_numpy()

    def followed(self, pairs: Pairs) -> np.ndarray:
        """The contacts after one step from where they were last."""
        self.load(pairs)
        self._follow()
        return self.found.to_numpy()

    @ti.func
    def outline(self, p, n: ti.template()):
        """A grain's outline."""
        return posed(self.shape[p, n], self.scale[p, n], ti.Vector([self.turn[p, n, 0], self.turn[p, n, 1]]))

    @ti.func
    def between(self, p):
        """From the second grain to the first."""
        return ti.Vector([self.apart[p, 0], self.apart[p, 1]])

    @ti.kernel
    def _by_nodes(self, all_nodes: ti.i32):
        for p in self.number:
            one, two = self.outline(p, 0), self.outline(p, 1)
            a, b = self.node[p, 0], self.node[p, 1]
            c, first, second = self.nodes.contact(one, two, self.between(p), a, b, all_nodes)
            self.node[p, 0], self.node[p, 1] = first, second
            for n in ti.static(range(5)):
                self.found[p, 0, n] = c[n]

    @ti.kernel
    def _scan(self, skin: ti.f64):
        for p in self.number:
            one, two = self.outline(p, 0), self.outline(p, 1)
            self.number[p] = self.tracked.scan(one, two, self.between(p), skin, self.places, p)
            self.follow(p)

    @ti.kernel
    def _follow(self):
        for p in self.number:
            self.follow(p)

    @ti.func
    def follow(self, p):
        """The contacts of a pair and the saddles between them, one step on."""
        one, two = self.outline(p, 0), self.outline(p, 1)
        for n in range(2 * self.number[p]):
            k = n // 2
            saddle = n % 2 == 1
            self.shallow[p, k] = ti.select(saddle, self.shallow[p, k], 0.0)
            if saddle and self.places.saddle_i[p, k] < 0.0:
                continue
            c = self.tracked.contact(
                True,
                ti.select(saddle, SADDLE, MINIMUM),
                one,
                two,
                self.between(p),
                ti.select(saddle, self.places.saddle_i[p, k], self.places.i[p, k]),
                ti.select(saddle, self.places.saddle_j[p, k], self.places.j[p, k]),
            )
            if saddle:
                self.shallow[p, k] = ti.max(c[0], 0.0)
            else:
                for m in ti.static(range(10)):
                    self.found[p, k, m] = c[m]
                self.places.i[p, k], self.places.j[p, k] = c[5], c[6]


def orientations(angle: np.ndarray) -> np.ndarray:
    """Cosines and sines (n, 2) of angles (n,) in rad, as kernels work them out."""
    runtime.initialise(1)
    arrays = State()
    given, (found,) = arrays.holding("given", angle, "pair"), arrays.reals(axes(len(angle), 2), "found")
    arrays.finish()
    _turn_towards(given, found)
    values = found.to_numpy()
    arrays.release()
    return values


@ti.kernel
def _turn_towards(angle: ti.template(), found: ti.template()):
    for k in angle:
        turn = towards(angle[k])
        found[k, 0], found[k, 1] = turn[0], turn[1]
