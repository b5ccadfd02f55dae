"""The bench of stability: its fast part passes, goes on where it was cut off, and its verdicts can say no."""

import json
from dataclasses import replace

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS
from lab.studies.bench import stability
from lab.studies.bench.stability import limit_case
from lab.studies.bench.stability.beds import ACETATE, RADIUS, bed, tank
from lab.studies.bench.stability.case import HardCase, Measure, judge, made_energy
from lab.studies.bench.stability.hard_beds import height
from lab.studies.bench.stability.limit_map import Limit, contacts, exact_limit, grows, limits, longest, packing, scene
from lab.studies.bench.stability.pushed import REFUSED, RIGHT, STOPPED, WRONG, verdict
from lab.studies.bench.stability.trial import Trial, follow, overlap_of
from lab.studies.case import Line
from lab.studies.suite import carried_out
from solvers.motion import Sway
from solvers.scene import Scene
from solvers.simulation import Simulation

SWAYED = HardCase("sway", "", lambda fast: None, measure=Measure("height", height, 0.1, ""))


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The folder that the fast part leaves."""
    folder = tmp_path_factory.mktemp("bench")
    return folder, stability.SUITE.run((), folder, True)


@pytest.fixture(scope="module")
def swayed():
    """A small bed that a tank at rest in its outermost place throws sideways, for a tenth of a second."""
    trial = bed(20, 0.1, across=5, motions=[(Sway(0.1, 2.0, -0.5 * np.pi),)])
    run = Simulation(trial.scene, trial.position[None], 1, arch="cpu")
    yield trial, follow(run, trial, 4.0 * trial.scene.time_step())
    run.close()


@pytest.mark.slow
def test_the_fast_part_passes_and_writes_a_page(page):
    folder, passed = page
    text, data = (folder / "stability.md").read_text(), json.loads((folder / "stability.json").read_text())
    assert passed, text
    assert "FAIL" not in text
    assert (folder / "stability-limits-verlet.png").stat().st_size > 10_000
    measured = {hard.name: hard.measure for hard in stability.ALL if hard.fast}
    assert set(data) == {*measured, "map-verlet"}
    for name, measure in measured.items():
        assert f"(`{name}`)" in text
        assert [len(table["rows"]) for table in data[name]["tables"]] == ([2] if measure else [])
    assert STOPPED in text and RIGHT in text


@pytest.mark.slow
@pytest.mark.parametrize("case", stability.CASES, ids=lambda case: case.name)
def test_a_hard_case_holds_at_the_automatic_step_and_misleads_at_none(case):
    outcome = carried_out(case, fast=True)
    assert outcome.passed, (outcome.fault, outcome.found.lines)


@pytest.mark.slow
def test_a_case_passes_and_writes_a_page(tmp_path):
    assert stability.SUITE.run(("wedged",), tmp_path, True)
    text, data = (tmp_path / "stability.md").read_text(), json.loads((tmp_path / "stability.json").read_text())
    assert "(`wedged`)" in text and "FAIL" not in text
    assert [row[4] for row in data["wedged"]["tables"][0]["rows"]] == [RIGHT, REFUSED + RIGHT]


def test_an_unknown_name_gives_one_sentence(tmp_path):
    with pytest.raises(LabError, match=r"^there is no case wedge-shaped; there are one-grain, corner, .*map-gear\.$"):
        stability.SUITE.run(("wedge-shaped",), tmp_path, False)
    assert not list(tmp_path.iterdir())
    (tmp_path / "stability.json").write_text("[1, 2")
    with pytest.raises(LabError, match="holds no results"):
        stability.SUITE.run((), tmp_path, True)


@pytest.mark.parametrize(("true", "failed"), [(1.2, 0), (0.99, 1), (0.0, 1)])
def test_a_derived_step_that_is_not_stable_fails(true, failed, monkeypatch):
    """In units of the derived step; 2/ω is that found or, in the last line, a tenth longer."""
    alike = [Limit("verlet", "linear", "none", "undamped", 1.0, true, exact) for exact in (None, true, 1.1 * true)]
    monkeypatch.setattr(limit_case, "found", lambda integrator, fast: alike)
    found = limit_case.check(True, "verlet")
    assert [line.passed for line in found.lines if "missing" in line.quantity] == [not failed] * 3
    assert [line.passed for line in found.lines if "longest" in line.quantity] == ([True, False] if true else [])
    assert found.tables[0].rows == [("linear", f"{true:.2g}", "", "")]


def failed(checks: list[Line]) -> list[str]:
    """What the checks that fail compare."""
    return [check.quantity for check in checks if not check.passed]


@pytest.mark.slow
def test_energy_equals_the_work_of_the_tank(swayed):
    """The bed is thrown against the walls, and its energy follows the tank's work but for what collisions take."""
    trial, course = swayed
    assert failed(judge(SWAYED, trial, course)) == []
    assert np.ptp(course.work) > 0.1 * trial.weight * trial.height
    assert made_energy(trial, course) < 1e-3


@pytest.mark.slow
def test_energy_without_a_source_is_detected(swayed):
    """Without the tank's work, or with a little more than there is, the energy has no source."""
    trial, course = swayed
    no_work = replace(course, work=np.zeros_like(course.work))
    assert made_energy(trial, no_work) > 0.1
    assert failed(judge(SWAYED, trial, no_work)) == ["energy made (share)"]
    warmer = course.energy + 0.03 * trial.weight * trial.height * np.linspace(0.0, 1.0, len(course.time)) ** 20
    assert failed(judge(SWAYED, trial, replace(course, energy=warmer))) == ["energy made (share)"]


@pytest.mark.slow
def test_other_errors_are_detected(swayed):
    trial, course = swayed
    assert failed(judge(SWAYED, trial, replace(course, stopped="it exploded."))) == ["the run"]
    assert failed(judge(replace(SWAYED, may_stop=True), trial, replace(course, stopped="it exploded."))) == []
    deep = course.rows | {"overlap": course.rows["overlap"] + 0.04}
    assert failed(judge(SWAYED, trial, replace(course, rows=deep))) == ["largest overlap (radii)"]
    lost = replace(course, energy=np.where(np.arange(len(course.time)) == 50, np.nan, course.energy))
    assert failed(judge(SWAYED, trial, lost)) == ["energy made (share)"]


@pytest.mark.slow
def test_longer_steps_are_classified(swayed):
    trial, course = swayed
    found = height(trial, course)
    assert verdict(SWAYED, trial, course, 4, found, 0.92 * found).outcome == RIGHT
    assert verdict(SWAYED, trial, course, 4, found, 0.9 * found).outcome == WRONG
    assert not verdict(SWAYED, trial, course, 4, found, 1.2 * found).passed
    hot = replace(course, energy=course.energy + np.linspace(0.0, 0.05, len(course.time)) * course.energy.max())
    assert verdict(SWAYED, trial, hot, 4, found, found).outcome == WRONG
    assert verdict(SWAYED, trial, course, 10, found, 0.9 * found).passed, "no number comes out of the app"
    stopped = verdict(SWAYED, trial, replace(course, stopped="too fast."), 4, found, found)
    assert stopped.outcome == STOPPED and stopped.said == "too fast." and stopped.passed


def test_hertz_estimate_of_an_impact_and_a_load():
    """By hand: E* = 3.2e9/(2 · 0.9216) = 1.7361 GPa; at a wall k = (4/3) E* √R, m = (4/3) π R³ ρ."""
    made = Scene([RADIUS], tank(0.1, 0.1), ACETATE, ACETATE)
    mass, k = 4.0 / 3.0 * np.pi * RADIUS**3 * 1319.0, 4.0 / 3.0 * 3.2e9 / (2.0 * 0.9216) * RADIUS**0.5
    assert overlap_of(made, 2.0, 0.0) == pytest.approx((1.25 * mass * 4.0 / k) ** 0.4 / RADIUS, rel=1e-12)
    assert overlap_of(made, 0.0, 5.0) == pytest.approx((5.0 / (k * 0.5**0.5)) ** (2 / 3) / RADIUS, rel=1e-12)


def test_bisection_finds_a_limit_above_and_below_and_none():
    for limit in (7.3, 1.0, 0.11):
        assert longest(lambda step, at=limit: step > at, 1.0) == pytest.approx(limit, rel=0.01)
    assert longest(lambda step: True, 1.0) == 0.0
    assert longest(lambda step: False, 1.0) > 50.0


@pytest.mark.slow
def test_packing_is_in_equilibrium_and_explodes_beyond_its_limit():
    """At a stable step no grain moves by as much as a thousandth of an overlap; a little beyond 2/ω they fly apart."""
    made = scene([1.0], "verlet", "linear", "none")
    places = packing("linear")[1][None]
    run = Simulation(made, places, 1, arch="cpu")
    assert not grows(run, places, 0, 0.97 * exact_limit("linear"))
    assert np.abs(run.snapshot()["position"] - places).max() < 1e-3 * contacts("linear")[0].overlap
    assert grows(run, places, 0, 1.03 * exact_limit("linear"))
    run.close()


@pytest.mark.slow
@pytest.mark.parametrize(("integrator", "friction"), [("gear", "haff-werner"), ("verlet", "mindlin")])
def test_the_step_of_draft_accuracy_is_stable_where_dampers_are_strong(integrator, friction):
    """Gear bears weaker dampers than Verlet; Mindlin's dashpot grows with the stiffness."""
    for found in limits(integrator, "hertz-viscoelastic", friction):
        assert found.ratio > LEVELS["draft"].longer_steps, found.damping


def test_a_trial_weighs_its_grains():
    made = Scene([RADIUS, 2.0 * RADIUS], tank(0.1, 0.1) + np.array([0.0, 0.3]), ACETATE, ACETATE)
    trial = Trial(made, np.array([[0.0, 0.31], [0.02, 0.32]]), 1.0)
    mass = 4.0 / 3.0 * np.pi * RADIUS**3 * 1319.0
    assert trial.weight == pytest.approx(9.0 * mass * 9.81, rel=1e-12)
    assert trial.height == pytest.approx((0.01 + 8.0 * 0.02) / 9.0, rel=1e-9)
