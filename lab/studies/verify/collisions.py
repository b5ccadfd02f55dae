"""Head-on collisions of two grains, or of a grain and a wall."""

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import HertzCollision, hertz_stiffness, sphere_mass
from lab.studies.verify.scenes import WEIGHTLESS, Setup, each_at_its_step, grain, track

SECTION = "Collisions"
RIGID = 1e15  # Pa, the most that a preset may say
CHUNG_OOI = "Chung and Ooi (2011)"
STEPS_A_COLLISION = "scheme O(Δt²), 25 steps a collision"
BOX = {"width": 1.0, "height": 1.0}


def elastic(young: float, poisson: float, density: float, friction: float) -> dict[str, float]:
    """A material whose restitution an elastic law ignores."""
    return {"young": young, "poisson": poisson, "density": density, "friction": friction, "restitution": 1.0}


# Material, and what Chung and Ooi print: largest overlap (µm), largest force (kN), duration (µs).
SPHERES = {
    "glass": (elastic(48e9, 0.20, 2800.0, 0.35), (274.1, 10.697, 40.34)),
    "limestone": (elastic(20e9, 0.25, 2500.0, 0.35), (368.3, 7.108, 54.20)),
}
SPHERE, SPEED, GAP = 0.01, 10.0, 1e-6
# Of a sphere that meets a rigid plane.
BALLS = {
    "aluminium": (elastic(70e9, 0.30, 2699.0, 0.35), (49.72, 11.370, 731.6)),
    "magnesium": (elastic(40e9, 0.35, 1800.0, 0.35), (52.12, 7.233, 767.0)),
}
BALL, SLOWLY = 0.1, 0.2


def spheres(_: bool) -> Found:
    """Two equal spheres meet at ± 10 m/s (their test 1)."""
    rows = [grain(side * (SPHERE + GAP / 2), 0.5, SPHERE, -side * SPEED) for side in (-1.0, 1.0)]
    setups = [_elastic_setup(rows, material) for material, _ in SPHERES.values()]
    lines = []
    for k, run in each_at_its_step(*setups):
        name, (material, published) = list(SPHERES.items())[k]
        mass = 0.5 * sphere_mass(SPHERE, material["density"])
        stiffness = hertz_stiffness(material["young"], material["poisson"], 0.5 * SPHERE)
        closed = HertzCollision(mass, stiffness, 2.0 * SPEED)
        path = track(run, int(1.2 * closed.duration / run.dt))
        overlap = 2.0 * SPHERE - np.diff(path.position[:, k, :, 0], axis=1)[:, 0]
        lines += _impact_lines(name, path.time, overlap, closed, published)
    return Found(lines)


def wall(_: bool) -> Found:
    """A sphere meets a rigid plane at 0.2 m/s (their test 2)."""
    rows = [grain(0.0, BALL + GAP, BALL, 0.0, -SLOWLY)]
    setups = [_elastic_setup(rows, material, {"young": RIGID}) for material, _ in BALLS.values()]
    lines = []
    for k, run in each_at_its_step(*setups):
        name, (material, published) = list(BALLS.items())[k]
        stiffness = hertz_stiffness(material["young"], material["poisson"], BALL, RIGID)
        closed = HertzCollision(sphere_mass(BALL, material["density"]), stiffness, SLOWLY)
        path = track(run, int(1.2 * closed.duration / run.dt))
        lines += _impact_lines(name, path.time, BALL - path.position[:, k, 0, 1], closed, published)
    return Found(lines)


def _elastic_setup(rows: list, material: dict, against: dict | None = None) -> Setup:
    laws = {"normal": "hertz", "tangential": "mindlin"}
    return Setup(np.array(rows), material, BOX, against or {}, laws, run={"gravity": WEIGHTLESS})


def _impact_lines(
    name: str, time: np.ndarray, overlap: np.ndarray, closed: HertzCollision, published: tuple[float, ...]
) -> list[Line]:
    """Depth, force and duration of an elastic collision whose overlap (T,) m begins at −GAP, beside both references."""
    force = -closed.mass * np.diff(overlap, 2) / time[1] ** 2
    leaving = (overlap[-2] - overlap[-1]) / time[1]
    duration = time[-1] + overlap[-1] / leaving - GAP / closed.speed
    found = (
        ("largest overlap", 1e6 * peak(overlap), 1e6 * closed.deepest, "µm"),
        ("largest force", 1e-3 * peak(force), 1e-3 * closed.force, "kN"),
        ("duration", 1e6 * duration, 1e6 * closed.duration, "µs"),
    )
    lines = []
    for (quantity, value, reference, unit), printed in zip(found, published, strict=True):
        quantity = f"{quantity}, {name}"
        lines.append(Line(quantity, value, reference, "closed form (Hertz 1882)", 1.5e-3, STEPS_A_COLLISION, unit))
        lines.append(Line(quantity, value, printed, CHUNG_OOI, 1.7e-3, f"{STEPS_A_COLLISION}; digits printed", unit))
    return lines


def peak(values: np.ndarray) -> float:
    """Largest value of a curve (T,), by the parabola through its three highest points."""
    k = int(np.clip(values.argmax(), 1, len(values) - 2))
    before, middle, after = values[k - 1 : k + 2]
    return middle + (after - before) ** 2 / (8.0 * (2.0 * middle - before - after))


CASES = (
    Case("impact-spheres", SECTION, "Two elastic spheres head-on at ±10 m/s (Chung and Ooi 2011, test 1)", spheres),
    Case("impact-wall", SECTION, "An elastic sphere on a rigid plane, 0.2 m/s (Chung and Ooi 2011, test 2)", wall),
)
