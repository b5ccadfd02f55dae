"""Water in space: a step against double sums, momentum, turned scenes, tanks that move, and a slice."""

from collections.abc import Iterator

import numpy as np
import pytest
import taichi as ti

from solvers.fluid.lists import capacity
from solvers.fluid.state import SPRAY
from solvers.fluid.surface.void_indicator import PACKING, RAMP
from solvers.machine import runtime
from solvers.motion.harmonic import Pitch, Roll, Surge
from solvers.simulation import Simulation
from solvers.space.symmetric import least_eigenvalue, solved
from tests.oracles.water import GRAVITY, again
from tests.oracles.water_in_space import EarthWaterInSpace, PlainWaterInSpace, pool

SIDES, ROWS, SPACING = (10, 11, 10), 8, 0.05
STEP = 1.8e-3  # s, within the limits of all scenes: so that they share compiled kernels
STILL = (Roll(1e-30, 1.0), Pitch(1e-30, 1.0), Surge(1e-30, 1.0))  # the kernels of a moving tank
MOVES = (Roll(0.3, 0.8, centre=(0.1, 0.2)), Pitch(0.2, 0.6, centre=(0.05, 0.1)), Surge(0.05, 1.1))


def disturbed(seed: int = 1, **changes):
    """A pool whose particles were displaced and set in motion at random."""
    scene = pool(SIDES, ROWS, SPACING, **{"smoothing": 1.25, "motions": [STILL], "step": STEP} | changes)
    random, drops = np.random.default_rng(seed), scene.fluid.particles
    drops["position"] += 0.1 * SPACING * random.uniform(-1.0, 1.0, drops["position"].shape)
    drops["velocity"] = 0.2 * random.uniform(-1.0, 1.0, drops["position"].shape)
    return scene


def held(run: Simulation) -> tuple[np.ndarray, ...]:
    """Places, velocities, s, masses, accelerations and slopes of the particles, by their numbers."""
    p = run.water.particles
    vectors = (np.stack(p.read(*fields), axis=-1)[0] for fields in (p.place, p.velocity, p.acceleration, p.gradient))
    place, velocity, push, slope = vectors
    s, mass = (values[0] for values in p.read(p.deviation, p.mass))
    return place, velocity, s, mass, push, slope


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    made = Simulation(disturbed(), threads=1, arch="cpu")
    yield made
    made.close()


def test_a_step_equals_double_sums(run):
    """After some steps, so that velocities are those of a flow: pressures, walls, diffusion, shifts of density."""
    run.advance(7)
    plain, dt, numbers = PlainWaterInSpace(run.scene), run.dt, run.water.constants.numbers
    r, u, before, m, *_ = held(run)
    run.advance(1)
    push, slope, _ = plain.push(r, u, before, m)
    pressed = plain.wall_pressure(r, m, before) > 0.0
    u = u + dt * (push + plain.gravity)
    middle = r + 0.5 * dt * u
    full, lacking = plain.void_indicator(r, m, before, numbers["plane"])
    s = before + dt * (plain.rate(middle, u, before, m, slope, pressed) + plain.keeping(full, lacking, before))
    s = s / (1.0 + dt * numbers["relief"] * np.clip((PACKING**1.5 - full) / (1.5 * RAMP), 0.0, 1.0))
    found, [eigenvalue] = held(run), run.water.particles.read(run.water.particles.eigenvalue)[0]
    s = np.where(eigenvalue < SPRAY, np.maximum(s, 0.0), s)
    assert plain.is_straight.sum() > 50  # else the correction along faces is not tried
    np.testing.assert_allclose(run.water.particles.read(run.water.forces.voids.indicator)[0][0], full, atol=1e-9)
    np.testing.assert_allclose(found[4], push, atol=1e-9 * np.abs(push).max())
    np.testing.assert_allclose(found[5], slope, atol=1e-7 * np.abs(slope).max())
    np.testing.assert_allclose(found[2], s, atol=1e-9 * np.abs(s).max())
    np.testing.assert_allclose(found[0], middle + 0.5 * dt * u, atol=1e-12)


def test_the_load_is_what_the_water_loses(run):
    """Momentum changes by the weight and minus the load, moment of momentum by their moments, to rounding.

    Velocities change where the places are at the start of a step: there the moments of a single one are taken.
    """
    again(run, disturbed()).advance(1)
    run.observe()
    for steps in (20, 1):
        r, before, _, mass, *_ = held(run)
        run.advance(steps)
        load = run.observe()["wall_force"][0]
        gained, weight = mass[:, None] * (held(run)[1] - before), np.array([0.0, -GRAVITY, 0.0])
        scale = steps * run.dt * np.abs(load).max()
        pulled = steps * run.dt * mass.sum() * weight
        np.testing.assert_allclose(gained.sum(axis=0), pulled - steps * run.dt * load[:3], atol=1e-12 * scale)
    moment = np.cross(r, gained).sum(axis=0) - run.dt * np.cross(mass @ r, weight)
    np.testing.assert_allclose(moment, -run.dt * load[3:], atol=1e-12 * scale)


def test_a_tank_on_end_holds_the_water_as_before(run):
    """Turned by 90 degrees about the vertical, so that y is −x: the same course, to rounding."""
    scene, turned = disturbed(2), disturbed(2)
    drops = turned.fluid.particles
    for name in ("position", "velocity"):
        y, x = drops[name][..., 0].copy(), drops[name][..., 2].copy()
        drops[name][..., 0], drops[name][..., 2] = -x, y
    again(run, scene).advance(20)
    place = run.snapshot()["water_position"][0]
    again(run, turned).advance(20)
    found = run.snapshot()["water_position"][0]
    np.testing.assert_allclose(found[:, [2, 1]], place[:, [0, 1]], atol=1e-10 * SPACING)
    np.testing.assert_allclose(found[:, 0], -place[:, 2], atol=1e-10 * SPACING)


def test_a_run_goes_on_bit_for_bit(run):
    """What is restored from the state of a step goes on as the run that was not interrupted."""
    again(run, disturbed(3)).advance(15)
    kept = run.state()
    run.advance(15)
    whole = run.state()
    run.restore(kept)
    run.advance(15)
    for name, values in run.state().items():
        np.testing.assert_array_equal(values, whole[name], err_msg=name)


def over_earth(points: np.ndarray, time: float) -> np.ndarray:
    """Where points (n, 3) m of a tank moved by MOVES are over the earth, the first motion innermost."""
    roll, pitch, surge = (one.amplitude * np.sin(2.0 * np.pi * one.frequency * time) for one in MOVES)
    y, z, x = (points - np.array([*MOVES[0].centre, 0.0])).T
    y, z = np.cos(roll) * y - np.sin(roll) * z, np.sin(roll) * y + np.cos(roll) * z
    turned = np.stack([y, z, x], axis=-1) + np.array([*MOVES[0].centre, 0.0])
    y, z, x = (turned - np.array([0.0, *MOVES[1].centre])).T
    z, x = np.cos(pitch) * z - np.sin(pitch) * x, np.sin(pitch) * z + np.cos(pitch) * x
    return np.stack([y, z, x], axis=-1) + np.array([0.0, MOVES[1].centre[0], MOVES[1].centre[1] + surge])


@pytest.mark.slow
def test_a_moving_tank_is_that_of_the_earth_s_axes(run):
    """Rolling, pitching and surging: places after two steps are those of double sums over the earth.

    To what differences in time are off: their step of 1e-4 s gives accelerations to 1e-7 of g.
    """
    scene = disturbed(4, motions=[MOVES])
    scene.fluid.particles["velocity"] = 0.0
    run.close()  # kernels are found only by a Taichi without arrays
    run = Simulation(scene, threads=1, arch="cpu")
    plain = EarthWaterInSpace(scene, over_earth, run.water.constants.numbers["plane"])
    run.advance(1)

    def earth(points: np.ndarray) -> np.ndarray:
        return over_earth(points, run.time)

    r, u, s, mass, *_ = held(run)
    [eigenvalue] = run.water.particles.read(run.water.particles.eigenvalue)[0]
    r, u = earth(r), earth(u) - earth(0.0 * u)
    for _ in range(2):
        r, u, s = plain.step(r, u, s, mass, run.time, run.dt, PACKING**1.5, 1.5 * RAMP)
        run.advance(1)
    found = held(run)[0]
    inner = eigenvalue > 0.5  # no spray, whose density oracles do not keep from suction
    np.testing.assert_allclose(earth(found)[inner], r[inner], atol=2e-5 * SPACING)
    assert np.abs(earth(found) - found).max() > 0.01 * SPACING
    run.close()


@pytest.mark.slow
def test_a_slice_that_begins_alike_along_it_stays_so():
    """A slice without ends, four smoothing lengths thick, set in motion across it: 1000 steps, to rounding.

    What is alike in exact numbers parts by the sums' rounding, which a flow that mixes magnifies: this one hardly does.
    """
    scene = pool((12, 14, 6), 10, SPACING, periodic=("x",))
    drops = scene.fluid.particles
    y, z = drops["position"][..., 0], drops["position"][..., 1]
    drops["velocity"][..., 0] = 0.1 * np.sin(2.0 * np.pi * y / 0.6) * np.cosh(2.0 * np.pi * z / 0.6) / 10.0
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(1000)
    place = run.snapshot()["water_position"][0]
    slices = place.reshape(6, -1, 3)
    np.testing.assert_allclose(slices[:, :, 2] - drops["position"][0].reshape(6, -1, 3)[:, :, 2], 0.0, atol=1e-9)
    np.testing.assert_allclose(slices[:, :, :2], np.broadcast_to(slices[:1, :, :2], slices[:, :, :2].shape), atol=1e-9)
    assert np.abs(slices[0, :, :2] - drops["position"][0].reshape(6, -1, 3)[0, :, :2]).max() > 0.01 * SPACING
    run.close()


@pytest.mark.slow
def test_particles_that_move_one_by_one_see_the_weight_though_their_lists_must_grow(monkeypatch):
    """The first look takes a step back and forth; where lists grow in it the arrays are others then."""
    monkeypatch.setattr(capacity, "CROWDED", 0.2)
    run = Simulation(pool((6, 9, 6), 6, SPACING, schedule="per-grain"), threads=1, arch="cpu")
    load = run.observe()["wall_force"][0]
    mass = float(run.water.particles.mass.to_numpy().sum())
    assert load[1] == pytest.approx(-GRAVITY * mass, rel=0.02)
    run.advance(5)
    assert run.room > 1  # else nothing had to grow
    np.testing.assert_allclose(run.observe()["wall_force"][0, [0, 2]], 0.0, atol=1e-9 * GRAVITY * mass)
    run.close()


@pytest.mark.parametrize("axes", [2, 3])
def test_the_least_eigenvalue_and_the_solution_of_symmetric_matrices(axes):
    """Against numpy: of two alike to what the docstring says, of those well apart far better."""
    random = np.random.default_rng(1)
    turned = np.linalg.qr(random.normal(size=(64, axes, axes)))[0]
    values = np.sort(random.uniform(0.1, 1.0, (64, axes)), axis=1)
    values[32:, 1] = values[32:, 0]  # the two smallest alike
    matrices = np.einsum("nab,nb,ncb->nac", turned, values, turned)
    right = random.normal(size=(64, axes))
    least, solution = by_lists(matrices, right)
    off, spread = values[:, 0] - least, values.std(axis=1)
    assert (off > -1e-9).all() and (off <= 0.03 * spread + 2e-6).all()
    parted = values[:, 1] - values[:, 0] > 0.3
    assert parted.sum() > 5 and (off[parted] < 1e-3).all()
    np.testing.assert_allclose(solution, np.linalg.solve(matrices, right[..., None])[..., 0], rtol=1e-8)


def by_lists(matrices: np.ndarray, right: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The smallest eigenvalues (n,) of symmetric matrices (n, D, D), and their solutions (n, D) of M x = right."""
    runtime.initialise(1, "cpu", "f64")
    count, axes = right.shape
    entries = np.array([[m[a, b] for a in range(axes) for b in range(a, axes)] for m in matrices])
    given, least = ti.field(ti.f64, entries.shape), ti.field(ti.f64, count)
    sides, found = ti.field(ti.f64, right.shape), ti.field(ti.f64, right.shape)
    given.from_numpy(entries)
    sides.from_numpy(right)

    @ti.kernel
    def solve():
        for i in range(count):
            m = [given[i, n] for n in ti.static(range(entries.shape[1]))]
            least[i] = least_eigenvalue(m)
            over, determinant = solved(m, [sides[i, a] for a in ti.static(range(axes))])
            for a in ti.static(range(axes)):
                found[i, a] = over[a] / determinant

    solve()
    return least.to_numpy(), found.to_numpy()
