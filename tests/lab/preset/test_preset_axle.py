"""An axle in presets: what the solver gets of it, and one sentence with the key for everything that cannot be."""

import tomllib

import numpy as np
import pytest

from lab.preset.find import load
from lab.preset.merge import merged, nested
from lab.preset.recorded import resolved_from, to_table
from lab.preset.schema import Preset, resolve
from lab.report.free import described
from solvers.motion.harmonic import Sway
from tests.oracles.presets import error_of

TANK = """
format = 3
title = "a tank"
[tank]
width = "900 mm"
height = "500 mm"
thickness = "62 mm"
[axle]
place = ["0 mm", "470 mm"]
inertia = "26.9 kg m^2"
moment = "-29.2 kg m"
friction = "0.54 N m"
damping = "0.326 N m s"
[axle.slide]
mass = "4978 g"
amplitude = "100 mm"
period = "2 s"
[run]
duration = "3 s"
"""
WATER, LATE = {"depth": "92 mm"}, {"sound_speed": "real", "stiff_from": "1 s"}
SHIP = {"breadth": "2 m", "height": "1 m", "draught": "0.4 m", "gravity_height": "0.3 m", "gyradius": "0.5 m"}
RECORD = "t; place; other\n0; 0; 5\n1; 10; 5\n2; 0; 5\n3; -10; 5\n4; 0; 5\n"


def hung(**overrides) -> Preset:
    """The tank with dotted keys (double underscores for dots) over it."""
    dotted = {key.replace("__", "."): value for key, value in overrides.items()}
    return resolve(merged(tomllib.loads(TANK), nested(dotted)))


def fault(**overrides) -> str:
    return error_of(lambda: hung(**overrides))


def recorded(tmp_path, **overrides) -> dict:
    """Keys of a slide from a file."""
    (tmp_path / "slide.csv").write_text(RECORD)
    slide = {"file": str(tmp_path / "slide.csv"), "time_column": "t", "column": "place", "length_unit": "mm"}
    alone = {"axle__slide__amplitude": False, "axle__slide__period": False, "axle__slide__soft_start": "1 s"}
    return alone | {f"axle__slide__{key}": value for key, value in (slide | overrides).items()}


def test_the_solver_gets_the_axle_in_si():
    axle = hung().axle.solved
    assert (*axle.place, axle.inertia, axle.moment) == pytest.approx((0.0, 0.47, 26.9, -29.2))
    assert (axle.friction, axle.damping, axle.mass) == (0.54, 0.326, pytest.approx(4.978))
    assert axle.slide == Sway(0.1, 0.5)
    assert axle.share(0.062) == 1.0
    assert hung(axle__length="124 mm").axle.solved.share(0.062) == pytest.approx(2.0)


def test_a_slide_follows_any_two_columns_of_a_file(tmp_path):
    slide = hung(**recorded(tmp_path)).axle.solved.slide
    assert slide.time == (0.0, 1.0, 2.0, 3.0, 4.0)
    np.testing.assert_allclose(slide.values, [0.0, 0.01, 0.0, -0.01, 0.0])


def test_a_recording_gives_the_axle_back(tmp_path):
    for preset in (hung(), hung(**recorded(tmp_path))):
        assert resolved_from(to_table(preset)) == preset


def test_a_measured_series_is_read_where_it_is(tmp_path, monkeypatch):
    (tmp_path / "slide.csv").write_text(RECORD)
    changes = {"axle.slide.file": "$CARGOLAB_DATA/slide.csv", "axle.slide.time_column": "t", "run.duration": "3 s"}
    changes |= {"axle.slide.column": "place", "axle.slide.soft_start": "1 s"}
    monkeypatch.delenv("CARGOLAB_DATA", raising=False)
    assert "set CARGOLAB_DATA" in error_of(lambda: load("sloshing/roll-damper", changes))
    monkeypatch.setenv("CARGOLAB_DATA", str(tmp_path))
    assert load("sloshing/roll-damper", changes).resolved.axle.slide.file.columns["place"][1] == 10.0


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"motion__sway": {"amplitude": "1 mm", "frequency": "1 Hz"}}, "motion: a tank on an axle rolls by itself"),
        ({"ship": SHIP}, "axle: a ship carries her tank herself"),
        ({"axle__inertia": "0 kg m^2"}, "axle.inertia: must be greater than 0"),
        ({"axle__inertia": "3 kg"}, "axle.inertia:"),
        ({"axle__slide__period": False}, "axle.slide.period: missing; give amplitude and period, or a file."),
        ({"axle__slide__amplitude": False}, "axle.slide.amplitude: missing"),
        ({"water": WATER, "axle__heel": "5 deg"}, "axle.release: what is in the tank bears no sudden heel; give at"),
        ({"run__duration": False}, "run.duration: missing"),
        ({"water": WATER, "air": LATE}, "air.stiff_from: a tank on an axle answers to its load in steps of one length"),
    ],
)
def test_what_cannot_be_is_told_by_its_key(changes, says):
    assert fault(**changes).startswith(says)


def test_faults_of_a_slides_file_are_told_by_its_keys(tmp_path):
    assert "no column x; it has t, place, other" in fault(**recorded(tmp_path, column="x"))
    assert fault(**recorded(tmp_path, length_unit="s")).startswith("axle.slide.length_unit:")
    assert fault(**recorded(tmp_path, soft_start="0 s")).startswith("axle.slide.file: the mass starts at")
    late = recorded(tmp_path) | {"run__duration": "9 s"}
    assert "longer than the slide's record, 4 s, which ends with the mass at" in fault(**late)
    both = recorded(tmp_path) | {"axle__slide__amplitude": "1 mm"}
    assert fault(**both).startswith("axle.slide.amplitude: the mass slides as its file has it")


def test_explain_tells_both_periods():
    told = dict(described(hung(water=WATER)))
    assert told["natural period"].startswith("1.925 s")
    assert told["first sloshing period"].startswith("1.927 s")
    assert "none" in dict(described(hung(axle__moment="1 kg m")))["natural period"]
    assert "first sloshing period" not in dict(described(hung()))
