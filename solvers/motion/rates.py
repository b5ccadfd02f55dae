"""Ships afloat as the time loop has them: how their state changes by the water's forces."""

from collections.abc import Sequence

import numpy as np
import taichi as ti

from solvers.machine.state import Axis, State
from solvers.motion.buoyancy import Hulls
from solvers.motion.frame import turned
from solvers.motion.tank_frame import APART
from solvers.ship.potential.memory import padded
from solvers.ship.vessel import Vessel

POSE, VELOCITY, MEMORY = 0, 3, 6  # first entries of these parts of a state
WORKS = 3  # last entries of a state: work (J/m) of the waves, against radiation, against viscosity


@ti.data_oriented
class Rates:
    """The numbers of W ships and their rates of change; all per metre of their lengths.

    The earth's axes have z = 0 on the calm surface and y = 0 at the hull's origin at the start.
    """

    def __init__(self, arrays: State, vessels: Sequence[Vessel], gravity: float):
        self.exact, self.real, self.vessels = arrays.exact, arrays.real, tuple(vessels)
        self.own, world = arrays.under("ship"), Axis("world", len(self.vessels))
        own, self.row = self.own, (world, Axis("number", APART))
        self.hulls = Hulls(arrays, [v.ship for v in self.vessels], [v.openings for v in self.vessels])
        memories = [vessel.ship.radiation.memory for vessel in self.vessels]
        self.states = max(0 if memory is None else len(memory.matrix) for memory in memories)
        self.size = MEMORY + self.states + WORKS
        self.gravity = own.holding("gravity", np.array([gravity]), "one", own.exact)
        self._declare_tables()
        if self.states:
            matrix = [padded(m, "matrix", (self.states, self.states)) for m in memories]
            self.matrix = self._table("matrix", matrix, "state state")
            self.entry = self._table("entry", [padded(m, "entry", (self.states, 3)) for m in memories], "state motion")
            self.exit = self._table("exit", [padded(m, "exit", (3, self.states)) for m in memories], "motion state")
        # Mass, centre from P (y, z) and inertia of the hull alone
        (self.body,) = own.reals((world, Axis("number", 4)), "body", kind=own.exact)
        states = own.reals((world, Axis("state", self.size)), "state", "trial", "slope", "total", kind=own.exact)
        self.state, self.trial, self.slope, self.total = states
        self._declare("mean")  # the load that the rates are found with

    def _table(self, name: str, values, axes: str = "") -> ti.Field:
        return self.own.holding(name, np.array(values, dtype=float), f"world {axes}", self.own.exact, kept=True)

    def _declare(self, *names: str) -> None:
        """Make arrays with a row for each ship."""
        for name in names:
            (field,) = self.own.reals(self.row, name, kind=self.exact)
            setattr(self, name, field)

    def _declare_tables(self) -> None:
        """Make the tables of the ships' numbers."""
        ships, table = [vessel.ship for vessel in self.vessels], self._table
        self.free = table("free", [ship.free for ship in ships], "motion")
        added = [ship.radiation.added_mass + np.diag(ship.rig.mass) for ship in ships]
        self.added = table("added", added, "motion motion")
        self.damping = table("damping", [ship.radiation.damping for ship in ships], "motion motion")
        self.viscous = table("viscous", [[ship.damping.linear, ship.damping.quadratic] for ship in ships], "number")
        self.dashpot = table("dashpot", [ship.rig.damping for ship in ships], "motion")
        self.spring = table("spring", [ship.rig.spring for ship in ships], "motion")
        self.rest = table("rest", [ship.rig.rest for ship in ships], "motion")

    def meet(self, vessels: Sequence[Vessel]) -> None:
        """Change the waves to those of `vessels`, which must equal the present ones in everything else."""
        self.vessels = tuple(vessels)
        self.hulls.meet([vessel.ship.load for vessel in vessels])
        self.added.from_numpy(np.array([v.ship.radiation.added_mass + np.diag(v.ship.rig.mass) for v in vessels]))
        self.damping.from_numpy(np.array([v.ship.radiation.damping for v in vessels]))

    @property
    def sizes(self) -> tuple[int, int, int]:
        """Numbers of states of the radiation memory, corners of a section, and wave components."""
        return self.states, self.hulls.corners, self.hulls.waves

    def _typed(self, values) -> np.ndarray:
        return np.array(values, dtype=np.float64 if self.exact is ti.f64 else np.float32)

    @ti.func
    def rate(self, w, t):
        """Time derivative of the trial state; see `motion.rate`."""
        pose = ti.Vector([self.trial[w, POSE + k] for k in ti.static(range(3))])
        velocity = ti.Vector([self.trial[w, VELOCITY + k] for k in ti.static(range(3))])
        water = self.hulls.water(w, pose, t)
        calm = self.hulls.calm(w, pose)
        radiated, viscous = self.radiated(w, velocity), self.rubbed(w, velocity)
        mass, weight = self.body[w, 0], self.body[w, 0] * self.gravity[0]
        arm = turned(self.body[w, 1], self.body[w, 2], pose[2])
        square = velocity[2] * velocity[2]
        force = water - radiated - viscous + self.vector(self.mean, w)
        force += ti.Vector([mass * square * arm[0], mass * square * arm[1] - weight, -weight * arm[0]])
        for k in ti.static(range(3)):
            force[k] = force[k] - self.spring[w, k] * (pose[k] - self.rest[w, k])
        acceleration = self.accelerated(w, pose[2], force)
        for k in ti.static(range(3)):
            self.slope[w, POSE + k], self.slope[w, VELOCITY + k] = velocity[k], acceleration[k]
        if ti.static(self.states > 0):
            for i in range(self.states):
                change = self.entry[w, i, 0] * velocity[0] + self.entry[w, i, 1] * velocity[1]
                change += self.entry[w, i, 2] * velocity[2]
                for j in range(self.states):
                    change += self.matrix[w, i, j] * self.trial[w, MEMORY + j]
                self.slope[w, MEMORY + i] = change
        works = ti.static(MEMORY + self.states)
        self.slope[w, works] = (water - calm).dot(velocity)
        self.slope[w, works + 1] = radiated.dot(velocity)
        self.slope[w, works + 2] = viscous.dot(velocity)

    @ti.func
    def radiated(self, w, velocity):
        """Radiation force and moment, without the added mass."""
        force = self.nothing()
        for k in ti.static(range(3)):
            for j in ti.static(range(3)):
                force[k] = force[k] + self.damping[w, k, j] * velocity[j]
            if ti.static(self.states > 0):
                for j in range(self.states):
                    force[k] = force[k] + self.exit[w, k, j] * self.trial[w, MEMORY + j]
        return force

    @ti.func
    def rubbed(self, w, velocity):
        """Force and moment of viscous roll damping and of the rig's dashpots."""
        force = self.nothing()
        for k in ti.static(range(3)):
            force[k] = self.dashpot[w, k] * velocity[k]
        spin = velocity[2]
        force[2] = force[2] + (self.viscous[w, 0] + self.viscous[w, 1] * ti.abs(spin)) * spin
        return force

    @ti.func
    def accelerated(self, w, roll, force):
        """Accelerations of P and of roll under a force and moment about P, M(φ)⁻¹ F; zero where not free."""
        return self.solved(w, self.inertia(w, roll), force, False)

    @ti.func
    def inertia(self, w, roll):
        """Inertia matrix of the hull about P."""
        mass, arm = self.body[w, 0], turned(self.body[w, 1], self.body[w, 2], roll)
        turning = self.body[w, 3] + mass * (arm[0] * arm[0] + arm[1] * arm[1])
        zero = ti.cast(0.0, self.exact)
        return ti.Matrix(
            [[mass, zero, -mass * arm[1]], [zero, mass, mass * arm[0]], [-mass * arm[1], mass * arm[0], turning]]
        )

    @ti.func
    def solved(self, w, matrix, force, loose: ti.template()):
        """Accelerations of an inertia `matrix` (3, 3), with the added mass, under a force; zero where not free.

        With `loose` the matters' added mass is part of the inertia as well.
        """
        inertia, right = matrix, force
        for i in ti.static(range(3)):
            right[i] = self.free[w, i] * right[i]
            for j in ti.static(range(3)):
                both = self.free[w, i] * self.free[w, j]
                inertia[i, j] = both * (inertia[i, j] + self.added[w, i, j])
                if ti.static(loose):
                    inertia[i, j] = inertia[i, j] + both * self.tank_frame.of_ship[w, 3 * i + j]
            inertia[i, i] = inertia[i, i] + 1.0 - self.free[w, i]
        return inertia.inverse() @ right

    @ti.func
    def vector(self, field: ti.template(), w):
        return ti.Vector([field[w, k] for k in ti.static(range(3))])

    @ti.func
    def put(self, field: ti.template(), w, values):
        for k in ti.static(range(3)):
            field[w, k] = values[k]

    @ti.func
    def nothing(self):
        return ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])
