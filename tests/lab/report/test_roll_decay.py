"""`cargolab roll-damping --decay`: coefficients of decays made up, with and without noise, and what it refuses."""

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import solve_ivp

from lab.base.errors import LabError
from lab.cli import main
from lab.naval.rolling.records import read_roll
from lab.report.rolling.decay import examine, extinction

OMEGA = 2.0 * np.pi / 11.0
TIME = np.arange(0.0, 150.0, 0.1)


def roll(share: float, quadratic: float) -> np.ndarray:
    """Roll (n,) deg let go at 20 deg, of φ̈ + 2 ζ ω φ̇ + b φ̇|φ̇| + ω² φ = 0."""

    def rate(_time, state):
        angle, speed = state
        return speed, -2.0 * share * OMEGA * speed - quadratic * speed * abs(speed) - OMEGA**2 * angle

    start = [np.radians(20.0), 0.0]
    found = solve_ivp(rate, (0.0, 150.0), start, t_eval=TIME, rtol=1e-10, atol=1e-12)
    return np.degrees(found.y[0])


def written(path, degrees, header="time s,roll deg"):
    rows = "\n".join(f"{t:.2f},{angle:.6g}" for t, angle in zip(TIME, degrees, strict=True))
    path.write_text(f"{header}\n{rows}\n", encoding="utf-8")
    return path


def swings(degrees: np.ndarray) -> np.ndarray:
    """Amplitudes of a geometric series with a quadratic loss, in deg."""
    found = [20.0]
    for _ in range(12):
        found.append(found[-1] - degrees[0] * found[-1] - degrees[1] * found[-1] ** 2)
    return np.array(found)


def test_a_linear_decay_has_its_p_and_no_q(tmp_path):
    """p = 2 tanh(π ζ/2√(1 − ζ²)), exactly; q and r nil within 2 % of p at the largest swing."""
    _, tables, numbers = examine(written(tmp_path / "a.csv", roll(0.03, 0.0)), tmp_path / "out")
    exact = 2.0 * np.tanh(0.5 * np.pi * 0.03 / np.sqrt(1.0 - 0.03**2))
    p, q, *_ = (float(row[3]) for row in tables["extinction"][1])
    assert p == pytest.approx(exact, rel=1e-3)
    assert abs(q) * 20.0 < 0.02 * p
    assert numbers["zeta"] == pytest.approx(0.03, rel=1e-3)
    assert numbers["period s"] == pytest.approx(11.0 / np.sqrt(1.0 - 0.03**2), rel=1e-3)


def test_a_quadratic_decay_has_its_q(tmp_path):
    """q = 4b/3 per rad and b to second order: within 5 % at ζ = 0.01 and bφ₀ = 0.1."""
    _, tables, numbers = examine(written(tmp_path / "a.csv", roll(0.01, 0.3)), tmp_path / "out")
    q = float(tables["extinction"][1][1][3])
    assert q == pytest.approx(4.0 / 3.0 * 0.3 * np.pi / 180.0, rel=0.05)
    assert numbers["quadratic 1/rad"] == pytest.approx(0.3, rel=0.03)


def test_the_intervals_cover_the_truth_as_often_as_they_say():
    """400 records of made-up swings with errors of 0.05 deg of each turning point: p is in its 95 % interval."""
    random, inside = np.random.default_rng(3), np.zeros(2)
    truth = np.array([0.06, 0.006])
    turns = swings_to_turns(truth)
    for _ in range(400):
        noisy = turns + random.normal(0.0, 0.05, len(turns))
        found = extinction(0.5 * np.abs(np.diff(noisy)), 2)
        clean = extinction(0.5 * np.abs(np.diff(turns)), 2)
        inside += np.abs(found.coefficients - clean.coefficients) < found.halves
    assert (np.abs(inside / 400 - 0.95) < 0.04).all()


def swings_to_turns(coefficients: np.ndarray) -> np.ndarray:
    """Turning points (deg) with amplitudes that fall by p and q of the smaller and larger swings' mean."""
    heights = swings(coefficients)
    return heights * (-1.0) ** np.arange(len(heights))


def test_noise_and_a_list_at_rest_change_little(tmp_path):
    noise = np.random.default_rng(4).normal(0.0, 0.1, len(TIME))
    _, _, numbers = examine(written(tmp_path / "a.csv", roll(0.02, 0.3) + 2.0 + noise), tmp_path / "out")
    assert abs(numbers["zeta"] - 0.02) < 4.0 * numbers["zeta error"]
    assert abs(numbers["quadratic 1/rad"] - 0.3) < 4.0 * numbers["quadratic error 1/rad"]


def test_radians_are_radians(tmp_path):
    degrees = roll(0.02, 0.0)
    one = read_roll(written(tmp_path / "deg.csv", degrees))[1]
    other = read_roll(written(tmp_path / "rad.csv", np.radians(degrees), "t [s],phi (rad)"))[1]
    assert other == pytest.approx(one, abs=1e-5)


@pytest.mark.parametrize(
    ("header", "values", "said"),
    [
        ("time s,roll", lambda d: d, "needs its unit"),
        ("time min,roll deg", lambda d: d, "has to be in s"),
        ("time s,pitch deg", lambda d: d, "one column time and one of roll"),
        ("time s,roll rad", lambda d: d, "look at its unit"),
        ("time s,roll deg", lambda d: 0.0 * d, "too few swings"),
    ],
)
def test_a_record_that_is_none_is_told_in_a_sentence(tmp_path, header, values, said):
    with pytest.raises(LabError, match=said):
        examine(written(tmp_path / "a.csv", values(roll(0.02, 0.0)), header), tmp_path / "out")


def test_the_command_takes_a_record_alone(tmp_path):
    path = written(tmp_path / "a.csv", roll(0.02, 0.1))
    told = CliRunner().invoke(main, ["roll-damping", "--decay", str(path), "--out", str(tmp_path / "out")])
    assert told.exit_code == 0 and "Froude's curve" in told.output
    told = CliRunner().invoke(main, ["roll-damping", "--decay", str(path), "--kg", "3"])
    assert told.exit_code and "leave out --kg" in told.output
