"""The wave tank of nonlinear potential flow: against linear theory, and what an ideal liquid keeps."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from lab.studies.reproduce.water import wavemaker
from lab.studies.reproduce.water.wave_tank import WaveTank

DEPTH = 0.31


def test_low_waves_are_those_of_linear_theory():
    """A piston that swings by a five hundredth of the depth, by Havelock's integral."""

    def curve(time, order):
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
        state = tank.stepped(state, np.zeros(3), np.zeros(3), step)
    return np.array(found).T


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
        return 0.03 * (way**2 * (3 - 2 * way) if order == 0 else 12.0 * way * (1 - way))

    places = np.linspace(0.0301, 2.999, 400)
    _, rises = tank.rises(curve, 1.0, places)
    assert np.trapezoid(rises[-1], places) == pytest.approx(0.03 * DEPTH, rel=0.01)
