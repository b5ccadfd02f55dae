"""Steering: for any user input, the tank's motion is smooth, bounded, and reaches the settings."""

import numpy as np
import pytest

from lab.preset.find import load
from lab.view.panel.controls import CONTROLS, MOVES, offered
from lab.view.panel.steering import FASTEST, Steering

PIECE = 0.01  # s
AT_REST = {"tilt": 0.0, "sway": 0.0, "heave": 0.0, "roll": 0.0}


def steering(**wanted: float) -> Steering:
    made = Steering(offered(load("tilting/quick").resolved))
    made.wanted |= AT_REST | wanted
    return made


def ends(pieces: list[np.ndarray], time: float) -> np.ndarray:
    """Value, rate and acceleration (3, 3) of turn, y and z at a time within a piece."""
    curves = [np.polynomial.Polynomial(piece) for piece in pieces]
    return np.array([[curve(time), curve.deriv()(time), curve.deriv(2)(time)] for curve in curves])


@pytest.mark.parametrize("seed", range(5))
def test_the_motion_is_smooth_between_pieces_and_within_bounds(seed):
    random, steered = np.random.default_rng(seed), steering()
    moves = [name for name in steered.wanted if CONTROLS[name].kind == MOVES]
    last = np.zeros((3, 3))
    for _ in range(600):
        if random.random() < 0.05:
            name = moves[random.integers(len(moves))]
            steered.wanted[name] = random.uniform(CONTROLS[name].low, CONTROLS[name].high)
        pieces = steered.follow(PIECE)
        assert ends(pieces, 0.0) == pytest.approx(last, abs=1e-9)
        last = ends(pieces, PIECE)
        assert abs(last[0, 1]) < FASTEST["turn"]


def test_a_tilt_turns_at_its_rate_and_arrives():
    steered = steering(tilt=0.5, tilt_rate=0.25)
    seen = np.array([ends(steered.follow(PIECE), PIECE)[0] for _ in range(400)])
    assert seen[100:180, 1] == pytest.approx(0.25, abs=1e-3)
    assert seen[-1] == pytest.approx([0.5, 0.0, 0.0], abs=1e-3)


def test_a_sway_settles_into_its_amplitude_and_frequency():
    steered = steering(sway=0.02, sway_frequency=2.0)
    y, _, bend = np.array([ends(steered.follow(PIECE), PIECE)[1] for _ in range(500)])[300:].T
    assert np.abs(y).max() == pytest.approx(0.02, rel=1e-2)
    assert bend == pytest.approx(-((2.0 * np.pi * 2.0) ** 2) * y, abs=1e-3)
    assert np.abs(np.fft.rfft(y))[1:].argmax() + 1 == round(2.0 * len(y) * PIECE)


def test_the_centre_of_roll_stays_where_it_is():
    steered = steering(roll=0.4, roll_frequency=0.7, centre_y=0.1, centre_z=0.3)
    centre = 0.1 + 0.3j
    for _ in range(300):
        turn, y, z = ends(steered.follow(PIECE), PIECE)[:, 0]
    for _ in range(200):
        turn, y, z = ends(steered.follow(PIECE), PIECE)[:, 0]
        assert y + 1j * z + np.exp(1j * turn) * centre == pytest.approx(centre, abs=1e-6)


def test_without_settings_the_tank_does_not_move():
    steered = steering()
    assert all(not np.any(piece) for _ in range(5) for piece in steered.follow(PIECE))
