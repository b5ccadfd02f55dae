"""The wave tank of nonlinear potential flow: against linear theory, and what an ideal liquid keeps."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lab.studies.reproduce.water.theory import wavemaker
from lab.studies.reproduce.water.theory.wave_tank import WaveTank

DEPTH = 0.31


@pytest.mark.slow
def test_low_waves_are_those_of_linear_theory():
    """A piston that swings by a five hundredth of the depth, by Havelock's integral."""

    def curve(time, order):
        if order == 2:
            return np.zeros_like(time)
        ramp, angle = np.clip(time, 0.0, 1.0), 2.0 * np.pi * time
        swing = ramp * np.sin(angle) if order == 0 else (time < 1.0) * np.sin(angle) + 2 * np.pi * ramp * np.cos(angle)
        return DEPTH / 500.0 * swing

    times, rises = WaveTank(DEPTH, 4.0, 120).rises(curve, 4.0, np.array([0.38, 1.2]))
    table = np.arange(0.0, 8.0, 0.01)
    for k, place in enumerate((0.38, 1.2)):
        linear = np.interp(times, *wavemaker.rise(table, curve(table, 0), DEPTH, place))
        assert np.abs(rises[:, k] - linear).max() < 0.025 * np.abs(linear).max()


def swung(nodes: int, steps: int):
    """Energies (J s²/kg/m²) and volumes (m²) over one period of a steep standing wave in a tank of one metre."""
    tank, number = WaveTank(1.0, 1.0, nodes), np.pi
    state = np.array([0.1 * np.cos(number * tank.along), np.zeros(nodes)])
    step = 2.0 * np.pi / np.sqrt(9.81 * number * np.tanh(number)) / steps
    found = []
    for _ in range(steps + 1):
        steep = CubicSpline(tank.along, state[0])(tank.along, 1)
        flow = tank.outflow(0.0, 0.0, *state) * np.sqrt(1.0 + steep**2)
        whole = [CubicSpline(tank.along, one).integrate(0.0, 1.0) for one in (state[1] * flow, state[0] ** 2, state[0])]
        found.append((0.5 * (whole[0] + 9.81 * whole[1]), whole[2]))
        state = tank.stepped(state, np.zeros((3, 3)), step)
    return np.array(found).T


@pytest.mark.slow
def test_a_steep_standing_wave_keeps_its_energy_and_its_volume():
    """As it comes down its energy turns from that of weight to that of motion; errors fall as the elements squared."""
    errors = []
    for nodes in (20, 40):
        energy, volume = swung(nodes, 3 * nodes)
        errors.append((np.ptp(energy) / energy[0], np.abs(volume - volume[0]).max() / 0.1))
    coarse, fine = np.array(errors)
    assert np.all(fine < (6e-4, 3e-4)) and np.all(coarse > 3.0 * fine)  # of second order


def test_a_piston_pushes_its_volume_into_the_surface():
    tank = WaveTank(DEPTH, 3.0, 100)

    def curve(time, order):
        way = np.clip(time / 0.5, 0.0, 1.0)
        return 0.03 * [way**2 * (3 - 2 * way), 12.0 * way * (1 - way), 24.0 * (1 - 2 * way)][order]

    places = np.linspace(0.0301, 2.999, 400)
    _, rises = tank.rises(curve, 1.0, places)
    assert np.trapezoid(rises[-1], places) == pytest.approx(0.03 * DEPTH, rel=0.01)


def test_water_in_a_tank_that_sways_a_little_is_that_of_linear_theory():
    """From rest, at 0.8 of the first natural frequency; modes n = 1, 3, … (Faltinsen & Timokha 2009, section 5.3).

    η = Σ β_n cos(π n x/l), β_n'' + ω_n² β_n = −P_n ẍ with P_n = −4/(π n) tanh(π n h/l), n odd, ω_n² = g (π n/l) tanh.
    """
    length, size = 1.0, 2e-4
    number = np.pi * np.arange(1, 40, 2) / length
    natural = np.sqrt(9.81 * number * np.tanh(number * DEPTH))
    omega = 0.8 * natural[0]

    def curve(time, order):
        return size * np.real((1j * omega) ** order * np.exp(1j * omega * time))

    times, rises = WaveTank(DEPTH, length, 60, swayed=True).rises(curve, 2.5, np.array([0.05]))
    push = 4.0 / (length * number) * np.tanh(number * DEPTH) * -size * omega**2
    swings = push / (natural**2 - omega**2) * (np.cos(omega * times[:, None]) - np.cos(natural * times[:, None]))
    linear = swings @ np.cos(number * 0.05)
    assert np.abs(rises[:, 0] - linear).max() < 0.02 * np.abs(linear).max()
