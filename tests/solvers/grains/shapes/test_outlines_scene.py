"""Irregular grains in whole scenes: the disc limit, conservation, walls, schedules, rest."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import optimize

from solvers.grains.shapes.cargo import cargo
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.given import CONTACTS, Shapes
from solvers.grains.shapes.rules import osculating, rest
from solvers.motion import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.outlines import ellipse, star
from tests.oracles.scenes import box, material

RADIUS = 3e-3
LEDGE = np.array([[-0.03, 0.0], [0.01, 0.0], [0.01, 0.01], [0.03, 0.01], [0.03, 0.1], [-0.03, 0.1]])
SOFT = material(young=3e7, restitution=0.6, friction=0.4)
LOSSLESS = material(young=3e7, friction=0.0, dissipative_time=0.0)
AXES = 1.5, 1.0 / 1.5  # of an ellipse with the area of a disc of radius 1
ROUND = Contour(1.0)


def unit(outline):
    return outline.with_diameter(2.0)


def rice():
    return cargo("rice").outline(np.random.default_rng(1), 2.0)


def corn():
    return cargo("corn").outline(np.random.default_rng(1), 2.0)


def shapes(outlines, count, worlds=1, contact="continuous", angle=None, nodes=120):
    random = np.random.default_rng(3)
    which = random.integers(0, len(outlines), (worlds, count))
    turned = random.uniform(-np.pi, np.pi, (worlds, count)) if angle is None else np.full((worlds, count), angle)
    return Shapes(tuple(outlines), which, turned, contact, nodes)


def loose(columns, rows, pitch, worlds=1):
    """Radii and places of a loose stack above the ledge."""
    random = np.random.default_rng(5)
    column, row = (axis.ravel() for axis in np.meshgrid(np.arange(columns), np.arange(rows), indexing="ij"))
    sites = pitch * np.stack([column - 0.5 * (columns - 1), row + 0.6], axis=1) + [0.0, 0.01]
    places = sites + 0.05 * RADIUS * random.uniform(-1.0, 1.0, (worlds, len(sites), 2))
    return RADIUS * random.uniform(0.8, 1.0, (worlds, len(sites))), places


def scene(given, radius, **changes):
    """Grains above the ledge of a tank that sways."""
    motions = [(Sway(0.004, 6.0, phase=w),) for w in range(len(radius))]
    return scene_of(
        radius, LEDGE, SOFT, SOFT, tangential="mindlin", motions=motions, shapes=given, step=2e-5, **changes
    )


def falling(given, places, radius):
    return Simulation(scene(given, radius), places, threads=1)


def going_on(now, given, radius, threads=1, units=None, **changes):
    """A simulation started from the present state, so that equal runs have not diverged by chaos yet."""
    turned = given and replace(given, angle=now["angle"])
    simulation = Simulation(scene(turned, radius, **changes), now["position"], threads, units=units)
    simulation.launch(now["velocity"], now["spin"])
    simulation.start_clock()
    return simulation


@pytest.mark.slow
@pytest.mark.parametrize(("contact", "within"), [("continuous", 2e-5), ("nodes", 5e-3), ("area", 5e-3)])
def test_round_outlines_are_discs(contact, within):
    radius, places = loose(5, 4, 2.1 * RADIUS)
    start = falling(None, places, radius)
    start.advance(6000)
    now, found = start.snapshot(), []
    for given in (None, shapes([ROUND], radius.size, contact=contact, nodes=500)):
        simulation = going_on(now, given, radius)
        simulation.advance(400)
        found.append(simulation.snapshot())
    assert simulation.observe()["contacts"] > 5  # how many depends on the bed
    discs, outlines = found
    assert np.abs(discs["position"] - now["position"]).max() > 0.05 * RADIUS
    assert np.abs(outlines["position"] - discs["position"]).max() < within * RADIUS
    assert np.abs(outlines["angle"] - now["angle"] - discs["angle"]).max() < 2.0 * within


def collision(contact, outlines, grain=SOFT, step=1e-5, angles=(0.3, 1.9), speed=0.5):
    """Two grains that meet in free fall."""
    given = Shapes(tuple(outlines), np.array([[0, len(outlines) - 1]]), np.array([angles]), contact)
    places = np.array([[[-0.008, 0.05], [0.008, 0.052]]])
    made = scene_of(
        np.full((1, 2), RADIUS), box(0.1, 0.1), grain, grain, shapes=given, step=step, start_speed=2.0 * speed
    )
    simulation = Simulation(made, places, threads=1)
    simulation.launch(np.array([[[speed, 0.0], [-speed, 0.0]]]), np.array([[20.0, 35.0]]))
    simulation.start_clock()
    return simulation


def momenta(simulation):
    """Of both grains together: momentum (2,) and angular momentum about the common centre of mass."""
    now, mass = simulation.snapshot(), simulation.grains.mass[0]
    inertia = 1.0 / simulation.grains.grains.inverse_inertia.to_numpy()[0, :2]
    position, velocity = now["position"][0], now["velocity"][0]
    centre = (mass[:, None] * position).sum(axis=0) / mass.sum()
    away, momentum = position - centre, mass[:, None] * velocity
    turning = (away[:, 0] * momentum[:, 1] - away[:, 1] * momentum[:, 0]).sum() + (inertia * now["spin"][0]).sum()
    return momentum.sum(axis=0), turning


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contact", "other"), [("area", rice), ("continuous", rice), *((rule, corn) for rule in CONTACTS)]
)
def test_momenta_are_conserved_with_friction_and_losses(contact, other):
    simulation = collision(contact, [rice(), other()])
    before, turning = momenta(simulation)
    simulation.advance(1500)
    after, turning_after = momenta(simulation)
    weight = simulation.grains.mass.sum() * 9.81 * simulation.time
    scale = simulation.grains.mass[0, 0] * 0.5
    assert np.abs(simulation.snapshot()["velocity"][0, 0] - [0.5, -9.81 * simulation.time]).max() > 0.05  # they met
    assert after - before == pytest.approx([0.0, -weight], abs=1e-12 * scale)
    assert turning_after == pytest.approx(turning, abs=1e-12 * scale * RADIUS)


def energy(simulation):
    """Of all worlds together (J)."""
    row = simulation.observe()
    return float(sum(row[name].sum() for name in ("kinetic", "rotational", "potential", "elastic")))


@pytest.mark.slow
def test_energy_of_a_smooth_collision_converges_with_the_square_of_the_step():
    """Two convex rice grains without friction or losses."""
    errors = []
    for step in (1e-5, 5e-6):
        simulation = collision("continuous", [rice()], LOSSLESS, step)
        simulation.advance(1)
        start, worst = energy(simulation), 0.0
        moving = sum(simulation.observe()[name][0] for name in ("kinetic", "rotational"))
        for _ in range(30):
            simulation.advance(round(5e-4 / step))
            worst = max(worst, abs(energy(simulation) - start) / moving)
        errors.append([worst, abs(energy(simulation) - start) / moving])
        simulation.close()  # so that the next one finds its kernels
    during, after = np.array(errors).T
    assert during[0] / during[1] == pytest.approx(4.0, rel=0.15)
    assert after[0] < 2e-4 and after[1] < after[0] / 4.0


@pytest.mark.slow
def test_a_tip_may_overlap_by_more_than_its_radius_of_curvature():
    """The tip of one rice grain meets the side of another at 5 m/s each, without friction or losses."""
    outline = rice()
    theta = np.linspace(0.0, 2.0 * np.pi, 2000)
    p, d, dd = outline.polar(theta), outline.polar(theta, 1), outline.polar(theta, 2)
    roundness = ((p**2 + d**2) ** 1.5 / (p**2 + 2.0 * d**2 - p * dd)).min()
    long_way = theta[p.argmax()]
    simulation = collision("continuous", [outline], LOSSLESS, 2e-6, (0.5 * np.pi - long_way, np.pi - long_way), 5.0)
    simulation.advance(1)
    start, deepest, worst = energy(simulation), 0.0, 0.0
    for _ in range(60):
        simulation.advance(10)
        worst = max(worst, abs(energy(simulation) / start - 1.0))
        deepest = max(deepest, simulation.observe()["overlap"][0])
    assert deepest > 1.2 * roundness
    assert worst < 1e-3


@pytest.mark.slow
@pytest.mark.parametrize("name", ["corn", "sunflower"])
@pytest.mark.parametrize(("contact", "within"), [("continuous", 2e-2), ("area", 2e-3)])
def test_energy_of_a_bed_of_concave_grains_without_losses(contact, within, name):
    """It falls 10 diameters and is stirred by that for 0.2 s; contacts of bends come and go all the time.

    Mean of four beds: by the continuous rule beds that differ by a last digit gain 0.7 to 1.3 %, such means 0.8 to 1.2.
    """
    random = np.random.default_rng(2)
    outlines = [cargo(name).outline(random, 2.0) for _ in range(4)]
    worlds, columns, rows = 4, 4, 8
    site = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    pitch = 2.2 * max(outline.bounding_radius for outline in outlines) * RADIUS
    places = pitch * (site - [0.5 * (columns - 1), -0.6]) + random.uniform(-1e-4, 1e-4, (worlds, *site.shape))
    made = scene_of(
        np.full((worlds, len(site)), RADIUS),
        box(columns * pitch, 2.0 * rows * pitch),
        LOSSLESS,
        LOSSLESS,
        shapes=shapes(outlines, len(site), worlds, contact, nodes=200),
    )
    simulation = Simulation(made, places, threads=1)
    start, moved = energy(simulation), 0.0
    for _ in range(40):
        simulation.advance(round(5e-3 / simulation.dt))
        moved = max(moved, simulation.observe()["rotational"].sum() / start)
    assert moved > 0.02
    assert energy(simulation) == pytest.approx(start, rel=within)


DEPTH = 0.01 * RADIUS
CORNER, TOWARDS = np.array([0.01, 0.01]), np.array([-0.6, 0.8])  # between the normals of the ledge's two walls
ANGLES = (0.0, 0.4, 1.2)  # at which its normal on the corner lies between those


def nearest(place, angle):
    """Distance (m) from the ledge's corner to an ellipse, positive outside it."""
    tilt = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    own = tilt.T @ (CORNER - place) / RADIUS

    def away(t):
        return np.hypot(AXES[0] * np.cos(t) - own[0], AXES[1] * np.sin(t) - own[1])

    guess = min(np.linspace(0, 2 * np.pi, 400), key=away)
    best = optimize.minimize_scalar(away, bounds=(guess - 0.02, guess + 0.02), method="bounded").fun
    return RADIUS * best * (-1.0 if (own[0] / AXES[0]) ** 2 + (own[1] / AXES[1]) ** 2 < 1.0 else 1.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contact", "floor", "corner"),
    [("continuous", 1e-4, 1e-3), ("nodes", 2e-3, 3e-2)],
)
def test_ellipses_on_a_floor_and_on_a_reflex_corner(contact, floor, corner):
    """One reaches √(a² sin² + b² cos²) down from its middle; a corner is as deep in one as its nearest point is far.

    The rule of nodes takes the polar depth, which is longer by the outline's slope there, to the second order.
    """
    places = [(-0.015, RADIUS * np.hypot(AXES[0] * np.sin(a), AXES[1] * np.cos(a)) - DEPTH) for a in ANGLES]
    for angle in ANGLES:
        away = optimize.brentq(lambda s, a=angle: nearest(CORNER + s * TOWARDS, a) + DEPTH, 0.3 * RADIUS, 2.0 * RADIUS)
        places.append(CORNER + away * TOWARDS)
    count = len(places)
    given = Shapes((unit(ellipse(*AXES)),), np.zeros((count, 1), dtype=int), np.array([ANGLES * 2]).T, contact, 2000)
    made = scene_of(np.full((count, 1), RADIUS), LEDGE, SOFT, SOFT, shapes=given, step=1e-7)
    simulation = Simulation(made, np.array(places)[:, None], threads=1)
    simulation.advance(1)
    found = simulation.observe()["overlap"] * RADIUS
    assert found[: len(ANGLES)] == pytest.approx(DEPTH, rel=floor)
    assert found[len(ANGLES) :] == pytest.approx(DEPTH, rel=corner)


@pytest.mark.slow
def test_schedules_agree():
    """Bands to rounding, also of pairs that two share. Grain by grain, contacts are looked for at other times: 1e-5 R.

    The outlines are convex: of others some contacts come late, the sooner they are looked for the less so.
    """
    radius, places = loose(4, 3, 4.2 * RADIUS, worlds=2)
    given = shapes([unit(rice()), unit(ellipse(*AXES))], radius.shape[1], worlds=2)
    start = falling(given, places, radius)
    start.advance(5000)
    now, found = start.snapshot(), []
    for schedule, units in (("per-world", None), ("per-band", 2), ("per-grain", None)):
        simulation = going_on(now, given, radius, 2, units, schedule=schedule)
        simulation.advance(600)
        found.append(simulation.snapshot())
    assert simulation.observe()["contacts"].sum() > 3
    for other, within in zip(found[1:], (1e-6, 1e-5), strict=True):
        assert np.abs(other["position"] - found[0]["position"]).max() < within * RADIUS


@pytest.mark.slow
@pytest.mark.parametrize(
    ("contact", "speed", "within"),
    [
        *(("continuous", speed, 1e-4) for speed in (0.0, 0.1)),
        ("nodes", 0.0, 2e-2),
        ("nodes", 0.1, 2e-2),
        ("area", 0.0, 1e-4),
    ],
)
def test_updated_contacts_agree_with_contacts_found_at_each_step(contact, speed, within, monkeypatch):
    """In a bed at rest and one that is thrown; of nodes the next may come late, and a grain then tips elsewhere.

    By so much as 1e-2 of its way, by the bed.
    """
    radius, places = loose(4, 3, 4.2 * RADIUS, worlds=2)
    given = shapes([unit(rice()), unit(ellipse(*AXES))], radius.shape[1], 2, contact)
    start = falling(given, places, radius)
    start.advance(10000)
    now, found = start.snapshot(), []
    now["velocity"][:], now["spin"][:] = [speed, 0.0], 0.0
    for hardly, slides in ((rest.HARDLY, osculating.LONGEST), (0.0, 0.0)):
        monkeypatch.setattr(rest, "HARDLY", hardly)
        monkeypatch.setattr(osculating, "LONGEST", slides)
        simulation = going_on(now, given, radius)
        simulation.advance(500)
        found.append(simulation.snapshot())
    assert simulation.observe()["contacts"].sum() > 10  # how many depends on the bed, and on whether they fly
    went = np.abs(found[0]["position"] - now["position"]).max()
    assert went > 1e-3 * RADIUS
    assert np.abs(found[1]["position"] - found[0]["position"]).max() < within * went


@pytest.mark.slow
def test_a_state_continues_bit_for_bit():
    radius, places = loose(4, 3, 4.2 * RADIUS)
    given = shapes([unit(rice()), unit(star(3, 0.1))], radius.shape[1])
    first, second = (falling(given, places, radius) for _ in range(2))
    first.advance(3000)
    second.restore(first.state())
    for simulation in (first, second):
        simulation.advance(500)
    assert np.array_equal(first.snapshot()["position"], second.snapshot()["position"])
    assert np.array_equal(first.snapshot()["angle"], second.snapshot()["angle"])


@pytest.mark.slow
def test_a_grain_comes_to_rest_on_two_of_its_lobes():
    """Its middle is then as high as the outline's support is least, and no more energy is in it."""
    trefoil = unit(star(3, 0.2))
    theta = np.linspace(0.0, 2.0 * np.pi, 20_000)
    ways = np.linspace(0.0, 2.0 * np.pi, 1201)
    support = (trefoil.points(theta) @ np.stack([np.cos(ways), np.sin(ways)])).max(axis=0)
    rough = material(young=3e7, restitution=0.2, friction=0.5)
    given = Shapes((trefoil,), np.array([[0]]), np.array([[0.3]]))
    made = scene_of(np.full((1, 1), RADIUS), box(0.1, 0.1), rough, rough, tangential="mindlin", shapes=given)
    simulation = Simulation(made, np.array([[[0.0, 1.5 * RADIUS]]]), threads=1)
    assert simulation.settle(1e-9, 2.0)
    assert simulation.observe()["contacts"] == 2
    assert simulation.snapshot()["position"][0, 0, 1] == pytest.approx(support.min() * RADIUS, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize("nodes", [36, 120])
def test_a_disc_of_nodes_rolls_only_on_slopes_above_pi_over_the_nodes(nodes):
    """Two discs lie on an edge, on floors that fall from either side, a tenth steeper and flatter than that."""
    steep, flat = 1.1 * np.pi / nodes, 0.9 * np.pi / nodes
    floor = [[-0.2, 0.2 * np.tan(steep)], [0.0, 0.0], [0.2, 0.2 * np.tan(flat)]]
    away = np.array([[np.sin(steep), np.cos(steep)], [-np.sin(flat), np.cos(flat)]])  # from the floors
    place = np.mean([floor[::2], [[0.0, 0.0]] * 2], axis=0) + RADIUS * np.cos(np.pi / nodes) * away
    turn = np.arctan2(-away[:, 1], -away[:, 0]) + np.pi / nodes
    given = Shapes((ROUND,), np.zeros((1, 2), dtype=int), turn[None], "nodes", nodes)
    corners = np.array([*floor, [0.2, 0.3], [-0.2, 0.3]])
    simulation = Simulation(
        scene_of(np.full((1, 2), RADIUS), corners, SOFT, SOFT, tangential="mindlin", shapes=given),
        place[None],
        threads=1,
    )
    simulation.advance(round(0.3 / simulation.dt))
    gone = np.abs(simulation.snapshot()["position"][0] - place)[:, 0]
    assert gone[0] > RADIUS
    assert gone[1] < 0.01 * RADIUS


@pytest.mark.slow
def test_worlds_run_together_as_they_do_alone():
    radius, places = loose(3, 2, 4.2 * RADIUS, worlds=2)
    given = shapes([unit(rice()), unit(star(3, 0.1))], radius.shape[1], worlds=2)
    sizes = 0.8 * RADIUS, RADIUS
    alone = [
        scene(replace(given, which=given.which[[w]], angle=given.angle[[w]]), radius[[w]], sizes=sizes)
        for w in range(2)
    ]
    both = Simulation(Scene.joined(alone), places, threads=1)
    one = Simulation(alone[1], places[1:], threads=1)
    for simulation in (both, one):
        simulation.advance(3200)
    now = one.snapshot()
    assert np.abs(now["velocity"][0, :, 0]).max() > 0.01  # some have met the ledge or another
    assert np.abs(both.snapshot()["position"][1] - now["position"][0]).max() < 1e-6 * RADIUS
