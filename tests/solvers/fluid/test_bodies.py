"""Bodies and plates that stand or move in the water: loads, momentum, energy, tightness, added mass."""

from collections.abc import Iterator

import numpy as np
import pytest

from solvers.fluid.given import particles
from solvers.fluid.start.parts import clear_of
from solvers.fluid.start.rest import at_rest
from solvers.motion.harmonic import Heave, Roll, Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.parts import Body
from tests.oracles.water import GRAVITY, again, box, still

WIDTH, HEIGHT, DEPTH, ROWS = 0.6, 0.6, 0.3, 15
SPACING = DEPTH / ROWS
SIDES = ((-0.1, 0.08), (0.06, 0.08), (0.06, 0.24), (-0.1, 0.24))
FLAP, LOW = ((0.2, 0.0), (0.2, 0.4)), 0.2
BAFFLE = (-0.2, 0.1), (-0.2, 0.2)


def stirred(share: float) -> Scene:
    """A square that sways and rolls, a flap with less water behind it, and a baffle at rest, with both ends in water;
    by this share of their full motions.
    """
    square = Body(SIDES, closed=True, motions=(Sway(0.02 * share, 2.0), Roll(0.1 * share, 1.5, centre=(0.0, 0.15))))
    parts = square, Body(FLAP, motions=(Roll(0.1 * share, 1.0, centre=FLAP[0]),)), Body(BAFFLE)
    drops = still(WIDTH, HEIGHT, DEPTH, ROWS).fluid.particles
    beyond = drops["position"][0, :, 0] > FLAP[0][0]
    drops["deviation"][0, beyond] -= (DEPTH - LOW) / (100.0 * DEPTH)
    free = clear_of(drops["position"][0], parts, SPACING) & ~(beyond & (drops["position"][0, :, 1] > LOW))
    return still(WIDTH, HEIGHT, DEPTH, ROWS, parts=parts, drops=drops[:, free], alpha=0.02)


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    made = Simulation(stirred(1.0), threads=1, arch="cpu")
    yield made
    made.close()


def moved(run: Simulation, share: float) -> Simulation:
    """The same simulation from its start, the bodies with this share of their full motions."""
    again(run, stirred(share))
    pairs = zip(run.water.bodies.carriers, run.scene.parts, strict=True)
    for carrier, part in ((carrier, part) for carrier, part in pairs if part.motions):
        centres = [motion.centre if motion.coordinate == "turn" else (0.0, 0.0) for motion in part.motions]
        numbers = [(*at, *motion.parameters(0.0)) for at, motion in zip(centres, part.motions, strict=True)]
        carrier.table.from_numpy(np.concatenate(numbers)[None])
    return run


def momentum(run: Simulation) -> tuple[np.ndarray, float]:
    """Momentum over the earth (N s/m) and mass (kg/m) of the water of the first world."""
    p = run.water.particles
    v, w, m = (values[0] for values in p.read(*p.velocity, p.mass))
    return np.array([m @ v, m @ w]), m.sum()


@pytest.mark.slow
def test_water_tank_and_bodies_share_momentum_and_energy(run):
    """Momentum changes by weight and by minus all loads, to rounding; the work of the bodies is all accounted for.

    The account has the errors of the step on a start from rest with a jump of the bodies' velocities: 1 % of the work.
    """
    start = moved(run, 1.0).observe()
    run.advance(10)
    run.observe()
    (before, mass), steps = momentum(run), 590
    run.advance(steps)
    end, after = run.observe(), momentum(run)[0]
    load, weight = end["wall_force"][0, :2], np.array([0.0, -GRAVITY * mass])
    scale = steps * run.dt * np.abs(load).max()
    np.testing.assert_allclose(after - before, steps * run.dt * (weight - load), atol=1e-12 * scale)
    taken = sum(end[name] - start[name] for name in ("water_viscous", "water_diffusive", "water_wall_energy"))
    work, gain = end["water_work"] - start["water_work"], end["water_total"] - start["water_total"]
    assert np.abs(end["part_force"]).min() > 0.0 and work > 4.0  # else nothing was tried
    np.testing.assert_allclose(end["part_work"].sum(axis=1), work)
    np.testing.assert_allclose(gain + taken, work, rtol=0.02)
    turn = run.placed()["part_turn"][0]
    angles = [0.1 * np.sin(2.0 * np.pi * frequency * run.time) for frequency in (1.5, 1.0)]
    np.testing.assert_allclose(turn, [*angles, 0.0], atol=1e-12)


@pytest.mark.slow
def test_bodies_in_still_water_bear_its_pressure(run):
    """A square 8 spacings wide bears its own weight of water (Archimedes), to 4 %, a plate between two levels their
    difference, and no water passes it. The load on the tank and the bodies is the weight of the water, which rests.
    """
    moved(run, 0.0).observe()
    start = run.snapshot()["water_position"][0]
    run.advance(100)
    run.observe()
    beyond = run.snapshot()["water_position"][0, :, 0] > FLAP[0][0]
    run.advance(500)
    rows, mass, place = run.observe(), momentum(run)[1], run.snapshot()["water_position"][0]
    run.close()  # the slow ones that follow find its kernels
    np.testing.assert_array_equal(place[:, 0] > FLAP[0][0], beyond)
    assert np.linalg.norm(place - start, axis=1).max() < SPACING
    buoyancy = 1000.0 * GRAVITY * 0.16**2
    np.testing.assert_allclose(rows["part_force"][0, 0, :2], [0.0, buoyancy], atol=0.04 * buoyancy)
    push = 0.5 * 1000.0 * GRAVITY * (DEPTH**2 - LOW**2)
    np.testing.assert_allclose(rows["part_force"][0, 1, 0], push, rtol=0.06)
    np.testing.assert_allclose(rows["wall_force"][0, 1], -mass * GRAVITY, rtol=5e-3)


@pytest.mark.slow
def test_a_plate_is_as_tight_as_a_wall():
    """Water on one side of a plate moves as in a tank that ends there, whatever stands on the other.

    To 1e-4 of a spacing: wall particles slide along the plate to its very end, but askew behind the corner of a tank.
    """
    plate = Body(((0.0, 0.0), (0.0, HEIGHT)))
    drops = still(WIDTH, HEIGHT, DEPTH, ROWS).fluid.particles
    left, low = drops["position"][0, :, 0] < 0.0, 0.1
    other = ~left & (drops["position"][0, :, 1] < low)
    whole, alone = drops[:, left | other], drops[:, left]
    beyond = whole[0, :, 0] > 0.0
    whole["deviation"][0, beyond] = GRAVITY * (low - whole[0, beyond, 1]) / (100.0 * GRAVITY * DEPTH)
    half = box(0.5 * WIDTH, HEIGHT) - [0.25 * WIDTH, 0.0]
    scenes = {"parts": (plate,), "drops": whole}, {"outline": half, "drops": alone}
    runs = [Simulation(still(WIDTH, HEIGHT, DEPTH, ROWS, **changes), threads=1, arch="cpu") for changes in scenes]
    places = []
    for run in runs:
        run.advance(200)
        places.append(run.snapshot()["water_position"][0])
    np.testing.assert_allclose(places[0][~beyond], places[1], atol=1e-4 * SPACING)
    assert places[0][beyond, 0].min() > 0.25 * SPACING
    runs[0].observe()
    runs[0].advance(100)
    wanted = 0.5 * 1000.0 * GRAVITY * (DEPTH**2 - low**2)
    np.testing.assert_allclose(runs[0].observe()["part_force"][0, 0, 0], wanted, rtol=0.03)


AFLOAT = Body(((0.0, 0.08), (0.0, 0.2)))
RIDGE = np.array([(-0.3, 0.0), (-0.1, 0.0), (0.0, 0.14), (0.1, 0.0), (0.3, 0.0), (0.3, 0.6), (-0.3, 0.6)])


@pytest.mark.parametrize(
    ("given", "seconds", "most"),
    [({"parts": (AFLOAT,)}, 8.0, 3e-3), ({"outline": RIDGE}, 10.0, 15e-3)],
)
@pytest.mark.slow
def test_water_that_starts_as_a_lattice_round_free_ends_comes_to_rest(given, seconds, most):
    """R.m.s. speed (m/s): packed water in a box without plates has 1.7 mm/s after 4 s."""
    solid = given.get("parts") or (Body(RIDGE[1:4].tolist(), closed=True),)
    drops = still(WIDTH, HEIGHT, DEPTH, ROWS).fluid.particles
    drops = drops[:, clear_of(drops["position"][0], solid, SPACING)]
    run = Simulation(still(WIDTH, HEIGHT, DEPTH, ROWS, drops=drops, alpha=0.02, **given), threads=1, arch="cpu")
    run.advance(round(seconds / run.dt))
    assert np.sqrt((run.snapshot()["water_velocity"][0] ** 2).sum(axis=1).mean()) < most


@pytest.mark.parametrize("points", [((-0.1, 0.0), (0.05, 0.2)), ((-0.09, 0.08), (0.03, 0.24))])
@pytest.mark.slow
def test_water_packed_beside_a_slanted_plate_stays_still(points):
    """Within 8 s, r.m.s., to 0.02 √(g Δx), the speed of a fall by Δx/5000; a lattice stirs to two to seven times it."""
    parts = (Body(points),)
    scene = still(WIDTH, HEIGHT, DEPTH, ROWS, parts=parts, alpha=0.02)
    drops = at_rest(scene.outline, DEPTH, scene.fluid.water, GRAVITY, parts, scene.outline)[None]
    run = Simulation(still(WIDTH, HEIGHT, DEPTH, ROWS, parts=parts, drops=drops, alpha=0.02), threads=1, arch="cpu")
    for seconds in (4.0, 8.0):
        run.advance(round(seconds / run.dt) - round(run.time / run.dt))
        speed = np.sqrt((run.snapshot()["water_velocity"][0] ** 2).sum(axis=1).mean())
        assert speed < 0.02 * np.sqrt(GRAVITY * SPACING)
    run.close()


@pytest.mark.slow
def test_a_swaying_cylinder_has_the_added_mass_of_potential_theory():
    """In a full round tank: ρ π a² (b² + a²)/(b² − a²) (Lamb 1932, art. 68), to 8 % with 16 spacings across."""
    inner, outer, spacing, frequency, amplitude = 0.1, 0.25, 0.0125, 4.0, 0.004
    angle = 2.0 * np.pi * (np.arange(48) + 0.5) / 48
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    body = Body(tuple(map(tuple, inner * ring)), closed=True, motions=(Sway(amplitude, frequency),))
    count = int(outer / spacing)
    side = (np.arange(-count, count) + 0.5) * spacing
    grid = np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2)
    grid = grid[(np.hypot(*grid.T) > inner + 0.3 * spacing) & (np.hypot(*grid.T) < outer - 0.3 * spacing)]
    drops = particles(1, len(grid))
    drops["position"][0], drops["volume"] = grid, np.pi * (outer**2 - inner**2) / len(grid)
    changes = {"outline": outer * ring, "parts": (body,), "drops": drops, "gravity": 0.0, "full": True}
    scene = still(1.0, 1.0, 20 * spacing, 20, sound_speed=40.0, **changes)
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(1)
    time, force = [], []
    run.observe()
    for _ in range(100):
        run.advance(10)
        time.append(run.time - 5 * run.dt)
        force.append(run.observe()["part_force"][0, 0, 0])
    time, force = np.array(time), np.array(force)
    whole = time > time[-1] - 1.0 / frequency
    waves = np.column_stack([f(2.0 * np.pi * frequency * time[whole]) for f in (np.cos, np.sin)])
    found = np.linalg.lstsq(waves, force[whole], rcond=None)[0][1] / (amplitude * (2.0 * np.pi * frequency) ** 2)
    wanted = 1000.0 * np.pi * inner**2 * (outer**2 + inner**2) / (outer**2 - inner**2)
    np.testing.assert_allclose(found, wanted, rtol=0.08)


@pytest.mark.slow
def test_a_plate_that_is_torn_up_along_itself_does_not_press_on_water_that_slides():
    """Its ends' wall particles have the pressure of the water before them, however it is accelerated: to 5 % of ρ a Δx.

    Both plates are where they would be at rest; one is accelerated along itself, as water that slides does not feel.
    """
    frequency, amplitude, pressures = 20.0, 2e-5, []
    for share in (1e-9, 1.0):
        torn = Body(((0.0, 0.0), (0.0, HEIGHT)), motions=(Heave(share * amplitude, frequency, 0.5 * np.pi),))
        run = Simulation(still(WIDTH, HEIGHT, DEPTH, ROWS, parts=(torn,)), threads=1, arch="cpu")
        run.advance(1)
        first = run.water.particles.fluid_blocks + run.water.bodies.first[0]
        pressures.append(run.water.particles.pressure.to_numpy()[first:])
        run.close()
    pull = amplitude * (2.0 * np.pi * frequency) ** 2
    assert np.abs(pressures[0]).max() > 1000.0  # else nothing was tried
    np.testing.assert_allclose(pressures[1], pressures[0], atol=0.05 * 1000.0 * pull * SPACING)
