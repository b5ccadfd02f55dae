"""Water in `cargolab verify`: its references against what is known of them otherwise, and its cheapest fast case."""

import numpy as np
import pytest

from lab.studies.verify.water import (
    CASES,
    balance,
    bore,
    drops,
    orifice,
    patch,
    rest,
    sloshing,
    vortices,
    waves,
)
from lab.studies.verify.water.laplace import first_mode
from lab.studies.verify.water.phases import bubbles, interface
from lab.studies.verify.water.scenes import Swing, box, chamfered, order, order_line, swing
from lab.studies.verify.water.vorticity import middle_pressure
from solvers.fluid.start.rest import STARTS

WIDTH, DEPTH = 0.30, 0.105  # m
CUTS = (
    *((0.0525, 0.03, 1.138), (0.0525, 0.045, 1.126), (0.0525, 0.05, 1.117)),
    *((0.105, 0.04, 1.440), (0.105, 0.05, 1.435), (0.105, 0.06, 1.427), (0.105, 0.075, 1.403)),
)


def test_finite_elements_have_the_closed_form_of_a_box():
    """ω² = (πg/l) tanh(πd/l) to 0.1 %, and with second order."""
    k = np.pi / WIDTH
    exact = np.sqrt(9.81 * k * np.tanh(k * DEPTH))
    errors = [first_mode(box(WIDTH, 0.2), DEPTH, n, n).rate / exact - 1.0 for n in (10, 20, 40)]
    assert 0.0 < errors[-1] < 1e-3
    assert order([4.0, 2.0, 1.0], errors) == pytest.approx(2.0, abs=0.1)


def test_finite_elements_find_the_flow_of_a_box():
    """Fastest at the surface in the middle, along it; up at one side and down at the other."""
    mode = first_mode(box(WIDTH, 0.2), DEPTH)
    k, place = np.pi / WIDTH, np.array([[0.0, 0.1], [0.1, 0.05], [-0.1, 0.05]])
    y, z = place.T
    exact = np.stack([np.cos(k * y) * np.cosh(k * z), np.sin(k * y) * np.sinh(k * z)], axis=1) / np.cosh(k * DEPTH)
    found = mode.flow(place)
    np.testing.assert_allclose(found * np.sign(found[0, 0]), exact, atol=0.01)


def test_the_walls_over_the_earth_move_as_fast_as_their_places_say():
    """Velocity and acceleration are the derivatives of place and angle; the tank starts at rest."""
    step, time = 1e-5, 0.07
    before, now, after = (balance.over_earth(time + k * step) for k in (-1, 0, 1))
    for place, speed in (("origin", "velocity"), ("angle", "rate"), ("velocity", "acceleration"), ("rate", "gain")):
        slope = (getattr(after, place) - getattr(before, place)) / (2.0 * step)
        np.testing.assert_allclose(getattr(now, speed), slope, rtol=1e-6)
    assert np.abs(balance.over_earth(0.0).velocity).max() < 1e-12


@pytest.mark.parametrize(("depth", "cut", "rate"), CUTS)
def test_slanted_corners_slow_the_water(depth, cut, rate):
    """Hz, by another finite-element program."""
    assert first_mode(chamfered(WIDTH, 0.21, cut), depth).rate / (2.0 * np.pi) == pytest.approx(rate, abs=1e-3)


def test_a_damped_oscillation_is_found_in_its_values():
    time = np.linspace(0.0, 9.0, 90)
    value = 0.3 * np.exp(-0.12 * time) * np.cos(5.1 * time + 0.4) + 0.02
    found = swing(time, value, 5.5)
    assert (found.rate, found.decay) == pytest.approx((5.1, 0.12), rel=1e-6)
    np.testing.assert_allclose(Swing(5.1, 0.12).course(time, value), value, atol=1e-12)


def test_no_order_is_told_of_one_error_or_of_noise():
    assert order_line("it", [1.0], [0.1], 0.01) == []
    assert order_line("it", [2.0, 1.0], [0.1, 0.005], 0.01) == []
    (line,) = order_line("it", [2.0, 1.0], [0.2, 0.1], 0.01)
    assert line.value == pytest.approx(1.0)
    (line,) = order_line("it", [2.0, 1.0], [0.1, 0.1], 0.01)
    assert not line.passed  # what does not converge fails
    (line,) = order_line("the decay between two fluids", [2.0, 1.0], [0.08, 0.146], 0.01)
    assert not line.passed and line.value < 0.0  # and what grows
    assert order_line("it", [2.0, 1.0], [0.8, 0.1], 0.01)[0].passed  # a third order is no error
    unsure = order_line("it", [2.0, 1.0], [0.09, 0.05], 0.01)[0]  # 0.85 ± 0.45
    assert unsure.passed and unsure.tolerance == pytest.approx(0.31 / np.log(2.0), rel=0.01)


def test_the_axes_of_a_drop_are_those_of_the_literature():
    """At 7.6 ms of a strain of 100/s; and period and extremes of one that is pulled to a point."""
    np.testing.assert_allclose(drops.exact(100.0, 0.0, np.array([7.6e-3]))[0], drops.AXES, rtol=1e-4)
    round_again = drops.exact(1.0, 1.0, np.array([drops.PERIOD]))[0]
    np.testing.assert_allclose(round_again, 1.0, atol=2e-3)
    swung = drops.exact(1.0, 1.0, np.linspace(0.0, drops.PERIOD, 2001)[1:])[:, 0]
    np.testing.assert_allclose([swung.min(), swung.max()], drops.EXTREMES, rtol=1e-4)


@pytest.mark.parametrize(("share", "narrowest"), [(0.1, 0.612), (0.2, 0.616), (0.3, 0.622), (0.5, 0.644)])
def test_the_contraction_of_a_slot_is_that_of_the_literature(share, narrowest):
    """Von Mises (1917), as in handbooks of hydraulics; π/(π + 2) in a wide floor (Kirchhoff 1869)."""
    assert orifice.contraction(share) == pytest.approx(narrowest, abs=6e-4)
    assert orifice.contraction(1e-6) == pytest.approx(np.pi / (np.pi + 2.0), rel=1e-5)


def test_a_tank_empties_as_its_balance_says():
    """B dh/dt = −δ V with V² = 2 g h + (dh/dt)², in small steps; and C_d and the time are found again in its depths."""
    narrowest = orifice.contraction(orifice.SLOT / orifice.WIDTH) * orifice.SLOT
    depth, step, course = orifice.FULL, 1e-4, [orifice.FULL]
    while depth > orifice.LOW:
        jet = np.sqrt(2.0 * 9.81 * depth / (1.0 - (narrowest / orifice.WIDTH) ** 2))
        depth -= step * jet * narrowest / orifice.WIDTH
        course.append(depth)
    emptied = orifice.Outflow(step * np.arange(len(course)), np.array(course), np.ones(len(course)))
    assert emptied.coefficient == pytest.approx(orifice.discharge(), rel=1e-3)
    assert emptied.lasting == pytest.approx(orifice.emptying(orifice.discharge(), orifice.HIGH, orifice.LOW), rel=1e-3)


@pytest.mark.parametrize("ratio", [1.05, 1.5, 2.5, 6.0])
def test_a_bore_keeps_mass_and_momentum_and_loses_energy(ratio):
    """Bélanger's (1828) ratio; and a second of stream and pressure against what the bore has left behind by then."""
    jump = bore.Jump(0.1, 0.1 * ratio)
    c, stream, low, high = jump.speed, jump.stream, jump.before, jump.after
    froude = jump.inflow / np.sqrt(9.81 * low)
    assert 0.5 * (np.sqrt(1.0 + 8.0 * froude**2) - 1.0) == pytest.approx(ratio, rel=1e-12)
    assert c * (high - low) == pytest.approx(stream * low, rel=1e-12)
    pressed = 0.5 * 1000.0 * 9.81 * np.array([low, high]) ** 2
    assert jump.push == pytest.approx(pressed[1])
    assert pressed[1] - pressed[0] == pytest.approx(1000.0 * low * (c + stream) * stream, rel=1e-12)
    before = (c + stream) * (0.5 * 1000.0 * low * stream**2 + pressed[0])  # of the water that the bore has met
    assert before + pressed[0] * stream - c * pressed[1] == pytest.approx(jump.loss, rel=1e-9)
    assert jump.loss > 0.0


def test_what_is_read_off_a_bore_is_there():
    """Of columns of water as deep as the bore has them, which move alike behind it."""
    length, spacing, place = 4.0, 0.01, 2.4
    y = (np.arange(round(length / spacing)) + 0.5) * spacing
    volume = np.where(y < place, bore.JUMP.after, bore.JUMP.before) * spacing
    assert bore.front(y, volume, length) == pytest.approx(place, abs=0.25 * bore.DEPTH)
    assert bore.front(y, np.full_like(y, bore.DEPTH * spacing), length) == 0.0
    area, kinetic, long = bore.behind(place, y, volume, 3.0 * volume)
    assert area / long == pytest.approx(bore.JUMP.after, rel=0.01) and kinetic == pytest.approx(3.0 * area)
    assert bore.behind(8.0 * bore.JUMP.after, y, volume, volume) == (0.0, 0.0, 0.0)  # too near the wall
    time = np.linspace(0.0, bore.DURATION, 50)
    late = np.maximum(time - bore.FROM * bore.JUMP.after / bore.JUMP.speed, 0.0)
    run = bore.Bore(time, 2.0 * late, *[time] * 5, *[np.ones(50)] * 3)
    assert run.rate("place") == pytest.approx(2.0, rel=1e-9)
    assert run.pushed == pytest.approx(time[late > 0.0].mean(), rel=0.01)


def test_a_viscous_wave_decays_as_lamb_says(monkeypatch):
    """s → −2νk² (Lamb 1932, §348) for small ν; the layer under the surface takes √(νk²/ω)/√2 of it away."""
    monkeypatch.setattr(waves, "VISCOSITY", 1e-5)
    thin = 1e-5 * waves.K**2 / waves.RATE
    share = -waves.viscous().real / (2.0 * 1e-5 * waves.K**2)
    assert share == pytest.approx(1.0 - np.sqrt(thin / 2.0), abs=3e-4)
    assert waves.viscous().imag == pytest.approx(waves.RATE, rel=1e-4)


def test_the_channel_starts_at_rest_and_ends_as_a_parabola():
    across = np.linspace(-vortices.HALF, vortices.HALF, 11)
    parabola = vortices.FASTEST * (1.0 - (across / vortices.HALF) ** 2)
    np.testing.assert_allclose(vortices.channel(across, 0.0), 0.0, atol=1e-4)
    np.testing.assert_allclose(vortices.channel(across, 100.0), parabola, atol=1e-12)
    # At first the middle falls freely
    assert vortices.channel(np.zeros(1), 0.05)[0] == pytest.approx(vortices.PULL * 0.05, rel=1e-3)


def test_the_pressure_of_a_turning_patch_solves_its_equation():
    """∇²p = 2 ρ ω², and none at the edges; lowest in the middle."""
    step, middle = 0.02, np.array([0.07, -0.11])
    around = middle + step * np.array([[0, 0], [1, 0], [-1, 0], [0, 1], [0, -1]])
    p = patch.pressure(around)
    assert (p[1:].sum() - 4.0 * p[0]) / step**2 == pytest.approx(2.0 * 1000.0 * patch.RATE**2, rel=0.02)
    middle = patch.pressure(np.zeros((1, 2)))[0]
    assert np.abs(patch.pressure(np.array([[0.5, 0.1], [-0.2, -0.5]]))).max() < -1e-4 * middle
    assert middle < -100.0


def test_a_hole_in_a_patch_is_seen():
    place = np.stack(np.meshgrid(*[np.linspace(-0.5, 0.5, 21)] * 2), axis=-1).reshape(-1, 2)
    assert patch.widest_gap(place) == pytest.approx(0.05 / np.sqrt(2.0), rel=1e-3)
    assert patch.widest_gap(place[np.hypot(*(place - 0.1).T) > 0.12]) > 0.09


@pytest.mark.slow  # its physics is in `tests/solvers/fluid/test_motion.py`
def test_a_strained_drop_passes():
    found = drops.freely(True)
    assert found.lines and all(line.passed for line in found.lines)


@pytest.mark.slow  # a drop falls in `tests/solvers/fluid/test_step.py`, and one keeps its momentum in `test_motion.py`
def test_a_drop_that_falls_gains_momentum_as_its_weight_says():
    """The cheapest case that runs water; the others are run by `test_fast_cases_pass_and_leave_a_page`."""
    assert balance.free_drop(balance.G).passed


def test_every_case_of_water_says_so():
    assert all(case.name.startswith("water-") and case.section.startswith("Water") for case in CASES)


def test_the_pressure_in_a_turning_patch_begins_as_its_series_says(monkeypatch):
    """And later does not hang on how many terms and markers find it."""
    times = (0.0, 0.5, 1.0)
    found = middle_pressure(times)
    assert found[0] == pytest.approx(patch.pressure(np.zeros((1, 2)))[0] / 1000.0, rel=1e-3)
    monkeypatch.setattr("lab.studies.verify.water.vorticity.TERMS", 4)
    monkeypatch.setattr("lab.studies.verify.water.vorticity.MARKERS", 40)
    assert middle_pressure(times) == pytest.approx(found, abs=1e-4)


@pytest.mark.slow
def test_water_between_slanted_corners_rests_for_a_minute():
    found = rest.rested(rest.VESSELS["chamfers"], 20, rest.LONG)
    assert found.pressure < 0.01 and abs(found.gauge) < 0.01
    assert found.stirred < rest.STILL
    assert found.down == pytest.approx(1.0, abs=1e-3)


@pytest.mark.slow
def test_water_that_starts_packed_sloshes_as_water_and_a_lattice_faster(monkeypatch):
    """The shear stiffness of a lattice under pressure quickens it by 0.6 to 0.9 %, see `lattice`."""
    pool = sloshing.BOXES[sloshing.FAST]
    packed = sloshing.slosh(pool, 12) / pool.rate - 1.0
    monkeypatch.setitem(STARTS, "packed", STARTS["lattice"])
    assert abs(packed) < 0.005
    assert 0.004 < sloshing.slosh(pool, 12) / pool.rate - 1.0 - packed < 0.012


def test_references_of_water_and_air():
    """Without air the wave's rate is that of water alone; under its own density there is none. A circle is round."""
    alone = np.sqrt(9.81 * np.pi * np.tanh(np.pi))
    assert interface.Between(1e-9).rate == pytest.approx(alone, rel=1e-9)
    assert interface.Between(1.2).rate == pytest.approx(alone * np.sqrt(998.8 / 1001.2), rel=1e-9)
    assert waves.between(1000.0, 1e-9, waves.VISCOSITY) == pytest.approx(waves.viscous(), rel=1e-6)
    thin, rate = 1e-3 * waves.VISCOSITY, interface.Between(500.0).rate
    layers = 2.0 * 0.5 / 1.5**2 * np.pi * np.sqrt(0.5 * rate * thin)
    assert waves.between(1000.0, 500.0, thin) == pytest.approx(-layers + 1j * (rate - layers), rel=1e-4)
    assert interface.Between(1.2).unsure(0.025) == pytest.approx(np.exp(0.025 * np.pi) - 1.0, rel=0.01)
    assert interface.Between(500.0).unsure(0.025) > 2.0 * interface.Between(1.2).unsure(0.025)  # layers are thin
    place = np.array([[0.1, 0.3], [-0.2, 1.5]])
    below, above = (interface.mode(np.array([[0.2, 1.0 + off]]))[0, 1] for off in (-1e-9, 1e-9))
    assert below == pytest.approx(above)  # neither parts from the other
    assert (interface.mode(place)[:, 0] * [1.0, -1.0] > 0.0).all()
    corners = bubbles.circle(0.25, (0.0, 0.5))
    y, z = corners.T
    assert 0.5 * abs(y @ np.roll(z, -1) - z @ np.roll(y, -1)) == pytest.approx(np.pi * 0.25**2, rel=1e-12)
    grid = np.stack(np.meshgrid(*[np.arange(-0.3, 0.3, 0.01)] * 2), axis=-1).reshape(-1, 2)
    assert bubbles.roundness(grid[np.hypot(*grid.T) < 0.2], 0.01) == pytest.approx(1.0, abs=0.02)
    long = grid[np.hypot(grid[:, 0] / 0.28, grid[:, 1] / 0.14) < 1.0]
    assert bubbles.roundness(long, 0.01) == pytest.approx(0.917, abs=0.03)  # an ellipse of 2 to 1, by Ramanujan


def test_limit_and_order_of_three_spacings():
    """Of a value that goes as a limit and a power of the spacing they are that limit and power."""
    for power in (0.5, 1.0, 2.0):
        values = [0.62 + 0.3 * (1.0 / count) ** power for count in orifice.ACROSS]
        assert orifice.converged(values) == pytest.approx((0.62, power))
