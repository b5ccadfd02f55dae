"""Free bodies touch walls and each other: bounces, friction, rest, momentum and energy by closed forms.

Without water these scenes take a second or two each.
"""

from dataclasses import replace
from math import cos, pi, sin, sqrt, tan

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.parts import clear_of
from solvers.motion import contact_pairs
from solvers.motion.axle import Axle
from solvers.motion.contact_pairs import Touch
from solvers.motion.harmonic import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.outline import moments
from solvers.tank.parts import Body, Free, Part
from tests.oracles.held import Held
from tests.oracles.water import GRAVITY, box, lattice

DENSITY = 500.0  # kg/m³


def turned(points, turn: float, centre) -> np.ndarray:
    y, z = np.asarray(points, dtype=float).T
    return np.column_stack([centre[0] + cos(turn) * y - sin(turn) * z, centre[1] + sin(turn) * y + cos(turn) * z])


def disc(corners: int, radius: float, centre, turn: float = 0.0) -> np.ndarray:
    angles = 2.0 * pi * np.arange(corners) / corners
    return turned(radius * np.column_stack([np.cos(angles), np.sin(angles)]), turn, centre)


def block(width: float, height: float, centre, turn: float = 0.0) -> np.ndarray:
    return turned(box(width, height) - (0.0, 0.5 * height), turn, centre)


def free(points, **given) -> Body:
    area, centre, polar = moments(points)
    own = Free(DENSITY * area, DENSITY * polar, centre, **given)
    return Body(tuple(map(tuple, points)), closed=True, free=own)


def dry(parts, dt: float, outline=None, **given) -> Scene:
    return Scene(box(8.0, 3.0) if outline is None else outline, parts=tuple(parts), step=dt, thickness=1.0, **given)


def bodies_of(run) -> tuple[np.ndarray, np.ndarray]:
    """Places and velocities of all free bodies (bodies, 3), the latter half a step before."""
    bodies = run.parts.bodies
    return tuple(np.stack([field.to_numpy()[0] for field in of], axis=-1) for of in (bodies.place, bodies.velocity))


RESTITUTIONS = 1.0, 0.7, 0.3, 0.1
FALL = 0.05  # m


def falling(dt: float) -> tuple[Simulation, np.ndarray]:
    """Bodies just before they touch the floor: a box flat and on a corner, a disc on a corner and flat, by restitution.

    From here on nothing pulls them.
    """
    radius, half = 0.25, 0.3 * sqrt(0.5)
    shapes = (
        (lambda y: block(0.5, 0.3, (y, 0.15 + FALL))),
        (lambda y: block(0.3, 0.3, (y, half + FALL), 0.25 * pi)),
        (lambda y: disc(48, radius, (y, radius + FALL), -0.5 * pi)),
        (lambda y: disc(48, radius, (y, radius * cos(pi / 48) + FALL), -0.5 * pi + pi / 48)),
    )
    each = [(shape, e) for shape in shapes for e in RESTITUTIONS]
    parts = [free(shape(k - 7.5), restitution=e) for k, (shape, e) in enumerate(each)]
    scene = dry(parts, dt, box(17.0, 1.0), gravity=GRAVITY)
    run = Simulation(scene, threads=1)
    run.advance(int(sqrt(2.0 * FALL / GRAVITY) / dt) - 2)
    run.alter(replace(scene, gravity=0.0))
    return run, bodies_of(run)[1]


def test_a_bounce_through_the_centre_has_the_restitution_asked_for():
    # Half an undamped oscillation takes 28 steps or more, for which `Touch` promises 1 %. The disc's next corners are
    # 2.1 mm higher than the lowest; overlaps are 1.3 mm at 1 m/s.
    run, before = falling(1e-4)
    assert before[:, 1] == pytest.approx(-sqrt(2.0 * GRAVITY * FALL), rel=5e-3)
    run.advance(1000)
    after = bodies_of(run)[1]
    run.close()
    ratio = (-after[:, 1] / before[:, 1]).reshape(-1, len(RESTITUTIONS))
    assert ratio == pytest.approx(np.tile(RESTITUTIONS, (4, 1)), rel=0.01)
    assert np.abs(after[:, [0, 2]]).max() < 1e-9  # straight up


def test_two_bodies_bounce_off_each_other_with_the_mean_of_their_restitutions():
    # Equal faces: each corner of one lies on a corner of the other, so that there are four contacts, of 20 steps.
    lower, upper = (
        free(block(0.5, 0.3, (0.0, 0.5)), restitution=0.4),
        free(block(0.5, 0.6, (0.0, 1.0)), restitution=0.6),
    )
    run = Simulation(dry([lower, upper], 1e-4, gravity=0.0), threads=1)
    run.advance(1)
    run.parts.bodies.velocity[1].from_numpy(np.array([[0.0, -1.0]]))
    run.advance(1000)
    _, speed = bodies_of(run)
    run.close()
    ends = np.array([(1.0 + 0.5) * 2.0 / 3.0, (2.0 - 0.5) / 3.0])  # masses as 1 to 2
    assert -speed[:, 1] == pytest.approx(ends, rel=0.01)


def tumbling(dt: float) -> float:
    """Relative change of bodies' energies in bounces without losses or friction, r.m.s.

    Boxes and triangles fall on the floor at many angles, far off their centres.
    """
    turns = np.linspace(0.05, 1.5, 12)
    shapes = [block(0.5, 0.2, (0.8 * k - 4.8, 0.0), turn) for k, turn in enumerate(turns)]
    shapes += [disc(3, 0.3, (0.8 * k + 4.8, 0.0), turn) for k, turn in enumerate(turns[:6])]
    raised = [points - (0.0, points[:, 1].min() - FALL) for points in shapes]
    scene = dry([free(points, restitution=1.0, friction=0.0) for points in raised], dt, box(22.0, 2.0), gravity=GRAVITY)
    run = Simulation(scene, threads=1)
    run.advance(int(sqrt(2.0 * FALL / GRAVITY) / dt) - 3)
    run.alter(replace(scene, gravity=0.0))
    run.advance(1)
    start = run.observe()["body_energy"][0]
    run.advance(round(0.03 / dt))
    found = run.observe()
    run.close()
    assert found["contact_elastic"] == 0.0  # all are off the floor
    lost = start.sum() - found["body_energy"].sum()
    assert found["contact_lost"][0] == pytest.approx(lost, abs=1e-9 * start.sum())
    return np.sqrt(np.mean((found["body_energy"][0] / start - 1.0) ** 2))


@pytest.mark.slow
def test_a_bounce_without_losses_keeps_the_energy_to_second_order(monkeypatch):
    # An oscillation of ω is too fast by (ω Δt)²/24, a thousandth at 20 steps for half of it. Of that order is what a
    # collision that begins inside a step gains or loses. With as stiff springs and a quarter of the step it is a
    # sixteenth, but for chance.
    coarse = tumbling(2e-4)
    monkeypatch.setattr(contact_pairs, "STEPS", 4.0 * contact_pairs.STEPS)
    fine = tumbling(0.5e-4)
    assert coarse < 2e-3
    assert fine < coarse / 8.0


def test_a_box_sticks_on_a_slope_below_the_angle_of_friction_and_slides_above_as_coulomb_says():
    # The floor is of many short edges, on which nothing may catch.
    angle, friction, dt = 0.3, 0.2, 1e-4
    floor = np.column_stack([np.linspace(-4.0, 4.0, 81), np.zeros(81)])
    outline = np.concatenate([floor, [(4.0, 3.0), (-4.0, 3.0)]])
    boxes = (3.0, tan(angle) + 0.01), (1.0, friction), (-0.5, 0.0)
    parts = [free(block(0.5, 0.3, (y, 0.15)), friction=mu) for y, mu in boxes]
    run = Simulation(dry(parts, dt, outline, motions=[[Held(angle)]], gravity=GRAVITY), threads=1)
    run.advance(2000)
    run.observe()
    (place, start), lost = bodies_of(run), run.observe()["contact_lost"][0]
    run.advance(8000)
    there, end = bodies_of(run)
    found, loads = run.observe(), run.loads()[0]
    run.close()
    expected = [-GRAVITY * (sin(angle) - mu * cos(angle)) for _, mu in boxes[1:]]
    assert (end - start)[1:, 0] / 0.8 == pytest.approx(expected, rel=0.01)
    assert np.abs(there - place)[0].max() < 1e-3 * 0.02  # a thousandth of a spacing of 2 cm
    assert np.abs(end[:, 1:]).max() < 1e-6
    mass = parts[0].free.mass
    rubbed = friction * mass * GRAVITY * cos(angle) * (place - there)[1, 0]
    assert found["contact_lost"][0] - lost == pytest.approx(rubbed, rel=0.01)
    # What the floor bears is the boxes' weight but for what makes two of them slide, and has their moments.
    pushed = mass * (np.array([3.0 * GRAVITY * sin(angle) + sum(expected), 3.0 * GRAVITY * cos(angle)]))
    assert loads[0, :2] == pytest.approx([-pushed[0], -pushed[1]], rel=0.01)
    assert found["wall_force"][0] == pytest.approx(loads[0], rel=1e-9)
    assert loads.sum(axis=0) == pytest.approx(0.0, abs=1e-12 * np.abs(loads).sum())


@pytest.mark.slow
@pytest.mark.parametrize("aside", [0.0, 0.04])
def test_a_stack_of_two_boxes_stands(aside):
    # In line the corners of one lie on those of the other, and must not be pushed aside.
    dt, parts = 2e-4, [free(block(0.5, 0.3, (0.0, 0.15))), free(block(0.5, 0.3, (aside, 0.45)))]
    run = Simulation(dry(parts, dt, gravity=GRAVITY), threads=1)
    run.advance(5000)
    start, _ = bodies_of(run)
    run.observe()
    run.advance(5000)
    end, speed = bodies_of(run)
    run.observe()
    loads = run.loads()[0]
    run.close()
    weight = GRAVITY * parts[0].free.mass
    assert np.abs(end - start).max() < 1e-9
    assert np.abs(speed).max() < 1e-6
    # Two springs each bear half of both, and of one
    spring = Touch(parts[0], None).spring(dt)
    assert end[0, 1] == pytest.approx(0.15 - weight / spring, abs=1e-8)
    assert loads[:, 1] == pytest.approx([-2.0 * weight, weight, weight], rel=1e-6)
    assert loads[2, 2] == pytest.approx(weight * aside, rel=1e-3, abs=1e-6 * weight)


def pile() -> Scene:
    """Two bodies and a block that a driven wall pushes into each other, without weight, and away from there."""
    ram = Body(tuple(map(tuple, block(0.2, 0.6, (-1.2, 0.5)))), closed=True, motions=(Sway(0.4, 0.5),))
    bodies = [free(disc(11, 0.2, (-0.8, 0.55)), friction=0.5), free(block(0.3, 0.5, (-0.3, 0.4), 0.3), restitution=0.8)]
    outline = np.array([(-2.0, 0.0), (0.6, 0.0), (0.6, 0.3), (2.0, 0.3), (2.0, 1.0), (-2.0, 1.0)])
    still = Body(tuple(map(tuple, block(0.2, 0.2, (0.2, 0.85), 0.4))), closed=True)
    return dry([ram, *bodies, still], 1e-4, outline, gravity=0.0)


def test_what_bodies_gain_the_others_lose():
    scene = pile()
    run = Simulation(scene, threads=1)
    masses = np.array([[part.free.mass] * 2 + [part.free.inertia] for part in scene.parts if part.free])
    impulses, magnitude = np.zeros((1 + len(scene.parts), 3)), np.zeros(3)
    for _ in range(40):
        run.advance(250)
        run.observe()
        impulses += run.loads()[0] * 250 * run.dt
        magnitude += np.abs(run.loads()[0]).sum(axis=0) * 250 * run.dt
    place, velocity = bodies_of(run)
    run.close()
    momentum = masses * velocity
    momentum[:, 2] += place[:, 0] * momentum[:, 1] - place[:, 1] * momentum[:, 0]
    # Places are half a step ahead of velocities; along these the moment is the same.
    assert (magnitude > 1.0).all()
    assert (np.abs(impulses).max(axis=1) > 0.1).all()  # each of them was touched
    assert np.abs(impulses.sum(axis=0) / magnitude).max() < 1e-12
    assert np.abs((impulses[[2, 3]] - momentum) / magnitude).max() < 1e-12


def test_a_run_goes_on_bit_for_bit_from_within_a_contact():
    scene = pile()
    run = Simulation(scene, threads=1)
    steps = 0
    while not (run.arrays.read()["contacts.memory"][..., 0] != 0.0).any():
        run.advance(100)
        steps += 100
        assert steps < 20000
    state = run.state()
    run.advance(3000)
    whole = run.state()
    run.close()
    run = Simulation(scene, threads=1)
    run.restore(state)
    run.advance(3000)
    again = run.state()
    run.close()
    assert {name for name in whole if not np.array_equal(whole[name], again[name])} == set()


@pytest.mark.slow
def test_corners_of_the_tank_bear_a_body_and_an_edge_without_a_wall_does_not():
    # A board lies across a ridge; another one falls through an opening in the floor.
    outline = np.array(
        [(-3.0, 0.0), (-1.0, 0.0), (-0.6, 0.5), (-0.2, 0.0), (1.0, 0.0), (3.0, 0.0), (3.0, 2.0), (-3.0, 2.0)]
    )
    parts = [free(block(1.0, 0.1, (-0.6, 0.55)), friction=0.0), free(block(0.8, 0.2, (2.0, 0.3)))]
    run = Simulation(dry(parts, 2e-4, outline, gravity=GRAVITY, open_edges=(4,)), threads=1)
    run.advance(5000)
    place, speed = bodies_of(run)
    run.close()
    assert place[0] == pytest.approx([-0.6, 0.55, 0.0], abs=1e-3)
    assert np.abs(speed[0]).max() < 1e-6
    assert place[1] == pytest.approx([2.0, 0.3 - 0.5 * GRAVITY, 0.0], abs=2e-3)


def test_a_box_in_a_groove_is_borne_by_both_its_sides():
    # The lowest corner touches both at once, the two beside it one each: springs of 4 k/2 across.
    side, outline = 0.3, np.array([(0.0, 0.0), (1.0, 1.0), (-1.0, 1.0)])
    part = free(block(side, side, (0.0, side * sqrt(0.5)), 0.25 * pi), friction=0.0)
    run = Simulation(dry([part], 2e-4, outline, gravity=GRAVITY), threads=1)
    run.advance(2500)
    place, speed = bodies_of(run)
    run.close()
    sunk = part.free.mass * GRAVITY / (2.0 * Touch(part, None).spring(2e-4))
    assert place[0] == pytest.approx([0.0, side * sqrt(0.5) - sunk, 0.0], abs=0.01 * sunk)
    assert np.abs(speed).max() < 1e-6


@pytest.mark.slow
def test_a_smooth_body_slides_in_a_round_tank_like_a_pendulum():
    # Without friction or losses; neither the disc's corners nor those between the tank's edges may catch.
    radius, ball, angle = 1.0, 0.2, 0.3
    long, height = radius - ball, radius * cos(pi / 96)
    centre = long * sin(angle), radius - (height - ball) * cos(angle)
    part = free(disc(48, ball, centre, 0.013), friction=0.0, restitution=1.0)
    run = Simulation(dry([part], 1e-4, disc(96, radius, (0.0, radius), -0.5 * pi), gravity=GRAVITY), threads=1)
    times, places = [], []
    energy = run.observe()["body_energy"][0, 0]
    for _ in range(160):
        run.advance(250)
        times.append(run.time)
        places.append(bodies_of(run)[0][0, 0])
    found = run.observe()
    run.close()
    up = [k for k in range(159) if places[k] < 0.0 <= places[k + 1]]
    crossed = [np.interp(0.0, places[k : k + 2], times[k : k + 2]) for k in up]
    period = 2.0 * pi * sqrt(long / GRAVITY) * (1.0 + angle**2 / 16.0)
    # Facets of the disc raise it by up to 0.4 mm, on which it hops: 1.2 % of the 36 mm that it falls.
    assert np.diff(crossed) == pytest.approx(period, rel=0.012)
    kept = found["body_energy"][0, 0] + found["contact_elastic"][0]
    least = part.free.mass * GRAVITY * ball
    assert kept == pytest.approx(energy, abs=2e-3 * (energy - least))  # twice (ω Δt)²/24, as of a bounce


@pytest.mark.slow
def test_an_axle_feels_a_free_body_by_its_contacts_alone():
    # The tank is so heavy that it hardly turns: its moment is that of the body's weight.
    part = free(block(0.4, 0.2, (1.0, 0.1)))
    scene = dry([part], 2e-4, gravity=GRAVITY, axles=[Axle((0.0, 0.0), 1e9, 0.0)])
    assert scene.shares.tolist() == [[1.0, 0.0]]
    run = Simulation(scene, threads=1)
    run.advance(2000)
    run.observe()
    run.advance(1000)
    found = run.observe()
    run.close()
    moment = -GRAVITY * part.free.mass
    assert found["axle_moment"][0] == pytest.approx(moment, rel=1e-3)
    inertia = 1e9 * found["pose_rate"][0, 2] / run.time
    assert inertia == pytest.approx(moment, rel=0.01)


@pytest.mark.slow
def test_bodies_pass_plates_and_what_is_held_pushes_nothing():
    plate = Part(((-1.0, 0.5), (1.0, 0.5)))
    lower, upper = free(block(0.4, 0.2, (0.0, 0.09)), release=9.0), free(block(0.2, 0.2, (0.0, 1.0)))
    run = Simulation(dry([plate, lower, upper], 2e-4, gravity=GRAVITY), threads=1)
    run.advance(5000)
    run.observe()
    place, loads = bodies_of(run)[0], run.loads()[0]
    run.close()
    assert place[0] == pytest.approx([0.0, 0.09, 0.0], abs=0.0)
    assert place[1, 1] == pytest.approx(0.29, abs=1e-3)
    assert not loads[:2].any()


SPACING, STEEP = 0.05, 0.1  # m; slope of the floor


def sunken() -> Scene:
    """A box of 1.5 times the density of water, askew over the sloping floor of a small tank that is full of it."""
    width, depth, size, sound = 1.0, 0.8, (0.3, 0.2), 10.0 * sqrt(GRAVITY * 0.8)
    outline = box(width, 1.2) + STEEP * np.array([(0.0, -0.5), (0.0, 0.5), (0.0, 0.0), (0.0, 0.0)])
    body = free(block(*size, (0.1, 0.2), STEEP + 0.1))
    mass = 1500.0 * size[0] * size[1]
    own = Free(mass, mass * (size[0] ** 2 + size[1] ** 2) / 12.0, body.free.centre)
    body = replace(body, free=own)
    drops = lattice(width, depth, SPACING, sound)
    places = drops["position"][0]
    wet = places[:, 1] > STEEP * places[:, 0] + 0.4 * SPACING
    drops = drops[:, wet & clear_of(places, (body,), SPACING)]
    return Scene(outline, (Fluid(Water(spacing=SPACING, sound_speed=sound), drops),), parts=(body,), thickness=1.0)


@pytest.mark.slow
@pytest.mark.parametrize("until", [4.0, 60.0])
def test_a_heavy_body_sinks_and_rests_on_a_slope_under_water(until):
    # It may go a twentieth of a spacing in that time: below it are few particles of water, or none, which come and go.
    scene = sunken()
    run = Simulation(scene, threads=1)
    run.advance(round(2.0 / run.dt))
    run.observe()
    place, _ = bodies_of(run)
    run.advance(round((until - 2.0) / run.dt))
    (end, speed), found = bodies_of(run), run.observe()
    loads = run.loads()[0]
    run.close()
    drops = scene.fluid.particles
    weight, water = (
        GRAVITY * scene.parts[0].free.mass,
        GRAVITY * 1e3 * (drops["volume"] * (1.0 + drops["deviation"])).sum(),
    )
    assert np.hypot(*(end - place)[0, :2]) < 0.05 * SPACING
    assert end[0, 2] == pytest.approx(-0.1, abs=0.01)  # flat on the floor, to a twentieth of its height
    assert np.abs(speed).max() < 0.01
    assert loads[1, 1] == pytest.approx(weight, rel=0.01)
    assert found["wall_force"][0, 1] == pytest.approx(-weight - water, rel=0.01)


def test_a_body_that_may_fall_on_the_floor_bounds_the_step_and_one_that_floats_does_not():
    # v = √(2 g' h) with what buoyancy leaves of gravity; its overlap v √(m/k) is half a spacing.
    scene = sunken()
    heavy, own = scene.parts[0], scene.parts[0].free
    height = min(z for _, z in heavy.points) + 0.5 * STEEP
    speed = sqrt(2.0 * GRAVITY * height * (1.0 - 1.0 / 1.5))
    steps = 28.0  # and 56 ζ is 27.8 at a restitution of 0.3
    expected = 0.5 * SPACING / (speed * sqrt(2.0) * steps / pi)
    found = {limit.reason: limit.step for limit in scene.step_limits()}
    (reason,) = (reason for reason in found if "overlap" in reason)
    assert found[reason] == pytest.approx(expected, rel=1e-6)
    light = replace(heavy, free=replace(own, mass=own.mass / 2.0))
    assert not any("overlap" in limit.reason for limit in replace(scene, parts=(light,)).step_limits())
