"""Where steps do become unstable, against where the lab stops: a compressed packing, disturbed a little, by law and scheme.

Six grains round a seventh in a hexagonal tank that squeezes them, so that every contact is as deep as the hardest
impact that the derived step is meant for. It is in equilibrium; the exact motion of a small disturbance keeps its
energy or loses it. A step is called unstable if the kinetic energy of the disturbance, spin included, grows by more than
GROWTH within STEPS steps, or the watch stops the run.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import cos, pi, sqrt

import numpy as np

from lab.bench.stability.beds import ACETATE
from solvers.errors import BadState
from solvers.integrators import INTEGRATORS
from solvers.laws import NORMAL, TANGENTIAL
from solvers.materials import Material, hertz_stiffness
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.watch import RUNNING

RADIUS, SPEED = 1.5e-3, 1.0  # m, m/s of the impact
DISTURBED = 1e-6  # of that speed
GROWTH, STEPS = 1e4, 2000
RESTITUTIONS = {"undamped": 1.0, "e = 0.3": 0.3}
STUCK = 100.0  # a friction coefficient that no disturbance overcomes
COARSE, FINE = 1.5, 1.01  # ratios of steps: of the search upwards, and of the bracket at its end
FARTHEST = 200.0  # derived steps


@dataclass(frozen=True)
class Found:
    """The longest stable step (s) of a scheme under two laws with a damping, beside the derived one."""

    integrator: str
    normal: str
    tangential: str
    damping: str
    derived: float
    true: float
    reason: str

    @property
    def ratio(self) -> float:
        """True over derived."""
        return self.true / self.derived


def combinations(fast: bool) -> list[tuple[str, str, str]]:
    """Integrators with every normal law without friction, and with every tangential law on the default normal one."""
    if fast:
        return [("verlet", "hertz-viscoelastic", "haff-werner")]
    pairs = [(normal, "none") for normal in NORMAL]
    pairs += [("hertz-viscoelastic", tangential) for tangential in TANGENTIAL if tangential != "none"]
    return [(integrator, *pair) for integrator in INTEGRATORS for pair in pairs]


def material(restitution: float) -> Material:
    """Acetate with a restitution and so much friction that nothing slides."""
    return replace(ACETATE, restitution=restitution, friction=STUCK)


def packing(normal: str) -> tuple[np.ndarray, np.ndarray]:
    """Outline (6, 2) and places (7, 2), m, of the compressed packing; equal materials.

    An outer grain bears the force F of the middle one and of two neighbours, 2 F outwards in sum, and its two walls
    F_w each at 30° to that: F_w = F/cos 30°. With F = k ξ^p the overlap at the walls follows from that of two grains.
    """
    grain = material(1.0)
    mass = 4.0 / 3.0 * pi * RADIUS**3 * grain.density
    young = grain.young / (2.0 * (1.0 - grain.poisson**2))
    overlap = (1.25 * 0.5 * mass * SPEED**2 / hertz_stiffness(young, 0.5 * RADIUS)) ** 0.4
    if normal.startswith("hertz"):
        power, softer = 1.5, sqrt(0.5)  # k ∝ √R_eff
    else:
        power, softer = 1.0, sqrt(0.5) ** 0.8 * 0.5**0.2  # k_l ∝ k^(4/5) m_eff^(1/5)
    at_wall = overlap * (softer / cos(pi / 6.0)) ** (1.0 / power)
    apart = 2.0 * RADIUS - overlap
    corner = apart + (RADIUS - at_wall) / cos(pi / 6.0)
    angle = pi / 3.0 * np.arange(6)
    around = np.column_stack([np.cos(angle), np.sin(angle)])
    return corner * around, np.vstack([[0.0, 0.0], apart * around])


def scene(restitutions, integrator: str, normal: str, tangential: str) -> Scene:
    """One world for each restitution."""
    materials = [material(e) for e in restitutions]
    outline, places = packing(normal)
    return Scene(
        np.full((len(materials), len(places)), RADIUS),
        outline,
        materials,
        materials,
        normal=normal,
        tangential=tangential,
        gravity=0.0,
        start_speed=SPEED,
        integrator=integrator,
    )


def measure(integrator: str, normal: str, tangential: str) -> Iterator[Found]:
    """The longest stable steps of one combination, undamped and damped."""
    made = scene(RESTITUTIONS.values(), integrator, normal, tangential)
    places = np.tile(packing(normal)[1], (made.worlds, 1, 1))
    run = Simulation(made, places, 1, arch="cpu")
    for world, (name, restitution) in enumerate(RESTITUTIONS.items()):
        limit = scene([restitution], integrator, normal, tangential).step_limits()[0]
        true = longest(lambda step, w=world: grows(run, places, w, step), limit.step)
        yield Found(integrator, normal, tangential, name, limit.step, true, limit.reason)
    run.close()


def longest(unstable, derived: float) -> float:
    """The longest stable step (s) by bisection of its logarithm, searched upwards from the derived one.

    Zero where the derived one is not stable, infinity where none up to FARTHEST times it is unstable.
    """
    stable, step = 0.0, derived
    while not unstable(step):
        stable, step = step, COARSE * step
        if step > FARTHEST * derived:
            return float("inf")
    if not stable:
        return 0.0
    while step > FINE * stable:
        middle = sqrt(stable * step)
        stable, step = (stable, middle) if unstable(middle) else (middle, step)
    return stable


def grows(run: Simulation, places: np.ndarray, world: int, step: float) -> bool:
    """Whether the disturbance of a world's packing grows with this step."""
    random = np.random.default_rng(1)
    velocity = SPEED * DISTURBED * random.normal(size=places.shape)
    spin = SPEED * DISTURBED / RADIUS * random.normal(size=places.shape[:2])
    run.dt = step
    run.start_clock()
    run.place(places, velocity, spin)
    start = kinetic(velocity[world], spin[world])
    for _ in range(10):
        try:
            run.advance(STEPS // 10)
        except BadState:
            if run.clock.status.to_numpy()[world] != RUNNING:
                return True
        state = run.snapshot()
        if not kinetic(state["velocity"][world], state["spin"][world]) < GROWTH * start:
            return True
    return False


def kinetic(velocity: np.ndarray, spin: np.ndarray) -> float:
    """Kinetic energy of equal grains, velocities (n, 2) m/s and spins (n,) rad/s, per half mass (m²/s²)."""
    return float((velocity**2).sum() + 0.4 * RADIUS**2 * (spin**2).sum())
