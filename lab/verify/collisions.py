"""Head-on collisions of two grains, or of a grain and a wall."""

import numpy as np

from lab.verify.case import Case, Found, Line
from lab.verify.references import HertzCollision, hertz_stiffness, sphere_mass
from lab.verify.scenes import WEIGHTLESS, Setup, Track, each_at_its_step, grain, track

SECTION = "Collisions"
RIGID = 1e30  # Pa
CHUNG_OOI = "Chung and Ooi (2011)"
STEPS_A_COLLISION = "scheme O(Δt²), 36 steps a collision"
BOX = {"width": 1.0, "height": 1.0}


def elastic(young: float, poisson: float, density: float, friction: float) -> dict[str, float]:
    """A material whose restitution an elastic law ignores."""
    return {"young": young, "poisson": poisson, "density": density, "friction": friction, "restitution": 1.0}


# Material, and what Chung and Ooi print: largest overlap (µm), largest force (kN), duration (µs).
SPHERES = {
    "glass": (elastic(48e9, 0.20, 2800.0, 0.35), (274.1, 10.697, 40.34)),
    "limestone": (elastic(20e9, 0.25, 2500.0, 0.35), (368.3, 7.108, 54.20)),
}
SPHERE, SPEED = 0.01, 10.0


def spheres(_: bool) -> Found:
    """Two equal spheres meet at ± 10 m/s (their test 1)."""
    gap = 1e-6
    rows = [grain(side * (SPHERE + gap / 2), 0.5, SPHERE, -side * SPEED) for side in (-1.0, 1.0)]
    laws = {"normal": "hertz", "tangential": "mindlin"}
    setups = [Setup(np.array(rows), m, BOX, contact=laws, run={"gravity": WEIGHTLESS}) for m, _ in SPHERES.values()]
    lines = []
    for k, run in each_at_its_step(*setups):
        name, (material, published) = list(SPHERES.items())[k]
        mass = 0.5 * sphere_mass(SPHERE, material["density"])
        stiffness = hertz_stiffness(material["young"], material["poisson"], 0.5 * SPHERE)
        closed = HertzCollision(mass, stiffness, 2.0 * SPEED)
        path = track(run, int(1.2 * closed.duration / run.dt))
        overlap = 2.0 * SPHERE - np.diff(path.position[:, k, :, 0], axis=1)[:, 0]
        lines += _impact_lines(name, path, overlap, mass, closed, published)
    return Found(lines)
