"""The peer code does with a bed of ours what its law and Newton's say."""

from dataclasses import replace
from math import pi, sin, sqrt

import numpy as np
import pytest

from benchmarks.peers import liggghts
from benchmarks.peers.liggghts import run_liggghts
from benchmarks.peers.peer import Task
from lab.base.errors import LabError
from solvers.grains.materials import Material

RADIUS = 1.5e-3
WIDTH, HEIGHT = 61.5e-3, 0.2
GRAVITY = 9.81
ACETATE = Material(density=1319.0, young=3.2e6, poisson=0.28, friction=0.25, restitution=0.6)

installed = pytest.mark.skipif(liggghts.available() is None, reason="the peer code LIGGGHTS is not installed")


def run(position, *, material=ACETATE, dt=1e-5, steps=1000, **options):
    position = np.atleast_2d(np.asarray(position, dtype=float))
    radius = np.full(len(position), RADIUS)
    return run_liggghts(Task(position, radius, WIDTH, HEIGHT, material, dt, steps, **options))


def stacked(rows: int) -> np.ndarray:
    """Rows of twenty grains, each grain but the lowest row's resting on two others (m)."""
    row, column = np.divmod(np.arange(20 * rows), 20)
    y = -WIDTH / 2 + RADIUS * (1 + 2 * column + row % 2)
    return np.column_stack((y, RADIUS * (1 + sqrt(3) * row)))


@installed
def test_a_resting_grain_sinks_in_as_a_sphere_by_hertz():
    mass = 4 / 3 * pi * RADIUS**3 * ACETATE.density
    modulus = ACETATE.young / (2 * (1 - ACETATE.poisson**2))
    overlap = (3 * mass * GRAVITY / (4 * modulus * sqrt(RADIUS))) ** (2 / 3)
    rest = run([0.0, RADIUS], steps=30_000)
    assert RADIUS - rest.position[0, 1] == pytest.approx(overlap, rel=1e-3)
    assert abs(rest.position[0, 0]) < 1e-12


@installed
@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_a_dropped_grain_bounces_with_the_given_restitution(restitution):
    drop, material = 0.02, replace(ACETATE, restitution=restitution)
    bounce = run([0.0, RADIUS + drop], material=material, dt=2e-6, steps=80_000, sample_every=100)
    height = bounce.centre_of_mass[:, 1] - RADIUS
    landed = np.argmax(height < 0)
    assert height[landed:].max() == pytest.approx(restitution**2 * drop, rel=0.02)


@installed
def test_two_grains_part_with_equal_and_opposite_momentum():
    start = [[-0.95 * RADIUS, 0.1], [0.95 * RADIUS, 0.1]]
    apart = run(start, gravity=0.0, tangential="no_history", sample_every=100)
    assert apart.position[1, 0] > 1.1 * RADIUS
    np.testing.assert_allclose(apart.centre_of_mass, [[0.0, 0.1]] * 11, atol=1e-12)


@installed
def test_a_flying_grain_falls_along_the_rotating_gravity():
    rate, middle = 5.0, [0.0, HEIGHT / 2]
    flight = run(middle, steps=10_000, tilt_rate=rate)
    swept = rate * flight.time
    expected = -GRAVITY * (swept - np.array([sin(angle) for angle in swept])) / rate**2
    np.testing.assert_allclose(flight.time, np.linspace(0, 0.1, 11), atol=1e-12)
    np.testing.assert_allclose(flight.centre_of_mass[:, 0], expected, atol=1e-6)
    assert flight.centre_of_mass[-1, 0] < -RADIUS


@installed
def test_a_stacked_bed_of_500_stays_and_keeps_its_order(tmp_path):
    start = stacked(25)
    stay = run(start, steps=4000, workdir=tmp_path / "kept")
    assert np.linalg.norm(stay.position - start, axis=1).max() < 0.5 * RADIUS
    assert stay.grain_steps_per_s == pytest.approx(500 * 4000 / stay.loop_s)
    np.testing.assert_allclose(stay.centre_of_mass[0], start.mean(axis=0), rtol=1e-12)
    assert {"bed.data", "deck.in", "log.liggghts"} <= {p.name for p in (tmp_path / "kept").iterdir()}


@installed
def test_a_run_stopped_by_liggghts_is_reported():
    with pytest.raises(LabError, match="LIGGGHTS stopped: ERROR"):
        run([0.0, 0.01], material=replace(ACETATE, poisson=0.9))


@installed
def test_a_grain_that_leaves_the_tank_is_reported():
    with pytest.raises(LabError, match="LIGGGHTS stopped: ERROR"):
        run([[0.0, 0.1], [0.1 * RADIUS, 0.1]], dt=1e-2)


def test_without_the_executable_it_says_so(monkeypatch):
    monkeypatch.setattr(liggghts, "EXECUTABLE", "no-such-peer")
    with pytest.raises(LabError, match="no-such-peer"):
        run([0.0, 0.01])


def test_a_material_without_restitution_is_refused():
    with pytest.raises(LabError, match="restitution"):
        run([0.0, 0.01], material=replace(ACETATE, restitution=None, dissipative_time=1e-5))
