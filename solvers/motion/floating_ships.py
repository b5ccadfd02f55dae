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

from collections.abc import Sequence

import taichi as ti

from solvers.machine.state import State
from solvers.motion.rates import POSE, VELOCITY
from solvers.motion.ships import Ships
from solvers.ship.vessel import Vessel
from solvers.tank.load import Load

STAGES = 4  # of the Runge–Kutta method

# Under-relaxation of the walls' lagged added mass A, on the ship's own side (M), if that is wanted. With a share θ
# errors of her acceleration shrink from step to step by (1 − θ) A/(M + θ A): for θ ≤ 1/2 not in all cases, and with θ =
# 1 the lag that damps the water's sound is gone, so that hull and water ring.
RELAXATION = 0.75


@ti.data_oriented
class FloatingShips(Ships):
    """Ships that respond at each step to the load of its instant."""

    def __init__(self, arrays: State, vessels: Sequence[Vessel], gravity: float, every: int, wet: bool = False):
        super().__init__(arrays, vessels, gravity, every, wet)
        # Poses are those at the beginning of the next step, velocities half a step before. Mean acceleration, drift and
        # mean load of this interval, and of the previous one; sum of the load so far.
        self._declare("steady", "steady_before", "drift", "mean_before", "load")

    def bear(self, loads: Sequence[Load]) -> None:
        """Respond to these loads from now on."""
        super().bear(loads)
        if self.relaxed:
            self.relaxed_mass = self._table("relaxed_mass", RELAXATION * self.lagged_mass.reshape(-1, 9), "entry")

    @ti.func
    def move(self, w, t, step, kick, load):
        """One leapfrog step, with velocities half a step behind the poses, as for the grains."""
        first = self.done[w, 0] == 0
        if first:
            self.put(self.pose, w, self.vector(self.heeled, w))
            for k in ti.static(range(3)):
                self.velocity[w, k] = 0.0
        pose, before = self.vector(self.pose, w), self.vector(self.velocity, w)
        force = self.to_earth(w, pose[2], load)
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
        if ti.static(self.adds_mass or self.relaxed):
            if ti.static(self.adds_mass):
                rate = before[2] + 0.5 * step * self.last[w, 2]
                force = self.added_mass(w, pose[2], rate, force)
            else:
                force = self.expect(w, pose[2], force)
            right = force - self.tank_frame.reaction(w, steady) - mean
            more = self.solved(w, self.inertia(w, pose[2]), right, True)
            acceleration = share * (steady + more)
            force = force - self.tank_frame.reaction(w, steady + more)
        velocity = before + 0.5 * step * acceleration
        if first:
            velocity = before
        self.tank_frame.feel(w, self.gravity[0], pose, velocity, acceleration, step / kick)
        after = before + step * acceleration
        self.given[w, 0] = self.given[w, 0] + step * share * force.dot(0.5 * (before + after))
        self.put(self.velocity, w, after)
        self.put(self.last, w, acceleration / share)
        self.put(self.load, w, self.vector(self.load, w) + force)
        whole = after + self.vector(self.drift, w)
        self.tank_frame.note_middle(w, pose + 0.5 * step * whole, whole)
        pose = pose + step * whole
        self.put(self.pose, w, pose)
        self.done[w, 0] = self.done[w, 0] + 1
        self.tank_frame.note(w, pose, after + 0.5 * step * acceleration / share, acceleration / share)
        if not (self.limits[w, 0] < pose[2] < self.limits[w, 1]):
            self.capsized[w] = t + step

    @ti.func
    def expect(self, w, roll, force):
        """Add to a load the reaction of the lagged added mass that is on the ship's side to the last acceleration."""
        zero = ti.cast(0.0, self.exact)
        for entry in ti.static(range(9)):
            self.tank_frame.of_tank[w, entry] = self.relaxed_mass[w, entry]
        found = self.tank_frame.transform_added_mass(w, roll, zero, force)
        return found + self.tank_frame.reaction(w, self.vector(self.last, w))

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
