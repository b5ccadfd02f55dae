"""Collisions of two frictionless grains without losses, Hertz's force on each contact, by velocity Verlet."""

from dataclasses import dataclass

import numpy as np
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.pose import posed
from solvers.grains.shapes.rules.nodes import Nodes
from solvers.grains.shapes.rules.tracked import MINIMUM, SADDLE, Places, Tracked
from solvers.grains.shapes.tables import Tables
from solvers.machine import runtime
from solvers.machine.state import Axis, State
from tests.oracles.axes import axes

ROOM = 8
SKIN = 0.05
SCANS = 100  # in the time of a run


@dataclass
class Outcome:
    """After each run (n,): energy and angular momentum about the origin, momentum (n, 2), and the deepest overlap."""

    energy: np.ndarray
    spin: np.ndarray
    momentum: np.ndarray
    deepest: np.ndarray


@ti.data_oriented
class Collisions:
    """n runs of two equal grains of one outline, density 1; the rule is "nodes" or "tracked".

    State (2, 3) of each run: centre and angle, of which the second grain's are the second row, and their rates.
    """

    def __init__(self, outline: Contour, rule: str, count: int, stiffness: float, nodes: int = 200):
        runtime.initialise(1)
        self.rule, self.stiffness = rule, stiffness
        self.mass = [outline.mass(1.0), outline.mass(1.0), outline.inertia(1.0)]
        arrays = State()
        self.tables = Tables(arrays, [outline])
        if rule == "nodes":
            self.nodes = Nodes(arrays, self.tables, [outline], nodes)
        else:
            self.tracked = Tracked(self.tables)
        self.place, self.rate, self.push = arrays.reals(axes(count, 2, 3), "place", "rate", "push")
        self.places = Places(arrays, Axis("unit", count), ROOM)
        self.number, self.steps = arrays.integers(axes(count), "number", "steps")
        (self.deepest,) = arrays.reals(axes(count), "deepest")
        arrays.finish()

    def run(self, place: np.ndarray, rate: np.ndarray, time: float, steps: np.ndarray) -> Outcome:
        """What comes of these starts (n, 2, 3) after so much time in so many steps (n,), multiples of SCANS."""
        self.place.from_numpy(place)
        self.rate.from_numpy(rate)
        self.steps.from_numpy(steps.astype(np.int32))
        self.deepest.fill(0.0)
        self._run(time)
        place, rate = self.place.to_numpy(), self.rate.to_numpy()
        momentum = np.array(self.mass) * rate
        about = place[..., 0] * momentum[..., 1] - place[..., 1] * momentum[..., 0] + momentum[..., 2]
        energy = 0.5 * (momentum * rate).sum(axis=(1, 2))
        return Outcome(energy, about.sum(axis=1), momentum[..., :2].sum(axis=1), self.deepest.to_numpy())

    @ti.kernel
    def _run(self, time: ti.f64):
        for p in self.steps:
            dt = time / self.steps[p]
            for s in range(self.steps[p]):
                if s % (self.steps[p] // SCANS) == 0:
                    self.seek(p)
                if s == 0:
                    self.forces(p)
                for g, n in ti.static(ti.ndrange(2, 3)):
                    self.rate[p, g, n] += 0.5 * dt * self.push[p, g, n] * ti.static(1.0 / self.mass[n])
                    self.place[p, g, n] += dt * self.rate[p, g, n]
                self.forces(p)
                for g, n in ti.static(ti.ndrange(2, 3)):
                    self.rate[p, g, n] += 0.5 * dt * self.push[p, g, n] * ti.static(1.0 / self.mass[n])

    @ti.func
    def outline(self, p, g: ti.template()):
        """A grain's outline."""
        return posed(0, 1.0, ti.Vector([ti.cos(self.place[p, g, 2]), ti.sin(self.place[p, g, 2])]))

    @ti.func
    def apart(self, p):
        """From the second grain's centre to the first's."""
        return ti.Vector([self.place[p, 0, n] - self.place[p, 1, n] for n in ti.static(range(2))])

    @ti.func
    def seek(self, p):
        """List the contacts, where the rule wants a list."""
        if ti.static(self.rule == "tracked"):
            one, two = self.outline(p, 0), self.outline(p, 1)
            self.number[p] = self.tracked.scan(one, two, self.apart(p), SKIN, self.places, p)

    @ti.func
    def forces(self, p):
        """Forces and torques on both grains."""
        for g, n in ti.static(ti.ndrange(2, 3)):
            self.push[p, g, n] = 0.0
        apart, one, two = self.apart(p), self.outline(p, 0), self.outline(p, 1)
        if ti.static(self.rule == "tracked"):
            for k in range(self.number[p]):
                c = self.tracked.contact(True, MINIMUM, one, two, apart, self.places.i[p, k], self.places.j[p, k])
                self.places.i[p, k], self.places.j[p, k] = c[5], c[6]
                if c[7] > 0.0:
                    self.press(p, c, apart, 1.0)
                if self.places.saddle_i[p, k] >= 0.0:
                    a, b = self.places.saddle_i[p, k], self.places.saddle_j[p, k]
                    c = self.tracked.contact(True, SADDLE, one, two, apart, a, b)
                    self.places.saddle_i[p, k], self.places.saddle_j[p, k] = c[5], c[6]
                    if c[7] > 0.0:
                        self.press(p, c, apart, -1.0)
        else:
            self.press(p, self.nodes.contact(one, two, apart, 0, 0, 0)[0], apart, 1.0)

    @ti.func
    def press(self, p, c, apart, sign):
        """Hertz's force of a contact, or less by that of a saddle."""
        overlap = ti.max(c[0], 0.0)
        force = sign * self.stiffness * overlap**1.5 * ti.Vector([c[1], c[2]])
        lever = ti.Vector([c[3], c[4]])
        for n in ti.static(range(2)):
            self.push[p, 0, n] += force[n]
            self.push[p, 1, n] -= force[n]
        self.push[p, 0, 2] += lever.cross(force)
        self.push[p, 1, 2] -= (lever + apart).cross(force)
        self.deepest[p] = ti.max(self.deepest[p], overlap)
