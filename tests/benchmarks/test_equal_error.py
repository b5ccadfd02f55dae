"""How codes are compared at equal error: the step each may take, the pairs that meet, and what peers are told."""

import numpy as np
import pytest

from benchmarks.peers import lammps, liggghts, peer
from benchmarks.speed import beds, equal_error, processors, workers
from benchmarks.speed.equal_error import situations, steps
from benchmarks.speed.equal_error.steps import PAIRS, SPEED, duration, longest_step, meeting, parted
from lab.base.errors import LabError


def erring(order: float, at_thirty: float):
    """Rebounds whose error grows with a power of the step, and is `at_thirty` with 30 steps a collision."""
    return lambda dt: (
        SPEED * (0.6 + 0.6 * at_thirty * np.linspace(-1.0, 1.0, PAIRS) * (30.0 * dt / duration()) ** order)
    )


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_the_longest_step_is_the_one_that_just_holds_the_error(order):
    assert longest_step(erring(order, 0.99e-2), 0.01) == pytest.approx(duration() / 30)
    assert longest_step(erring(order, 1.01e-2), 0.01) == pytest.approx(duration() / 32)


def test_a_step_that_is_right_by_chance_does_not_count():
    def lucky(dt: float) -> np.ndarray:
        off = 0.02 if 20.0 < duration() / dt < 40.0 else 0.0  # right again at longer steps
        return np.full(PAIRS, 0.6 * (1.0 + off))

    assert longest_step(lucky, 0.01) == pytest.approx(duration() / 41)


def test_a_code_that_holds_the_error_at_no_step_is_not_compared():
    with pytest.raises(LabError, match="restitution"):
        longest_step(erring(0.0, 0.5), 0.01)


def test_pairs_meet_at_moments_spread_over_a_step():
    dt = duration() / 20
    bed, velocity, steps = meeting(dt)
    pairs = bed.position.reshape(PAIRS, 2, 2)
    gap = pairs[:, 1, 0] - pairs[:, 0, 0] - 2.0 * bed.radius[0]
    np.testing.assert_allclose(gap / (SPEED * dt), 2.0 + np.arange(PAIRS) / PAIRS, rtol=1e-9)
    assert (pairs[1:, 0, 0] - pairs[:-1, 1, 0]).min() > SPEED * steps * dt  # no pair reaches the next
    np.testing.assert_allclose(parted(velocity), -SPEED)


@pytest.mark.parametrize(("code", "run"), [(lammps, lammps.run_lammps), (liggghts, liggghts.run_liggghts)])
def test_peers_are_told_velocities_and_the_tilt(code, run, monkeypatch, tmp_path):
    def stop(*_):
        raise LabError("stop")

    monkeypatch.setattr(peer, "execute", stop)
    bed, velocity, _ = meeting(1e-5)
    how = {"velocity": velocity, "tilt": np.radians(30.0), "workdir": tmp_path}
    with pytest.raises(LabError, match="stop"):
        run(peer.Task(bed.position, bed.radius, bed.width, 0.2, steps.SOFT, 1e-5, 10, **how))
    rows = (tmp_path / peer.BED).read_text().split("Velocities\n\n")[1].splitlines()
    np.testing.assert_allclose(np.array([row.split() for row in rows], dtype=float)[:, [1, 3]], velocity)
    ramp = (tmp_path / peer.DECK).read_text().split("equal ramp(")[1].split(")")[0]
    np.testing.assert_allclose([float(angle) for angle in ramp.split(",")], -30.0)


@pytest.mark.parametrize(("code", "run"), [(lammps, lammps.run_lammps), (liggghts, liggghts.run_liggghts)])
def test_peers_are_told_the_places_of_spheres_and_the_end_walls(code, run, monkeypatch, tmp_path):
    def stop(*_):
        raise LabError("stop")

    monkeypatch.setattr(peer, "execute", stop)
    place = np.array([[0.01, 0.02, -0.03], [-0.01, 0.04, 0.03]])  # y, z, x
    task = peer.Task(place, np.full(2, 1e-3), 0.1, 0.2, steps.SOFT, 1e-5, 10, workdir=tmp_path, along=0.08)
    with pytest.raises(LabError, match="stop"):
        run(task)
    bed, deck = (tmp_path / peer.BED).read_text(), (tmp_path / peer.DECK).read_text()
    rows = bed.split("Atoms\n\n")[1].split()
    np.testing.assert_array_equal(np.array(rows, dtype=float).reshape(2, 7)[:, [4, 6, 5]], place)
    assert "-0.040000000000000001 0.040000000000000001 ylo yhi" in bed
    ends = [word for line in deck.splitlines() if "yplane" in line for word in line.split("yplane")[1].split()]
    assert sorted(map(float, ends)) == [-0.04, 0.04]


@pytest.mark.parametrize("copies", [6, 100])
def test_copies_of_a_bed_in_space_fill_one_tank(copies):
    one = beds.Bed(np.full(2, 1e-3), np.array([[-5e-3, 1e-3, 4e-3], [5e-3, 1e-3, -4e-3]]), 0.02, 0.01)
    many = one.times(copies)
    assert many.count == 2 * copies
    assert many.width * many.along == pytest.approx(copies * one.width * one.along)
    assert np.abs(many.position[:, 0]).max() == pytest.approx(many.width / 2 - 5e-3)
    assert np.abs(many.position[:, 2]).max() == pytest.approx(many.along / 2 - 1e-3)
    assert len(np.unique(many.position, axis=0)) == many.count


@pytest.mark.slow
def test_the_lab_rebounds_with_the_restitution_asked_for():
    np.testing.assert_allclose(steps.rebounds_here(duration() / 100), 0.6 * SPEED, rtol=1e-3)


def test_ratios_of_one_kind_stay_when_others_are_measured(tmp_path):
    at_error = equal_error.kept_ratio("LAMMPS", "1 % of restitution", "at rest", np.array([4.0, 5.0]))
    by_steps = processors.ratio("LAMMPS", *processors.SPRINGS, np.array([9.0]), np.array([3.0]))
    for ratios in ([by_steps], [at_error]):
        processors.keep(tmp_path, ratios)
    kept = next(iter(processors.RECORDS.validate_python(processors.read(tmp_path / "speed-peers.json")).values()))
    assert {one.what for one in kept.ratios} == {by_steps.what, at_error.what}


@pytest.mark.parametrize(("code", "run"), [(lammps, lammps.run_lammps), (liggghts, liggghts.run_liggghts)])
def test_a_flying_grain_is_shaken_as_in_a_swaying_tank(code, run):
    """y = A (sin ω since + ω cos(ω since) t − sin ω (since + t)) in the tank's axes; no gravity."""
    if code.available() is None:
        pytest.skip(f"{code.NAME} is not installed")
    amplitude, omega, since, end = 0.01, 30.0, 0.04, 0.05
    shaking = peer.Shaking(amplitude * omega**2, omega, since)
    grain = np.array([[0.0, 0.1]]), np.array([1.5e-3])
    found = run(peer.Task(*grain, 0.2, 0.2, steps.SOFT, end / 5000, 5000, gravity=1e-9, shaking=shaking))
    lag = np.sin(omega * since) + omega * np.cos(omega * since) * end - np.sin(omega * (since + end))
    np.testing.assert_allclose(found.position[0], [amplitude * lag, 0.1], atol=2e-6)


@pytest.mark.slow
def test_every_turn_moves_the_bed_alike(tmp_path):
    """A swayed bed of 500, followed twice from the same places, speeds and phase of the motion."""
    one = situations.every_situation(beds.usual_bed(tmp_path, 500), tmp_path)["swayed"]
    how = {"material": steps.GRAINS, "schedule": "per-world", **one.scene}
    turned = workers._Timed(one.bed, 1, 1, "cpu", 1, one.since, how)
    places = []
    for _ in range(2):
        assert turned.course(2e-3, one.velocity) > 0.0
        places.append(turned.run.snapshot()["position"][0])
    turned.run.close()
    moved = np.abs(places[0] - one.bed.position).max()
    assert np.abs(places[1] - places[0]).max() < 1e-9 < 1e-5 < moved


def test_copies_of_a_moving_bed_move_as_it_does():
    bed = beds.Bed(np.full(2, 1.5e-3), np.array([[0.0, 0.01], [0.01, 0.02]]), 0.1)
    two = situations.Situation(bed, np.array([[1.0, 2.0], [3.0, 4.0]])).times(2)
    assert two.bed.count == 4 and two.velocity.tolist() == [[1.0, 2.0], [3.0, 4.0]] * 2
    assert situations.Situation(bed).times(2).velocity is None
