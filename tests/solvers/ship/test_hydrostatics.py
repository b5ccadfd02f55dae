"""The section's clipping against strips, hydrostatics against a box's closed forms, moments against the energy."""

from math import atan, pi

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.hydrostatics import (
    Loading,
    balanced_heave,
    buoyancy,
    equilibrium,
    metacentric_height,
    potential_energy,
    restoring,
    righting_lever,
    righting_levers,
    stiffness,
    surface_force,
    turned,
)
from solvers.ship.section import Section, box
from solvers.ship.water import Water
from tests.oracles.hulls import catamaran, circle, lopsided, mirrored

WATER = Water()
BREADTH, HEIGHT, DRAUGHT, GRAVITY_HEIGHT = 0.34, 0.30, 0.11, 0.10  # m, the barge of Spandonidis (2016), chapter 7
BARGE = box(BREADTH, HEIGHT)
LOADED = Loading(WATER.density * BREADTH * DRAUGHT, (0.0, GRAVITY_HEIGHT))
SECTIONS = {"box": BARGE, "lopsided": lopsided(), "catamaran": catamaran()}
POSES = [(-0.11, 0.0), (-0.2, 0.3), (0.02, -0.7), (0.1, 1.6), (0.13, 2.8), (0.15, pi)]


def strips(section: Section, heave: float, roll: float, elevation: float, slope: float, count: int = 40000):
    """Area (m²), ∫∫y dA and ∫∫z dA under the surface from vertical strips, each cut by the even–odd rule."""
    corners = turned(tuple(section.outline.T), roll) + np.array([0.0, heave])
    low, high = corners[:, 0].min(), corners[:, 0].max()
    width = (high - low) / count
    y = low + width * (np.arange(count) + 0.5)
    a, b = corners, np.roll(corners, -1, axis=0)
    within = (a[:, 0, None] > y) != (b[:, 0, None] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        z = a[:, 1, None] + (y - a[:, 0, None]) / (b[:, 0] - a[:, 0])[:, None] * (b[:, 1] - a[:, 1])[:, None]
    top = elevation + slope * y
    z = np.sort(np.where(within, np.minimum(z, top), np.inf), axis=0)
    z = np.where(np.isfinite(z), z, top)  # pairs of nothing
    z = z[: len(z) // 2 * 2]
    area, half_square = z[1::2] - z[::2], 0.5 * (z[1::2] ** 2 - z[::2] ** 2)
    return width * area.sum(), width * (area.sum(0) @ y), width * half_square.sum()


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize(("elevation", "slope"), [(0.0, 0.0), (0.03, 0.4), (-0.02, -0.2)])
def test_immersed_part_is_that_of_strips(name, elevation, slope):
    section = SECTIONS[name]
    for heave, roll in POSES:
        wet = section.immersion(heave, roll, elevation, slope)
        area, moment_y, moment_z = strips(section, heave, roll, elevation, slope)
        assert wet.area == pytest.approx(area, abs=1e-6)
        if area == 0.0:
            assert wet.area == 0.0 and np.isnan(wet.centroid).all()
            continue
        assert wet.area * wet.centroid == pytest.approx(np.array([moment_y, moment_z]), abs=3e-7)


def test_several_poses_give_the_same_as_one_by_one():
    heave, roll = np.array(POSES).T
    together = BARGE.immersion(heave, roll, 0.01, 0.1)
    for k, pose in enumerate(POSES):
        one = BARGE.immersion(*pose, 0.01, 0.1)
        assert together.area[k] == one.area
        assert np.array_equal(together.centroid[k], one.centroid)


def test_waterline():
    """One piece between a box's sides, at both of its heights; two of a catamaran, none where it is dry or sunk."""
    assert BARGE.waterlines(-DRAUGHT, 0.0) == pytest.approx(np.array([[[-0.17, 0.0], [0.17, 0.0]]]))
    tan = 0.3
    ends = BARGE.waterlines(-DRAUGHT, 0.0, slope=tan)
    assert ends == pytest.approx(np.array([[[-0.17, -0.17 * tan], [0.17, 0.17 * tan]]]))
    pieces = catamaran().waterlines(-0.1, 0.0)
    assert pieces[:, :, 0] == pytest.approx(np.array([[-0.20, -0.12], [0.12, 0.20]]))
    plane = catamaran().waterplane(-0.1, 0.0)
    assert (plane.breadth, plane.second_moment) == pytest.approx((0.16, 2.0 * (0.2**3 - 0.12**3) / 3.0))
    for heave in (0.1, -1.0):
        assert len(BARGE.waterlines(heave, 0.3)) == 0
        assert BARGE.waterplane(heave, 0.3).breadth == 0.0


def test_righting_lever_of_a_box():
    """GZ = sin φ (GM + ½ BM tan²φ) (Scribanti) until an edge of bottom or deck reaches the water."""
    metacentre = BREADTH**2 / (12.0 * DRAUGHT)
    height = 0.5 * DRAUGHT + metacentre - GRAVITY_HEIGHT
    assert metacentric_height(BARGE, LOADED, WATER) == pytest.approx(height, rel=1e-9)
    until = min(atan(2.0 * DRAUGHT / BREADTH), atan(2.0 * (HEIGHT - DRAUGHT) / BREADTH))
    rolls = np.linspace(-until, until, 21)
    closed = np.sin(rolls) * (height + 0.5 * metacentre * np.tan(rolls) ** 2)
    assert righting_levers(BARGE, LOADED, WATER, rolls) == pytest.approx(closed, abs=1e-6 * BREADTH, rel=1e-6)
    assert abs(righting_lever(BARGE, LOADED, WATER, until + 0.15) / (np.sin(until + 0.15) * height) - 1.0) > 0.01


def test_righting_lever_of_a_box_on_its_side_and_upside_down():
    """At 90° the box floats on a side, draught A/height, upright in y: GZ = height/2 − KG; at 180° none."""
    assert righting_lever(BARGE, LOADED, WATER, pi / 2) == pytest.approx(0.5 * HEIGHT - GRAVITY_HEIGHT, rel=1e-9)
    assert righting_lever(BARGE, LOADED, WATER, pi) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("name", SECTIONS)
def test_righting_levers_by_strips_to_180_degrees(name):
    """At the balanced heave, strips find the weight's area, and the lever from their centroid."""
    section = SECTIONS[name]
    loading = Loading(0.45 * section.area * WATER.density, (0.01, 0.12))
    for roll in np.radians(np.arange(-180.0, 181.0, 24.0)):
        heave = balanced_heave(section, loading, WATER, roll)
        area, moment_y, _ = strips(section, heave, roll, 0.0, 0.0)
        assert area * WATER.density == pytest.approx(loading.mass, rel=2e-5)
        expected = turned(loading.centre, roll)[0] - moment_y / area
        assert righting_lever(section, loading, WATER, roll) == pytest.approx(expected, abs=2e-5 * section.size)


@pytest.mark.parametrize("name", SECTIONS)
def test_restoring_forces_are_minus_the_gradient_of_the_energy(name):
    """About the centre of gravity, whose height follows from heave and roll: F_z = −∂U/∂z_G, M = −∂U/∂φ."""
    section, step = SECTIONS[name], 1e-5
    loading = Loading(20.0, (0.02, 0.12))

    def energy(height, roll):
        return potential_energy(section, loading, WATER, height - turned(loading.centre, roll)[1], roll)

    for heave, roll in POSES:
        height = heave + turned(loading.centre, roll)[1]
        force = (energy(height - step, roll) - energy(height + step, roll)) / (2.0 * step)
        moment = (energy(height, roll - step) - energy(height, roll + step)) / (2.0 * step)
        _, vertical, turning = restoring(section, loading, WATER, heave, roll)
        assert (vertical, turning) == pytest.approx((force, moment), rel=1e-6, abs=1e-6)


@pytest.mark.parametrize("name", SECTIONS)
def test_linear_hydrostatics_are_the_derivatives_at_equilibrium(name):
    """Stiffness and wave force against finite differences, at a heeled equilibrium."""
    section, step = SECTIONS[name], 1e-6
    loading = Loading(0.4 * section.area * WATER.density, (0.01, 0.08))
    heave, roll = equilibrium(section, loading, WATER, roll=0.1)
    centre = turned(loading.centre, roll)

    def held(rise, turn):
        now = turned(loading.centre, roll + turn)
        return restoring(section, loading, WATER, heave + rise + centre[1] - now[1], roll + turn)

    found = stiffness(section, loading, WATER, heave, roll)
    assert np.all(found[:, 0] == 0.0)
    for column, unit in ((1, (step, 0.0)), (2, (0.0, step))):
        slope = (held(*np.negative(unit)) - held(*unit)) / (2.0 * step)
        assert found[:, column] == pytest.approx(slope, abs=1e-4 * np.abs(found).max())
    righting = metacentric_height(section, loading, WATER, roll) * loading.mass * WATER.gravity
    assert found[2, 2] - found[1, 2] ** 2 / found[1, 1] == pytest.approx(righting, rel=1e-9)
    about = (0.03, 0.1)
    for row, unit in zip(surface_force(section, WATER, heave, roll, about), np.eye(2) * step, strict=True):
        slope = [buoyancy(section, WATER, heave, roll, *(sign * unit), about=about) for sign in (1.0, -1.0)]
        assert row == pytest.approx((slope[0] - slope[1]) / (2.0 * step), abs=1e-3)


def test_a_sloping_surface_equals_turned_gravity():
    """A uniform pressure gradient (−s, 1) ρ g is gravity √(1 + s²) g turned by α = atan s; turn all back by α."""
    section, heave, roll, alpha = lopsided(), -0.08, 0.5, 0.2
    sloped = buoyancy(section, WATER, heave, roll, slope=np.tan(alpha), about=(0.03, 0.1))
    stronger = Water(WATER.density, gravity=WATER.gravity / np.cos(alpha))
    # The hull's origin lies `heave` above the sloping surface, measured upright, heave × cos α measured square to it.
    level = buoyancy(section, stronger, heave * np.cos(alpha), roll - alpha, about=(0.03, 0.1))
    back = turned((level[0], level[1]), alpha)
    assert sloped == pytest.approx(np.array([back[0], back[1], level[2]]), rel=1e-12)


def test_equilibrium():
    """Upright if stable; at the angle of loll of a box with GM < 0, tan²φ = −2 GM/BM; capsized where that is nearer."""
    heave, roll = equilibrium(BARGE, LOADED, WATER, roll=0.4)
    assert (heave, roll) == pytest.approx((-DRAUGHT, 0.0), abs=1e-10)
    metacentre = BREADTH**2 / (12.0 * DRAUGHT)
    tender = Loading(LOADED.mass, (0.0, 0.5 * DRAUGHT + metacentre + 0.005))
    loll = atan(np.sqrt(2.0 * 0.005 / metacentre))
    assert equilibrium(BARGE, tender, WATER)[1] == pytest.approx(loll, rel=1e-9)
    assert equilibrium(BARGE, tender, WATER, roll=-0.05)[1] == pytest.approx(-loll, rel=1e-9)
    top_heavy = Loading(LOADED.mass, (0.0, HEIGHT - 0.14))  # steady bottom up: there the centre is 0.14 m high
    assert equilibrium(BARGE, top_heavy, WATER, roll=3.1)[1] == pytest.approx(pi, abs=1e-9)


def test_mass_off_the_middle_heels_to_its_side():
    """A centre of gravity to starboard: starboard side down, a negative roll; both lie on one vertical line."""
    loading = Loading(LOADED.mass, (0.004, GRAVITY_HEIGHT))
    heave, roll = equilibrium(BARGE, loading, WATER)
    assert roll < -0.05
    centroid = BARGE.immersion(heave, roll).centroid
    assert centroid[0] == pytest.approx(turned(loading.centre, roll)[0], abs=1e-12)
    seen = mirrored(BARGE), Loading(LOADED.mass, (-0.004, GRAVITY_HEIGHT))
    assert equilibrium(*seen, WATER)[1] == pytest.approx(-roll, rel=1e-9)


def test_a_circle_rolls_about_its_centre_without_moment():
    """Buoyancy passes through the centre: the lever is that of the weight, |OG| sin φ."""
    section = circle(0.2, 720)
    loading = Loading(0.4 * section.area * WATER.density, (0.0, -0.05))
    assert righting_lever(section, loading, WATER, 0.7) == pytest.approx(0.05 * np.sin(0.7), rel=1e-3)


@pytest.mark.parametrize(
    ("outline", "says"),
    [
        ([[0, 0], [1, 0]], "three corners"),
        ([[0, 0], [1, 0], [1, np.nan]], "finite"),
        ([[0, 0], [0, 1], [1, 1], [1, 0]], "clockwise"),
        ([[0, 0], [1, 0], [1, 0], [1, 1]], "twice in a row, at number 2"),
        ([[0, 0], [1, 1], [1, 0], [0, 1]], "crosses or touches itself"),
        ([[0, 0], [2, 0], [2, 1], [1, 0], [0, 1]], "crosses or touches itself"),
        ([[0, 0], [1, 0], [0.5, 0], [0.5, 1]], "crosses or touches itself"),
    ],
)
def test_bad_outlines_are_refused(outline, says):
    with pytest.raises(Unavailable, match=says):
        Section(np.array(outline, dtype=float))


def test_a_hull_that_sinks_is_refused():
    with pytest.raises(Unavailable, match="displaces"):
        equilibrium(BARGE, Loading(103.0, (0.0, 0.1)), WATER)
