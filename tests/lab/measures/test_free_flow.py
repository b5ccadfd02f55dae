"""Drops that swing, water that turns and vortices that decay, recorded as their closed forms have them."""

import numpy as np
import pytest

from lab.measures import measure_all
from lab.measures.free_flow import ellipse
from lab.recording import open_recording
from solvers.fluid.start.flow import vortices
from tests.oracles.recorded_water import DROPS, pool, record_pool

TIME = np.arange(6.0)  # s
ARMS = np.random.default_rng(1).normal(size=(DROPS, 2)) * 0.05
ARMS -= ARMS.mean(axis=0)
NOWHERE = {"gauges": False, "run": {"gravity": "0 m/s^2", "duration": "5 s"}}
DROP = {"radius": "100 mm", "centre": ["0 mm", "250 mm"], "spacing": "20 mm"}


def of(folder, water: dict, places: np.ndarray, velocities: np.ndarray | None = None, **more) -> dict:
    """What is measured on frames of places (F, n, 2) m and velocities m/s."""
    preset = pool(**NOWHERE, water=water, **more)
    frames = {"water_position": places[:, None]}
    if velocities is not None:
        frames["water_velocity"] = velocities[:, None]
    energy = np.linspace(2.0, 1.9, len(TIME))[:, None]
    with open_recording(record_pool(folder / "run", TIME, {"water_total": energy}, frames, preset)) as recording:
        return measure_all(recording)


def test_a_drop_on_its_closed_form_has_no_error(tmp_path):
    axes = ellipse(0.5, 1.0, TIME)
    assert axes[:, 0].max() > 1.2
    drop = DROP | {"flow": {"strain": "0.5 1/s", "pull": "1 rad/s"}}
    found = of(tmp_path / "exact", drop, ARMS * axes[:, None] + [0.3, 0.2])
    assert found["axes_error"].value == pytest.approx(0.0, abs=1e-3)
    assert found["energy_lost"].value == pytest.approx(5.0)
    assert "sloshing_frequency" not in found and "highest_water" not in found  # it has no weight
    period = float(found["swing_period"].note.split()[2])
    assert found["swing_period"].value == pytest.approx(period, rel=0.05)
    small = of(tmp_path / "small", DROP | {"flow": {"strain": "0.01 1/s", "pull": "1 rad/s"}}, ARMS * axes[:, None])
    assert float(small["swing_period"].note.split()[2]) == pytest.approx(2.0**0.5 * np.pi, rel=1e-3)
    thick = of(tmp_path / "thick", drop, ARMS * (axes * np.where(TIME == 3.0, 1.1, 1.0)[:, None])[:, None])
    assert thick["axes_error"].value == pytest.approx(10.0, rel=1e-3)


def test_water_that_turns_freely_keeps_its_momentum_and_its_corners_fly_straight(tmp_path):
    corners = np.array([[-0.1, 0.1], [0.1, 0.1], [0.1, 0.3], [-0.1, 0.3], [0.0, 0.15], [0.0, 0.25]])
    region = [[f"{y} m", f"{z} m"] for y, z in corners[:4]]
    turn = np.stack([0.2 - corners[:, 1], corners[:, 0]], axis=1)  # at 1 rad/s
    places = corners + TIME[:, None, None] * turn
    water = {"region": region, "flow": {"rotation": "1 rad/s"}, "spacing": "20 mm"}
    found = of(tmp_path, water, places, np.tile(turn, (len(TIME), 1, 1)))
    assert found["angular_momentum"].value == pytest.approx(100.0, rel=1e-5)
    assert found["corner_flight"].value == pytest.approx(100.0, rel=1e-5)


def test_vortices_that_decay_by_viscosity_alone_are_whole(tmp_path):
    places = np.random.default_rng(2).uniform(0.0, 0.5, (len(TIME), DROPS, 2))
    rate = 1e-3 * (2.0 * np.pi) ** 2 * (1.0 + 4.0)
    shapes = np.array([vortices(place - [-0.5, 0.0], (1.0, 0.5)) for place in places])
    velocities = 0.3 * np.exp(-rate * TIME)[:, None, None] * shapes
    viscous = {"viscosity": "laminar", "kinematic_viscosity": "1e-3 m^2/s", "flow": {"vortices": "0.3 m/s"}}
    water = {"depth": "0.5 m", "full": True, "periodic": "yz", "spacing": "20 mm", **viscous}
    found = of(tmp_path, water, places, velocities)
    assert found["vortex_amplitude"].value == pytest.approx(100.0, rel=1e-4)
