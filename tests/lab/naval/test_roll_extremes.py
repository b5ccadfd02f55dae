"""The largest roll by Gumbel and by Weibull: made-up samples, how often intervals hold, and when nothing is told."""

import numpy as np
import pytest
from click.testing import CliRunner
from scipy import stats

from lab.base.errors import LabError
from lab.cli import main
from lab.naval.rolling import extremes as fits
from lab.report.rolling.extremes import Record, judge, read


def test_the_likeliest_gumbel_is_that_of_scipy():
    maxima = np.random.default_rng(1).gumbel(12.0, 1.5, 40)
    found = fits.fit_gumbel(maxima)
    assert (found.place, found.scale) == pytest.approx(stats.gumbel_r.fit(maxima), rel=1e-4)


def test_the_likeliest_weibull_is_that_of_scipy():
    peaks = 3.0 * np.random.default_rng(2).weibull(1.7, 400)
    shape, _, scale = stats.weibull_min.fit(peaks, floc=0.0)
    assert fits.fit_weibull(peaks) == pytest.approx((scale, shape), rel=1e-3)


@pytest.mark.parametrize("count", [10, 40])
def test_gumbels_intervals_hold_as_often_as_they_say(count):
    """600 samples of μ = 12, β = 1.5: the mean of the largest in 18 blocks is in its 95 % interval in 95 ± 3 %."""
    random, inside = np.random.default_rng(3), 0
    truth = 12.0 + 1.5 * (np.log(18.0) + fits.EULER)
    for _ in range(600):
        level = fits.fit_gumbel(random.gumbel(12.0, 1.5, count)).mean(18.0)
        inside += level.low < truth < level.high
    assert inside / 600 == pytest.approx(0.95, abs=0.03)


def test_the_mean_of_many_blocks_is_that_of_their_largest():
    random = np.random.default_rng(4)
    largest = random.gumbel(12.0, 1.5, (20000, 18)).max(axis=1)
    assert fits.fit_gumbel(random.gumbel(12.0, 1.5, 1000)).mean(18.0).value == pytest.approx(largest.mean(), rel=0.02)


def test_weibulls_intervals_hold_nearly_as_often_as_they_say():
    """120 samples of 400 peaks of Rayleigh: the bootstrap's 95 % interval holds in 88 to 99 %."""
    random, inside = np.random.default_rng(5), 0
    truth = 2.0 * np.sqrt(2.0 * np.log(1000.0))
    for _ in range(120):
        level = fits.weibull_largest(random.rayleigh(2.0, fits.PEAKS), 1000.0)
        inside += level.low < truth < level.high
    assert 0.88 <= inside / 120 <= 0.99


def gaussian(seed: int, duration: float = 3600.0) -> Record:
    """Roll of a narrow band about 0.6 rad/s with a standard deviation of 3 deg."""
    random, time = np.random.default_rng(seed), np.arange(0.0, duration, 0.5)
    omega = 0.6 + 0.04 * random.standard_normal(120)
    size = np.radians(3.0) * np.sqrt(2.0 / 120)
    phase = random.uniform(0.0, 2.0 * np.pi, 120)
    return Record(f"{seed}", time, size * np.cos(np.outer(time, omega) + phase).sum(axis=1))


def test_both_ways_find_the_largest_of_a_gaussian_roll():
    """Longuet-Higgins (1952) in 3 h: 3 (√(2 ln N) + 0.577/√(2 ln N)) deg, N = 2·1031 half cycles; within a tenth."""
    found = judge([gaussian(seed) for seed in range(12)], 3.0, 600.0)
    assert not found.silent
    root = np.sqrt(2.0 * np.log(2.0 * 10800.0 * 0.6 / (2.0 * np.pi)))
    assert found.levels["Gumbel, mean"].value == pytest.approx(3.0 * (root + fits.EULER / root), rel=0.1)
    assert found.levels["Weibull, most probable"].value == pytest.approx(3.0 * root, rel=0.1)
    level = found.levels["Gumbel, not exceeded with 95 %"]
    assert level.low < level.value < level.high


@pytest.mark.parametrize(
    ("records", "hours", "block", "said"),
    [
        (9, 3.0, None, "from 9 blocks"),
        (12, 3.0, 60.0, "rolls"),
        (2, 300.0, 600.0, "times all records"),
    ],
)
def test_too_little_tells_nothing(records, hours, block, said):
    found = judge([gaussian(seed) for seed in range(records)], hours, block)
    assert any("cannot tell" in why and said in why for why in found.silent)
    assert not any("Gumbel" in name for name in found.levels)


def written(path, seed):
    record = gaussian(seed)
    rows = "\n".join(f"{t:.1f},{np.degrees(r):.5f}" for t, r in zip(record.time, record.roll, strict=True))
    path.write_text(f"time s,roll deg\n{rows}\n", encoding="utf-8")
    return str(path)


def test_the_command_on_tables(tmp_path):
    files = [written(tmp_path / f"{seed}.csv", seed) for seed in range(2)]
    how = ["--block", "600", "--out", str(tmp_path / "out")]
    told = CliRunner().invoke(main, ["extremes", *files, *how], catch_exceptions=False)
    assert told.exit_code == 0 and "Gumbel, mean" in told.output
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"extremes.csv", "extremes.png"}
    told = CliRunner().invoke(main, ["extremes", *files, "--block", "9000"])
    assert told.exit_code and "longer than the shortest record" in told.output


def test_what_is_no_record_is_told_in_a_sentence(tmp_path):
    with pytest.raises(LabError):
        read([tmp_path])
