"""Single collisions at many speeds and spins: in the solver at several steps, and by integrating the law itself."""

from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf

import numpy as np
from scipy.integrate import solve_ivp

from lab.preset.outline import rectangle
from lab.studies.verify.impacts.law import Bodies, Impact, Normal, Shear
from lab.studies.verify.references import (
    RIGID,
    HertzCollision,
    damping_of,
    dissipative_time,
    hertz_stiffness,
    mindlin_stiffness,
    sphere_mass,
)
from solvers.grains.given import Grains
from solvers.grains.materials import Material
from solvers.scene import Scene
from solvers.simulation import Simulation

PHASES = (0.1, 0.4, 0.7)  # of a step, when contact begins
MEAN_ROOT_CUBED = 0.68109  # of (ξ/ξ_max)^(3/4) over an elastic collision, where ω_t ∝ ξ^(1/4)
LONGEST = 12.0  # elastic collisions; none here takes longer
HEAVIER, LARGER = 1000.0, 5.0  # density and radius of a giant, which stands for a plane


@dataclass(frozen=True)
class Substance:
    """Young's modulus (Pa), Poisson's ratio and density (kg/m³)."""

    name: str
    young: float
    poisson: float
    density: float


@dataclass(frozen=True, eq=False)
class Meetings:
    """Spheres of a radius (m) that come down on another body at a closing speed (m/s) and move past it or spin.

    `along` (n,) m/s and `spin` (n,) rad/s of the first body; speed and restitution (n,) or one. The restitution is that
    at each closing speed, or for all of them at the speed `given_at`. The other body is a "plane" of Young's modulus
    `wall`, a "twin", which spins the other way, or a "giant" at rest. Under the viscoelastic or another `normal`
    law, along the plane under Mindlin's, or Haff and Werner's with a `damper` (N s/m); contact begins at some `phases`
    of a step. The solver is told the dissipative time or, if `told`, the restitution.
    """

    substance: Substance
    radius: float
    speed: float | np.ndarray
    friction: float
    restitution: float | np.ndarray = 1.0
    along: np.ndarray = field(default_factory=lambda: np.zeros(1))
    spin: np.ndarray = field(default_factory=lambda: np.zeros(1))
    mate: str = "plane"
    wall: float = RIGID
    given_at: float | None = None
    damper: float | None = None
    normal: str = "hertz-viscoelastic"
    told: bool = False
    integrator: str = "verlet"
    phases: tuple[float, ...] = PHASES

    @cached_property
    def all(self) -> np.ndarray:
        """Restitution, speed along, spin and closing speed of every meeting (n, 4)."""
        return np.column_stack(np.broadcast_arrays(self.restitution, self.along, self.spin, self.speed))

    @cached_property
    def bodies(self) -> Bodies:
        """The two."""
        mass = sphere_mass(self.radius, self.substance.density)
        other = {
            "plane": (0.0, inf),
            "twin": (self.radius, mass),
            "giant": (LARGER * self.radius, HEAVIER * LARGER**3 * mass),
        }
        return Bodies(self.radius, mass, *other[self.mate])

    @cached_property
    def contact(self) -> tuple[float, float]:
        """k and 8 G* √R_eff (N/m^1.5)."""
        s, other = self.substance, self.bodies.other_radius
        reduced = 1.0 / (1.0 / self.radius + (1.0 / other if other else 0.0))
        wall = None if other else self.wall
        moduli = s.young, s.poisson, reduced, wall
        return hertz_stiffness(*moduli), mindlin_stiffness(*moduli)

    def elastic(self, k: int = 0) -> HertzCollision:
        """A meeting head-on and without losses."""
        return HertzCollision(self.bodies.m_eff, self.contact[0], float(self.all[k, 3]))

    def time(self, e: float, speed: float) -> float:
        """The dissipative time A (s) of a restitution e, given at a speed (m/s) if not at one for all."""
        return dissipative_time(damping_of(e), self.bodies.m_eff, self.contact[0], self.given_at or speed)

    @cached_property
    def expected(self) -> np.ndarray:
        """Velocity of the first body past the second (y, z) m/s and both spins (rad/s) after each meeting (n, 4)."""
        found, (stiffness, shear) = [], self.contact
        for e, along, spin, speed in self.all:
            time = self.time(e, speed)
            rough = Shear(self.friction, shear, 0.5, time) if self.friction else Shear(0.0)
            if self.damper:
                rough = Shear(self.friction, damper=self.damper)
            law = Normal(stiffness, 1.5 * time * stiffness), rough
            spins = spin, -spin if self.mate == "twin" else 0.0
            found.append(Impact(self.bodies, *law).meet(along, speed, spins))
        return np.array(found)

    def scene(self, chosen: slice = slice(None), phases: int = 0) -> Scene:
        """A world for each of the meetings that are chosen, at each phase, or at so many."""
        s, rows = self.substance, np.repeat(self.all[chosen], phases or len(self.phases), axis=0)
        own, wall = (
            [Material(s.density, young, s.poisson, self.friction, **self._losses(e, speed)) for e, _, _, speed in rows]
            for young in (s.young, self.wall)
        )
        size = [self.radius] + ([self.bodies.other_radius] if self.bodies.other_radius else [])
        more = {}
        if self.mate == "giant":
            heavy = replace(own[0], density=HEAVIER * s.density)
            more = {"others": (heavy,), "kind": np.tile([0, 1], (len(rows), 1)), "unlike": (((0, 1), own[0]),)}
        slowest = self.elastic(int(self.all[:, 3].argmin())).duration
        half = 20.0 * max(size) + 20.0 * slowest * np.abs(rows[:, 1]).max()
        law = "haff-werner" if self.damper else "mindlin" if self.friction else "none"
        fastest = float(np.hypot(rows[:, 1], rows[:, 3]).max())
        return Scene(
            np.array(rectangle(2.0 * half, half)),
            (
                Grains(
                    np.tile(size, (len(rows), 1)),
                    own,
                    wall,
                    normal=self.normal,
                    tangential=law,
                    integrator=self.integrator,
                    start_speed=fastest,
                    **more,
                ),
            ),
            gravity=0.0,
        )

    def _losses(self, e: float, speed: float) -> dict[str, float]:
        damped = {"shear_damping": self.damper} if self.damper else {}
        if self.told:
            return {"restitution": e, "restitution_speed": self.given_at or speed, **damped}
        return {"dissipative_time": self.time(e, speed), **damped}

    def steps(self) -> np.ndarray:
        """The derived step (n,) s of every meeting by itself."""
        return np.array([self.scene(slice(k, k + 1), 1).time_step() for k in range(len(self.all))])

    @cached_property
    def late(self) -> np.ndarray:
        """By how much (n,) of its slip a contact that sticks all the time may err at the derived step.

        Slip swings with ω_t² = (7/2) k_t/m*, k_t = 8 G* √(R* ξ), which a leapfrog makes too fast by a share
        (ω_t Δt)²/24 (Hairer, Lubich and Wanner 2006, IX), so that it ends (Δt²/24) ∫ ω_t³ dt of an angle ahead. That
        is the error where the slip is steepest in the angle; what slides at times errs by less.
        """
        found = []
        for k, step in enumerate(self.steps()):
            hertz = self.elastic(k)
            peak = np.sqrt(3.5 * self.contact[1] * np.sqrt(hertz.deepest) / self.bodies.m_eff)
            found.append(step**2 / 24.0 * peak**3 * MEAN_ROOT_CUBED * hertz.duration)
        return np.array(found)

    def run(self, lengths: tuple[float, ...]) -> np.ndarray:
        """What `expected` is (lengths, phases, n, 4), each meeting at its own derived step times the lengths."""
        scene, steps, found = self.scene(), self.steps(), []
        place = self._starts(scene, 0.0)[0]
        run = Simulation(scene, place, 1, arch="cpu")
        for longer in lengths:
            for k, step in enumerate(longer * steps):
                run.dt = step
                run.start_clock()
                run.place(*self._starts(scene, step))
                run.advance(int(LONGEST * self.elastic(k).duration / step))
                found.append(self._relative(run)[k])
        run.close()
        return np.moveaxis(np.array(found).reshape(len(lengths), len(steps), len(self.phases), 4), 1, 2)

    def _starts(self, scene: Scene, step: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Places (W, n, 2) m, velocities and spins of all worlds, to touch at their phases of a step (s)."""
        rows, other = np.repeat(self.all, len(self.phases), axis=0), self.bodies.other_radius
        gap = (0.5 + np.tile(self.phases, len(self.all))) * step * rows[:, 3]
        base = 0.5 * np.ptp(scene.outline[:, 1]) if other else 0.0
        place = np.zeros((*scene.grains.radius.shape, 2))
        velocity, spin = np.zeros_like(place), np.zeros(scene.grains.radius.shape)
        place[:, 0, 1] = base + other + self.radius + gap
        velocity[:, 0], spin[:, 0] = np.column_stack([rows[:, 1], -rows[:, 3]]), rows[:, 2]
        if other:
            place[:, 1, 1] = base
        if self.mate == "twin":
            velocity[:, 1] = -0.5 * velocity[:, 0]
            velocity[:, 0] *= 0.5
            spin[:, 1] = -spin[:, 0]
        return place, velocity, spin

    def _relative(self, run: Simulation) -> np.ndarray:
        """Velocities past the second body and both spins (n, phases, 4) now."""
        state = run.snapshot()
        velocity, spin = state["velocity"], state["spin"]
        if velocity.shape[1] == 1:
            velocity = np.concatenate([velocity, np.zeros_like(velocity)], axis=1)
            spin = np.concatenate([spin, np.zeros_like(spin)], axis=1)
        columns = np.concatenate([velocity[:, 0] - velocity[:, 1], spin], axis=1)
        return columns.reshape(len(self.all), len(self.phases), 4)

    def forces(self, lengths: tuple[float, ...]) -> list[tuple[np.ndarray, ...]]:
        """For each length of step: times since touch (T,) s, overlaps (m) and forces (N) in the solver and by Hertz.

        Of the first meeting and phase; forces are second differences of places, which are Verlet's to rounding.
        """
        scene, step, found = self.scene(), self.steps()[0], []
        run = Simulation(scene, self._starts(scene, 0.0)[0], 1, arch="cpu")
        for longer in lengths:
            run.dt = longer * step
            run.start_clock()
            run.place(*self._starts(scene, run.dt))
            depth = [self._depth(run)]
            for _ in range(int(1.3 * self.elastic().duration / run.dt) + 2):
                run.advance(1)
                depth.append(self._depth(run))
            overlap = np.array(depth)
            time = run.dt * np.arange(len(overlap)) + overlap[0] / self.elastic().speed
            force = -self.elastic().mass * np.diff(overlap, 2) / run.dt**2
            found.append((time[1:-1], overlap[1:-1], force, *self._hertz(time[1:-1])))
        run.close()
        return found

    def _depth(self, run: Simulation) -> float:
        place = run.snapshot()["position"][0]
        apart = place[0, 1] - (place[1, 1] if len(place) > 1 else 0.0)
        return self.radius + self.bodies.other_radius - apart

    def _hertz(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Overlaps (m) and forces (N) of the elastic collision at times since touch, by DOP853 at 1e-11."""
        c = self.elastic()

        def motion(_, state):
            return [state[1], -c.stiffness * max(state[0], 0.0) ** 1.5 / c.mass]

        overlap, inside = c.speed * time, time > 0.0
        scale = [1e-12 * c.deepest, 1e-12 * c.speed]
        span = (0.0, time[-1])
        path = solve_ivp(motion, span, [0.0, c.speed], "DOP853", t_eval=time[inside], rtol=1e-11, atol=scale)
        overlap[inside] = path.y[0]
        return overlap, c.stiffness * np.clip(overlap, 0.0, None) ** 1.5
