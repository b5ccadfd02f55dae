"""Presets that run alike, though an earlier version wrote down what this one derives."""

from dataclasses import replace

import pytest

from lab.preset.find import load
from lab.preset.recorded import resolved_from, to_table
from lab.runs.alike import alike, apart


def test_what_an_earlier_version_wrote_down_of_derived_values_makes_no_difference():
    """It kept the outline for width and height, the walls' whole material, the stiffness, the duration, a colour."""
    preset = load("tilting/quick").resolved
    table = to_table(preset)
    table["tank"] |= {"outline": [list(corner) for corner in preset.tank.corners], "width": None, "height": None}
    table["contact"]["stiffness_scale"] = preset.stiffness_scale
    table["run"]["duration"] = preset.duration
    table["wall"] |= {"young": preset.wall_material.young, "friction": preset.wall_material.friction}
    table["video"]["colour"] = "speed"
    table |= {"title": "Another", "based_on": ""}
    assert alike(preset, resolved_from(table))


def test_no_background_pressure_is_none_where_there_is_no_air():
    """Earlier versions kept 0 Pa for it."""
    preset = load("sloshing/quick").resolved
    table = to_table(preset)
    table["water"]["background_pressure"] = 0.0
    assert alike(preset, resolved_from(table))


def test_keys_that_make_another_run_are_named():
    preset = load("sloshing/quick").resolved
    other = replace(preset, water=replace(preset.water, spacing=0.01, depth=0.02), run=replace(preset.run, seed=7))
    assert apart(preset, other) == "water.depth, water.spacing, run.seed"


@pytest.mark.parametrize(
    ("section", "change"),
    [
        ("tank", {"width": 0.1}),
        ("contact", {"stiffness_scale": 0.01}),
        ("run", {"duration": 3.0}),
        ("wall", {"friction": 0.4}),
        ("run", {"seed": 7}),
    ],
)
def test_what_changes_a_run_makes_one(section, change):
    preset = load("tilting/quick").resolved
    assert not alike(preset, replace(preset, **{section: replace(getattr(preset, section), **change)}))
