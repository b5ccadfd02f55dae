"""Ways to couple a ship with what is in her tanks: load of the instant, extrapolated load, mass on her own side."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.motion.staggered_error import BETA, BOSSAK, EVEN, GAMMA, LARGEST, elongation, growth
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
def test_steps_of_10_and_5_ms_roll_the_same():
    """Free rolling agrees within 0.02 % of its amplitude, and with the load of each instant within 0.03 %."""
    _, exact = roll(little(None), 2.0)
    rolls = [roll(little(step), 2.0)[1] for step in (0.01, 0.005)]
    assert np.ptp(exact) > 0.05
    assert np.abs(rolls[0] - rolls[1]).max() < 2e-4 * np.abs(exact).max()
    for found in rolls:
        assert np.abs(found - exact).max() < 3e-4 * np.abs(exact).max()


@pytest.mark.slow
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


def test_light_water_lets_10_and_5_ms_agree():
    """By linear equations, 3 s let go: to 0.01 %, with five points as with the exact load; of second order.

    With an even average of accelerations it is 0.16 %, with the last load alone 1 %.
    """

    def apart(points: int | None, beta: float = BETA) -> float:
        return np.abs(line.stepped(0.01, 3.0, points, beta) - line.stepped(0.005, 3.0, points, beta)[::2]).max()

    assert apart(5) < 1e-4
    assert apart(5) == pytest.approx(apart(None), rel=0.02)
    assert apart(5, EVEN) == pytest.approx(1.57e-3, rel=0.02)
    assert apart(1) > 5e-3
    exact = line.exact(0.01, 3.0)
    for beta, last in ((BETA, 3e-5), (EVEN, 6e-4)):
        rolls = (line.stepped(0.01 / n, 3.0, 5, beta)[::n] for n in (1, 2, 4))
        errors = [np.abs(found - exact).max() for found in rolls]
        assert np.divide(errors[:-1], errors[1:]) == pytest.approx(4.0, rel=0.11)
        assert errors[1] < last


@pytest.mark.slow
def test_an_even_average_lengthens_periods_as_predicted(monkeypatch):
    """Without water, steps of 10 and 5 ms part as `elongation` says; those of β = 1/12 by fifteen times less."""
    monkeypatch.setattr(line, "CARRIED", 0.0)
    monkeypatch.setattr(line, "SWINGING", 0.0)
    exact = line.exact(0.01, 3.0)
    late = np.abs(0.01 * np.arange(len(exact)) * np.gradient(exact, 0.01)).max()

    def apart(beta: float) -> float:
        return np.abs(line.stepped(0.01, 3.0, None, beta) - line.stepped(0.005, 3.0, None, beta)[::2]).max()

    longer = elongation(0.01 * line.OWN, EVEN) - elongation(0.005 * line.OWN, EVEN)
    assert apart(EVEN) == pytest.approx(longer * late, rel=0.02)
    assert elongation(0.01 * line.OWN) == 0.0
    assert apart(BETA) < 0.06 * apart(EVEN)


def test_steady_waves_of_10_and_5_ms_agree():
    """From 0.7 to 1.3 of her frequency within 0.01 %, through five points; evenly averaged up to 0.37 %."""
    even = {0.7: 2.9e-4, 0.8: 7.3e-4, 0.9: 2.04e-3, 1.0: -3.09e-3, 1.1: -1.83e-3, 1.3: -3.69e-3}
    for ratio, worst in even.items():
        coarse, fine = (line.steady(step, ratio * line.OWN, 5) for step in (0.01, 0.005))
        assert coarse == pytest.approx(fine, rel=1e-4)
        coarse, fine = (line.steady(step, ratio * line.OWN, 5, EVEN) for step in (0.01, 0.005))
        assert coarse / fine - 1.0 == pytest.approx(worst, rel=0.02)


@pytest.mark.parametrize(("angle", "stable"), [(LARGEST, True), (1.01 * LARGEST, False)])
def test_steps_are_stable_up_to_the_largest(angle, stable):
    """Largest factor from step to step of an oscillation without damping: x, H v and H² a."""
    after = np.array([-(angle**2), -(angle**2), -(angle**2) * (0.5 - BETA) - BOSSAK])
    after /= 1.0 - BOSSAK + angle**2 * BETA
    whole = [np.array([1.0, 1.0, 0.5 - BETA]) + BETA * after, np.array([0.0, 1.0, 1.0 - GAMMA]) + GAMMA * after, after]
    assert (np.abs(np.linalg.eigvals(whole)).max() <= 1.0) == stable
