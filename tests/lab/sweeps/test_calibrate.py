"""Calibration: a known response is inverted, errors are reported before any run, and losses are reported."""

import json
from types import SimpleNamespace

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures.value import Value
from lab.preset.units import in_unit
from lab.sweeps import calibrate as module
from lab.sweeps.axes import values
from lab.sweeps.calibrate import calibrate, parse_request
from lab.sweeps.resume import resume_any

BEDS, SCATTER = 8, 3.0  # deg
EXACT = 1.5 - np.sqrt(1.25)  # 30 x − 10 x² = 10
OFFSETS = SCATTER * np.random.default_rng(3).normal(size=BEDS)
MEASURES = {"critical_angle": "deg", "surface_slope": "deg", "final_shift_y": "mm"}


class Sweeps:
    """Sweeps that are not run: 20 + 30 x − 10 x² deg, and of each bed an offset of its own.

    `lose` says what of a point is lost, by its value: numbers of beds, or the status of a run that was stopped.
    """

    def __init__(self):
        self.asked, self.overrides, self.cut, self.lose = [], [], set(), {}

    def __call__(self, name, axes, overrides, folder, *, video, quiet, cluster):
        ((key, listed),) = axes.items()
        if folder.name in self.cut:
            raise KeyboardInterrupt("interrupted; continue with: cargolab resume a-round")
        self.asked.append(listed)
        self.overrides.append(overrides)
        points = [self._point(folder / str(number), float(x), overrides) for number, x in enumerate(listed)]
        return SimpleNamespace(rows=[{key: float(x)} for x in listed], points=points)

    def _point(self, where, x, overrides):
        offsets = np.resize(OFFSETS - OFFSETS.mean(), overrides["run"]["repeats"])
        angles, lost = (20.0 + 30.0 * x - 10.0 * x**2 + offsets).tolist(), self.lose.get(round(x, 6), ())
        status = lost if isinstance(lost, str) else "complete"
        angles = [None if status == "complete" and bed in lost else angle for bed, angle in enumerate(angles)]
        note = f"the bed does not flow in {len(lost)} of {len(angles)} worlds" if lost and status == "complete" else ""
        value = {"value": 1.0, "unit": "deg", "std": 1.0, "uncertainty": None, "worlds": angles, "note": note}
        where.mkdir(parents=True, exist_ok=True)
        summary = {"status": status, "warnings": [], "measures": {"critical_angle": value}}
        (where / "summary.json").write_text(json.dumps(summary))
        return where


@pytest.fixture
def sweeps(monkeypatch):
    """Sweeps that are not run, of a preset that has MEASURES."""
    found = Sweeps()
    monkeypatch.setattr(module, "run_sweep", found)
    monkeypatch.setattr(
        module, "available_measures", lambda loaded: {k: Value(None, unit) for k, unit in MEASURES.items()}
    )
    return found


def calibrated(folder, target="repose=30 deg", vary="friction=0.1:0.9", overrides=None):
    return calibrate("tilting/quick", target, vary, overrides or {}, folder, quiet=True)


def test_a_known_response_is_inverted_with_the_error_of_its_beds(sweeps, tmp_path):
    made = calibrated(tmp_path)
    slope = 30.0 - 20.0 * EXACT
    assert made.key == "material.friction" and made.value == pytest.approx(EXACT, abs=1e-6)
    assert made.std == pytest.approx(OFFSETS.std(ddof=1) / slope, rel=1e-3)
    assert made.standard_error == pytest.approx(made.std / np.sqrt(BEDS))
    assert made.interval[0] < EXACT < made.interval[1] and made.beds == BEDS and not made.warnings()
    assert sweeps.asked[0] == values("friction", "0.1:0.9:5")
    assert min(map(float, sweeps.asked[1])) > 0.15 and max(map(float, sweeps.asked[1])) < 0.65
    data = json.loads((tmp_path / "calibration.json").read_text())
    assert (data["value"], data["n"], tuple(data["interval_95"])) == (made.value, BEDS, made.interval)
    assert " (s.e.), [" in made.text() and "(95 %) gives critical angle 30 deg; 8 beds" in made.text()


def test_the_page_shows_figure_values_and_what_more_beds_would_give(sweeps, tmp_path):
    made = calibrated(tmp_path)
    page = (tmp_path / "summary.md").read_text()
    assert (tmp_path / "calibration.png").stat().st_size > 10_000
    for words in ("# Calibration of material.friction", "![calibration]", "| 0.1 | 22.9 ± ", "Fieller 1954", "| 16 | "):
        assert words in page
    assert page.count("| 8 | 0 |") == len(made.trials) == 10
    for name in ("round-1", "round-2"):
        assert f"[{name}]({name}/summary.md)" in page


@pytest.mark.parametrize(
    ("target", "vary", "said"),
    [
        ("repose", "friction=0.1:0.9", "--target: 'repose' cannot be read"),
        ("repose=30 mm", "friction=0.1:0.9", "--target: .*angle"),
        ("repose=30 ± 2 mm", "friction=0.1:0.9", "--target: .*angle"),
        ("repose=30 ± -2 deg", "friction=0.1:0.9", "--target: a standard error cannot be negative"),
        (
            "shine=30 deg",
            "friction=0.1:0.9",
            "--target: runs of this preset have no shine; they have critical_angle, s",
        ),
        ("heap_angle=30 deg", "friction=0.1:0.9", "--target: runs of this preset have no heap_angle; they have crit"),
        ("repose=30 deg", "friction=0.1", 'a range FROM:TO is needed.*"0.1"'),
        ("repose=30 deg", "friction=0.1:much", r'material\.friction: a range FROM:TO is needed.*"0\.1:much"'),
        ("repose=30 deg", "friction=-1:1", r"material\.friction: must be at least 0 \(got -1"),
        ("repose=30 deg", "friction=0.1 mm:0.9 mm", r"material\.friction: .* is a length"),
        ("repose=30 deg", "contact.normal=0:1", r"contact\.normal: its value is not a single number"),
        ("repose=30 deg", "run.settle=0:1", r"run\.settle: its value is not a single number"),
        ("repose=30 deg", "motion.sway.amplitude=1 mm:2 mm", r"motion\.sway\.frequency: missing"),
        ("repose=30 deg", "slipperiness=0.1:0.9", "slipperiness: no preset has such a key"),
        ("repose=30 deg", "amplitude=1 mm:2 mm", "amplitude: it could be motion.sway.amplitude or "),
        ("repose=30 deg", "grains.diameter=0.3 m:0.5 m", r"grains\.diameter: grains of up to .* do not fit"),
    ],
)
def test_impossible_requests_are_refused_before_any_run(sweeps, tmp_path, target, vary, said):
    with pytest.raises(LabError, match=said):
        calibrated(tmp_path / "new", target, vary)
    assert not sweeps.asked and not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("overrides", "beds"),
    [({}, 8), ({"run.repeats": 12}, 12), ({"run": {"repeats": 3}}, 3), ({"run.seed": 5}, 8)],
)
def test_eight_beds_are_run_unless_another_number_is_requested(sweeps, tmp_path, overrides, beds):
    assert calibrated(tmp_path, overrides=overrides).beds == beds
    assert {run["run"]["repeats"] for run in sweeps.overrides} == {beds}


def test_a_warning_on_too_few_beds_names_the_number_needed(sweeps, tmp_path):
    made = calibrated(tmp_path, overrides={"run.repeats": 3})
    warning, beyond = made.warnings()
    assert "reaches beyond the range" in beyond and "[−∞, " in made.text()
    assert warning.startswith("The interval is not reliable: it takes at least 8 beds, not 3; with this scatter, ")
    assert f"{made.beds_needed} beds would give a half width of 0.04." in warning
    assert warning in (tmp_path / "summary.md").read_text() and warning in made.text()
    one = calibrated(tmp_path / "one", "repose=35 deg", overrides={"run.repeats": 1})
    assert one.interval is None and one.text().startswith("material.friction = 0.")
    assert one.warnings() == ["One bed gives no interval: it takes at least 8 beds, not 1."]


def test_missing_measures_and_stopped_runs_are_reported(sweeps, tmp_path):
    sweeps.lose = {0.1: (2, 5), 0.9: "stopped: world 3: a grain moves at 12 m/s", 0.7: (0, 1, 2, 3, 4)}
    made = calibrated(tmp_path)
    page = (tmp_path / "summary.md").read_text()
    assert "| 6 | 2 | the bed does not flow in 2 of 8 worlds |" in page
    assert "| 0.9 |  | 0 | 8 | stopped: world 3: a grain moves at 12 m/s |" in page
    assert "| 3 | 5 | the bed does not flow in 5 of 8 worlds |" in page
    assert "In 15 of 80 runs the measure was not found" in page and "In 15 of 80 runs" in made.text()
    assert 0.7 not in [point.x for point in made.usable]  # more than half is lost: it is no mean of these beds
    assert made.value == pytest.approx(EXACT, abs=1e-6)


def test_if_no_value_gives_the_target_the_measured_range_is_reported(sweeps, tmp_path):
    with pytest.raises(LabError) as refused:
        calibrated(tmp_path, "repose=80 deg")
    said = (
        "no value of material.friction in the range 0.1 to 0.9 gives critical angle 80 deg: "
        "the means of 8 beds are 22.9 to 38.9; vary it further, or another key"
    )
    assert str(refused.value) == f"--vary: {said}; see {tmp_path / 'summary.md'}."
    assert len(sweeps.asked) == 1
    page = (tmp_path / "summary.md").read_text()
    assert f"**{said}.**" in page and "| 0.5 | 32.5 ± " in page and (tmp_path / "calibration.png").exists()
    assert json.loads((tmp_path / "calibration.json").read_text())["value"] is None


def test_a_target_just_beyond_the_measured_range_is_called_undecided(sweeps, tmp_path):
    with pytest.raises(LabError, match=r"39 deg: .* 38\.9; at 0\.9 the difference from the target is not significant"):
        calibrated(tmp_path, "repose=39 deg")


def test_two_values_that_give_the_target_are_both_named(sweeps, tmp_path):
    with pytest.raises(LabError, match=r"several values of material\.friction give the target, about 1 and 2"):
        calibrated(tmp_path, "repose=40 deg", "friction=0.5:2.6")


def test_a_calibration_without_any_result_is_reported(sweeps, tmp_path):
    sweeps.lose = {x: "stopped: world 0: a grain left the tank" for x in (0.1, 0.3, 0.5, 0.7, 0.9)}
    with pytest.raises(LabError, match="too few of the runs have this measure"):
        calibrated(tmp_path)
    assert (tmp_path / "summary.md").read_text().count("a grain left the tank") == 5


def test_an_interrupted_calibration_continues_as_requested(sweeps, tmp_path):
    whole, folder = calibrated(tmp_path / "whole"), tmp_path / "cut"
    sweeps.cut = {"round-2"}
    with pytest.raises(KeyboardInterrupt) as cut:
        calibrated(folder)
    assert str(cut.value) == f"interrupted; continue with: cargolab resume {folder}"
    sweeps.cut = set()
    made = resume_any(folder, quiet=True)
    assert (made.value, made.interval) == (whole.value, whole.interval)
    assert (folder / "summary.md").read_text() == (tmp_path / "whole" / "summary.md").read_text()
    with pytest.raises(LabError, match="holds another calibration than the requested one"):
        calibrated(folder, "repose=31 deg")
    (folder / "asked.json").write_text("{}")
    with pytest.raises(LabError, match="is damaged"):
        resume_any(folder, quiet=True)


def test_whole_numbers_are_used_if_the_key_takes_them(sweeps, tmp_path):
    calibrated(tmp_path, "repose=-20 deg", "grains.count=1:7", {"grains.depth": False, "grains.count": 3})
    assert sweeps.asked[0] == [1, 2, 4, 6, 7]  # rounded to even where they are halves
    assert all(isinstance(value, int) for value in sweeps.asked[1])


@pytest.mark.parametrize(
    ("target", "value", "error"),
    [
        ("repose=30 deg", 30.0, 0.0),
        ("repose=0.5 rad", np.degrees(0.5), 0.0),
        ("critical angle = 30 deg", 30.0, 0.0),
        ("repose=30 ± 1.5 deg", 30.0, 1.5),
        ("repose=30 deg +- 1.5deg", 30.0, 1.5),
        ("final_shift_y=-3 ± 0.2 cm", -30.0, 2.0),
    ],
)
def test_a_target_may_have_a_standard_error(sweeps, target, value, error):
    plan = parse_request(module.Request("tilting/quick", target, "friction=0.1:0.9"))
    assert (plan.target, plan.target_error) == pytest.approx((value, error))


def test_the_targets_own_error_widens_the_interval(sweeps, tmp_path):
    exact, loose = calibrated(tmp_path / "a"), calibrated(tmp_path / "b", "repose=30 ± 2 deg")
    assert np.diff(loose.interval) > 1.2 * np.diff(exact.interval)
    assert "30.0 ± 2.0 deg (s.e.)" in (tmp_path / "b" / "summary.md").read_text()


def test_targets_may_have_any_compatible_unit():
    assert in_unit("0.5 rad", "deg", "x") == pytest.approx(np.degrees(0.5))
    assert in_unit("3 cm", "mm", "x") == pytest.approx(30.0)
    assert in_unit("5 d", "d", "x") == 5.0
