"""Ships afloat as the time loop has them: carriers of tanks, at rest or held until their release."""

from collections.abc import Callable, Sequence

import numpy as np
import taichi as ti

from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.harmonic import soft_start
from solvers.motion.rates import WORKS, Rates
from solvers.motion.tank_frame import TankFrame, apart
from solvers.ship.body import Body
from solvers.ship.vessel import Vessel
from solvers.tank.load import Load


@ti.data_oriented
class Ships(Rates):
    """The carrier of tanks in W ships, with the interface of `Prescribed`; who derives from it says how they `move`.

    The load is that of `Load.of_world`, per metre of a ship's length; in space she takes its forces along y and z and
    its moment about x. `every` is the number of steps in an interval.
    """

    rotating = moving = responds = True
    has_multiples = False  # the ship's steps have one length
    spatial, numbers = False, 4  # she moves in the plane; of a frame

    def __init__(self, arrays: State, vessels: Sequence[Vessel], gravity: float, every: int, wet: bool = False):
        super().__init__(arrays, vessels, gravity)
        self.loads, self.adds_mass, self.phases = (), False, (Phase(self.follow),)
        own, world, worlds = self.own, Axis("world", len(self.vessels)), len(self.vessels)
        self.every = own.holding("every", np.array([every]), "one", ti.i32)
        self.heel = self._table("heel", [vessel.heel for vessel in self.vessels])
        self.release = self._table("release", [vessel.release for vessel in self.vessels])
        limits = [np.clip(vessel.limits, -1e9, 1e9) for vessel in self.vessels]
        self.limits = self._table("limits", limits, "number")
        self.tank_frame = TankFrame(own, self._places(), gravity, wet)
        # The pose upright, and at the release
        self.upright, self.heeled = own.reals((world, Axis("motion", 3)), "upright", "heeled", kind=own.exact)
        (self.done,) = own.integers(self.row, "done")
        # Times (s) of capsize and of flooding, or −1; the cargo's work on the ship (J/m)
        self.capsized = self._table("capsized", np.full(worlds, -1.0))
        self.flooded = self._table("flooded", np.full(worlds, -1.0))
        self.sinks = any(vessel.sinks for vessel in self.vessels)
        if self.sinks:
            self.sunk = self._table("sunk", np.full(worlds, -1.0))
            self.reserve = self._table("reserve", [vessel.reserve for vessel in self.vessels])
        self._declare("given", "pose", "velocity", "last")  # of P, with its last acceleration

    def bear(self, loads: Sequence[Load]) -> None:
        """Respond to these loads from now on, those of all matters in the tank."""
        self.loads = tuple(loads)
        self.adds_mass = any(load.adds_mass for load in loads)
        lagged = [load.lagged_mass for load in loads if load.lagged_mass is not None]
        self.lagged_mass = sum(lagged, np.zeros((len(self.vessels), 3, 3)))
        self.relaxed = any(load.relaxed for load in loads)

    def begin(self, cargo: Callable[[], Sequence[Body]]) -> None:
        """Hold the ships at rest, upright in equilibrium; `cargo` returns theirs (W,), per metre in the tank's axes.

        Raises Unavailable if a ship sinks, if the cargo leaves a hull no mass or no inertia, or if it is too light.
        """
        body, upright, heeled = [], [], []
        for vessel, load, lagged in zip(self.vessels, cargo(), self.lagged_mass, strict=True):
            aboard = vessel.aboard(load)
            hull = vessel.hull(aboard)
            if not self.relaxed:
                vessel.refuse_light(hull, lagged)
            body.append([hull.mass, *np.subtract(hull.centre, vessel.ship.about), hull.inertia])
            upright.append(vessel.pose(aboard, 0.0))
            heeled.append(vessel.pose(aboard, vessel.heel))
        self.body.from_numpy(self._typed(body))
        self.upright.from_numpy(self._typed(upright))
        self.heeled.from_numpy(self._typed(heeled))
        self.capsized.fill(-1.0)
        self.flooded.fill(-1.0)
        if self.sinks:
            self.sunk.fill(-1.0)
        self.given.fill(0.0)
        self.done.fill(0)
        self.state.fill(0.0)
        still = [[*np.add(pose[:2], place), *[0.0] * 7] for pose, place in zip(upright, self._places(), strict=True)]
        self.tank_frame.tank.from_numpy(self._typed(apart(still)))

    def _places(self) -> np.ndarray:
        """The tank's origin (W, 2) m from P, in the hulls' axes."""
        return np.array([np.subtract(vessel.hold, vessel.ship.about) for vessel in self.vessels], dtype=float)

    def account(self, rows: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Work done so far, `ship_works` (W, 4) J/m: of waves, against radiation, against viscosity, of the cargo.

        And the times (s) at which a ship `capsized`, `flooded` and, where it may, `sunk`, (W,) each, −1 if that has not
        happened.
        """
        works = self.state.to_numpy()[:, -WORKS:]
        given = self.given.to_numpy()[:, :1]
        ends = {"capsized": self.capsized.to_numpy(), "flooded": self.flooded.to_numpy()}
        ends |= {"sunk": self.sunk.to_numpy()} if self.sinks else {}
        return {"ship_works": np.hstack([works, given]).astype(float), **ends}

    @ti.func
    def frame(self, w, t):
        """The tank's frame for the cargo: (b_y, b_z, φ̇, φ̈), with the body force per mass b = R(−φ)(g − P̈)."""
        # Number by number: whole vectors are not cast on real ones (`machine.wide`).
        return ti.Vector([ti.cast(self.tank_frame.felt[w, k], self.real) for k in ti.static(range(4))])

    @ti.func
    def kinematics(self, w, time):
        """Pose (Y, Z, φ) of the tank's origin now, its velocity and its acceleration in the earth frame."""
        return self.tank_frame.kinematics(w)

    @ti.func
    def passage(self, w, t, dt):
        """Pose and velocity in the middle of the step of dt (s) that begins at t (s), and the pose at its end."""
        return self.tank_frame.passage(w)

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of the base step."""
        return 1

    @ti.func
    def goes_on(self, w):
        """Whether a ship goes on: it has neither capsized nor flooded nor sunk."""
        goes = self.capsized[w] < 0.0 and self.flooded[w] < 0.0
        if ti.static(self.sinks):
            goes = goes and self.sunk[w] < 0.0
        return goes

    @ti.func
    def bear_water(self, w, mass, t):
        """Note that a ship has sunk at t (s) if the water that has entered her, kg/m, is more than she can bear."""
        if mass > self.reserve[w] and self.sunk[w] < 0.0:
            self.sunk[w] = t

    @ti.func
    def follow(self, w, time, kick, dt):
        """Advance the ship by the step of dt (s) that begins now, with the present load of the cargo.

        `kick` (s) is the time for which the cargo will be accelerated by the present frame.
        """
        t, step, load = ti.cast(time, self.exact), ti.cast(dt, self.exact), self.nothing()
        for k in ti.static(range(len(self.loads))):
            pushed = self.loads[k].of_world(w)
            load += ti.Vector([pushed[own] for own in ti.static(self.loads[k].in_plane)])
        if t < self.release[w]:
            self.hold_still(w, t, step)
        else:
            self.move(w, t, step, ti.cast(kick, self.exact), ti.cast(load, self.exact))

    @ti.func
    def hold_still(self, w, t, step):
        """Prescribed motion before the release: upright before the start, then turned to the initial heel."""
        pose, velocity, acceleration = self.held(w, t)
        self.tank_frame.feel(w, self.gravity[0], pose, velocity, acceleration, 1.0)
        if ti.static(self.tank_frame.wet):
            middle, speed, _ = self.held(w, t + 0.5 * step)
            self.tank_frame.note_middle(w, middle, speed)
            pose, velocity, acceleration = self.held(w, t + step)
        self.tank_frame.note(w, pose, velocity, acceleration)

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
    def added_mass(self, w, roll, rate, force):
        """Note the matters' added mass about P; returns their load while P is not accelerated."""
        for entry in ti.static(range(9)):
            self.tank_frame.of_tank[w, entry] = 0.0
        for k in ti.static(range(len(self.loads))):
            if ti.static(self.loads[k].adds_mass):
                self.loads[k].sum_added_mass(w, self.tank_frame.of_tank)
        return self.tank_frame.transform_added_mass(w, roll, rate, force)

    @ti.func
    def to_earth(self, w, roll, load):
        """The cargo's force and moment per metre about P in the earth's axes, from those in the tank's."""
        force = turned(load[0], load[1], roll)
        arm = self.tank_frame.arm(w, roll)
        moment = load[2] + arm[0] * force[1] - arm[1] * force[0]
        return ti.Vector([force[0], force[1], moment])
