"""Sliding, rolling, creeping and resting, against closed forms."""

import numpy as np
import pytest
from scenes import box, material, simulation

G = 9.81
LAWS = ["haff-werner", "mindlin"]


def tilted_floor(angle: float, length: float = 2.0) -> np.ndarray:
    """A box turned by `angle` (rad) about the middle of its floor."""
    c, s = np.cos(angle), np.sin(angle)
    return box(length, 0.5 * length) @ np.array([[c, s], [-s, c]])


def on_floor(run, radius: float) -> float:
    """Height (m) at which the floor carries the grain's weight: k ξ^(3/2) = m g."""
    k = 4 / 3 * run.scene.interfaces[1].young_modulus * np.sqrt(radius)
    return radius - (run.grains.mass[0, 0] * G / k) ** (2 / 3)


@pytest.mark.parametrize("law", LAWS)
def test_slip_to_roll_ends_at_five_sevenths(law):
    """A sphere set sliding on a floor rolls in the end at 5/7 of its speed, whatever the friction (Euler)."""
    radius, speed = 3e-3, 0.2
    grain = material(friction=0.3)
    run = simulation([[[-0.3, radius]]], radius, box(2.0, 0.1), grain, tangential=law, stiffness_scale=1e-3)
    run.grains.place(np.array([[[-0.3, on_floor(run, radius)]]]))
    run.launch(np.array([[[speed, 0.0]]]))
    sliding = 2 / 7 * speed / (0.3 * G)
    run.advance(int(0.5 * sliding / run.dt))
    state = run.snapshot()
    assert state["velocity"][0, 0, 0] == pytest.approx(speed - 0.3 * G * run.time, rel=1e-3)
    run.advance(int(1.5 * sliding / run.dt))
    state = run.snapshot()
    assert state["velocity"][0, 0, 0] == pytest.approx(5 / 7 * speed, rel=1e-3)
    assert state["spin"][0, 0] * radius == pytest.approx(-5 / 7 * speed, rel=1e-3)
    run.close()


@pytest.mark.parametrize("law", LAWS)
def test_rolls_down_an_incline(law):
    """Without slip a sphere rolls down at v = (5/7) g sin θ t, and with too little friction it slides."""
    radius, angle = 3e-3, np.radians(20.0)
    run = simulation(
        [[[0.5, 0.4]]], radius, tilted_floor(angle), material(friction=0.3), tangential=law, stiffness_scale=1e-3
    )
    along, normal = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    run.grains.place((0.3 * along + radius * normal)[None, None])
    run.advance(int(0.2 / run.dt))
    down = -run.snapshot()["velocity"][0, 0] @ along
    assert down == pytest.approx(5 / 7 * G * np.sin(angle) * run.time, rel=2e-3)
    run.close()


def test_column_carries_its_weight_and_rests():
    """Every contact of a column carries the weight above it, k ξ^(3/2) = N m g, and nothing stirs."""
    radius, count = 1.5e-3, 12
    height = radius * (1 + 2 * np.arange(count))
    position = np.column_stack([np.zeros(count), height])[None]
    run = simulation(position, radius, box(2 * radius * 1.0001, 0.06), stiffness_scale=1e-3)
    assert run.settle(1e-12, 3.0)
    rows = run.observe()
    above = run.grains.mass[0, 0] * G * np.arange(count, 0, -1)
    z = run.snapshot()["position"][0, :, 1]
    pair, wall = run.scene.interfaces
    k_pair, k_wall = 4 / 3 * pair.young_modulus * np.sqrt(radius / 2), 4 / 3 * wall.young_modulus * np.sqrt(radius)
    force = np.array([k_wall * (radius - z[0]) ** 1.5, *(k_pair * (2 * radius - np.diff(z)) ** 1.5)])
    assert force == pytest.approx(above, rel=2e-3)
    run.advance(int(0.5 / run.dt))
    later = run.snapshot()["position"][0]
    assert np.abs(later[:, 1] - z).max() < 1e-6 * radius
    assert run.observe()["kinetic"] <= max(rows["kinetic"], 1e-20)
    run.close()


def sinking(law: str, damping: float, dt_share: float = 1.0) -> tuple[float, float]:
    """Speed (m/s) at which a grain squeezed between two walls sinks under its weight, and its mass (kg)."""
    radius = 3e-3
    grain = material(friction=0.6, shear_damping=damping)
    run = simulation([[[0.0, 0.05]]], radius, box(2 * radius * 0.998, 0.1), grain, tangential=law, stiffness_scale=1e-3)
    run.dt *= dt_share
    run.advance(int(0.1 / run.dt))
    start, height = run.time, run.snapshot()["position"][0, 0, 1]
    run.advance(int(0.1 / run.dt))
    speed = (height - run.snapshot()["position"][0, 0, 1]) / (run.time - start)
    mass = run.grains.mass[0, 0]
    run.close()
    return speed, mass


def test_haff_werner_creeps_at_its_own_rate_and_history_holds():
    """Without memory a held load creeps, here at m g/(2 γ_s), whatever the step; a spring with history holds it."""
    for damping, dt_share in ((20.0, 1.0), (20.0, 0.25), (5.0, 1.0)):
        speed, mass = sinking("haff-werner", damping, dt_share)
        assert speed == pytest.approx(mass * G / (2 * damping), rel=1e-3)
    held, mass = sinking("mindlin", 20.0)
    assert abs(held) < 1e-4 * mass * G / (2 * 20.0)
