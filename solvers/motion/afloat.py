"""A tank in a ship: a frame that moves under the water's forces and the load of the cargo on the tank.

The hull is one more body in the grains' time loop. At each step it takes the contact forces of that instant, before the
grains are moved, so that neither lags behind the other. Staggered schemes pass the cargo's force of the last interval
to the hull and the hull's acceleration back. They are unstable with a rigid cargo heavier than the hull, and drive an
elastic cargo slightly if its damping is weaker than the effect of their delay (added-mass instability; Causin, Gerbeau
and Nobile 2005). Here the cargo may have any mass; only its layer at the walls must be light beside the hull.

The water's forces vary slowly and cost more. For every interval H, of many steps, the ship is advanced by the classical
Runge–Kutta method (`motion.advance`) with the cargo's mean load F̄ of the previous interval. Within H the ship has the
mean acceleration of that motion, plus at each step the response to the difference of the load F from that mean,

    a = (v(t + H) − v(t))/H + M(φ)⁻¹ (F − F̄),

with the added mass in M. H affects only the water's forces: their integration to fourth order, and the effect on them
of the deviation within one interval to second order.
"""

from collections.abc import Callable, Sequence

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.buoyancy import Hulls
from solvers.motion.frame import turned
from solvers.motion.harmonic import soft_start
from solvers.motion.hold import APART, Hold, apart
from solvers.ship.body import Body
from solvers.ship.potential.memory import padded
from solvers.ship.vessel import Vessel
from solvers.tank.load import Load

POSE, VELOCITY, MEMORY = 0, 3, 6  # first entries of these parts of a state
WORKS = 3  # last entries of a state: work (J/m) of the waves, against radiation, against viscosity
STAGES = 4  # of the Runge–Kutta method


@ti.data_oriented
class Afloat:
    """The carrier of tanks in W ships, with the interface of `Prescribed`.

    The earth's axes have z = 0 on the calm surface and y = 0 at the hull's origin at the start. All quantities of the
    ship are per metre of length, and so is the load from `Load.of_world`.
    """

    rotating = moving = answers = True
    paced = False  # the ship's leapfrog needs steps of one length

    def __init__(self, arrays: State, vessels: Sequence[Vessel], gravity: float, every: int, wet: bool = False):
        self.exact, self.real, self.vessels, self.loads = arrays.exact, arrays.real, tuple(vessels), ()
        self.pressed = False
        self.phases = (Phase(self.follow),)
        worlds = len(self.vessels)
        self.hulls = Hulls(arrays, [v.ship for v in self.vessels], [v.openings for v in self.vessels])
        memories = [vessel.ship.radiation.memory for vessel in self.vessels]
        self.states = max(0 if memory is None else len(memory.matrix) for memory in memories)
        self.size = MEMORY + self.states + WORKS
        own, world = arrays.under("ship"), Axis("world", worlds)
        self.gravity = own.holding("gravity", np.array([gravity]), "one", own.exact)
        self.every = own.holding("every", np.array([every]), "one", ti.i32)

        def table(name: str, values, axes: str = "") -> ti.Field:
            return own.holding(name, np.array(values, dtype=float), f"world {axes}", own.exact, kept=True)

        ships = [vessel.ship for vessel in self.vessels]
        self.free = table("free", [ship.free for ship in ships], "motion")
        added = [ship.radiation.added_mass + np.diag(ship.rig.mass) for ship in ships]
        self.added = table("added", added, "motion motion")
        self.damping = table("damping", [ship.radiation.damping for ship in ships], "motion motion")
        self.viscous = table("viscous", [[ship.damping.linear, ship.damping.quadratic] for ship in ships], "number")
        self.dashpot = table("dashpot", [ship.rig.damping for ship in ships], "motion")
        self.spring = table("spring", [ship.rig.spring for ship in ships], "motion")
        self.rest = table("rest", [ship.rig.rest for ship in ships], "motion")
        self.hold = Hold(own, self._places(), gravity, wet)
        self.heel = table("heel", [vessel.heel for vessel in self.vessels])
        self.release = table("release", [vessel.release for vessel in self.vessels])
        self.limits = table("limits", [np.clip(vessel.limits, -1e9, 1e9) for vessel in self.vessels], "number")
        if self.states:
            matrix = [padded(m, "matrix", (self.states, self.states)) for m in memories]
            self.matrix = table("matrix", matrix, "state state")
            self.entry = table("entry", [padded(m, "entry", (self.states, 3)) for m in memories], "state motion")
            self.exit = table("exit", [padded(m, "exit", (3, self.states)) for m in memories], "motion state")
        # Mass, centre from P (y, z) and inertia of the hull alone; the pose upright, and at the release
        (self.body,) = own.reals((world, Axis("number", 4)), "body", kind=own.exact)
        self.upright, self.heeled = own.reals((world, Axis("motion", 3)), "upright", "heeled", kind=own.exact)
        states = own.reals((world, Axis("state", self.size)), "state", "trial", "slope", "total", kind=own.exact)
        self.state, self.trial, self.slope, self.total = states
        # Pose at the beginning of the next step and velocity half a step before; mean acceleration, drift and mean load
        # of this interval, and of the previous one; sum of the load so far; last acceleration.
        names = "pose", "velocity", "steady", "steady_before", "drift", "mean", "mean_before", "load"
        row = world, Axis("number", APART)
        for name in (*names, "last"):
            (field,) = own.reals(row, name, kind=own.exact)
            setattr(self, name, field)
        (self.done,) = own.integers(row, "done")
        # Times (s) of capsize and of flooding, or −1; the cargo's work on the ship (J/m)
        self.capsized = table("capsized", np.full(worlds, -1.0))
        self.flooded = table("flooded", np.full(worlds, -1.0))
        (self.given,) = own.reals(row, "given", kind=own.exact)

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

    def bear(self, loads: Sequence[Load]) -> None:
        """Respond to these loads from now on, those of all matters in the tank."""
        self.loads = tuple(loads)
        self.pressed = any(load.pressed for load in loads)

    def begin(self, cargo: Callable[[], Sequence[Body]]) -> None:
        """Hold the ships at rest, upright in equilibrium; `cargo` returns theirs (W,), per metre in the tank's axes.

        Raises Unavailable if a ship sinks, or if the cargo leaves a hull no mass or no inertia.
        """
        body, upright, heeled = [], [], []
        for vessel, load in zip(self.vessels, cargo(), strict=True):
            aboard = vessel.aboard(load)
            hull = vessel.hull(aboard)
            body.append([hull.mass, *np.subtract(hull.centre, vessel.ship.about), hull.inertia])
            upright.append(vessel.pose(aboard, 0.0))
            heeled.append(vessel.pose(aboard, vessel.heel))
        self.body.from_numpy(self._typed(body))
        self.upright.from_numpy(self._typed(upright))
        self.heeled.from_numpy(self._typed(heeled))
        self.capsized.fill(-1.0)
        self.flooded.fill(-1.0)
        self.given.fill(0.0)
        self.done.fill(0)
        self.state.fill(0.0)
        still = [[*np.add(pose[:2], place), *[0.0] * 7] for pose, place in zip(upright, self._places(), strict=True)]
        self.hold.tank.from_numpy(self._typed(apart(still)))

    def _places(self) -> np.ndarray:
        """The tank's origin (W, 2) m from P, in the hulls' axes."""
        return np.array([np.subtract(vessel.hold, vessel.ship.about) for vessel in self.vessels], dtype=float)

    def _typed(self, values) -> np.ndarray:
        return np.array(values, dtype=np.float64 if self.exact is ti.f64 else np.float32)

    def account(self, rows: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Work done so far, `ship_works` (W, 4) J/m: of waves, against radiation, against viscosity, of the cargo.

        And the times (s) at which a ship `capsized` and `flooded`, (W,) each, −1 if that has not happened.
        """
        works = self.state.to_numpy()[:, -WORKS:]
        given = self.given.to_numpy()[:, :1]
        ends = {"capsized": self.capsized.to_numpy(), "flooded": self.flooded.to_numpy()}
        return {"ship_works": np.hstack([works, given]).astype(float), **ends}

    @ti.func
    def frame(self, w, t):
        """The tank's frame for the cargo: (b_y, b_z, φ̇, φ̈), with the body force per mass b = R(−φ)(g − P̈)."""
        return ti.cast(ti.Vector([self.hold.felt[w, k] for k in ti.static(range(4))]), self.real)

    @ti.func
    def kinematics(self, w, time):
        """Pose (Y, Z, φ) of the tank's origin now, its velocity and its acceleration in the earth frame."""
        return self.hold.kinematics(w)

    @ti.func
    def passage(self, w, t, dt):
        """Pose and velocity in the middle of the step of dt (s) that begins at t (s), and the pose at its end."""
        return self.hold.passage(w)

    @ti.func
    def pace(self, w):
        """Largest stride in base steps."""
        return 1

    @ti.func
    def goes_on(self, w):
        """Whether a ship goes on: it has neither capsized nor flooded."""
        return self.capsized[w] < 0.0 and self.flooded[w] < 0.0

    @ti.func
    def follow(self, w, time, kick, dt):
        """Advance the ship by the step of dt (s) that begins now, with the present load of the cargo.

        `kick` (s) is the time for which the cargo will be accelerated by the present frame.
        """
        t, step, load = ti.cast(time, self.exact), ti.cast(dt, self.exact), self.nothing()
        for k in ti.static(range(len(self.loads))):
            load += self.loads[k].of_world(w)
        if t < self.release[w]:
            self.hold_still(w, t, step)
        else:
            self.move(w, t, step, ti.cast(kick, self.exact), ti.cast(load, self.exact))

    @ti.func
    def hold_still(self, w, t, step):
        """Prescribed motion before the release: upright before the start, then turned to the initial heel."""
        pose, velocity, acceleration = self.held(w, t)
        self.hold.feel(w, self.gravity[0], pose, velocity, acceleration, 1.0)
        if ti.static(self.hold.wet):
            middle, speed, _ = self.held(w, t + 0.5 * step)
            self.hold.note_middle(w, middle, speed)
            pose, velocity, acceleration = self.held(w, t + step)
        self.hold.note(w, pose, velocity, acceleration)

    @ti.func
    def held(self, w, t):
        """Pose, velocity and acceleration of P at a time (s) before the release."""
        d = soft_start(t, self.release[w])
        pose, velocity, acceleration = self.vector(self.upright, w), self.nothing(), self.nothing()
        for k in ti.static(range(3)):
            way = self.heeled[w, k] - self.upright[w, k]
            pose[k] = pose[k] + d[0] * way
            velocity[k] = d[1] * way
            acceleration[k] = d[2] * way
        return pose, velocity, acceleration

    @ti.func
    def move(self, w, t, step, kick, load):
        """One leapfrog step, with velocities half a step behind the poses, as for the grains."""
        first = self.done[w, 0] == 0
        if first:
            self.put(self.pose, w, self.vector(self.heeled, w))
            for k in ti.static(range(3)):
                self.velocity[w, k] = 0.0
        pose, before = self.vector(self.pose, w), self.vector(self.velocity, w)
        force = self.aboard(w, pose[2], load)
        share = ti.cast(1.0, self.exact)
        steady, mean = self.vector(self.steady, w), self.vector(self.mean, w)
        if self.done[w, 0] % self.every[0] == 0:
            now = before + 0.5 * step * self.vector(self.last, w)
            if first:
                now, share = before, 0.5 * share
            self.begin_interval(w, t, step, first, pose, now, force)
            # The kick runs from half a step before to half a step after: half of it belongs to each interval.
            steady, mean = self.vector(self.steady, w), self.vector(self.mean, w)
            if not first:
                steady = 0.5 * (steady + self.vector(self.steady_before, w))
                mean = 0.5 * (mean + self.vector(self.mean_before, w))
        acceleration = share * (steady + self.accelerated(w, pose[2], force - mean))
        if ti.static(self.pressed):
            rate = before[2] + 0.5 * step * self.last[w, 2]
            force = self.answer(w, pose[2], rate, force)
            answer = self.hold.inertia(w)
            more = self.solved(w, self.inertia(w, pose[2]) + answer, force - answer @ steady - mean)
            acceleration = share * (steady + more)
            force -= answer @ (steady + more)
        velocity = before + 0.5 * step * acceleration
        if first:
            velocity = before
        self.hold.feel(w, self.gravity[0], pose, velocity, acceleration, step / kick)
        after = before + step * acceleration
        self.given[w, 0] = self.given[w, 0] + step * share * force.dot(0.5 * (before + after))
        self.put(self.velocity, w, after)
        self.put(self.last, w, acceleration / share)
        self.put(self.load, w, self.vector(self.load, w) + force)
        whole = after + self.vector(self.drift, w)
        self.hold.note_middle(w, pose + 0.5 * step * whole, whole)
        pose = pose + step * whole
        self.put(self.pose, w, pose)
        self.done[w, 0] = self.done[w, 0] + 1
        self.hold.note(w, pose, after + 0.5 * step * acceleration / share, acceleration / share)
        if not (self.limits[w, 0] < pose[2] < self.limits[w, 1]):
            self.capsized[w] = t + step

    @ti.func
    def begin_interval(self, w, t, step, first, pose, velocity, force):
        """Begin an interval: advance the ship over it with the mean load of the last one."""
        length = step * self.every[0]
        if ti.static(self.hulls.openings > 0):  # noqa: SIM102 (compiled only for ships that have some)
            if self.hulls.floods(w, pose, t):
                self.flooded[w] = t
        for k in ti.static(range(3)):
            self.steady_before[w, k], self.mean_before[w, k] = self.steady[w, k], self.mean[w, k]
            self.mean[w, k] = self.load[w, k] / self.every[0]
            if first:
                self.mean[w, k] = force[k]
            self.load[w, k] = 0.0
            self.state[w, POSE + k], self.state[w, VELOCITY + k] = pose[k], velocity[k]
        self.look_ahead(w, t, length)
        for k in ti.static(range(3)):
            steady = (self.state[w, VELOCITY + k] - velocity[k]) / length
            way = length * (velocity[k] + 0.5 * length * steady)
            self.steady[w, k] = steady
            self.drift[w, k] = (self.state[w, POSE + k] - pose[k] - way) / length

    @ti.func
    def look_ahead(self, w, t, length):
        """Advance the state by an interval (s), with the classical Runge–Kutta method (Kutta 1901)."""
        for k in range(self.size):
            self.trial[w, k], self.total[w, k] = self.state[w, k], 0.0
        for stage in range(STAGES):
            middle = stage == 1 or stage == 2
            self.rate(w, t + length * ((stage + 1) // 2) / 2)
            weight, ahead = ti.select(middle, 2, 1), ti.select(stage == 2, 1.0, 0.5) * length
            for k in range(self.size):
                self.total[w, k] = self.total[w, k] + weight * self.slope[w, k]
                self.trial[w, k] = self.state[w, k] + ahead * self.slope[w, k]
        for k in range(self.size):
            self.state[w, k] = self.state[w, k] + length / 6.0 * self.total[w, k]

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
        return self.solved(w, self.inertia(w, roll), force)

    @ti.func
    def answer(self, w, roll, rate, force):
        """Note what the matters answer to accelerations of P; returns their load while P is not accelerated."""
        for entry in ti.static(range(9)):
            self.hold.reply[w, entry] = 0.0
        for k in ti.static(range(len(self.loads))):
            if ti.static(self.loads[k].pressed):
                self.loads[k].add_inertia(w, self.hold.reply)
        return self.hold.answer(w, roll, rate, force)

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
    def solved(self, w, matrix, force):
        """Accelerations of an inertia `matrix` (3, 3), with the added mass, under a force; zero where not free."""
        inertia, right = matrix, force
        for i in ti.static(range(3)):
            right[i] = self.free[w, i] * right[i]
            for j in ti.static(range(3)):
                both = self.free[w, i] * self.free[w, j]
                inertia[i, j] = both * (inertia[i, j] + self.added[w, i, j])
            inertia[i, i] = inertia[i, i] + 1.0 - self.free[w, i]
        return inertia.inverse() @ right

    @ti.func
    def aboard(self, w, roll, load):
        """The cargo's force and moment per metre about P in the earth's axes, from those in the tank's."""
        force = turned(load[0], load[1], roll)
        arm = self.hold.arm(w, roll)
        moment = load[2] + arm[0] * force[1] - arm[1] * force[0]
        return ti.Vector([force[0], force[1], moment])

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
