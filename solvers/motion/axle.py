"""A tank that is free to roll about an axle: one degree of freedom, which responds to the load of the tank's contents.

As with a ship, the axle takes the load of the instant, before the contents are moved, so that neither lags behind the
other and no momentum is lost between them (see `motion.floating_ships` for what staggered coupling does).
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
import taichi as ti

from solvers.machine.limit import Limit
from solvers.machine.phase import Phase
from solvers.machine.state import Axis, State
from solvers.motion.frame import turned
from solvers.motion.harmonic import soft_start
from solvers.tank.load import Load

OF_PERIOD = 2e-3  # of the shortest period: the longest step of an empty tank, to 7e-6 of that period
APART = 32  # row length of arrays that are written for each world at each step
# Entries of such a row: roll at the beginning of the next step, rate half a step before it, rate and acceleration then
# as known from the last step; roll and rate in the middle of the step; roll, rate and acceleration that are felt at
# its beginning; whether the tank has been let go; how far the mass has slid; work (J) of the load, of the slide,
# against friction, against damping, up to the last kick, half a step ago; what that half step adds to each.
ROLL, RATE, RATE_NOW, RISE_NOW, MIDDLE, DURING, FELT, FELT_RATE, FELT_RISE, FREE, SLID, WORK = range(12)
WORKS = 4
LATELY = WORK + WORKS
# Columns of the table of axles: the first nine are fields of `Axle`, the parameters of the slide follow.
PLACE_Y, PLACE_Z, INERTIA, MOMENT, FRICTION, DAMPING, MASS, HEEL, RELEASE, SLIDE = range(10)


@dataclass(frozen=True)
class Axle:
    """(I0 + m x²) φ̈ + 2 m x ẋ φ̇ − g S sin φ + m g x cos φ = −K sign φ̇ − B φ̇ + Q: roll about an axle that is fixed.

    Source: Bulian, Souto-Iglesias, Delorme & Botia-Vera (2010), J. Hydraul. Res. 48, 28, with Q, the moment of the
    tank's contents. `place` (m) is the axle in the tank's axes; it may lie above the floor. I0 is the `inertia` (kg m²)
    of tank and structure, S their static `moment` (kg m), mass times the height of their centre of mass over the axle,
    K the dry `friction` (N m), B the linear `damping` (N m s). A `mass` m (kg) slides along a rail through the axle,
    by the motion `slide` x (m, to starboard), which comes up within `soft_start` (s).

    The tank is `length` (m) long along the axle, None: as thick as its slab. It is held until `release` (s), turned
    slowly to the `heel` (rad), and then let go at rest.

    Limits: friction at rest is that in motion; the axle does not give.

    Units: as above; φ rad, t s.
    """

    place: tuple[float, float]
    inertia: float
    moment: float
    friction: float = 0.0
    damping: float = 0.0
    mass: float = 0.0
    slide: object | None = None
    soft_start: float = 0.0
    length: float | None = None
    heel: float = 0.0
    release: float = 0.0

    @property
    def row(self) -> list[float]:
        """The kernel's numbers: columns of the table of axles."""
        own = [*self.place, self.inertia, self.moment, self.friction, self.damping]
        own += [self.mass if self.slide else 0.0, self.heel, self.release]
        return [*own, *(self.slide.parameters(self.soft_start) if self.slide else ())]

    @property
    def kind(self) -> tuple | None:
        """What selects the compiled motion of the mass: kind and number of parameters."""
        return (type(self.slide), len(self.slide.parameters(0.0))) if self.slide else None

    def share(self, thickness: float) -> float:
        """Factor from a load on a slab of some thickness (m) to that on the whole tank."""
        return (self.length or thickness) / thickness

    def natural_period(self, gravity: float) -> float | None:
        """Period (s) of small undamped rolls with an empty tank and the mass at the axle; None if it has none."""
        spring = -gravity * self.moment
        return 2.0 * pi * sqrt(self.inertia / spring) if spring > 0.0 else None

    def step_limit(self, gravity: float) -> Limit:
        """The longest step of an empty tank."""
        quickest = sqrt(gravity * abs(self.moment) / self.inertia)
        quickest = max(quickest, 2.0 * pi * getattr(self.slide, "frequency", 1.0))
        return Limit(OF_PERIOD * 2.0 * pi / quickest, f"{OF_PERIOD:g} of the period of roll", firm=True)


@ti.data_oriented
class OnAxle:
    """The carrier of tanks on W axles, with the interface of `Prescribed`.

    The angular momentum p = (I0 + m x²) φ̇ is kept half a step behind the roll φ and carried from the middle of one
    step to that of the next by the moments of the instant (leapfrog; Hairer, Lubich & Wanner 2003, Acta Numerica 12,
    399): p += Δt M(φ, t); φ += Δt p/(I0 + m x²). Without losses the step is symplectic and symmetric in time: energy
    does not drift. Damping acts with the mean of the rates before and after. Dry friction is the set-valued law of
    Moreau (1988): an impulse of up to K Δt that stops the roll if it can, and else opposes it, so that a tank that
    sticks does not chatter. All is of second order.

    Loads are those on the slab; with `Load`'s shares they are those on the whole tank.
    """

    rotating = moving = responds = True
    has_multiples = False  # leapfrog needs steps of one length
    spatial, numbers = False, 4  # it moves in the plane; of a frame

    def __init__(self, arrays: State, axles: Sequence[Axle], gravity: float, thickness: float):
        self.share = np.array([axle.share(thickness) for axle in axles])
        self.exact, self.real, self.axles, self.loads = arrays.exact, arrays.real, tuple(axles), ()
        self.phases = (Phase(self.follow),)
        self.slide = self.axles[0].slide
        self.slides = self.slide is not None
        own, worlds = arrays.under("axle"), len(self.axles)
        self.gravity = own.holding("gravity", np.array([gravity]), "one", own.exact)
        self.table = own.holding("axles", np.array([axle.row for axle in self.axles]), "world number", own.exact)
        (self.row,) = own.reals((Axis("world", worlds), Axis("number", APART)), "row", kind=own.exact)

    def bear(self, loads: Sequence[Load]) -> None:
        """Respond to these loads from now on, those of all matters in the tank."""
        self.loads = tuple(loads)

    def begin(self, cargo: Callable[[], Sequence]) -> None:
        """Hold the tanks: upright, or heeled if they are let go at once."""
        rows = np.zeros((len(self.axles), APART))
        for row, axle in zip(rows, self.axles, strict=True):
            row[[ROLL, MIDDLE, FELT]] = axle.heel if axle.release == 0.0 else 0.0
        self.row.from_numpy(rows.astype(np.float64 if self.exact is ti.f64 else np.float32))

    def account(self, rows: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
        """Of each tank on its axle, (W, …) each, from its other quantities `rows`; see `motion.quantities`."""
        state = self.row.to_numpy().astype(float)
        roll, rate, slid = state[:, ROLL], state[:, RATE_NOW], state[:, SLID]
        table = self.table.to_numpy().T
        inertia, mass, gravity = table[INERTIA], table[MASS], self.gravity.to_numpy()[0]
        kinetic = 0.5 * (inertia + mass * slid**2) * rate**2
        potential = gravity * (table[MOMENT] * np.cos(roll) + mass * slid * np.sin(roll))
        force = rows["wall_force"]
        moment = force[:, 2] - table[PLACE_Y] * force[:, 1] + table[PLACE_Z] * force[:, 0]
        return {
            "axle_moment": self.share * moment,
            "axle_slide": slid,
            "axle_energy": kinetic + potential,
            "axle_works": state[:, WORK:LATELY] + state[:, LATELY : LATELY + WORKS],
        }

    @ti.func
    def allowed_multiple(self, w):
        """The largest multiple of the base step."""
        return 1

    @ti.func
    def goes_on(self, w):
        """Whether the world goes on: always."""
        return True

    @ti.func
    def slid(self, w, t):
        """How far the mass has slid along its rail at a time (s), m."""
        x = ti.cast(0.0, self.exact)
        if ti.static(self.slides):
            x = self.slide.state(self.table, w, SLIDE, t)[0]
        return x

    @ti.func
    def inertia(self, w, t):
        """Moment of inertia (kg m²) about the axle at a time (s)."""
        x = self.slid(w, t)
        return self.table[w, INERTIA] + self.table[w, MASS] * x * x

    @ti.func
    def follow(self, w, time, kick, dt):
        """Advance the roll by the step of dt (s) that begins now, with the present load.

        `kick` (s) is the time for which the contents will be accelerated by the present frame.
        """
        t, step, load = ti.cast(time, self.exact), ti.cast(dt, self.exact), self.nothing()
        for k in ti.static(range(len(self.loads))):
            load += self.loads[k].of_world(w)
        pushed = load[2] - self.table[w, PLACE_Y] * load[1] + self.table[w, PLACE_Z] * load[0]
        if t < self.table[w, RELEASE]:
            self.hold(w, t, step)
        else:
            self.move(w, t, step, ti.cast(kick, self.exact), pushed)
        self.row[w, SLID] = self.slid(w, t + step)

    @ti.func
    def hold(self, w, t, step):
        """Prescribed roll before the release: upright before the start, then turned to the initial heel."""
        length = self.table[w, RELEASE]
        now = self.table[w, HEEL] * soft_start(t, length)
        middle = self.table[w, HEEL] * soft_start(t + 0.5 * step, length)
        after = self.table[w, HEEL] * soft_start(t + step, length)
        self.row[w, MIDDLE], self.row[w, DURING] = middle[0], middle[1]
        for k in ti.static(range(3)):
            self.row[w, FELT + k], self.row[w, ti.static((ROLL, RATE_NOW, RISE_NOW)[k])] = now[k], after[k]
        self.row[w, RATE], self.row[w, FREE] = 0.0, 0.0

    @ti.func
    def move(self, w, t, step, kick, pushed):
        """One leapfrog step under the moment `pushed` (N m) of the contents about the axle."""
        free = self.row[w, FREE] > 0.0
        during = ti.select(free, step, 0.5 * step)  # let go at rest, half a kick brings it to the middle of the step
        roll, before, g = self.row[w, ROLL], self.row[w, RATE], self.gravity[0]
        mass, x = self.table[w, MASS], self.slid(w, t)
        earlier, later = self.inertia(w, t + 0.5 * step - during), self.inertia(w, t + 0.5 * step)
        moment = g * (self.table[w, MOMENT] * ti.sin(roll) - mass * x * ti.cos(roll)) + pushed
        braked = 0.5 * during * self.table[w, DAMPING]
        momentum = (earlier - braked) * before + during * moment
        most = during * self.table[w, FRICTION]
        rubbed = ti.max(-most, ti.min(most, momentum))
        rate = (momentum - rubbed) / (later + braked)
        mean, rise = 0.5 * (before + rate), (rate - before) / during
        # The contents are accelerated for `kick`, and the tank reaches its rate within it.
        self.row[w, FELT], self.row[w, FELT_RATE] = roll, before + rise * (during - 0.5 * step)
        self.row[w, FELT_RISE] = (rate - before) / kick
        self.row[w, MIDDLE], self.row[w, DURING] = roll + 0.5 * step * rate, rate
        self.row[w, ROLL], self.row[w, RATE] = roll + step * rate, rate
        self.row[w, RATE_NOW], self.row[w, RISE_NOW] = rate + 0.5 * step * rise, rise
        self.row[w, FREE] = 1.0
        slid = self.slid(w, t + step) - x
        given = g * mass * slid * ti.sin(roll + 0.5 * step * rate) - 0.5 * (later - earlier) * before * rate
        works = [during * pushed * mean, given, rubbed * mean, 2.0 * braked * mean * mean]
        for k in ti.static(range(WORKS)):
            self.row[w, WORK + k] = self.row[w, WORK + k] + works[k]
            self.row[w, LATELY + k] = 0.5 * step / during * works[k]

    @ti.func
    def nothing(self):
        return ti.Vector([ti.cast(0.0, self.exact) for _ in ti.static(range(3))])

    @ti.func
    def arm(self, w, roll):
        """The tank's origin from the axle (m) in the earth frame."""
        return turned(0.0 - self.table[w, PLACE_Y], 0.0 - self.table[w, PLACE_Z], roll)

    @ti.func
    def frame(self, w, t):
        """The tank's frame for the cargo: (b_y, b_z, φ̇, φ̈), with the body force per mass b = R(−φ)(g − P̈)."""
        roll, rate, rise = self.row[w, FELT], self.row[w, FELT_RATE], self.row[w, FELT_RISE]
        arm, square = self.arm(w, roll), rate * rate
        b = turned(rise * arm[1] + square * arm[0], square * arm[1] - rise * arm[0] - self.gravity[0], -roll)
        return ti.Vector([ti.cast(value, self.real) for value in ti.static([b[0], b[1], rate, rise])])

    @ti.func
    def kinematics(self, w, time):
        """Pose (Y, Z, φ) of the tank's origin now, its velocity and its acceleration in the earth frame.

        The acceleration is that of the last step: the present one follows from a load that may depend on it.
        """
        roll, rate, rise = self.row[w, ROLL], self.row[w, RATE_NOW], self.row[w, RISE_NOW]
        arm, square = self.arm(w, roll), rate * rate
        y, z = self.table[w, PLACE_Y] + arm[0], self.table[w, PLACE_Z] + arm[1]
        up = ti.Vector([-rise * arm[1] - square * arm[0], rise * arm[0] - square * arm[1]])
        return ti.Vector([y, z, roll, -rate * arm[1], rate * arm[0], rate, up[0], up[1], rise])

    @ti.func
    def passage(self, w, t, dt):
        """Pose and velocity in the middle of the step that begins at t (s), and the pose at its end."""
        middle, rate, end = self.row[w, MIDDLE], self.row[w, DURING], self.row[w, ROLL]
        half, whole = self.arm(w, middle), self.arm(w, end)
        y, z = self.table[w, PLACE_Y], self.table[w, PLACE_Z]
        return ti.Vector(
            [y + half[0], z + half[1], middle, -rate * half[1], rate * half[0], rate, y + whole[0], z + whole[1], end]
        )
