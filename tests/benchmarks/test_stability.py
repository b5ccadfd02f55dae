"""The map of step limits: its fast part passes, its verdicts can say no, and its search finds known limits."""

import json

import numpy as np
import pytest

from benchmarks import stability
from benchmarks.stability import limit_case
from benchmarks.stability.limit_map import Limit, grows, limits, longest, scene
from benchmarks.stability.packings import MASS, packing
from lab.base.errors import LabError
from lab.preset.accuracy import LEVELS
from lab.studies.suite import carried_out
from solvers.machine.quantity import PLANE, SPACE
from solvers.simulation import Simulation


@pytest.mark.slow
def test_the_fast_part_passes_and_writes_a_page(tmp_path):
    passed = stability.SUITE.run((), tmp_path, True)
    text, data = (tmp_path / "stability.md").read_text(), json.loads((tmp_path / "stability.json").read_text())
    assert passed and "FAIL" not in text, text
    assert (tmp_path / "stability-limits-verlet.png").stat().st_size > 10_000
    assert set(data) == {"map-verlet"} and "(`map-verlet`)" in text


@pytest.mark.slow
@pytest.mark.parametrize("case", stability.CASES[1:], ids=lambda case: case.name)
def test_derived_steps_of_the_other_integrators_are_stable(case):
    outcome = carried_out(case, fast=True)
    assert outcome.passed, (outcome.fault, outcome.found.lines)


def test_an_unknown_name_gives_one_sentence(tmp_path):
    with pytest.raises(
        LabError, match=r"^there is no case wedge-shaped; there are map-verlet, .*map-gear, map-space-verlet, .*$"
    ):
        stability.SUITE.run(("wedge-shaped",), tmp_path, False)
    assert not list(tmp_path.iterdir())
    (tmp_path / "stability.json").write_text("[1, 2")
    with pytest.raises(LabError, match="holds no results"):
        stability.SUITE.run((), tmp_path, True)


@pytest.mark.parametrize(("true", "failed", "forced"), [(3.2, 0, 0), (1.2, 0, 1), (0.99, 1, 1), (0.0, 1, 1)])
def test_a_step_that_is_not_stable_fails(true, failed, forced, monkeypatch):
    """In derived steps, of which 3 may be forced; 2/ω is what was found or, in the last line, a tenth longer."""
    laws = "verlet", "linear", "none", "undamped"
    alike = [Limit(*laws, 1.0, 3.0, true, exact) for exact in (None, true, 1.1 * true)]
    monkeypatch.setattr(limit_case, "found", lambda integrator, fast, axes: alike)
    found = limit_case.check(True, "verlet")
    for said, failing in (("missing of a derived step", failed), ("missing of 3 derived steps", forced)):
        assert [line.passed for line in found.lines if said in line.quantity] == [not failing] * 3
    assert [line.passed for line in found.lines if "longest" in line.quantity] == ([True, False] if true else [])
    assert found.tables[0].rows == [("linear", f"{true:.2g}", "", "")]


def test_bisection_finds_a_limit_above_and_below_and_none():
    for limit in (7.3, 1.0, 0.11):
        assert longest(lambda step, at=limit: step > at, 1.0) == pytest.approx(limit, rel=0.01)
    assert longest(lambda step: True, 1.0) == 0.0
    assert longest(lambda step: False, 1.0) > 50.0


@pytest.mark.slow
@pytest.mark.parametrize("axes", [PLANE, SPACE])
def test_packing_is_in_equilibrium_and_explodes_beyond_its_limit(axes):
    """At a stable step no grain moves by as much as a thousandth of an overlap; a little beyond 2/ω they fly apart."""
    of = packing("linear", axes)
    made = scene(of, [1.0], "verlet", "linear", "none")
    places = of.places[None]
    run = Simulation(made, places, 1, arch="cpu")
    assert not grows(run, places, 0, 0.97 * of.exact_limit())
    assert np.abs(run.snapshot()["position"] - places).max() < 1e-3 * of.springs.overlap
    assert grows(run, places, 0, 1.03 * of.exact_limit())
    run.close()


@pytest.mark.parametrize("normal", ["hertz-viscoelastic", "linear"])
def test_grains_inside_a_block_have_twelve_contacts_nearly_as_deep_as_the_impact(normal):
    """In an endless crystal m ω² is 8 slopes of a contact less what its pressure takes; a block has longer waves."""
    of = packing(normal, SPACE)
    contacts = np.zeros(len(of.places), int)
    for i, j, *_ in of._pairs():
        contacts[[i, j]] += 1
    inside = np.linalg.norm(of.places - of.places.mean(axis=0), axis=1) < 2.1 * 1.5e-3
    assert inside.sum() == 13 and (contacts[inside] == 12).all()
    slope = of.springs.power * of.springs.force / of.springs.overlap
    stiffest = (2.0 / of.exact_limit()) ** 2 * MASS / slope
    assert 6.0 < stiffest < 8.0


@pytest.mark.slow
@pytest.mark.parametrize(("integrator", "friction"), [("gear", "haff-werner"), ("verlet", "mindlin")])
def test_the_step_of_draft_accuracy_is_stable_where_dampers_are_strong(integrator, friction):
    """Gear bears weaker dampers than Verlet; Mindlin's dashpot grows with the stiffness."""
    for found in limits(integrator, "hertz-viscoelastic", friction):
        assert found.ratio > LEVELS["draft"].longer_steps, found.damping
