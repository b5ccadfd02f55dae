"""What is measured of a world as it runs: sums over its grains, taken in one order."""

import taichi as ti

from solvers.contacts import Contacts
from solvers.frame import Frame
from solvers.grains import Grains
from solvers.neighbours import Neighbours
from solvers.per_world import ITERATIONS_A_THREAD
from solvers.runtime import Arrays
from solvers.walls import Walls


@ti.data_oriented
class Observer:
    """One row of numbers a world."""

    NAMES = (
        "pose_y",
        "pose_z",
        "pose_angle",
        "rate_y",
        "rate_z",
        "rate_angle",
        "centre_y",
        "centre_z",
        "kinetic",
        "rotational",
        "potential",
        "elastic",
        "contacts",
        "overlap",
        "escaped",
    )

    def __init__(
        self,
        arrays: Arrays,
        grains: Grains,
        walls: Walls,
        neighbours: Neighbours,
        contacts: Contacts,
        frame: Frame,
    ):
        self.grains, self.walls, self.neighbours = grains, walls, neighbours
        self.contacts, self.frame = contacts, frame
        (self.rows,) = arrays.reals(1, (grains.worlds, len(self.NAMES)))

    @ti.kernel
    def observe(self, time: ti.f64):
        """Fill the rows with the state at `time` (s), which must be the grains' own."""
        for k in range(self.grains.worlds * ITERATIONS_A_THREAD):
            if k % ITERATIONS_A_THREAD == 0:
                self.observe_world(self.grains, k // ITERATIONS_A_THREAD, time)

    @ti.func
    def observe_world(self, g: ti.template(), w, time):
        mass, moment_y, moment_z, kinetic, rotational = 0.0, 0.0, 0.0, 0.0, 0.0
        escaped = -1
        for i in range(g.count):
            m, j = 1.0 / g.inverse_mass[w, i], 1.0 / g.inverse_inertia[w, i]
            mass += m
            moment_y += m * g.y[w, i]
            moment_z += m * g.z[w, i]
            kinetic += 0.5 * m * (g.now_y[w, i] ** 2 + g.now_z[w, i] ** 2)
            rotational += 0.5 * j * g.spin_now[w, i] ** 2
            if not self.walls.holds(g.y[w, i], g.z[w, i]):
                escaped = i
        centre_y, centre_z = moment_y / mass, moment_z / mass
        pose = ti.Vector([0.0 for _ in ti.static(range(9))])
        if ti.static(self.frame.moving):
            pose = self.frame.kinematics(w, time)
        height = pose[1] + ti.sin(pose[2]) * centre_y + ti.cos(pose[2]) * centre_z
        census = self.contacts.census(g, self.walls, self.neighbours, w)
        for k in ti.static(range(6)):
            self.rows[w, k] = pose[k]
        self.rows[w, 6], self.rows[w, 7] = centre_y, centre_z
        self.rows[w, 8], self.rows[w, 9] = kinetic, rotational
        self.rows[w, 10] = mass * self.frame.gravity[0] * height
        self.rows[w, 11], self.rows[w, 12], self.rows[w, 13] = census[2], census[0], census[1]
        self.rows[w, 14] = escaped
