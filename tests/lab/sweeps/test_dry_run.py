"""A dry run finds the measures and units that a run will have."""

import pytest

from lab.preset.find import load, names
from lab.runs.runner import run_preset
from lab.sweeps.dry_run import available_measures

SMALL = {
    "tank": {"width": "24 mm", "height": "24 mm"},
    "grains": {"count": 16, "depth": False},
    "contact": {"tangential": "none"},
    "run": {"repeats": 1, "threads": 1},
}
RUNS = {
    "there and back": {"motion": {"tilt": {"rate": "60 deg/s", "angle": "15 deg", "hold": "0 s", "reverse": True}}},
    "swayed": {
        "motion": {"tilt": False, "soft_start": "0.1 s", "sway": {"amplitude": "2 mm", "frequency": "4 Hz"}},
        "run": SMALL["run"] | {"duration": "3 s"},
        "record": {"picture_rate": "100 Hz"},
    },
    "open": {"tank": SMALL["tank"] | {"lid": False}, "motion": {"tilt": {"rate": "60 deg/s", "angle": "15 deg"}}},
}


@pytest.mark.slow  # of a tilt it is in `tests/lab/runs/test_runner.py`
@pytest.mark.parametrize("case", RUNS)
def test_a_run_has_the_measures_of_its_dry_run(case, tmp_path):
    overrides = {**SMALL, **RUNS[case]}
    expected = available_measures(load("tilting/quick", overrides))
    found = run_preset("tilting/quick", overrides, tmp_path / "run", video=False, plots=False, quiet=True).measures
    assert {name: value.unit for name, value in expected.items()} == {name: v.unit for name, v in found.items()}


OF_MATTER = {
    "grains": {"final_shift", "largest_kinetic_energy", "mean_force_z"},
    "water": {"highest_water", "water_residual", "water_dense"},
    "air": set(),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", [name for name in names() if name.endswith("-quick")])
def test_every_preset_has_a_dry_run(name):
    preset = load(name)
    wanted = {measure for matter in preset.resolved.matters for measure in OF_MATTER[matter]}
    assert wanted <= available_measures(preset).keys()
