"""A full tank: there is no free surface, so that water closes up behind a body; what all bear is not shown."""

from collections.abc import Iterator

import numpy as np
import pytest
from scipy.spatial import cKDTree

from solvers.fluid.checks import residual
from solvers.fluid.given import Gauge
from solvers.simulation import Simulation
from solvers.tank.parts import Body
from tests.oracles.water import box, lattice, still

SPACING, SIDE, SPEED = 0.1, 0.8, 1.0  # m, m, m/s
WIDTH, HEIGHT = 4.0, 2.4
BACKGROUND = 4000.0  # Pa, four times ρ U²


def corners(middle: float) -> np.ndarray:
    """The square about a middle (y), half way up."""
    return box(SIDE, SIDE) + np.array([middle, 0.5 * (HEIGHT - SIDE)])


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    square = Body(tuple(map(tuple, corners(-1.2))), (2.4, 0.0), speed=SPEED, acceleration=2.0, closed=True)
    rows, sound = round(HEIGHT / SPACING), 40.0 * SPEED
    drops = lattice(WIDTH, HEIGHT, SPACING, sound)
    drops["deviation"] = 0.0
    low, high = corners(-1.2).min(axis=0), corners(-1.2).max(axis=0)
    beside = ((drops["position"][0] < low) | (drops["position"][0] > high)).any(axis=1)
    water = {"sound_speed": sound, "background": BACKGROUND, "shifting": "delta-plus", "speed": SPEED, "full": True}
    water["gauges"] = (Gauge((0.0, 0.0), 0.1),)
    scene = still(WIDTH, HEIGHT, HEIGHT, rows, gravity=0.0, parts=(square,), drops=drops[:, beside], **water)
    run = Simulation(scene, threads=1, arch="cpu")
    yield run
    run.close()


@pytest.mark.slow
def test_gauges_do_not_show_the_background(run):
    run.observe()
    run.advance(1)
    assert abs(run.observe()["gauge_pressure"][0, 0]) < 0.02 * BACKGROUND


@pytest.mark.slow
def test_water_closes_up_behind_a_square_and_accounts_for_its_energy(run):
    """Few wet places are farther from a particle than in a slightly strained lattice (0.71 spacings)."""
    start = run.observe()
    while run.time < 2.0:
        run.advance(100)
    rows, shot = run.observe(), run.snapshot()
    moved = corners(-1.2 + run.placed()["part"][0, 0, 0])
    near = np.stack(np.meshgrid(*(np.arange(-2.0, 2.4, 0.02),) * 2), axis=-1).reshape(-1, 2)
    edge = 0.5 * SPACING
    inside = (np.abs(near[:, 0]) < 0.5 * WIDTH - edge) & (near[:, 1] > edge) & (near[:, 1] < HEIGHT - edge)
    beside = ((near < moved.min(axis=0) - edge) | (near > moved.max(axis=0) + edge)).any(axis=1)
    away = cKDTree(shot["water_position"][0]).query(near[inside & beside])[0]
    assert (away > 0.75 * SPACING).mean() < 0.01
    assert abs(residual(rows, residual(start, 0.0))[0]) < 0.02 * rows["water_work"][0]


@pytest.mark.slow
def test_walls_are_no_surface_to_shifting(run):
    """Particles at the floor are shifted towards it and off it, as well as along it."""
    p = run.water.particles
    height, along, up = (values[0] for values in p.read(p.place[1], *p.shift))
    low = height < SPACING
    assert np.hypot(along[low], up[low]).max() > 1e-3 * SPEED
    assert np.median(np.abs(up[low])) > 0.1 * np.median(np.abs(along[low]))
