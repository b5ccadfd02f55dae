"""Fixed grains of rough walls: they act as grains of infinite mass, never move, and are not observed."""

import numpy as np
import pytest

from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.scenes import box, material
from tests.solvers.grains.test_collisions import rebound

RADIUS, LARGE, FRICTION = 1.5e-3, 4e-3, 0.2
# Two that lie in one another, as on the corners of a lining, and one alone.
FIXED = np.array([[0.0, 0.03, LARGE], [0.004, 0.028, LARGE], [-0.04, 0.03, LARGE]])
ALONE = FIXED[2, :2]
SPEEDS = np.array([0.05, 0.3, 1.0, 3.0])
SLANT = np.radians(65.0)  # from the normal: the contact slides all the time
SLOWER = 0.1  # so that the normal does not turn while the grain slides over the curve


@pytest.fixture(scope="module", params=["per-world", pytest.param("per-grain", marks=pytest.mark.slow)])
def struck(request):
    """A grain a speed hits the lone fixed grain head-on, another at a slant; a third rests far away.

    Returns the scene, states at the start and the end, rows at the end, and where the fixed grains are then.
    """
    worlds, gap = len(SPEEDS), 2e-6
    normal = np.array([[0.0, 1.0], [0.0, -1.0]])
    ways = np.array([[0.0, -1.0], [np.sin(SLANT), np.cos(SLANT)]])
    touching = ALONE + (LARGE + RADIUS) * normal
    place = np.tile(np.array([*(touching - gap * ways / np.abs(ways[:, 1:])), [0.04, 0.05]]), (worlds, 1, 1))
    velocity = np.zeros(place.shape)
    velocity[:, :2] = SPEEDS[:, None, None] * ways * [[1.0], [SLOWER]]
    grain, wall = material(young=1e9, friction=FRICTION), material(young=5e6, friction=0.7, restitution=0.2)
    scene = scene_of(
        np.full((worlds, 3), RADIUS),
        box(0.1, 0.06),
        grain,
        wall,
        tangential="mindlin",
        gravity=0.0,
        fixed=FIXED,
        start_speed=SPEEDS.max(),
        velocity=velocity,
        spin=np.zeros((worlds, 3)),
        schedule=request.param,
    )
    run = Simulation(scene, place, 1, arch="cpu")
    before = run.snapshot()
    run.advance(round((gap / (SLOWER * SPEEDS.min()) / np.cos(SLANT) + 1.5e-3) / run.dt))
    after, rows = run.snapshot(), run.observe()
    kept = [field.to_numpy()[:, 3 : 3 + len(FIXED)] for field in run.grains.grains.place]
    mass = run.grains.mass[0, 0]
    run.close()
    return scene, mass, before, after, rows, np.stack(kept, axis=2)


def restitution(scene: Scene, mass: float, speed: float) -> float:
    """Of a grain and an immovable one: k = (4/3) E* √R_eff, E* and loss of two grains, the mass of the one that moves.

    By integration of the law with x = (3/2) A (k/m)^(2/5) v^(1/5).
    """
    pair = scene.grains.interfaces[0]
    k = 4.0 / 3.0 * pair.young_modulus * np.sqrt(RADIUS * LARGE / (RADIUS + LARGE))
    return rebound(0.5, 1.5 * pair.dissipative_time * (k / mass) ** 0.4 * speed**0.2)[0]


@pytest.mark.slow
def test_restitution_is_that_of_a_grain_and_an_immovable_one(struck):
    scene, mass, _, after, _, _ = struck
    for w, speed in enumerate(SPEEDS):
        straight, slanting = speed, SLOWER * speed * np.cos(SLANT)
        up = restitution(scene, mass, straight) * straight
        down = -restitution(scene, mass, slanting) * slanting
        assert after["velocity"][w, 0] == pytest.approx([0.0, up], rel=2e-3, abs=1e-9), f"{speed} m/s"
        assert after["velocity"][w, 1, 1] == pytest.approx(down, rel=1e-2), f"{speed} m/s"


@pytest.mark.slow
def test_a_sliding_impact_gives_friction_and_spin(struck):
    """Gross sliding: Δv_t = μ (1 + e) v_n and ω = (5/2) μ (1 + e) v_n / R (Maw, Barber and Fawcett 1976)."""
    scene, mass, _, after, _, _ = struck
    for w, speed in enumerate(SPEEDS):
        normal = SLOWER * speed * np.cos(SLANT)
        lost = FRICTION * (1.0 + restitution(scene, mass, normal)) * normal
        assert SLOWER * speed * np.sin(SLANT) - after["velocity"][w, 1, 0] == pytest.approx(lost, rel=2e-2), (
            f"{speed} m/s"
        )
        assert abs(after["spin"][w, 1]) == pytest.approx(2.5 * lost / RADIUS, rel=2e-2), f"{speed} m/s"


@pytest.mark.slow
def test_fixed_grains_never_move(struck):
    *_, kept = struck
    assert np.array_equal(kept, np.tile(FIXED[:, :2], (len(SPEEDS), 1, 1)))


@pytest.mark.slow
def test_fixed_grains_do_not_count_in_observations(struck):
    """Centre of mass, energy and contacts are of the moving grains; the overlap of two fixed ones does not count."""
    _, mass, _, after, rows, _ = struck
    centre = after["position"].mean(axis=1)
    np.testing.assert_allclose(rows["centre_of_mass"], centre, rtol=1e-12)
    np.testing.assert_allclose(rows["kinetic"], 0.5 * mass * (after["velocity"] ** 2).sum(axis=(1, 2)), rtol=1e-12)
    assert not rows["contacts"].any()
    assert not rows["overlap"].any()
    assert not rows["elastic"].any()
    assert after["position"].shape == (len(SPEEDS), 3, 2)


@pytest.mark.slow
def test_the_tanks_load_includes_forces_on_fixed_grains(struck):
    """The impulse on the tank is the momentum that the grains have lost."""
    _, mass, before, after, rows, _ = struck
    given = mass * (before["velocity"] - after["velocity"]).sum(axis=1)
    time = rows["wall_force"][..., 1] / given[:, 1]
    assert time == pytest.approx(np.full(len(SPEEDS), time[0]), rel=1e-9)
    np.testing.assert_allclose(rows["wall_force"][..., 0], given[:, 0] * time[0], rtol=1e-9)
