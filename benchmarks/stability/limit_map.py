"""The true limit of stability against the derived step: a compressed packing with a small disturbance.

Contacts are as deep as the hardest impact for which the step is derived (`packings`). The packing is in equilibrium,
and the exact motion of a small disturbance keeps its energy or loses it. A step is unstable if the kinetic energy of
the disturbance, spin included, grows by GROWTH within STEPS steps, or if the watch stops the run.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from benchmarks.stability.packings import RADIUS, SPEED, Packing, material, packing
from solvers.grains.given import Grains
from solvers.grains.laws import NORMAL, TANGENTIAL
from solvers.machine.errors import BadState
from solvers.machine.limit import furthest
from solvers.machine.quantity import PLANE, SPACE
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.time.watch import RUNNING

DISTURBED = 1e-6  # of the impact's speed
GROWTH, STEPS, LOOKS = 1e4, 2000, 10
RESTITUTIONS = {"undamped": 1.0, "e = 0.5": 0.5, "e = 0.05": 0.05}
DAMPINGS = tuple(RESTITUTIONS)
SOFT = 1e-2  # of the stiffness
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


def found(integrator: str, fast: bool, axes: int = PLANE) -> Iterator[Limit]:
    """The limits of an integrator with every normal law alone and, on the default one, with every law of friction."""
    pairs = [(normal, "none") for normal in NORMAL]
    pairs += [("hertz-viscoelastic", friction) for friction in TANGENTIAL if friction != "none"]
    for normal, friction in pairs[:1] if fast else pairs:
        yield from limits(integrator, normal, friction, axes)


def limits(integrator: str, normal: str, friction: str, axes: int = PLANE) -> Iterator[Limit]:
    """The longest stable steps under two laws for every restitution, one world each."""
    of = packing(normal, axes)
    made = scene(of, RESTITUTIONS.values(), integrator, normal, friction)
    places = np.tile(of.places, (made.worlds, 1, 1))
    run = Simulation(made, places, 1, arch="cpu")
    for world, (damping, restitution) in enumerate(RESTITUTIONS.items()):
        if normal == "hertz" and world:  # it loses nothing whatever the restitution
            break
        alone = scene(of, [restitution], integrator, normal, friction)
        derived, soft = alone.step_limits()[0].step, replace(alone, stiffness_scale=SOFT).step_limits()
        true = longest(lambda step, w=world: grows(run, places, w, step), derived)
        known = not world and friction == "none" and integrator in CONSERVATIVE
        exact = of.exact_limit() if known else None
        forced = derived * furthest(soft) / soft[0].step
        yield Limit(integrator, normal, friction, damping, derived, forced, true, exact)
    run.close()


def scene(of: Packing, restitutions, integrator: str, normal: str, friction: str) -> Scene:
    """The packing in one world for each restitution."""
    materials = [material(e) for e in restitutions]
    return Scene(
        of.outline,
        (
            Grains(
                np.full((len(materials), len(of.places)), RADIUS),
                materials,
                materials,
                normal=normal,
                tangential=friction,
                start_speed=SPEED,
                integrator=integrator,
            ),
        ),
        gravity=0.0,
        solid=of.solid,
    )


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
    turns = places.shape if places.shape[2] == SPACE else places.shape[:2]
    spin = SPEED * DISTURBED / RADIUS * random.normal(size=turns)
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
    """Kinetic energy of equal grains, velocities (n, axes) m/s and spins rad/s, per half mass of one (m²/s²)."""
    return float((velocity**2).sum() + 0.4 * RADIUS**2 * (spin**2).sum())
