"""The true limit of stability against the derived step: a compressed packing with a small disturbance.

Six grains surround a seventh in a hexagonal tank that compresses them, so that every contact is as deep as the hardest
impact for which the step is derived. The packing is in equilibrium, and the exact motion of a small disturbance keeps
its energy or loses it. A step is unstable if the kinetic energy of the disturbance, spin included, grows by GROWTH
within STEPS steps, or if the watch stops the run.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sqrt

import numpy as np

from lab.studies.bench.speed.beds import ACETATE
from solvers.grains.given import Grains
from solvers.grains.laws import NORMAL, TANGENTIAL
from solvers.grains.materials import Material, effective_young, hertz_stiffness
from solvers.machine.errors import BadState
from solvers.machine.limit import furthest
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.time.watch import RUNNING

RADIUS = 1.5e-3  # m
SPEED = 1.0  # m/s, of the impact, and that at which the linear spring is as deep as Hertz's contact
DISTURBED = 1e-6  # of that speed
GROWTH, STEPS, LOOKS = 1e4, 2000, 10
RESTITUTIONS = {"undamped": 1.0, "e = 0.5": 0.5, "e = 0.05": 0.05}
DAMPINGS = tuple(RESTITUTIONS)
SOFT = 1e-2  # of the stiffness
STUCK = 100.0  # a friction coefficient that no disturbance overcomes
COARSE, FINE = 1.5, 1.01  # ratios of steps: of the search for a bracket, and of the bracket at its end
WIDEST = 100.0  # derived steps, up and down
NEAR_EXACT = 0.02  # the bracket, and growth that is slow next to the limit
CONSERVATIVE = ("verlet", "symplectic-euler")  # whose limit on an oscillator is 2/ω (Hairer, Lubich and Wanner 2006)


@dataclass(frozen=True)
class Limit:
    """The longest stable step (s) of an integrator under two laws with a damping, beside the derived one.

    `forced` is the longest (s) that a user may force, as with softer grains, for which Rayleigh waves set no bound;
    in derived steps the limits are the same whatever the stiffness. `exact` is 2/ω (s) where that is known, else None.
    """

    integrator: str
    normal: str
    tangential: str
    damping: str
    derived: float
    forced: float
    true: float
    exact: float | None

    @property
    def ratio(self) -> float:
        """True over derived."""
        return self.true / self.derived


def found(integrator: str, fast: bool) -> Iterator[Limit]:
    """The limits of an integrator with every normal law alone and, on the default one, with every law of friction."""
    pairs = [(normal, "none") for normal in NORMAL]
    pairs += [("hertz-viscoelastic", friction) for friction in TANGENTIAL if friction != "none"]
    for normal, friction in pairs[:1] if fast else pairs:
        yield from limits(integrator, normal, friction)


def limits(integrator: str, normal: str, friction: str) -> Iterator[Limit]:
    """The longest stable steps under two laws for every restitution, one world each."""
    made = scene(RESTITUTIONS.values(), integrator, normal, friction)
    places = np.tile(packing(normal)[1], (made.worlds, 1, 1))
    run = Simulation(made, places, 1, arch="cpu")
    for world, (damping, restitution) in enumerate(RESTITUTIONS.items()):
        if normal == "hertz" and world:  # it loses nothing whatever the restitution
            break
        alone = scene([restitution], integrator, normal, friction)
        derived, soft = alone.step_limits()[0].step, replace(alone, stiffness_scale=SOFT).step_limits()
        true = longest(lambda step, w=world: grows(run, places, w, step), derived)
        known = not world and friction == "none" and integrator in CONSERVATIVE
        exact = exact_limit(normal) if known else None
        forced = derived * furthest(soft) / soft[0].step
        yield Limit(integrator, normal, friction, damping, derived, forced, true, exact)
    run.close()


def material(restitution: float) -> Material:
    """Acetate with a restitution and so much friction that nothing slides."""
    return replace(ACETATE, restitution=restitution, restitution_speed=SPEED, friction=STUCK)


def scene(restitutions, integrator: str, normal: str, friction: str) -> Scene:
    """The packing in one world for each restitution."""
    materials = [material(e) for e in restitutions]
    outline, places = packing(normal)
    return Scene(
        outline,
        (
            Grains(
                np.full((len(materials), len(places)), RADIUS),
                materials,
                materials,
                normal=normal,
                tangential=friction,
                start_speed=SPEED,
                integrator=integrator,
            ),
        ),
        gravity=0.0,
    )


@dataclass(frozen=True)
class Contact:
    """A contact in the packing: overlap (m), force (N) and the force's slope (N/m)."""

    overlap: float
    force: float
    slope: float


def contacts(normal: str) -> tuple[Contact, Contact]:
    """Of two grains, and of an outer grain and each of its two walls, in equilibrium without losses.

    Two grains overlap as in Hertz's collision at SPEED, ξ = ((5/4) m_eff v²/k)^(2/5). An outer grain bears the force F
    of the middle one and of two neighbours, 2 F outwards in sum, and so F/cos 30° at a wall. F = k ξ^(3/2), or that of
    the linear spring that is as deep at that speed, k_l = (4/5)^(4/5) (k⁴ m_eff v²)^(1/5).
    """
    grain = material(1.0)
    mass, young = _mass(grain), effective_young(grain, grain)
    pair, wall = hertz_stiffness(young, 0.5 * RADIUS), hertz_stiffness(young, RADIUS)
    overlap = (0.625 * mass * SPEED**2 / pair) ** 0.4
    if normal.startswith("hertz"):
        force = pair * overlap**1.5
        pressed = force / cos(pi / 6.0)
        deep = (pressed / wall) ** (2.0 / 3.0)
        return Contact(overlap, force, 1.5 * force / overlap), Contact(deep, pressed, 1.5 * pressed / deep)
    spring, wall_spring = (0.8**0.8 * (k**4 * m * SPEED**2) ** 0.2 for k, m in ((pair, 0.5 * mass), (wall, mass)))
    force = spring * overlap
    pressed = force / cos(pi / 6.0)
    return Contact(overlap, force, spring), Contact(pressed / wall_spring, pressed, wall_spring)


def packing(normal: str) -> tuple[np.ndarray, np.ndarray]:
    """Outline (6, 2) and places (7, 2), m, of the compressed packing."""
    pair, wall = contacts(normal)
    apart = 2.0 * RADIUS - pair.overlap
    corner = apart + (RADIUS - wall.overlap) / cos(pi / 6.0)
    around = _around(pi / 3.0 * np.arange(6))
    return corner * around, np.vstack([[0.0, 0.0], apart * around])


def exact_limit(normal: str) -> float:
    """2/ω (s) with the highest frequency ω of the packing without friction and losses.

    m ω² is the largest eigenvalue of the sum over contacts of s n nᵀ − (F/d)(1 − n nᵀ), slope s, force F, normal n and
    distance d, as in lattice dynamics; a wall is flat and has only the first term.
    """
    pair, wall = contacts(normal)
    places = packing(normal)[1]
    apart = 2.0 * RADIUS - pair.overlap
    matrix = np.zeros((7, 2, 7, 2))
    for i in range(7):
        for j in range(i):
            away = places[i] - places[j]
            if np.hypot(*away) < 1.01 * apart:
                along = np.outer(away, away) / apart**2
                block = pair.slope * along - pair.force / apart * (np.eye(2) - along)
                for a, b, sign in ((i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)):
                    matrix[a, :, b, :] += sign * block
    for k in range(6):
        for inwards in _around(pi / 3.0 * k + np.array([pi / 6.0, -pi / 6.0])):
            matrix[k + 1, :, k + 1, :] += wall.slope * np.outer(inwards, inwards)
    stiffest = np.linalg.eigvalsh(matrix.reshape(14, 14)).max()
    return 2.0 / sqrt(stiffest / _mass(material(1.0)))


def longest(unstable: Callable[[float], bool], derived: float) -> float:
    """The longest stable step (s), by bisection of its logarithm from a bracket found from the derived one.

    Zero where none down to 1/WIDEST of it is stable; no longer than WIDEST times it.
    """
    step, stable = derived, 0.0
    if unstable(step):
        while unstable(step):
            step /= COARSE
            if step < derived / WIDEST:
                return 0.0
        stable, step = step, COARSE * step
    else:
        while not unstable(step):
            stable, step = step, COARSE * step
            if step > WIDEST * derived:
                return stable
    while step > FINE * stable:
        middle = sqrt(stable * step)
        stable, step = (stable, middle) if unstable(middle) else (middle, step)
    return stable


def grows(run: Simulation, places: np.ndarray, world: int, step: float) -> bool:
    """Whether the disturbance of a world's packing grows with this step."""
    random = np.random.default_rng(1)
    velocity = SPEED * DISTURBED * random.normal(size=places.shape)
    spin = SPEED * DISTURBED / RADIUS * random.normal(size=places.shape[:2])
    start = kinetic(velocity[world], spin[world])
    run.dt = step
    run.start_clock()
    run.place(places, velocity, spin)
    for _ in range(LOOKS):
        try:
            run.advance(STEPS // LOOKS)
        except BadState:  # of any world
            if run.clock.status.to_numpy()[world] != RUNNING:
                return True
        state = run.snapshot()
        if not kinetic(state["velocity"][world], state["spin"][world]) < GROWTH * start:
            return True
    return False


def kinetic(velocity: np.ndarray, spin: np.ndarray) -> float:
    """Kinetic energy of equal grains, velocities (n, 2) m/s and spins (n,) rad/s, per half mass of one (m²/s²)."""
    return float((velocity**2).sum() + 0.4 * RADIUS**2 * (spin**2).sum())


def _mass(grain: Material) -> float:
    return 4.0 / 3.0 * pi * RADIUS**3 * grain.density


def _around(angle: np.ndarray) -> np.ndarray:
    """Unit vectors (n, 2)."""
    return np.column_stack([np.cos(angle), np.sin(angle)])
