"""Hard cases of irregular grains: needles, triangles, strong lobes, rough discs; fast, stiff, long runs."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.grains.shapes.cargo import cargo
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import Shapes
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.outlines import ellipse, star
from tests.oracles.scenes import box, material
from tests.oracles.scenes import simulation as moving

RADIUS = 1.5e-3
WORLDS = 24
ACETATE = 3.2e9  # Pa


def harmonics(**amplitudes):
    """Outline with these descriptors relative to R0, "d3" the third, of phase zero."""
    wanted = {int(name[1:]): value for name, value in amplitudes.items()}
    descriptors = [wanted.get(n + 1, 0.0) for n in range(max(wanted))]
    return Contour(1.0, descriptors, [0.0] * len(descriptors)).with_diameter(2.0)


NEEDLE = ellipse(2.0, 0.5).with_diameter(2.0)
TRIANGLE = harmonics(d3=0.12, d6=0.02)
STAR = harmonics(d3=0.2, d8=0.1)
ROUGH = harmonics(d50=0.0133)  # 0.02 mm


def energy(simulation):
    rows = simulation.observe()
    return rows["kinetic"] + rows["rotational"] + rows["elastic"]


def collisions(outline, contact, speed, young, nodes=200, share=1.0, worlds=WORLDS):
    """Pairs at random angles that meet off centre at `speed` (m/s) each, without friction, losses and gravity.

    Their steps are a `share` of the automatic one.

    Returns by how much the energy of each has changed in the end, relative to what it was, and how many have met.
    """
    random = np.random.default_rng(1)
    angle, off = random.uniform(-np.pi, np.pi, (worlds, 2)), random.uniform(-0.4, 0.4, worlds) * RADIUS
    apart = np.full(worlds, 1.03 * outline.bounding_radius * RADIUS)
    first = np.stack([-apart, off], axis=1)
    place = np.stack([first, -first], axis=1) + np.array([0.0, 0.05])
    velocity = np.zeros_like(place)
    velocity[:, 0, 0], velocity[:, 1, 0] = speed, -speed
    lossless = material(young=young, friction=0.0, dissipative_time=0.0)
    made = scene_of(
        np.full((worlds, 2), RADIUS),
        box(0.1, 0.1),
        lossless,
        lossless,
        gravity=1e-9,
        shapes=Shapes((outline,), np.zeros((worlds, 2), dtype=int), angle, contact, nodes),
        start_speed=2.0 * speed,
        velocity=velocity,
    )
    simulation = Simulation(replace(made, step=share * made.time_step()), place, threads=1)
    simulation.advance(1)
    start = energy(simulation)
    simulation.advance(round(5.0 * RADIUS / speed / simulation.dt))
    met = np.abs(simulation.snapshot()["velocity"][:, 0] - velocity[:, 0]).max(axis=1) > 0.1 * speed
    change = energy(simulation) / start - 1.0
    simulation.close()
    return change, int(met.sum())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("outline", "speed", "young", "within"),
    [
        pytest.param(NEEDLE, 10.0, ACETATE, 1e-3, id="needles, 10 m/s"),
        pytest.param(NEEDLE, 1.0, 3e7, 1e-3, id="soft needles"),
        pytest.param(TRIANGLE, 10.0, ACETATE, 1e-3, id="triangles, 10 m/s"),
        pytest.param(star(5, 0.25), 1.0, 3e7, 1e-3, id="stars that interlock"),
        pytest.param(STAR, 1.0, 3e7, 2e-2, id="D3 and D8"),
        pytest.param(
            *(ROUGH, 0.3, ACETATE, 2e-2),
            id="rough",
            marks=pytest.mark.xfail(reason="of 50 lobes that mesh some contacts are lost", strict=True),
        ),
    ],
)
def test_energy_of_collisions_at_the_automatic_step(outline, speed, young, within):
    change, met = collisions(outline, "continuous", speed, young)
    assert met > WORLDS // 2
    assert np.abs(change).max() < within


@pytest.mark.slow
def test_contacts_between_lobes_are_found_however_short_the_steps():
    """By how far grains have moved, not by the number of steps: else more of these would be found too late."""
    change, met = collisions(STAR, "continuous", 1.0, 3e7, share=0.25)
    assert met > WORLDS // 2
    assert np.abs(change).max() < 5e-3


@pytest.mark.slow
def test_ninety_nine_of_a_hundred_collisions_of_sand_keep_their_energy():
    """To 5 %. Of contacts looked for every so many steps so many came late that one of a hundred gained 20 %."""
    sand = cargo("sand").outline(np.random.default_rng(2), 2.0)
    change, met = collisions(sand, "continuous", 0.3, 3.2e6, worlds=400)
    assert met > 300
    assert np.quantile(np.abs(change), 0.99) < 0.05
    assert np.abs(np.mean(change)) < 2e-3


@pytest.mark.slow
@pytest.mark.parametrize(
    ("outline", "speed", "young", "nodes"),
    [
        pytest.param(ROUGH, 0.3, ACETATE, 500, id="rough"),
        pytest.param(ROUGH, 1.0, 3e7, 500, id="soft and rough"),
        pytest.param(NEEDLE, 10.0, ACETATE, 200, id="needles, 10 m/s"),
        pytest.param(TRIANGLE, 10.0, ACETATE, 200, id="triangles, 10 m/s"),
        pytest.param(star(5, 0.25), 1.0, 3e7, 200, id="stars that interlock"),
        pytest.param(STAR, 1.0, 3e7, 200, id="D3 and D8"),
    ],
)
def test_energy_of_collisions_by_shared_areas(outline, speed, young, nodes):
    change, met = collisions(outline, "area", speed, young, nodes)
    assert met > WORLDS // 2
    assert np.abs(change).max() < 1e-2


@pytest.fixture(scope="module")
def rough_by_nodes():
    return collisions(ROUGH, "nodes", 1.0, 3e7, 500)


@pytest.mark.slow
def test_half_of_rough_discs_of_500_nodes_gain_little(rough_by_nodes):
    change, met = rough_by_nodes
    assert met > WORLDS // 2
    assert np.isfinite(change).all()
    assert np.abs(np.median(change)) < 0.1


@pytest.mark.slow
@pytest.mark.xfail(reason="the deepest node jumps from lobe to lobe, and energy with it", strict=True)
def test_a_rough_disc_of_500_nodes_keeps_its_energy(rough_by_nodes):
    assert np.abs(rough_by_nodes[0]).max() < 1e-2


@pytest.mark.slow
def test_a_triangle_rests_on_its_edge_for_a_minute():
    lossy = material(young=3e6, restitution=0.5, friction=0.5)
    made = scene_of(
        np.full((1, 1), RADIUS),
        box(0.03, 0.02),
        lossy,
        lossy,
        tangential="mindlin",
        shapes=Shapes((TRIANGLE,), np.zeros((1, 1), dtype=int), np.full((1, 1), -np.pi / 6.0)),
    )
    simulation = Simulation(made, np.array([[[0.0, 1.2 * RADIUS]]]), threads=1)
    simulation.advance(round(2.0 / simulation.dt))
    before = simulation.snapshot()
    simulation.advance(round(60.0 / simulation.dt))
    after = simulation.snapshot()
    assert simulation.observe()["contacts"][0] >= 1
    assert np.abs(after["position"] - before["position"]).max() < 1e-3 * RADIUS
    assert abs(after["angle"] - before["angle"]).max() < 1e-3


@pytest.mark.slow
def test_a_spinning_grain_bears_a_list_that_has_shrunk_in_mixed_precision():
    """The last two grains part. Their place in the list pads it then, with the first grain and one 1 km off."""
    place = np.array([[0.0, 0.05], [2.5 * RADIUS, 0.05], [5.0 * RADIUS, 0.05]])
    velocity = np.array([[0.0, 0.0], [0.0, 0.0], [2.0, 0.0]])
    shapes = Shapes((ellipse(1.3, 0.8),), np.zeros((1, 3), dtype=int), np.zeros((1, 3)))
    simulation = moving(
        place[None], RADIUS, box(0.2, 0.1), velocity=velocity, spin=np.array([500.0, 0.0, 0.0]), gravity=1e-9,
        shapes=shapes, precision="mixed", start_speed=2.0, stiffness_scale=1e-2,
    )  # fmt: skip
    lists = simulation.grains.lists.pairs.length
    simulation.advance(1)
    before = lists[0]
    simulation.advance(50)
    assert before == 2
    assert lists[0] == 1
    assert np.isfinite(simulation.snapshot()["spin"]).all()
    simulation.close()
