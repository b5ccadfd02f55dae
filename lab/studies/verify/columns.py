"""Cargo at rest: the contact forces in a column, that nothing moves, and the weight of a bed on its tank."""

from functools import cache

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import hertz_stiffness, sphere_mass
from lab.studies.verify.scenes import ACETATE, G, Setup, Track, grain, simulated, track

SECTION = "Rest"
RADIUS, COUNT, SOFT = 1.5e-3, 12, 1e-3  # m; of the stiffness
MASS = sphere_mass(RADIUS, ACETATE["density"])
REST, LIMIT = 1e-14, 4.0  # of m g d, of the mean kinetic energy; s
SETTLED = "settled to 1e-14 m g d: a swing of 1e-5 of the overlaps"
LOOKS, LOOK = 20, 0.01  # s


def settled(setup: Setup) -> tuple[Track, dict[str, np.ndarray]]:
    """What a setup does in 0.2 s once it has come to rest, and what is observed of it, averaged over that time."""
    with simulated(setup) as run:
        if not run.settle(REST, LIMIT):
            raise RuntimeError(f"nothing rests within {LIMIT:g} s")
        run.observe()
        path = track(run, LOOKS, round(LOOK / run.dt))
        return path, {name: values[0] for name, values in run.observe().items()}


@cache
def column() -> tuple[Track, dict[str, np.ndarray]]:
    """Twelve grains upon one another in a slot."""
    rows = [grain(0.0, RADIUS * (1 + 2 * k), RADIUS) for k in range(COUNT)]
    tank = {"width": 2.0 * RADIUS * 1.0001, "height": 0.05}
    return settled(Setup(np.array(rows), ACETATE, tank, contact={"tangential": "mindlin", "stiffness_scale": SOFT}))


def pressure(_: bool) -> Found:
    """Every contact of a column carries the weight above it."""
    path, observed = column()
    height = path.position[-1, 0, :, 1]
    overlap = np.array([RADIUS - height[0], *(2.0 * RADIUS - np.diff(height))])
    young, poisson = SOFT * ACETATE["young"], ACETATE["poisson"]
    stiffness = np.full(COUNT, hertz_stiffness(young, poisson, RADIUS / 2.0))
    stiffness[0] = hertz_stiffness(young, poisson, RADIUS)
    force = 1e3 * stiffness * overlap**1.5
    above = 1e3 * MASS * G * np.arange(COUNT, 0, -1)
    names = [f"force on contact {k + 1}" for k in range(COUNT)]
    lines = [Line(names[k], force[k], above[k], "weight above", 1e-4, SETTLED, "mN") for k in range(COUNT)]
    load = -1e3 * observed["wall_force"][..., 1]
    return Found([*lines, Line("force on the tank", load, above[0], "weight of all", 1e-6, SETTLED, "mN")])


def stillness(_: bool) -> Found:
    """A settled column stays at rest."""
    path, _ = column()
    allowed = np.sqrt(2.0 * REST * COUNT * G * 2.0 * RADIUS)  # as if one grain had all the energy that may be left
    speed = np.abs(path.velocity).max()
    return Found([Line.off("largest speed", "rest", speed, allowed, SETTLED, "m/s"), creep_line(path)])


def bed(_: bool) -> Found:
    """The tank carries the weight of a settled bed, at its centre of mass, and nothing sideways."""
    random = np.random.default_rng(3)
    sites = np.stack(np.meshgrid(np.arange(16) - 7.5, np.arange(9) + 0.6), axis=-1).reshape(-1, 2)
    places = 2.3 * RADIUS * (sites + random.uniform(-0.04, 0.04, sites.shape))
    radius = RADIUS * random.uniform(0.8, 1.0, len(places))
    rows = [grain(y, z, size) for (y, z), size in zip(places, radius, strict=True)]
    material = ACETATE | {"friction": 0.5, "restitution": 0.3, "rolling_friction": 0.1}
    contact = {"tangential": "mindlin", "rolling": "elastic-plastic", "stiffness_scale": SOFT}
    path, observed = settled(Setup(np.array(rows), material, {"width": 0.058, "height": 0.06}, contact=contact))
    weight = G * sphere_mass(1.0, ACETATE["density"]) * (radius**3).sum()
    sideways = observed["wall_force"][..., 0] / weight
    moment, expected = -1e6 * observed["wall_force"][..., 2], 1e6 * weight * observed["centre_of_mass"][..., 0]
    lines = [
        Line("force down", -1e3 * observed["wall_force"][..., 1], 1e3 * weight, "weight", 1e-6, SETTLED, "mN"),
        Line.off("force sideways, of the weight", "rest", sideways, 1e-6, SETTLED),
        Line("moment about the floor's middle", moment, expected, "weight at its centre", 1e-5, SETTLED, "µN m"),
        creep_line(path),
    ]
    note = "With rolling friction; without, a loose grain rolls to and fro between its neighbours for seconds."
    return Found(lines, notes=[note])


def creep_line(path: Track) -> Line:
    """How far any grain goes while all should rest."""
    shift = np.linalg.norm(path.position[-1] - path.position[0], axis=-1).max() / RADIUS
    name = f"largest shift in {path.time[-1] - path.time[0]:.2g} s, in radii"
    return Line.off(name, "a spring with history holds", shift, 1e-7, SETTLED)


CASES = (
    Case("column-pressure", SECTION, "What the contacts of a column carry", pressure),
    Case("column-stillness", SECTION, "A column at rest", stillness),
    Case("bed-weight", SECTION, "A settled bed on its tank", bed, quick=False),
)
