"""The peer code LAMMPS does with a bed of ours what its law, which is nearly ours, and Newton's say."""

from dataclasses import replace
from math import pi, sin, sqrt

import numpy as np
import pytest

from benchmarks.peers import lammps, liggghts
from benchmarks.peers.lammps import run_lammps
from benchmarks.peers.liggghts import run_liggghts
from benchmarks.peers.peer import Task
from lab.base.errors import LabError
from solvers.grains.materials import Material
from solvers.grains.restitution import dissipative_time_for, restitution_from

RADIUS = 1.5e-3
WIDTH, HEIGHT = 61.5e-3, 0.2
GRAVITY = 9.81
ACETATE = Material(density=1319.0, young=3.2e6, poisson=0.28, friction=0.25, restitution=0.6, restitution_speed=0.5)
STIFF = replace(ACETATE, young=3.2e8)  # so that gravity has no time to act in a collision
MASS = 4 / 3 * pi * RADIUS**3 * ACETATE.density
MODULUS = ACETATE.young / (2 * (1 - ACETATE.poisson**2))

installed = pytest.mark.skipif(lammps.available() is None, reason="the peer code LAMMPS (lmp) is not installed")


def run(position, *, material=ACETATE, dt=1e-5, steps=1000, **options):
    position = np.atleast_2d(np.asarray(position, dtype=float))
    radius = np.full(len(position), RADIUS)
    return run_lammps(Task(position, radius, WIDTH, HEIGHT, material, dt, steps, **options))


def stacked(rows: int) -> np.ndarray:
    """Rows of twenty grains, each grain but the lowest row's resting on two others (m)."""
    row, column = np.divmod(np.arange(20 * rows), 20)
    y = -WIDTH / 2 + RADIUS * (1 + 2 * column + row % 2)
    return np.column_stack((y, RADIUS * (1 + sqrt(3) * row)))


@installed
@pytest.mark.parametrize("tangential", ["history", "no_history"])
def test_a_resting_grain_sinks_in_as_a_sphere_by_hertz(tangential):
    overlap = (3 * MASS * GRAVITY / (4 * MODULUS * sqrt(RADIUS))) ** (2 / 3)
    rest = run([0.0, RADIUS], steps=30_000, tangential=tangential)
    assert RADIUS - rest.position[0, 1] == pytest.approx(overlap, rel=1e-3)
    assert abs(rest.position[0, 0]) < 1e-12


@installed
@pytest.mark.parametrize("restitution", [0.5, 0.9])
def test_a_dropped_grain_bounces_with_the_given_restitution_at_its_speed(restitution):
    drop = 0.02
    material = replace(STIFF, restitution=restitution, restitution_speed=sqrt(2 * GRAVITY * drop))
    assert bounced(drop, material) == pytest.approx(restitution**2 * drop, rel=0.01)


@installed
def test_a_faster_impact_loses_more_energy():
    drop = 0.08
    stiffness = 4 / 3 * STIFF.young / (1 - STIFF.poisson**2) / 2 * sqrt(RADIUS)
    time = dissipative_time_for(STIFF.restitution, STIFF.restitution_speed, stiffness, MASS)
    expected = restitution_from(time, sqrt(2 * GRAVITY * drop), stiffness, MASS)
    assert expected < 0.57
    assert bounced(drop, STIFF) == pytest.approx(expected**2 * drop, rel=0.01)


def bounced(drop: float, material: Material) -> float:
    """How high (m) a grain comes back that falls from `drop` (m)."""
    bounce = run([0.0, RADIUS + drop], material=material, dt=5e-7, steps=500_000, sample_every=100)
    height = bounce.centre_of_mass[:, 1] - RADIUS
    return height[np.argmax(height < 0) :].max()


@installed
def test_two_grains_part_with_equal_and_opposite_momentum():
    start = [[-0.95 * RADIUS, 0.1], [0.95 * RADIUS, 0.1]]
    apart = run(start, gravity=0.0, sample_every=100)
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
    assert {"bed.data", "deck.in", "log.lammps"} <= {p.name for p in (tmp_path / "kept").iterdir()}


@installed
def test_two_processes_do_what_one_does():
    start = stacked(5)
    try:
        both = run(start, steps=500, processes=2)
    except LabError as error:
        pytest.skip(f"MPI starts no two processes here: {error}")
    np.testing.assert_allclose(both.position, run(start, steps=500).position, atol=1e-9)


@installed
@pytest.mark.skipif(liggghts.available() is None, reason="the peer code LIGGGHTS is not installed")
def test_a_stacked_bed_settles_to_the_height_that_liggghts_finds():
    start = stacked(5)
    radius = np.full(len(start), RADIUS)
    theirs = run_liggghts(Task(start, radius, WIDTH, HEIGHT, ACETATE, 1e-5, 20_000))
    ours = run(start, steps=20_000)
    sunk = start.mean(axis=0)[1] - theirs.centre_of_mass[-1, 1]
    assert start.mean(axis=0)[1] - ours.centre_of_mass[-1, 1] == pytest.approx(sunk, rel=0.01)


@installed
def test_a_run_stopped_by_lammps_is_reported():
    with pytest.raises(LabError, match="LAMMPS stopped: ERROR"):
        run([0.0, 0.01], dt=0.0, steps=-1)


@installed
def test_a_grain_that_leaves_the_tank_is_reported():
    with pytest.raises(LabError, match="LAMMPS stopped: ERROR"):
        run([[0.0, 0.1], [0.1 * RADIUS, 0.1]], dt=1e-2)


def test_without_the_executable_it_says_so(monkeypatch):
    monkeypatch.setattr(lammps, "EXECUTABLE", "no-such-peer")
    with pytest.raises(LabError, match="no-such-peer"):
        run([0.0, 0.01])


def test_a_material_without_restitution_is_refused():
    with pytest.raises(LabError, match="restitution"):
        run([0.0, 0.01], material=replace(ACETATE, restitution=None, dissipative_time=1e-5))
