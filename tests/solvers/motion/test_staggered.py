"""Ways to couple a ship with what is in her tanks: load of the instant, extrapolated load, mass on her own side."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.motion.staggered import elongation, growth
from solvers.ship.body import Body
from solvers.ship.motion import Radiation
from solvers.simulation import Simulation
from tests.oracles import staggered_line as line
from tests.solvers.motion.test_water_aboard import ADDED, DAMPED, DEEP, LENGTH, WIDE, aboard, roll, ship

LITTLE = 0.05  # of her length: a tank whose water as_K bears


def of_mass(water: float, **changes):
    """The barge, with a hull of that many kg/m as far as her water says, and no added mass."""
    vessel = ship(release=0.05, **changes)
    own = Body(1000.0 * 0.5 * WIDE * DEEP / water, (0.0, 0.05), 20.0 * 0.5 * WIDE * DEEP / water)
    return replace(vessel, ship=replace(vessel.ship, body=own, radiation=Radiation(0.0 * ADDED, 0.2 * DAMPED)))


def little(handover: float | None, model: str = "linear"):
    """A short tank with linear water in a ship that rolls freely."""
    return replace(aboard(ship(release=0.05, handover=handover), model, step=1e-3), length=LITTLE * LENGTH)


@pytest.mark.slow
def test_an_extrapolated_load_is_of_second_order():
    """Against the load of each instant the error falls by four as the ship's step is halved.

    It is that of Bossak's steps, which lengthen her period as `elongation` says; the extrapolated load adds nothing.
    """
    time, exact = roll(little(None), 2.0)
    steps = (0.02, 0.01, 0.005)
    rolls = [roll(little(step), 2.0)[1] for step in steps]
    errors = [np.abs(found - exact).max() / np.abs(exact).max() for found in rolls]
    assert errors[0] < 0.04
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.15)
    assert errors[1] / errors[2] == pytest.approx(4.0, rel=0.15)
    free = time > 0.1
    crossed = time[1:][free[1:] & (exact[:-1] * exact[1:] < 0.0)]
    rate = np.pi / np.diff(crossed).mean()
    late = (time - 0.05)[free] * np.gradient(exact, time)[free]
    for step, found in zip(steps, rolls, strict=True):
        longer = -((found - exact)[free] @ late) / (late @ late)
        assert longer == pytest.approx(elongation(rate * step), rel=0.15)


def test_an_extrapolated_load_drives_a_light_ship_as_predicted():
    """A ship that heaves with rigid contents diverges by the factor of `growth` from each of her steps to the next."""
    vessel, handover = ship(release=0.05, heel=0.02, handover=0.005), 0.005
    vessel = replace(vessel, ship=replace(vessel.ship, free=(False, True, False)))
    scene = aboard(vessel, "frozen", step=1e-3)
    inertia = vessel.ship.body.mass + ADDED[1, 1]
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(round(0.35 / run.dt))
    speed = []
    for _ in range(18):
        run.advance(round(handover / run.dt))
        speed.append(run.observe()["pose_rate"][0, 1])
    run.close()
    factors = np.abs(np.array(speed[1:]) / np.array(speed[:-1]))
    assert factors[-3:] == pytest.approx(growth(1000.0 * 0.5 * WIDE * DEEP / inertia), rel=0.01)


@pytest.mark.slow
def test_water_far_heavier_than_the_ship_is_refused_or_eased():
    """Explicit coupling is refused in one sentence; with the layer's mass on her own side she rolls and stays whole."""
    with pytest.raises(Unavailable, match=r'times as heavy as she is.*take water\.added_mass = "layer"'):
        roll(aboard(of_mass(100.0)), 0.1)
    time, found = roll(aboard(of_mass(100.0), added_mass="layer"), 0.6)
    assert time[-1] == pytest.approx(0.6, abs=0.02)
    assert np.abs(found).max() < 0.03


@pytest.mark.slow
def test_the_mass_of_the_layer_changes_nothing_that_is_seen():
    """Where both couplings are stable she rolls the same."""
    (_, plain), (_, eased) = roll(aboard(of_mass(1.0)), 0.6), roll(aboard(of_mass(1.0), added_mass="layer"), 0.6)
    assert np.ptp(plain) > 0.02
    assert eased == pytest.approx(plain, abs=0.01 * np.ptp(plain))


def test_what_steps_of_10_and_5_ms_differ_by_is_bossaks(monkeypatch):
    """By linear equations, 3 s let go: 0.16 % of her roll with the exact load, no more with five points, 1 % with one.

    Without water it is 0.22 %, as `elongation` says: no load makes such steps agree to 0.1 % after some swings.
    """

    def apart(points: int | None) -> float:
        return np.abs(line.stepped(0.01, 3.0, points) - line.stepped(0.005, 3.0, points)[::2]).max()

    worst = {points: apart(points) for points in (None, 5, 3, 1)}
    assert worst[None] == pytest.approx(1.6e-3, rel=0.05)
    assert worst[5] == pytest.approx(worst[None], rel=0.02)
    assert worst[3] == pytest.approx(worst[None], rel=0.02)
    assert worst[1] > 5.0 * worst[None]
    exact = line.exact(0.01, 3.0)
    errors = [np.abs(line.stepped(h, 3.0, 5)[:: round(0.01 / h)] - exact).max() for h in (0.01, 0.005, 0.0025)]
    assert np.divide(errors[:-1], errors[1:]) == pytest.approx(4.0, rel=0.05)
    monkeypatch.setattr(line, "CARRIED", 0.0)
    monkeypatch.setattr(line, "SWINGING", 0.0)
    exact = line.exact(0.01, 3.0)
    late = np.abs(0.01 * np.arange(len(exact)) * np.gradient(exact, 0.01)).max()
    assert apart(None) == pytest.approx((elongation(0.01 * line.OWN) - elongation(0.005 * line.OWN)) * late, rel=0.02)


def test_what_steady_waves_of_10_and_5_ms_differ_by_is_bossaks():
    """At 0.9, 1 and 1.3 of her frequency by 0.20, 0.31 and 0.37 %, of second order; five points add less than 1e-5.

    With b = 0, the trapezoidal rule, it is a quarter less.
    """
    for omega, worst in ((0.9 * line.OWN, 2.04e-3), (line.OWN, -3.09e-3), (1.3 * line.OWN, -3.69e-3)):
        apart = {}
        for points in (None, 5):
            rolls = [line.steady(step, omega, points) for step in (0.01, 0.005, 0.0025)]
            apart[points] = rolls[0] / rolls[1] - 1.0
            assert (rolls[0] - rolls[1]) / (rolls[1] - rolls[2]) == pytest.approx(4.0, rel=0.01)
        assert apart[None] == pytest.approx(worst, rel=0.01)
        assert apart[5] == pytest.approx(apart[None], abs=1e-5)
        level = line.steady(0.01, omega, 5, bossak=0.0) / line.steady(0.005, omega, 5, bossak=0.0) - 1.0
        assert level / apart[5] == pytest.approx((1.0 / 4.0 - 1.0 / 12.0) / (1.1**2 / 4.0 - 1.0 / 12.0), rel=0.02)
