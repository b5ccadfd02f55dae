"""Shifting: a turning patch of water keeps its momentum, and the moment of it, while its particles are shifted."""

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water, particles
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.water import box

ACROSS, RATE, FORWARD = 20, 1.0, 0.4  # particles; rad/s, m/s


def patch(shifting: str) -> Scene:
    """A square patch, 1 m wide, that turns and moves on, without gravity, in a tank that it does not touch."""
    spacing = 1.0 / ACROSS
    line = (np.arange(ACROSS) + 0.5) * spacing - 0.5
    place = np.stack(np.meshgrid(line, line, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = particles(1, len(place))
    drops["position"][0], drops["volume"] = place + np.array([0.0, 2.0]), spacing**2
    drops["velocity"][0, :, 0], drops["velocity"][0, :, 1] = FORWARD - RATE * place[:, 1], RATE * place[:, 0]
    water = Water(spacing, 10.0, walls=False, shifting=shifting, speed=1.0)
    return scene_of(radius=np.zeros((1, 0)), outline=box(4.0, 4.0), fluid=Fluid(water, drops), gravity=0.0)


def kept(run: Simulation) -> tuple[np.ndarray, float]:
    """Momentum (2,) and moment of momentum about the centre of mass, per metre."""
    p = run.water.particles
    y, z, v, w, mass = (values[0] for values in p.read(*p.place, *p.velocity, p.mass))
    momentum = np.array([mass @ v, mass @ w])
    middle, speed = np.array([mass @ y, mass @ z]) / mass.sum(), momentum / mass.sum()
    return momentum, float(mass @ ((y - middle[0]) * (w - speed[1]) - (z - middle[1]) * (v - speed[0])))


@pytest.fixture(scope="module")
def run() -> Simulation:
    run = Simulation(patch("delta-plus-momentum"), threads=1, arch="cpu")
    yield run
    run.close()


@pytest.mark.slow
def test_momentum_is_kept_to_rounding_and_its_moment_to_the_error_of_sums(run):
    momentum, moment = kept(run)
    while run.time < 1.0:
        run.advance(100)
    after, turned = kept(run)
    speed = FORWARD * 1000.0
    assert np.abs(after - momentum).max() < 1e-10 * speed
    assert turned == pytest.approx(moment, rel=4e-3)
    p = run.water.particles
    shift = np.hypot(*(values[0] for values in p.read(*p.shift)))
    eigenvalue = p.read(p.eigenvalue)[0][0]
    assert shift.max() > 1e-3  # m/s: they are shifted
    assert not shift[eigenvalue < 0.75].any()  # but at the surface


@pytest.mark.slow
def test_water_that_is_not_shifted_has_nothing_of_it(run):
    """No array that shifting needs, so that no kernel can hold a line of it; and what momentum needs goes alone."""
    arrays = {}
    for shifting in ("none", "delta-plus"):
        other = Simulation(patch(shifting), threads=1, arch="cpu")
        arrays[shifting] = set(other.arrays.arrays)
        other.close()
    shifted = {"water.eigenvalue_before", "water.shift_y", "water.shift_z"}
    assert arrays["delta-plus"] - arrays["none"] == shifted and arrays["none"] < arrays["delta-plus"]
    assert set(run.arrays.arrays) - arrays["delta-plus"] == {"water.carried_y", "water.carried_z"}
