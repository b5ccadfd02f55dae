"""Conservation of momenta and energy, and the source's own checks of its code (Spandonidis 2016, tables 4.3, 6.3)."""

from dataclasses import dataclass

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import sphere_mass
from lab.studies.verify.scenes import ACETATE, WEIGHTLESS, Setup, again, grain, simulated

SECTION = "Conservation"
RADIUS, SOFT = 1.5e-3, 1e-3  # m; of the stiffness
COVERED = 0.3  # share of the plane that the gas covers
FASTEST = 0.6  # m/s, at the start, all along y
WARMING = 0.15  # share of the run that is left out of the averages
LOOKS, A_SNAPSHOT = 2000, 20  # at a run of 200 000 steps; looks from one at the single grains to the next
KEPT, AVERAGES = 5e-3, 2e-2  # the source's deviations of what is kept, and of its averages
CONFIDENCE = 1.96  # standard deviations, 95 %, as the source has it
CONSERVED = "Spandonidis (2016), table {}: < 0.5 %"
AVERAGED = "Spandonidis (2016), table {}: < 2 %"
CLOUD = 40


@dataclass(frozen=True)
class Gas:
    """What is seen of W gases: energies (T, W) J, shares (S, W) of the motion along y, grains inside at the end, and
    what is missing between the momenta (3, W) and the impulses of the walls, as a share of all grains' own."""

    kinetic: np.ndarray
    elastic: np.ndarray
    along: np.ndarray
    inside: int
    missing: np.ndarray


def gas_setup(count: int, seed: int) -> Setup:
    """Smooth elastic grains in a square box without gravity, whose energy is all in their motion along y."""
    random = np.random.default_rng(seed)
    side = np.sqrt(count * np.pi * RADIUS**2 / COVERED)
    across = int(np.ceil(np.sqrt(count)))
    pitch = side / across
    sites = np.stack(np.meshgrid(np.arange(across), np.arange(across)), axis=-1).reshape(-1, 2)[:count]
    clearance = pitch - 2.0 * RADIUS
    places = (sites + 0.5) * pitch - [side / 2.0, 0.0] + random.uniform(-0.45, 0.45, (count, 2)) * clearance
    speed = random.uniform(-FASTEST, FASTEST, count)
    rows = [grain(y, z, RADIUS, v) for (y, z), v in zip(places, speed, strict=True)]
    contact = {"normal": "hertz", "tangential": "none", "stiffness_scale": SOFT}
    box = {"width": side, "height": side}
    return Setup(np.array(rows), ACETATE | {"restitution": 1.0}, box, contact=contact, run={"gravity": WEIGHTLESS})


def momenta(mass: np.ndarray, radius: np.ndarray, place: np.ndarray, velocity: np.ndarray, spin: np.ndarray):
    """Momenta along y and z (kg m/s) and about the origin (kg m²/s) of each grain, (3, …)."""
    turning = place[..., 0] * velocity[..., 1] - place[..., 1] * velocity[..., 0] + 0.4 * radius**2 * spin
    return mass * np.array([velocity[..., 0], velocity[..., 1], turning])


def gas(count: int, worlds: int, steps: int) -> Gas:
    """Run gases with different initial states for a number of steps."""
    mass = sphere_mass(RADIUS, ACETATE["density"])
    energies, along, impulse = [], [], np.zeros((3, worlds))
    with simulated(*(gas_setup(count, seed) for seed in range(worlds)), threads=0) as run:
        start = run.snapshot()
        before = momenta(mass, RADIUS, start["position"], start["velocity"], 0.0)
        for look in range(1, LOOKS + 1):
            passed = steps * look // LOOKS - run.steps
            run.advance(passed - 1)
            place = run.snapshot()["position"] if look == LOOKS else None
            run.advance(1)
            rows = run.observe()
            impulse += passed * run.dt * rows["wall_force"].T
            energies.append([rows["kinetic"], rows["elastic"]])
            if look % A_SNAPSHOT == 0:
                square = (run.snapshot()["velocity"] ** 2).sum(axis=1)
                along.append(square[:, 0] / square.sum(axis=1))
        state = run.snapshot()
        # Verlet's velocities are those of the middles of its steps, and balance with its forces to rounding.
        after = momenta(mass, RADIUS, place, (state["position"] - place) / run.dt, 0.0)
        low, high = run.scene.outline.min(axis=0), run.scene.outline.max(axis=0)
    inside = int(np.all((state["position"] > low) & (state["position"] < high), axis=-1).sum())
    missing = np.abs((after - before).sum(axis=-1) + impulse) / np.abs(before[[0, 0, 2]]).sum(axis=-1)
    kinetic, elastic = np.moveaxis(np.array(energies), 1, 0)
    return Gas(kinetic, elastic, np.array(along), inside, missing)


def table_4_3(_: bool) -> Found:
    """2000 grains for 200 000 steps, as in the source's table 4.3."""
    found = gas(2000, 4, 200_000)
    return Found([*kept_lines(found, 8000, "4.3"), *average_lines(found, "4.3")], notes=[NOTE])


def table_6_3(_: bool) -> Found:
    """15560 grains, as in the source's table 6.3, for a tenth of its steps."""
    found = gas(15_560, 2, 20_000)
    note = "Two gases of 15560 grains for 20 000 steps, where the source took 200 000."
    return Found([*kept_lines(found, 31_120, "6.3"), *average_lines(found, "6.3")], notes=[note])


NOTE = """Four gases of 2000 grains for 200 000 steps. The source checks a system in equilibrium after Haile (1997) and
prints deviations, not its scene. Here it is smooth elastic grains in a box without gravity, at a thousandth of the
stiffness of acetate and the derived step, all their motion along one axis at first. The source's third row, the same
code on another machine or by another compiler, 0.2 to 2 %, has no like here: the same schedule gives the same bits on
any number of threads."""


def kept_lines(found: Gas, count: int, table: str) -> list[Line]:
    """What must not change at all, or by the scheme's error alone."""
    energy = found.kinetic + found.elastic
    drift = np.abs(energy / energy[0] - 1.0).max()
    source = CONSERVED.format(table)
    lines = [
        Line("grains in the tank", found.inside, count, source, 0.5, "a whole number", relative=False),
        Line.off("largest change of the energy", source, drift, 1e-3, "O(Δt²), 0.1 % a collision"),
    ]
    for name, missing in zip(("momentum along y", "along z", "about the origin"), found.missing, strict=True):
        quantity = f"{name}, less the walls' impulse"
        lines.append(Line.off(quantity, "Newton", missing.max(), 1e-9, "rounding"))
    return lines


def average_lines(found: Gas, table: str) -> list[Line]:
    """What a gas in equilibrium shows on average, and from one start to another."""
    warm = slice(int(WARMING * len(found.kinetic)), None)
    energy = (found.kinetic + found.elastic)[warm]
    kinetic, elastic = found.kinetic[warm] / energy, found.elastic[warm] / energy
    along = found.along[int(WARMING * len(found.along)) :].mean()
    conserved, averaged = CONSERVED.format(table), AVERAGED.format(table)
    chance = "chance, as the source's"
    lines = [Line("share of the motion along y", along, 0.5, f"equal parts; {conserved}", KEPT, chance)]
    spread = kinetic.std(axis=0).max() / kinetic.mean()
    lines.append(Line.off("spread of the kinetic energy in time", conserved, spread, KEPT, chance))
    for name, values in (("kinetic", kinetic), ("internal (elastic)", elastic)):
        between = CONFIDENCE * values.mean(axis=0).std(ddof=1) / values.mean()
        quantity = f"mean {name} energy from start to start"
        lines.append(Line.off(quantity, averaged, between, AVERAGES, chance))
    return lines


def cloud(_: bool) -> Found:
    """Rough lossy grains of many sizes collide away from all walls: both momenta stay, energy is only lost."""
    random = np.random.default_rng(5)
    radius = RADIUS * random.uniform(0.6, 1.0, CLOUD)
    sites = np.stack(np.meshgrid(np.arange(8) - 3.5, np.arange(5) - 2.0), axis=-1).reshape(-1, 2)
    place = 2.15 * RADIUS * sites
    velocity = 10.0 * np.stack([-4.0 * place[:, 0] - place[:, 1], place[:, 0] - 4.0 * place[:, 1]], axis=1)
    velocity += random.normal(0.0, 0.02, velocity.shape)
    middle, spin = np.array([0.0, 0.5]), random.normal(0.0, 100.0, CLOUD)
    rows = np.column_stack([place + middle, radius, velocity, spin])
    material = ACETATE | {"restitution": 0.8, "rolling_friction": 0.05}
    contact = {"tangential": "mindlin", "rolling": "elastic-plastic", "stiffness_scale": SOFT}
    setup = Setup(rows, material, {"width": 1.0, "height": 1.0}, contact=contact, run={"gravity": WEIGHTLESS})
    mass, told, energy = sphere_mass(radius, ACETATE["density"]), [], []
    with simulated(setup) as run:
        for _ in range(50):
            rows, state = run.observe(), run.snapshot()
            energy.append((rows["kinetic"] + rows["rotational"] + rows["elastic"])[0])
            told.append(momenta(mass, radius, state["position"][0] - middle, state["velocity"][0], state["spin"][0]))
            run.advance(round(0.001 / run.dt))
    if rows["contacts"][0] or energy[-1] > 0.8 * energy[0]:
        raise RuntimeError("the cloud has not collided and come apart")
    change = np.abs((told[-1] - told[0]).sum(axis=1)) / np.abs(told[0]).sum(axis=1)
    names = ("momentum along y", "momentum along z", "momentum about the middle")
    lines = [Line.off(name, "Newton", value, 1e-10, "rounding") for name, value in zip(names, change, strict=True)]
    gained = max(0.0, np.diff(energy).max() / energy[0])
    lines.append(Line.off("largest gain of energy in 1 ms", "losses only", gained, 1e-3, "O(Δt²) while grains touch"))
    note = f"""Of its own energy the cloud keeps {energy[-1] / energy[0]:.2f}. The change of a momentum is a share of
    the sum over the grains of its sizes at the start; at the end no two grains touch."""
    return Found(lines, notes=[note])


# Of an elastic impact's energy at the derived step, with which its force begins and ends: Hertz's smoothly, the others'
# with a kink. All fall as Δt².
KEEPS = {
    "hertz": (4e-4, "(ω Δt)²/40, a smooth beginning"),
    "hertz-viscoelastic": (4e-4, "(ω Δt)²/40, a smooth beginning"),
    "hertz-dashpot": (4e-4, "(ω Δt)²/40, a smooth beginning"),
    "linear": (6e-4, "(ω Δt)²/6, kinks where it begins and ends"),
    "hysteretic": (1.3e-3, "(ω Δt)²/6, kinks where it begins and ends"),
}
TANGENTIAL = ("mindlin", "cundall-strack", "haff-werner")
THROWN, LOSSY = 1.0, 0.99  # m/s; a restitution whose losses are far beyond the scheme's error
ANGLES, SPINS, BEGINS = (0.0, 15.0, 45.0, 75.0, 85.0), (0.0, 300.0, -300.0), (0.1, 0.35, 0.6, 0.85)


def impact_energies(normal: str, tangential: str, restitution: float, parts: tuple[int, ...]) -> np.ndarray:
    """Energy of spheres after an impact on a wall over that before (parts, n): all angles, spins, phases of a step."""
    cases = [(a, s, p) for a in np.radians(ANGLES) for s in SPINS for p in BEGINS]
    rows = [
        grain(0.02 * k, 0.01, RADIUS, THROWN * np.sin(a), -THROWN * np.cos(a), s) for k, (a, s, _) in enumerate(cases)
    ]
    contact = {"normal": normal, "tangential": tangential}
    tank = {"width": 0.05 * len(rows), "height": 0.1}
    setup = Setup(
        np.array(rows), ACETATE | {"restitution": restitution}, tank, contact=contact, run={"gravity": WEIGHTLESS}
    )
    angle, _, phase = np.array(cases).T
    found = []
    with simulated(setup) as run:
        start, derived = run.snapshot(), run.dt
        before = _energy(start)
        for part in parts:
            step = derived / part
            place = start["position"].copy()
            place[0, :, 1] = RADIUS + (phase + 0.5) * step * THROWN * np.cos(angle)
            again(run, place, step, start["velocity"], start["spin"])
            run.advance(int(3e-4 / step))
            if run.observe()["contacts"][0]:
                raise RuntimeError("a sphere has not come off the wall")
            found.append(_energy(run.snapshot()) / before)
    return np.array(found)


def _energy(state: dict[str, np.ndarray]) -> np.ndarray:
    """Kinetic energies of the first world's grains over their mass (n,) m²/s²."""
    return 0.5 * (state["velocity"][0] ** 2).sum(axis=-1) + 0.2 * RADIUS**2 * state["spin"][0] ** 2


def impacts(fast: bool) -> Found:
    """An elastic impact keeps its energy but for the scheme's error; one that loses more than that never gains."""
    lines = []
    for normal in [*KEEPS][:1] if fast else KEEPS:
        allowed, reason = KEEPS[normal]
        smooth = np.abs(impact_energies(normal, "none", 1.0, (1, 4)) - 1.0).max(axis=1)
        source = "an elastic impact keeps its energy"
        lines += [
            Line.off(f"{normal}, restitution 1: energy gained or lost", source, smooth[0], allowed, reason),
            Line.off("the same at Δt/4", source, smooth[1], allowed / 8.0, "falls as Δt²: /16"),
        ]
        for tangential in TANGENTIAL[:1] if fast else TANGENTIAL:
            rough = impact_energies(normal, tangential, 1.0, (1,)).max() - 1.0
            name = f"{normal}, {tangential}, restitution 1: energy gained"
            lines.append(Line.off(name, "friction only takes", max(0.0, rough), allowed, reason))
            if normal != "hertz":
                lossy = impact_energies(normal, tangential, LOSSY, (1,)).max() - 1.0
                name = f"{normal}, {tangential}, restitution {LOSSY:g}: energy gained"
                lines.append(Line.off(name, "losses only", max(0.0, lossy), 1e-12, "rounding"))
    note = f"""Spheres at {THROWN:g} m/s on a wall at 0 to 85°, with and without spin, contacts beginning at four places
    of a step, at the derived step."""
    return Found(lines, notes=[note])


CASES = (
    Case("impact-energy", SECTION, "Energy of single impacts, any angle and spin", impacts),
    Case("momentum-cloud", SECTION, "Rough lossy grains that collide freely", cloud),
    Case("gas-table-4.3", SECTION, "An elastic gas, after the source's table 4.3", table_4_3, quick=False),
    Case("gas-table-6.3", SECTION, "An elastic gas, after the source's table 6.3", table_6_3, quick=False),
)
