"""Calibration: a known response is inverted, its error is that of the beds, and what cannot be is said."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from lab import calibrate as module
from lab.axes import values
from lab.calibrate import calibrate
from lab.errors import LabError
from lab.units import in_unit

BEDS, SCATTER = 8, 3.0  # deg


@pytest.fixture
def response(monkeypatch):
    """Sweeps that are not run: 20 + 30 x - 10 x² deg, and of each bed an offset of its own."""
    asked = []

    def sweep(name, axes, overrides, folder, *, video, quiet, cluster):
        ((key, listed),) = axes.items()
        asked.append(listed)
        offsets = SCATTER * np.random.default_rng(3).normal(size=BEDS)
        points = []
        for number, x in enumerate(map(float, listed)):
            angles = (20.0 + 30.0 * x - 10.0 * x**2 + offsets - offsets.mean()).tolist()
            value = {"value": np.mean(angles), "unit": "deg", "std": 1.0, "uncertainty": None, "worlds": angles}
            where = folder / str(number)
            where.mkdir(parents=True)
            summary = {"status": "complete", "warnings": [], "measures": {"critical_angle": value | {"note": ""}}}
            (where / "summary.json").write_text(json.dumps(summary))
            points.append(where)
        return SimpleNamespace(rows=[{key: float(x)} for x in listed], points=points)

    monkeypatch.setattr(module, "run_sweep", sweep)
    return asked


def test_a_known_response_is_inverted_with_the_error_of_its_beds(response, tmp_path):
    made = calibrate("tilting/quick", "repose=30 deg", "friction=0.1:0.9", {}, tmp_path)
    exact = 1.5 - np.sqrt(1.25)  # 30 x - 10 x² = 10
    assert made.key == "material.friction" and made.value == pytest.approx(exact, abs=1e-4)
    offsets = SCATTER * np.random.default_rng(3).normal(size=BEDS)
    slope = 30.0 - 20.0 * exact
    assert made.error == pytest.approx(offsets.std() / np.sqrt(BEDS) / slope, rel=0.15)
    assert made.interval[0] < exact < made.interval[1]
    assert response[0] == values("friction", "0.1:0.9:5")
    assert min(map(float, response[1])) > 0.15 and max(map(float, response[1])) < 0.65
    assert json.loads((tmp_path / "calibration.json").read_text())["value"] == made.value
    assert (tmp_path / "calibration.png").stat().st_size > 10_000
    assert made.text().startswith("material.friction = 0.382 ± ")


@pytest.mark.parametrize(
    ("target", "vary", "said"),
    [
        ("repose", "friction=0.1:0.9", "--target: 'repose' cannot be read"),
        ("repose=30 mm", "friction=0.1:0.9", "--target: .*angle"),
        ("shine=30 deg", "friction=0.1:0.9", "--target: these runs have no shine; they have critical_angle"),
        ("repose=80 deg", "friction=0.1:0.9", r"--vary: between 0.1 and 0.9 of material.friction .* never 80"),
        ("repose=30 deg", "friction=0.1", 'a range FROM:TO is needed.*"0.1"'),
        ("repose=30 deg", "slipperiness=0.1:0.9", "slipperiness: no preset has such a key"),
        ("repose=30 deg", "amplitude=1 mm:2 mm", "amplitude: it could be motion.sway.amplitude or "),
    ],
)
def test_what_cannot_be_is_one_sentence(response, tmp_path, target, vary, said):
    with pytest.raises(LabError, match=said):
        calibrate("tilting/quick", target, vary, {}, tmp_path)


def test_targets_may_come_in_any_unit_of_their_kind():
    assert in_unit("0.5 rad", "deg", "x") == pytest.approx(np.degrees(0.5))
    assert in_unit("3 cm", "mm", "x") == pytest.approx(30.0)
    assert in_unit("5 d", "d", "x") == 5.0
