"""Radiation and diffraction against published limits, multipoles, and the relations of energy and reciprocity."""

from functools import partial
from math import inf, pi, tanh

import numpy as np
import pytest
from scipy.special import exp1

from solvers.machine.errors import Unavailable
from solvers.ship.hydrostatics import Loading, stiffness, surface_force
from solvers.ship.potential import radiation
from solvers.ship.potential.panels import wet_panels
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.section import Section, box
from solvers.ship.water import Water
from tests.oracles.hulls import catamaran, circle, lopsided, mirrored, rounded

WATER = Water()
BREADTH, DRAUGHT = 0.34, 0.11
BARGE = box(BREADTH, 0.30)
WATERLINE = (0.0, DRAUGHT)


def barge(frequency, water=WATER, count=120, about=WATERLINE):
    return hydrodynamics(BARGE, water, -DRAUGHT, frequency, about=about, count=count)


def wave_power(frequency, water):
    """Power per square of amplitude (W/m³) of a wave, ρ g c_g/2."""
    return 0.5 * water.density * water.gravity * water.group_speed(frequency)


def test_values_of_another_solver():
    """Spandonidis' barge at 4 rad/s, coefficients of a close-fit source method, about the waterline's middle."""
    found = barge([4.0])
    added, damping, force = found.added_mass[0], found.damping[0], np.abs(found.excitation[0])
    numbers = [added[0, 0], damping[0, 0], added[1, 1], damping[1, 1], added[2, 2], added[0, 2], *force]
    assert numbers == pytest.approx([42.0, 52.0, 51.5, 201.0, 0.201, 0.47, 1117.0, 2200.0, 4.0], rel=0.02)


def test_limits_of_a_square():
    """Half of a deep square of side 2a: 4.754 ρ a² and 0.725 ρ a⁴ (Newman 1977, table 4.3), heave and roll at ω → ∞.

    There the surface is one of zero potential, and the square below it with its image a rigid square; at ω → 0 it is
    a wall, and so in sway.
    """
    a = 0.15
    found = hydrodynamics(box(2 * a, 2 * a), WATER, -a, [0.05], about=(0.0, a), count=160)
    assert found.infinite_added_mass[1, 1] == pytest.approx(0.5 * 4.754 * WATER.density * a**2, rel=2e-3)
    assert found.infinite_added_mass[2, 2] == pytest.approx(0.5 * 0.725 * WATER.density * a**4, rel=3e-3)
    assert found.added_mass[0, 0, 0] == pytest.approx(0.5 * 4.754 * WATER.density * a**2, rel=2e-3)


def test_limits_of_a_circle():
    """Half-immersed: π ρ a²/2 in heave at ω → ∞ and in sway at ω → 0, 2 ρ a²/π in sway at ω → ∞ (Ursell 1949)."""
    a = 0.2
    found = hydrodynamics(circle(a, 256), WATER, 0.0, [0.02], count=128)
    disc = 0.5 * pi * WATER.density * a**2
    assert found.infinite_added_mass[1, 1] == pytest.approx(disc, rel=2e-3)
    assert found.infinite_added_mass[0, 0] == pytest.approx(disc * 4.0 / pi**2, rel=2e-3)
    assert found.added_mass[0, 0, 0] == pytest.approx(disc, rel=2e-3)


def source(number, x, y):
    """Potential of a source at the origin of deep water's surface and its slopes along x and y (downwards)."""
    c = -y + 1j * np.abs(x)
    wave = np.exp(number * c)
    principal = wave * (exp1(number * c) + 1j * pi)
    slope = number * principal - 1.0 / c  # along c
    along = number * wave
    side = np.sign(x)
    value = principal.real + 1j * pi * wave.real
    return value, side * (-slope.imag - 1j * pi * along.imag), -slope.real - 1j * pi * along.real


def multipoles(number, mode, orders=12):
    """Added mass over ρ a² and damping over ρ a² ω of a half-immersed circle of radius 1 by Ursell's (1949) multipoles.

    Heave: a source and r^(−2m) cos 2mθ + K r^(1−2m) cos (2m−1)θ/(2m−1), θ from the downward vertical; sway: the
    source's slope along x and r^(−2m−1) sin (2m+1)θ + K r^(−2m) sin 2mθ/2m. Least squares for the normal velocity at
    r = 1.
    """
    theta = (np.arange(200) + 0.5) / 200 * pi / 2
    x, y = np.sin(theta), np.cos(theta)
    m = np.arange(1, orders + 1)[:, None]
    if mode == "heave":
        given, trig, first, second, divisor = y, np.cos, 2 * m, 2 * m - 1, 2 * m - 1
        value, slope_x, slope_y = source(number, x, y)
        slope = slope_x * x + slope_y * y
    else:
        given, trig, first, second, divisor = x, np.sin, 2 * m + 1, 2 * m, 2 * m
        h = 1e-4  # the dipole: differences of sources, of fourth order

        def dipole(r):
            at = [source(number, r * x + n * h, r * y)[0] for n in (-2, -1, 1, 2)]
            return (at[0] - 8.0 * at[1] + 8.0 * at[2] - at[3]) / (12.0 * h)

        value, slope = dipole(1.0), (dipole(1.0 + 1e-3) - dipole(1.0 - 1e-3)) / 2e-3
    values = trig(first * theta) + number / divisor * trig(second * theta)
    slopes = -first * trig(first * theta) - number / divisor * second * trig(second * theta)
    strength = np.linalg.lstsq(np.vstack([slope, slopes]).T, given.astype(complex))[0]
    potential = strength @ np.vstack([value, values])
    impulse = -2.0 * (potential * given).sum() * pi / 400.0
    return impulse.real, impulse.imag


@pytest.mark.parametrize("number", [0.2, 0.6, 1.0, 1.8, 3.0])
def test_a_circle_agrees_with_ursells_multipoles(number):
    a = 0.2
    omega = np.sqrt(number * WATER.gravity / a)
    found = hydrodynamics(circle(a, 256), WATER, 0.0, [omega], count=128)
    for mode, k in (("sway", 0), ("heave", 1)):
        added, damping = multipoles(number, mode)
        scale = WATER.density * a**2
        assert found.added_mass[0, k, k] / scale == pytest.approx(added, abs=4e-3)
        assert found.damping[0, k, k] / (scale * omega) == pytest.approx(damping, abs=4e-3)


@pytest.fixture
def alone(monkeypatch):
    """Panels as they are: both solutions have `count` of them, so that nothing is extrapolated."""
    monkeypatch.setattr(radiation, "wet_panels", lambda *at_and_count, halved=0: wet_panels(*at_and_count))
    return lambda solve, count: solve(count=2 * count)


def test_a_circle_turning_about_its_centre_radiates_nothing(alone):
    found = alone(partial(hydrodynamics, circle(0.2, 256), WATER, 0.0, [3.0, 8.0]), 128)
    for table in (found.added_mass, found.damping):
        assert np.abs(table[:, 2]).max() < 1e-8 * np.abs(table).max()


def test_sides_of_a_turning_polygon_push_as_the_square_of_their_number():
    """Halves of a straight side do not face the centre, so that extrapolated tables have what a polygon radiates."""
    found = [hydrodynamics(circle(0.2, n), WATER, 0.0, [3.0], count=n) for n in (64, 128)]
    few, many = (np.abs(one.damping[:, 2, 0]).max() / one.damping.max() for one in found)
    assert few < 1e-3
    assert many == pytest.approx(few / 4.0, rel=0.1)


WATERS = {"deep": WATER, "0.5 m": Water(depth=0.5), "0.15 m": Water(depth=0.15)}
FREQUENCIES = np.array([1.0, 4.9, 8.0])


@pytest.mark.parametrize(
    ("hull", "depth"),
    [
        ("box", "deep"),
        ("box", "0.15 m"),
        ("lopsided", "deep"),
        ("lopsided", "0.5 m"),
        ("catamaran", "deep"),
        ("catamaran", "0.5 m"),
    ],
)
def test_energy_reciprocity_and_haskind(hull, depth):
    """A and B symmetric (Green); B_ij v_i v_j the power that leaves to both sides (Newman 1976); Haskind's relation.

    The wave that a motion sends to one side goes, by Haskind, with the force on the hull in waves from that side:
    B_ij = Re Σ_± X_i± X_j±* / (4 ρ g c_g), which for a symmetric hull is ω|X|²/(ρ g²) in deep water.
    """
    water, section = WATERS[depth], {"box": BARGE, "lopsided": lopsided(), "catamaran": catamaran()}[hull]
    here = hydrodynamics(section, water, -0.1, FREQUENCIES, about=(0.01, 0.12))
    there = hydrodynamics(mirrored(section), water, -0.1, FREQUENCIES, about=(-0.01, 0.12))
    back = there.excitation * [-1.0, 1.0, -1.0]
    power = 8.0 * wave_power(FREQUENCIES, water)[:, None, None]
    sides = [np.einsum("ni,nj->nij", force, force.conj()) for force in (here.excitation, back)]
    expected = (sides[0] + sides[1]).real / power
    for table in (here.added_mass, here.damping):
        assert np.all(np.abs(table - table.transpose(0, 2, 1)) < 6e-3 * scale_of(table))
    assert np.all(np.abs(here.damping - expected) < 6e-3 * scale_of(here.damping))
    size = np.abs(here.excitation).max(axis=0)
    assert np.all(np.abs(here.excitation - here.haskind) < 6e-3 * size)


def scale_of(table):
    """Bounds (3, 3) of a positive matrix's entries, √(a_ii a_jj), over the frequencies."""
    diagonal = np.abs(np.diagonal(table, axis1=1, axis2=2)).max(axis=0)
    return np.sqrt(np.outer(diagonal, diagonal))


def test_sway_and_roll_of_a_symmetric_hull_radiate_proportional_waves():
    """One unknown wave shape: B24² = B22 B44."""
    damping = barge([3.0, 6.0, 9.0]).damping
    assert damping[:, 0, 2] ** 2 == pytest.approx(damping[:, 0, 0] * damping[:, 2, 2], rel=0.02, abs=1e-3)


def test_roll_about_another_point():
    """Roll about a point d higher is roll plus a sway of d φ: the matrices and forces transform as such."""
    low, high = barge([4.0, 7.0], about=WATERLINE), barge([4.0, 7.0], about=(0.03, 0.20))
    # Velocity of the old point under unit roll about the new one, (−(z − z'), y − y').
    arm_y, arm_z = 0.0 - 0.03, DRAUGHT - 0.20
    change = np.array([[1.0, 0.0, -arm_z], [0.0, 1.0, arm_y], [0.0, 0.0, 1.0]])
    for name in ("added_mass", "damping"):
        assert getattr(high, name) == pytest.approx(change.T @ getattr(low, name) @ change, rel=1e-9, abs=1e-9)
    assert high.excitation == pytest.approx(low.excitation @ change, rel=1e-9, abs=1e-9)
    assert high.infinite_added_mass == pytest.approx(change.T @ low.infinite_added_mass @ change, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("depth", [inf, 0.5])
def test_long_waves_are_a_slowly_sloping_surface(depth):
    """Incident waves: hydrostatics of elevation 1 and slope ik; in sway the added mass takes part."""
    water, section, heave, about, omega = Water(depth=depth), lopsided(), -0.1, (0.02, 0.12), 0.05
    found = hydrodynamics(section, water, heave, [omega], about=about)
    k = float(water.wave_number(omega))
    rise, tilt = surface_force(section, water, heave, 0.0, about)
    expected = rise + 1j * k * tilt
    assert found.froude_krylov[0].imag == pytest.approx(expected.imag, rel=0.02)
    assert found.froude_krylov[0].real[1:] == pytest.approx(expected.real[1:], rel=0.02)
    wet = section.immersion(heave, 0.0).area * water.density
    sway = -1j * k * water.gravity * (wet + found.added_mass[0, 0, 0])
    assert found.excitation[0, 0].imag == pytest.approx(sway.imag, rel=0.02)


def test_long_waves_in_shallow_water():
    """Heave pumps B ż/2 to each side into waves of speed √(gh): damping ρ B² √(gh)/(2h)."""
    water = Water(depth=0.3)
    damping = hydrodynamics(BARGE, water, -DRAUGHT, [0.1]).damping[0, 1, 1]
    assert damping == pytest.approx(0.5 * water.density * BREADTH**2 * np.sqrt(water.gravity / water.depth), rel=5e-3)


def test_deep_water_is_the_limit_of_finite_depth():
    frequency = [2.0, 4.0, 8.0]
    deep, far, near = barge(frequency), barge(frequency, Water(depth=100.0)), barge(frequency, Water(depth=0.5))
    assert far.damping == pytest.approx(deep.damping, rel=1e-4, abs=1e-6)
    assert far.added_mass == pytest.approx(deep.added_mass, rel=2e-4, abs=1e-6)
    assert far.infinite_added_mass == pytest.approx(deep.infinite_added_mass, rel=2e-4, abs=1e-6)
    assert far.excitation == pytest.approx(deep.excitation, rel=1e-3, abs=1e-3)
    assert abs(near.added_mass[0, 1, 1] / deep.added_mass[0, 1, 1] - 1.0) > 0.1


@pytest.mark.parametrize(
    ("omega", "measured"), [(4.143, (0.93075, 1.2099, 2.3563)), (7.004, (0.39725, 0.30688, 0.33135))]
)
def test_motions_of_a_measured_section(omega, measured):
    """Sundsdal et al. (2025), a section free in sway, heave and roll, waves of 24 and 40 mm off its roll resonance.

    Sway and heave per wave amplitude, roll per wave slope; rig and springs as they state them. Linear theory, 10 %.
    """
    water, draught, length, centre = Water(depth=1.0), 0.20, 0.586, (0.0, 0.108)
    section = rounded(0.40, 0.256, 0.051)
    mass = float(section.immersion(-draught, 0.0).area) * water.density
    inertia = np.diag([mass + 0.303 / length, mass, mass * (0.36 * 0.40) ** 2])
    rig = np.diag([8.7, 8.7, 0.0]) / length
    spring = stiffness(section, Loading(mass, centre), water, -draught, 0.0) + np.diag([59.4, 0.0, 0.0]) / length
    found = hydrodynamics(section, water, -draught, [omega], about=centre)
    impedance = spring - omega**2 * (inertia + found.added_mass[0]) - 1j * omega * (found.damping[0] + rig)
    motion = np.abs(np.linalg.solve(impedance, found.excitation[0])) / [1.0, 1.0, water.wave_number(omega)]
    assert motion == pytest.approx(np.array(measured), rel=0.10)


def irregular_frequency():
    """First standing wave inside the barge: ν = (π/B) coth(πT/B)."""
    return np.sqrt(WATER.gravity * pi / BREADTH / tanh(pi * DRAUGHT / BREADTH))


def roughness(table):
    """Relative distance of the middle of five evenly spaced values from the cubic through the other four."""
    a, b, middle, c, d = table
    return abs((-a + 4.0 * b + 4.0 * c - d) / 6.0 - middle) / abs(middle)


def test_irregular_frequencies_are_removed(monkeypatch):
    """Sway and heave run smoothly through the first one; without the points inside, heave does not."""
    frequency = irregular_frequency() + np.array([-0.02, -0.01, 0.0, 0.01, 0.02])
    with_points = barge(frequency)
    assert roughness(with_points.added_mass[:, 1, 1]) < 1e-6
    assert roughness(with_points.added_mass[:, 0, 0]) < 1e-6
    monkeypatch.setattr(radiation, "interior_points", lambda *_: np.empty(0, complex))
    assert roughness(barge(frequency).added_mass[:, 1, 1]) > 1e-3


def test_second_order_in_the_panels(alone):
    """Differences between successive doublings fall fourfold."""
    tables = [
        np.concatenate([t.added_mass.ravel(), t.damping.ravel()])
        for t in (alone(partial(barge, [6.0]), n) for n in (30, 60, 120))
    ]
    coarse, fine = np.linalg.norm(tables[1] - tables[0]), np.linalg.norm(tables[2] - tables[1])
    assert 3.0 < coarse / fine < 5.5


def test_extrapolation_takes_the_second_order_out():
    """Differences between successive doublings fall by more than the fourfold of panels alone."""
    tables = [
        np.concatenate([t.added_mass.ravel(), t.damping.ravel()])
        for t in (barge([6.0], count=n) for n in (40, 80, 160))
    ]
    coarse, fine = np.linalg.norm(tables[1] - tables[0]), np.linalg.norm(tables[2] - tables[1])
    assert coarse / fine > 5.0


def test_roll_of_a_hull_with_bilges_needs_no_more_than_eighty_panels():
    """Damping in roll at 1.1 √(g/T), where bilges make it: against 320 panels."""
    half = [(5.37, 0.0), (6.85, 1.48), (6.85, 7.5)]
    hull = Section(np.array([*half, *((-y, z) for y, z in half[::-1])]))
    omega = 1.1 * np.sqrt(WATER.gravity / 4.0)
    found = [hydrodynamics(hull, WATER, -4.0, [omega], about=(0.0, 3.75), count=n).damping[0, 2, 2] for n in (80, 320)]
    assert found[0] == pytest.approx(found[1], rel=5e-3)  # 2.7 % too little without extrapolation


@pytest.mark.parametrize(
    ("heave", "frequency", "water", "says"),
    [
        (0.2, [4.0], WATER, "touch the water"),
        (-0.11, [0.0], WATER, "above zero"),
        (-0.11, [500.0], WATER, "must stay below"),
        (-0.11, [4.0], Water(depth=0.11), "deeper than the draught"),
    ],
)
def test_unsolvable_requests_are_refused(heave, frequency, water, says):
    with pytest.raises(Unavailable, match=says):
        hydrodynamics(BARGE, water, heave, frequency)
