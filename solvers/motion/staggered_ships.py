"""Staggered coupling: a ship takes long steps with an extrapolated load, as published of two programs.

In this scheme (Serván-Camas, Cercós-Pita, Colom-Cobb, García-Espinosa & Souto-Iglesias 2016, sections 3 and 4) the ship
goes from t_n to t_(n+1) = t_n + H with the load F* of the contents that a polynomial through the last five gives
(Lagrange), and the contents follow in short steps of their own on the way between the two poses:

    F* = 5 F_n − 10 F_(n−1) + 10 F_(n−2) − 5 F_(n−3) + F_(n−4),
    (1 − b) M a_(n+1) + b M a_n = F(x_(n+1), v_(n+1), t_(n+1)) + F*,

with Newmark's averages of γ = ½ − b and β = 1/12 (Wood, Bossak & Zienkiewicz 1980; b = −0.1, not in the source for the
print lost it). Accelerations are iterated with Aitken's relaxation (Irons & Tuck 1969). Between the poses is a cubic.
The contents' load is that of the ship's acceleration at the instant, (1 − b) a_(n+1) + b a_n.

This deviates from the source, which averages accelerations evenly, β' = (1 − b)²/4. That is stable with any step but
lengthens her period, by 0.04 % at ω H = 0.06; β = 1/12 does not, and is stable up to ω H = 2.35, ten times and more
that of ships with 10 ms. But an even average hands nothing on to the contents that turns round from step to step, as
noise of particles does, and 1/12 does. So contents follow the smoothed

    y_n = x_n + (β' − β) H² (a_n − ā_n),   w_n = v_n − (β' − β) H (ā_n − ā_(n−1)),   ā_n = ā_(n−1) + ¼ (a_n − ā_(n−1)),

which of such noise have 3 and 4 % of H² a and H a. Else y − x is of H³ and w − v of H² (own derivation).

Limits: unstable with contents whose added mass acts at once and is more than some 3 % of the ship's mass, added mass
included, see `motion.staggered_error`; it is here to be compared. The memory of radiation goes by the trapezoidal rule.
"""

from collections.abc import Sequence

import taichi as ti

from solvers.machine.state import State
from solvers.motion.rates import MEMORY, POSE, VELOCITY
from solvers.motion.ships import Ships
from solvers.motion.staggered_error import BETA, BOSSAK, EVEN, GAMMA, POINTS, SMOOTHING, lagrange
from solvers.ship.vessel import Vessel

MOST = 60  # iterations
CLOSE = 1e-11  # m/s² and rad/s²: residual at which they end
WEIGHTS = tuple(float(weight) for weight in lagrange())


@ti.data_oriented
class StaggeredShips(Ships):
    """Ships whose steps are `every` steps of the contents long."""

    def __init__(self, arrays: State, vessels: Sequence[Vessel], gravity: float, every: int, wet: bool = False):
        super().__init__(arrays, vessels, gravity, every, wet)
        # Smoothed pose and velocity at the end of the present interval, and the load that the contents have at its
        # beginning; `pose`, `velocity` and `last` are of its beginning. The acceleration in Bossak's equation is that
        # of −b H earlier; `ahead_now` is that of the end itself. The last POINTS loads, newest
        # first.
        self._declare("ahead_pose", "ahead_velocity", "ahead_last", "ahead_now", "smooth", "past")

    @ti.func
    def move(self, w, t, step, kick, load):
        """One step of the contents, on the way to the end of the ship's step."""
        number, length = self.done[w, 0] % self.every[0], step * self.every[0]
        if number == 0:
            self.begin_interval(w, t, length, load)
        since = step * number
        pose, velocity, acceleration = self.on_the_way(w, since, length)
        force = self.felt(w, pose, velocity, acceleration, load)
        self.given[w, 0] = self.given[w, 0] + step * force.dot(velocity)
        self.tank_frame.feel(w, self.gravity[0], pose, velocity, acceleration, 1.0)
        middle, fast, _ = self.on_the_way(w, since + 0.5 * step, length)
        self.tank_frame.note_middle(w, middle, fast)
        end, speed, gain = self.on_the_way(w, since + step, length)
        self.tank_frame.note(w, end, speed, gain)
        self.done[w, 0] = self.done[w, 0] + 1
        if not (self.limits[w, 0] < end[2] < self.limits[w, 1]):
            self.capsized[w] = t + step

    @ti.func
    def felt(self, w, pose, velocity, acceleration, load):
        """The contents' force and moment about P of a tank that moves so, from their present `load`."""
        force = self.to_earth(w, pose[2], load)
        if ti.static(self.adds_mass):
            force = self.added_mass(w, pose[2], velocity[2], force)
            force = force - self.tank_frame.reaction(w, acceleration)
        return force

    @ti.func
    def on_the_way(self, w, since, length):
        """Pose, velocity and acceleration `since` s after the beginning of an interval, on a cubic (Hermite)."""
        x, u = self.vector(self.pose, w), self.vector(self.velocity, w)
        mean = (self.vector(self.ahead_pose, w) - x) / length
        v = self.vector(self.ahead_velocity, w)
        bend, twist = (3.0 * mean - 2.0 * u - v) / length, (u + v - 2.0 * mean) / (length * length)
        pose = x + since * (u + since * (bend + since * twist))
        return pose, u + since * (2.0 * bend + 3.0 * since * twist), 2.0 * bend + 6.0 * since * twist

    @ti.func
    def begin_interval(self, w, t, length, load):
        """Take the present load, and find where the ship is at the end of the interval."""
        first, now = self.done[w, 0] == 0, self.vector(self.ahead_now, w)
        for k in ti.static(range(3)):
            self.pose[w, k], self.velocity[w, k] = self.ahead_pose[w, k], self.ahead_velocity[w, k]
            self.last[w, k] = self.ahead_last[w, k]
            if first:
                self.pose[w, k], self.velocity[w, k], self.last[w, k] = self.heeled[w, k], 0.0, 0.0
                self.state[w, POSE + k], self.state[w, VELOCITY + k] = self.heeled[w, k], 0.0
                now[k] = 0.0
        pose, velocity = self.vector(self.pose, w), self.vector(self.velocity, w)
        if ti.static(self.hulls.openings > 0):  # noqa: SIM102 (compiled only for ships that have some)
            if self.hulls.floods(w, pose, t):
                self.flooded[w] = t
        force = self.felt(w, pose, velocity, now, load)
        for k in ti.static(range(3)):
            for n in ti.static(range(POINTS - 1, 0, -1)):
                self.past[w, 3 * n + k] = ti.select(first, force[k], self.past[w, 3 * (n - 1) + k])
            self.past[w, k] = force[k]
        self.look_ahead(w, t, length)

    @ti.func
    def look_ahead(self, w, t, length):
        """Advance the state by an interval (s): Newmark's averages, iterated after Aitken."""
        for k in range(self.size):
            self.trial[w, k] = self.state[w, k]
        for k in ti.static(range(3)):
            self.mean[w, k] = self.past[w, k]
        self.rate(w, t)
        before = self.vector(self.last, w)
        for k in range(self.size):
            self.total[w, k] = self.slope[w, k]
        for k in ti.static(range(3)):
            if self.done[w, 0] == 0:
                before[k] = self.slope[w, VELOCITY + k]
                self.smooth[w, k] = before[k]
            ahead = 0.0 * before[k]
            for n in ti.static(range(POINTS)):
                ahead += WEIGHTS[n] * self.past[w, 3 * n + k]
            self.mean[w, k] = ahead
        after, old, relaxed = before, self.nothing(), ti.cast(1.0, self.exact)
        count, going = 0, True
        while going:
            self.try_ahead(w, length, before, after)
            self.rate(w, t + length)
            residual = self.nothing()
            for k in ti.static(range(3)):
                residual[k] = (self.slope[w, VELOCITY + k] - BOSSAK * before[k]) / (1.0 - BOSSAK) - after[k]
            change = residual - old
            square = change.dot(change)
            if count > 0 and square > 0.0:
                relaxed = 0.0 - relaxed * old.dot(change) / square
            after, old, count = after + relaxed * residual, residual, count + 1
            going = count < MOST and ti.sqrt(residual.dot(residual)) > CLOSE
        self.try_ahead(w, length, before, after)
        for k in range(self.size):
            self.state[w, k] = self.trial[w, k]
        self.hand_on(w, length, before, after)

    @ti.func
    def hand_on(self, w, length, before, after):
        """Set what the contents follow to the end of an interval, from accelerations at its beginning and its end."""
        for k in ti.static(range(3)):
            change = SMOOTHING * (after[k] - self.smooth[w, k])
            rough = after[k] - self.smooth[w, k] - change
            self.ahead_pose[w, k] = self.state[w, POSE + k] + (EVEN - BETA) * length * length * rough
            self.ahead_velocity[w, k] = self.state[w, VELOCITY + k] - (EVEN - BETA) * length * change
            self.ahead_last[w, k], self.smooth[w, k] = after[k], self.smooth[w, k] + change
            self.ahead_now[w, k] = (1.0 - BOSSAK) * after[k] + BOSSAK * before[k]

    @ti.func
    def try_ahead(self, w, length, before, after):
        """The trial state at the end of an interval, for accelerations at its beginning and its end."""
        for k in ti.static(range(3)):
            start, speed = self.state[w, POSE + k], self.state[w, VELOCITY + k]
            way = (0.5 - BETA) * before[k] + BETA * after[k]
            self.trial[w, POSE + k] = start + length * (speed + length * way)
            self.trial[w, VELOCITY + k] = speed + length * ((1.0 - GAMMA) * before[k] + GAMMA * after[k])
        for k in range(MEMORY, self.size):
            self.trial[w, k] = self.state[w, k] + 0.5 * length * (self.total[w, k] + self.slope[w, k])
