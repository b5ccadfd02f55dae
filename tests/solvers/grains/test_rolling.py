"""Resistance to rolling against closed forms: on the flat, on slopes too steep to hold and on one that holds."""

import numpy as np
import pytest

from solvers.grains.laws import ROLLING
from solvers.grains.laws.constant_torque import TURNING
from tests.oracles.scenes import material, simulation

G, RADIUS = 9.81, 3e-3
FRICTION = 0.2  # of rolling
STEEP, GENTLE = np.radians([20.0, 8.0])
# A floor with a steep slope on its right and a gentle one on its left, under a box.
LEFT, RIGHT = np.array([[-0.5, 0.0], [0.5, 0.0]])
OUTLINE = np.array([LEFT, RIGHT, [1.5, np.tan(STEEP)], [1.5, 1.5], [-1.5, 1.5], [-1.5, np.tan(GENTLE)]])
UP_STEEP = np.array([np.cos(STEEP), np.sin(STEEP)])
UP_GENTLE = np.array([-np.cos(GENTLE), np.sin(GENTLE)])
LAWS = [
    pytest.param(law, marks=pytest.mark.slow if law == "constant-torque" else ()) for law in ROLLING if law != "none"
]


@pytest.fixture(scope="module", params=LAWS)
def rolling(request):
    """Three grains that do not meet: on the floor, on the steep slope and on the gentle one; with and without friction.

    World 0 has friction, and the first grain rolls at 0.4 m/s; world 1 has none, and it spins on the spot at 400 rad/s;
    world 2 has friction but none of rolling.
    """
    places = np.array([[0.0, RADIUS], RIGHT + 0.5 * UP_STEEP, LEFT + 0.5 * UP_GENTLE])
    places[1] += RADIUS * np.array([-UP_STEEP[1], UP_STEEP[0]])
    places[2] += RADIUS * np.array([UP_GENTLE[1], -UP_GENTLE[0]])
    velocity, spin = np.zeros((3, 3, 2)), np.zeros((3, 3))
    velocity[0, 0, 0], spin[0, 0], spin[1, 0] = 0.4, -0.4 / RADIUS, 400.0
    given = ((0.6, FRICTION), (0.0, FRICTION), (0.6, 0.0))
    grain = [material(friction=mu, rolling_friction=rolls) for mu, rolls in given]
    run = simulation(
        np.tile(places, (3, 1, 1)),
        RADIUS,
        OUTLINE,
        grain,
        velocity=velocity,
        spin=spin,
        tangential="mindlin",
        rolling=request.param,
        stiffness_scale=1e-3,
    )
    run.advance(int(0.14 / run.dt))
    before, start = run.snapshot(), run.time
    run.advance(int(0.05 / run.dt))
    yield run, before, run.snapshot(), run.time - start
    run.close()


def spinning_grain_is_braked(_, before, after, time) -> None:
    """ω = ω₀ − 5 μ_r g t/(2 R) where nothing but the rolling torque acts."""
    assert before["spin"][1, 0] - after["spin"][1, 0] == pytest.approx(2.5 * FRICTION * G * time / RADIUS, rel=2e-3)
    assert before["velocity"][1, 0, 0] == pytest.approx(0.0, abs=1e-12)


def rolling_grain_slows_down(_, before, after, time) -> None:
    """(7/5) m R² ω̇ = −μ_r R m g: v = v₀ − (5/7) μ_r g t, still rolling."""
    slower = before["velocity"][0, 0, 0] - after["velocity"][0, 0, 0]
    assert slower == pytest.approx(5 / 7 * FRICTION * G * time, rel=2e-3)
    assert after["spin"][0, 0] * RADIUS == pytest.approx(-after["velocity"][0, 0, 0], rel=1e-3)


def rolls_down_a_steep_slope(_, before, after, time) -> None:
    """v = (5/7) g (sin θ − μ_r cos θ) t."""
    pull = 5 / 7 * G * (np.sin(STEEP) - FRICTION * np.cos(STEEP))
    faster = (before["velocity"] - after["velocity"])[0, 1] @ UP_STEEP
    assert faster == pytest.approx(pull * time, rel=2e-3)


def gentle_slope_holds(run, before, after, time) -> None:
    """tan θ < μ_r: with history it stands still; the constant torque creeps at R × 1e-3 rad/s × tan θ/μ_r."""
    down = (before["position"] - after["position"])[0, 2] @ UP_GENTLE / time
    if run.scene.grains.rolling == "elastic-plastic":
        assert abs(down) < 1e-9
    else:
        assert down == pytest.approx(RADIUS * TURNING * np.tan(GENTLE) / FRICTION, rel=1e-2)


def without_friction_rolls_freely(run, before, after, time) -> None:
    """The torque's cap and spring vanish with μ_r: v = (5/7) g sin θ t."""
    faster = (before["velocity"] - after["velocity"])[2, 1] @ UP_STEEP
    assert faster == pytest.approx(5 / 7 * G * np.sin(STEEP) * time, rel=2e-3)
    assert np.isfinite(run.observe()["elastic"]).all()


def test_closed_forms(rolling):
    spinning_grain_is_braked(*rolling)
    rolling_grain_slows_down(*rolling)
    rolls_down_a_steep_slope(*rolling)
    without_friction_rolls_freely(*rolling)
    gentle_slope_holds(*rolling)
