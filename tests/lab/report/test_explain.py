"""The estimated cost of a preset: every part of a run counts."""

import re

import pytest

from lab.assembly.scene import build
from lab.preset.accuracy import LEVELS
from lab.preset.find import load
from lab.report import water
from lab.report.cost import cost_in_seconds
from lab.report.explain import explain
from solvers.simulation import Simulation

HOLD = "space/sloshing"
FEW = {"run.threads": 1, "run.duration": "10 s"}


def told(name: str, **changes) -> float:
    """The run time (s) that is told."""
    words = re.search(r"run time +about (\d+) s on", explain(load(name, {**FEW, **changes})))
    return float(words[1])


def parts(name: str, changes: dict) -> dict[str, float]:
    resolved = load(name, {**FEW, **changes}).resolved
    scene, position = build(resolved)
    simulation = Simulation(scene, position, 1)
    try:
        return cost_in_seconds(resolved, scene, simulation)
    finally:
        simulation.close()


def test_a_small_ship_costs_more_than_the_steps_of_her_few_grains():
    """Sixteen grains: kernels, figures and 250 pictures outweigh all steps; more pictures cost more."""
    few = told("ship/model-test-quick", **{"record.picture_rate": "25 Hz"})
    assert few >= 10.0
    assert told("ship/model-test-quick", **{"record.picture_rate": "100 Hz"}) > 1.5 * few


def test_the_parts_of_the_cost_grow_with_their_quantities(monkeypatch):
    monkeypatch.setattr("lab.report.cost.taken", lambda *_: (False, None))  # nothing was compiled on this machine
    calm, rough, tank = (
        parts("ship/barge-roll", {"grains.diameter": "20 mm"}),
        parts("ship/irregular-sea", {"grains.diameter": "20 mm"}),
        parts("shaking/sway", {"grains.diameter": "10 mm"}),
    )
    assert rough["of her hull and water"] > 1.1 * calm["of her hull and water"]  # a memory and 200 waves
    assert rough["of pictures"] == calm["of pictures"]
    assert "of her hull and water" not in tank and tank["to start and compile"] < calm["to start and compile"]
    longer = parts("ship/barge-roll", {"grains.diameter": "20 mm", "run.duration": "20 s"})
    for part in ("of steps", "of her hull and water", "of pictures"):
        assert longer[part] == pytest.approx(2.0 * calm[part])
    assert longer["of figures"] == calm["of figures"]


def test_each_key_of_the_preset_is_explained():
    lines = explain(load("tilting/quick", FEW)).splitlines()
    (rate,) = (line for line in lines if line.strip().startswith("rate = "))
    assert rate.split(" # ")[1] == "Speed of turning."


def test_it_says_when_steps_are_longer_and_when_they_never_are():
    slow = r"slow grains +steps are 2 times as long while no two grains may meet faster than \d"
    assert re.search(slow, explain(load("tilting/quick", FEW)))
    assert "slow grains" not in explain(load("tilting/quick", FEW | {"run.step": "1 us"}))


@pytest.mark.parametrize(
    ("spacing", "level", "said"),
    [("4 mm", "draft", "larger than"), ("2.6 mm", "draft", ""), ("1.3 mm", "standard", "")],
)
def test_the_error_of_water_is_that_of_the_layers_it_has(spacing, level, said):
    """Of 52.5 mm: 13 layers are worse than a draft, 20 are one, 40 are the standard, whatever the level's name."""
    rows = dict(water.accuracy(load("sloshing/source-p-25", {"water.spacing": spacing}).resolved))
    assert LEVELS[level].of_water in rows["error"]
    assert said in rows["error"] and ("larger than" in rows["error"]) is bool(said)


def test_water_in_space_takes_less_than_a_kilobyte_a_particle_and_its_peak_is_told():
    """0.4 to 0.7 kB in arrays, and the state once more: of 56 000 particles 396 MiB were found in a run, to 20 %."""
    words = re.search(r"memory +(\S+) MiB, (\d+) bytes a particle, in arrays; some (\d+) MiB", explain(load(HOLD, FEW)))
    assert 400 <= int(words[2]) <= 700
    assert int(words[3]) == pytest.approx(396, rel=0.2)
