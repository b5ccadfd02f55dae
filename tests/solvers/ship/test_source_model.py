"""The source's barge and its equations: levers, frequencies, small waves against closed forms, corrected errors."""

from dataclasses import replace
from math import atan, cos, pi, sin

import numpy as np
import pytest

from solvers.ship.hydrostatics import surface_force
from solvers.ship.linear import oscillations
from solvers.ship.motion import RollDamping, rate, sail, start
from solvers.ship.potential.radiation import hydrodynamics
from solvers.ship.water import Water
from tests.oracles.source_model import (
    BREADTH,
    DRAUGHT,
    FIXED_AXIS,
    FREE,
    GRAVITY_HEIGHT,
    PIVOT,
    Afloat,
    barge,
    barge_body,
    source_free,
    source_roll,
)

WATER = Water()
CALM = 0.0
METACENTRE = BREADTH**2 / (12.0 * DRAUGHT)
HEIGHT = 0.5 * DRAUGHT + METACENTRE - GRAVITY_HEIGHT


@pytest.fixture(scope="module")
def fixed_body():
    return barge_body(axis_is_fixed=True)


@pytest.fixture(scope="module")
def free_body():
    return barge_body(axis_is_fixed=False)


def test_mass_and_inertia_of_the_barge(fixed_body, free_body):
    """GM of 50 mm and radii of gyration usual for ships; the slower free roll requires the larger inertia."""
    assert pytest.approx(0.05, abs=1e-3) == HEIGHT
    for body in (fixed_body, free_body):
        assert body.mass == pytest.approx(1000.0 * BREADTH * DRAUGHT)
        assert 0.33 < np.sqrt(body.inertia / body.mass) / BREADTH < 0.42
    assert free_body.inertia > 1.1 * fixed_body.inertia


def test_natural_frequencies(fixed_body, free_body):
    """0.78 Hz about the axis, 1.35 s free: modes of the source's equations with coefficients of that frequency."""
    fixed = source_roll(fixed_body, CALM, FIXED_AXIS, RollDamping())
    free = source_free(free_body, CALM, FREE, RollDamping())
    assert oscillations(fixed, start(fixed, -DRAUGHT))[0].imag == pytest.approx(FIXED_AXIS, rel=2e-3)
    assert np.abs(oscillations(free, start(free, -DRAUGHT)).imag - FREE).min() < 2e-3 * FREE
    # The same hull let free rolls faster: an axis is a constraint.
    loose = source_free(fixed_body, CALM, FIXED_AXIS, RollDamping())
    assert oscillations(loose, start(loose, -DRAUGHT))[0].imag > 1.005 * FIXED_AXIS


def test_levers_of_a_box(fixed_body):
    """Centre of buoyancy (BM tan φ, T/2 + ½ BM tan²φ) in the box's axes until the bilge emerges, about P."""
    afloat = Afloat(barge(), fixed_body.loading, WATER, PIVOT)
    until = atan(2.0 * DRAUGHT / BREADTH)
    rolls = np.linspace(-0.95 * until, 0.95 * until, 19)
    tan = np.tan(rolls)
    # To port, the side that sinks at a positive roll
    closed = -METACENTRE * tan * np.cos(rolls) - (0.5 * METACENTRE * tan**2 - 0.5 * DRAUGHT) * np.sin(rolls)
    assert afloat.lever(rolls) == pytest.approx(closed, abs=1e-6)
    assert afloat.lever(rolls + 2.0 * pi) == pytest.approx(afloat.lever(rolls), abs=1e-12)
    assert afloat.lever(-rolls) == pytest.approx(-afloat.lever(rolls), abs=1e-9)


@pytest.mark.slow
def test_small_roll_of_the_first_model(fixed_body):
    """|φ| = W GM A k r / |W GM − ω² (I + δI) − iωB|, I about P."""
    omega, amplitude, slope, linear = 4.4, 1e-5, 0.7, 1.0
    ship = source_roll(fixed_body, amplitude, omega, RollDamping(linear), slope, 3.0)
    count = 60
    voyage = sail(ship, start(ship, -DRAUGHT), 2.0 * pi / omega / count, 14 * 2.0 * pi / omega)
    found = 2.0 / count * abs(np.exp(1j * omega * voyage.time[-count:]) @ voyage.roll[-count:])
    righting = fixed_body.mass * 9.81 * HEIGHT
    inertia = fixed_body.inertia + fixed_body.mass * (GRAVITY_HEIGHT - DRAUGHT) ** 2 + ship.radiation.added_mass[2, 2]
    below = abs(righting - omega**2 * inertia - 1j * omega * (ship.radiation.damping[2, 2] + linear))
    assert found == pytest.approx(righting * amplitude * slope * omega**2 / 9.81 / below, rel=0.01)


def test_waves_of_the_first_model(fixed_body):
    """Eq. 7.1: W GM A k r cos ωt about the axis in any pose, its soft start over the first seconds; and the weight."""
    omega, amplitude, share = 4.4, 0.01, 0.7
    load = source_roll(fixed_body, amplitude, omega, RollDamping(), share, 2.0).load
    push = fixed_body.mass * 9.81 * HEIGHT * amplitude * omega**2 / 9.81 * share
    for roll in (0.0, 0.5):
        pose = np.array([0.0, 0.0, roll])
        for time, grown in ((3.0, 1.0), (7.1, 1.0), (1.0, np.exp(1.0 - 4.0 / 3.0))):
            moved = load.force(pose, time) - load.still.force(pose, time)
            assert moved == pytest.approx([0.0, 0.0, grown * push * cos(omega * time)], abs=1e-9)


def test_quadratic_damping_depends_on_the_rate_not_the_angle(fixed_body):
    """Corrects eq. 7.1: zero at zero rate, four times as large at twice the rate."""
    bare = source_roll(fixed_body, CALM, 4.5, RollDamping())
    damped = replace(bare, damping=RollDamping(0.0, 0.3))

    def drag(speed):
        state = start(bare, -DRAUGHT, 0.3, np.array([0.0, 0.0, speed]))
        return rate(damped, state, 0.0)[5] - rate(bare, state, 0.0)[5]

    assert drag(0.0) == 0.0
    assert drag(1.0) == pytest.approx(0.25 * drag(2.0)) and drag(1.0) < 0.0 < drag(-1.0)


def test_forces_of_the_second_model_are_those_of_long_waves(free_body):
    """Sway and heave: Froude–Krylov of the boundary elements. Roll: buoyancy's share; the rest has the ship's I."""
    omega, amplitude = 1.0, 1e-4
    ship = source_free(free_body, amplitude, omega, RollDamping())
    rest = np.array([0.0, 0.0, 0.0])
    table = hydrodynamics(barge(), WATER, -DRAUGHT, [omega], about=PIVOT)
    number = omega**2 / WATER.gravity
    tilt = surface_force(barge(), WATER, -DRAUGHT, 0.0, PIVOT)[1, 2] * number
    for time in (0.0, 1.0, 2.0):
        force = (ship.load.force(rest, time) - ship.load.still.force(rest, time)) / amplitude
        krylov = (table.froude_krylov[0] * np.exp(-1j * omega * time)).real
        size = np.abs(table.froude_krylov[0])
        assert np.abs(force[:2] - krylov[:2]) == pytest.approx(np.zeros(2), abs=0.01 * size[0])
        assert force[2] == pytest.approx((tilt - ship.load.inertia * number * omega**2) * sin(omega * time), rel=1e-3)
        assert abs(krylov[1] - size[1] * cos(omega * time)) < 0.01 * size[1]


def test_resonance_without_damping_ends_in_capsize(fixed_body):
    """Without wave damping roll grows beyond 90 deg; the run ends there without overflow."""
    ship = source_roll(fixed_body, 0.03, 5.4, RollDamping())
    ship = replace(ship, radiation=replace(ship.radiation, damping=np.zeros((3, 3))))
    voyage = sail(ship, start(ship, -DRAUGHT), 0.025, 40.0, (-1.0, 1.0))
    assert voyage.capsized == voyage.time[-1]
    assert abs(voyage.roll[-1]) >= 1.0 and np.abs(voyage.roll[:-1]).max() < 1.0
    assert np.isfinite(voyage.state).all()
