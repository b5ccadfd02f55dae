"""Motions of plug-ins: they move the tank as the lab's own do, are checked as keys are, and go on bit for bit."""

from pathlib import Path

import numpy as np
import pytest

import cargolab
from lab.plugins import loading
from lab.preset import fields
from lab.preset.recorded import _model, from_table, to_table
from lab.preset.sections.motion import Motion

MINE = """
import numpy as np
import cargolab
import taichi as ti
from dataclasses import dataclass
from typing import Annotated
from solvers.machine.marks import Unit

@cargolab.motion(moves="roll", unit="deg", parameters={"amplitude": "deg", "period": "s"})
def rocking(time, amplitude, period=0.5):
    "Rolling to and fro."
    return amplitude * np.sin(2.0 * np.pi * time / period)

@cargolab.motion(moves={"heave": "mm", "sway": "mm"}, parameters={"radius": "mm", "turn": "s"})
def circling(time, radius, turn):
    return radius * (1.0 - np.cos(2 * np.pi * time / turn)), radius * np.sin(2 * np.pi * time / turn)

@ti.func
def pushed(table: ti.template(), w, first, t):
    rise = table[w, first]
    return ti.Vector([0.5 * rise * t * t, rise * t, rise])

@cargolab.motion(name="push")
@dataclass(frozen=True)
class Push:
    "A push."
    acceleration: Annotated[float, Unit("m/s^2")]
    coordinate = "y"
    state = staticmethod(pushed)

    def duration(self):
        return 0.0

    def parameters(self, soft_start):
        return [self.acceleration]

    def fastest(self, soft_start):
        return self.acceleration
"""
STILL = {"motion.tilt": False, "motion.soft_start": "0.1 s", "run.duration": "0.3 s"}
TEN = {"motion.roll": {"amplitude": "10 deg", "frequency": "2 Hz"}}
MINE_TEN = {"motion.rocking": {"amplitude": "10 deg", "period": "0.5 s"}}


@pytest.fixture
def mine(tmp_path, monkeypatch):
    """A file with motions; what it registers is forgotten afterwards."""
    monkeypatch.delenv(loading.ALLOWED, raising=False)
    parts = ("__init__", "__repr__", "__eq__", "__hash__", "__match_args__", "__dataclass_fields__", "__annotations__")
    kept = {part: getattr(Motion, part) for part in parts} | {"__annotations__": dict(Motion.__annotations__)}
    known = [(one, set(one)) for one in (loading.hashes, loading._loaded)]
    path = tmp_path / "mine.py"
    path.write_text(MINE)
    yield path
    for part, value in kept.items():
        setattr(Motion, part, value)
    for registry, names in known:
        for name in set(registry) - names:
            del registry[name]
    for remembered in (fields.taken_of, fields.defaults_of, fields.walk, _model):
        remembered.cache_clear()


def loaded(mine: Path) -> dict[str, object]:
    """The key by which a preset names the file, which is loaded."""
    cargolab.plugin(mine)
    return {"plugins": [str(mine)], **STILL}


def test_a_function_moves_the_bed_as_the_labs_own_motion_does(mine, small, tmp_path):
    """To the error of the samples, 3e-9 m of 30 mm here; grains that touch make it grow to a micrometre at most."""
    preset = small.changed(loaded(mine))
    runs = {
        name: preset.changed(motion).run(tmp_path / name, video=False, plots=False, quiet=True).recording
        for name, motion in {"own": MINE_TEN, "lab": TEN}.items()
    }
    own, lab = runs["own"], runs["lab"]
    assert np.abs(own.series["pose"][..., 2]).max() > np.radians(9.0)
    np.testing.assert_allclose(own.series["pose"], lab.series["pose"], rtol=0.0, atol=1e-9)
    np.testing.assert_allclose(own.series["centre_of_mass"], lab.series["centre_of_mass"], rtol=0.0, atol=1e-6)
    assert own.versions["plug-in mine.py"] == loading.hashes["mine.py"]
    assert "rocking: amplitude 10 deg, period 500 ms" in (tmp_path / "own" / "summary.md").read_text()


def test_what_is_sampled_is_consistent_and_as_close_as_it_says(mine, small):
    motion = small.changed({**loaded(mine), **MINE_TEN}).values.motion.parts["rocking.roll"]
    time = np.linspace(0.0, 0.3, 4001)
    omega, amplitude = 4.0 * np.pi, np.radians(10.0)
    place, speed, bent = (motion.curve(time, order) for order in range(3))
    assert np.abs(place - amplitude * np.sin(omega * time)).max() <= motion.place_error < 1e-9
    np.testing.assert_allclose(speed, amplitude * omega * np.cos(omega * time), atol=1e-7)
    error = bent + amplitude * omega**2 * np.sin(omega * time)
    assert np.sqrt((error**2).mean() / (bent**2).mean()) <= motion.acceleration_error < 1e-3


def test_several_coordinates_go_by_one_function_innermost_first(mine, small):
    given = {"motion.circling": {"radius": "5 mm", "turn": "0.3 s"}}
    preset = small.changed({**loaded(mine), **given, **MINE_TEN, **TEN})
    assert list(preset.values.motion.parts) == ["roll", "circling.sway", "circling.heave", "rocking.roll"]
    heave = preset.values.motion.parts["circling.heave"]
    assert heave.curve(0.15) == pytest.approx(0.01, abs=1e-8) and heave.rests == (True, True)


@pytest.mark.slow
def test_a_class_like_the_labs_own_moves_the_tank_exactly(mine, small, tmp_path):
    preset = small.changed({**loaded(mine), "motion.push": {"acceleration": "0.5 m/s^2"}})
    recording = preset.run(tmp_path / "run", video=False, plots=False, quiet=True).recording
    time = recording.series["time"]
    np.testing.assert_allclose(recording.series["pose"][:, 0, 0], 0.25 * time**2, atol=1e-12)


def test_it_is_a_key_like_the_others(mine, small):
    preset = small.changed({**loaded(mine), "motion.rocking.amplitude": "10 deg"})
    assert preset["motion.rocking.amplitude"] == pytest.approx(np.radians(10.0))
    assert preset["motion.rocking.period"] == 0.5 and preset["motion.rocking.end"] == pytest.approx(0.3)
    assert preset.schema("motion.rocking.amplitude")["usual"] == "deg"
    said = preset.explain()
    assert "rocking.roll, up to" in said and "a function in 2049 samples, off by up to" in said
    assert from_table(to_table(preset.values)) == preset.values
    assert "rocking" in preset.schema()["properties"]["motion"]["anyOf"][0]["properties"]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"amplitud": "10 deg"}, r"motion\.rocking\.amplitud: unknown key; did you mean 'amplitude'"),
        ({"amplitude": "10 mm"}, r'motion\.rocking\.amplitude: "10 mm" is a length, but deg \(an angle\) is needed'),
        ({"period": "1 s"}, r"motion\.rocking\.amplitude: missing; an angle is needed"),
        ({"amplitude": "10 deg", "period": "0 s"}, r"motion\.rocking: mine\.py: ZeroDivisionError"),
        ({"amplitude": "10 deg", "period": "1 ms"}, r"its roll has speeds up to .* no tank is shaken so"),
        ({"amplitude": "10 deg", "end": "0.1 s"}, r"run\.duration: .* ends with roll at .*, not at rest"),
    ],
)
def test_a_wrong_value_is_told_in_one_sentence(mine, small, given, said):
    preset = small.changed(loaded(mine))
    with pytest.raises(cargolab.Error, match=said) as refused:
        preset.changed({"motion.rocking": given})
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("returned", "said"),
    [
        ("1 / 0", r"motion\.bad: .*ZeroDivisionError: division by zero\."),
        ("float('nan')", r"motion\.bad: .*it returned nan at 0 s, which is no finite number"),
        ("(1.0, 2.0)", r"motion\.bad: .*it returned 2 numbers, not one for each of roll"),
        ("'far'", r"motion\.bad: .*could not convert string"),
        ("0.1 * (time > 0.2)", r"motion\.bad: .*its place jumps at about 0\.2 s, and no tank is moved so"),
        ("max(time - 0.2, 0.0)", r"motion\.bad: .*its speed jumps at about 0\.2 s, and no tank is moved so"),
        ("0.1 + time * time", r"motion\.bad: roll starts at 5\.73 deg, not at zero; let it come up by motion\.soft"),
        ("next(count) * 1e-3", r"motion\.bad: .*it returned two places at 0 s"),
    ],
)
def test_a_function_that_is_no_motion_is_told_in_one_sentence(mine, small, returned, said):
    mine.write_text(f"""
import cargolab, itertools
count = itertools.count()

@cargolab.motion
def bad(time):
    return {returned}
""")
    still = {**loaded(mine), "motion.soft_start": "0 s"}
    with pytest.raises(cargolab.Error, match=said) as refused:
        small.changed({**still, "motion.bad": {}})
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("head", "said"),
    [
        ("@cargolab.motion(moves='rol')\ndef m(time): ...", r"moves: 'rol' is unknown; choose from roll, pitch"),
        ("@cargolab.motion(unit='mm')\ndef m(time): ...", r"motion m: unit: .* is a length"),
        ("@cargolab.motion\ndef m(time, a): ...", r"its function must take time; name in parameters what it takes"),
        ("@cargolab.motion(parameters={'a': 'x'})\ndef m(time, a): ...", r"m: a: the unit 'x' is unknown"),
        ("@cargolab.motion(parameters={'end': 's'})\ndef m(time, end): ...", r"'end' is no name for a parameter"),
        ("@cargolab.motion\ndef tilt(time): ...", r"motion: 'tilt' is no name, or one of the lab's"),
        ("@cargolab.motion(name='m')\nclass M: ...", r"motion m: its class has no coordinate; the page on extending"),
    ],
)
def test_a_declaration_that_is_none_is_told_in_one_sentence(mine, head, said):
    mine.write_text(f"import cargolab\n{head}\n")
    with pytest.raises(cargolab.Error, match=said) as refused:
        cargolab.plugin(mine)
    assert "\n" not in str(refused.value)


def test_motions_of_space_are_refused_in_the_plane(mine, small):
    mine.write_text("import cargolab\n@cargolab.motion(moves='yaw')\ndef turning(time): return 0.1 * time**2\n")
    with pytest.raises(cargolab.Error, match=r"motion\.turning: a tank moves so in space alone; give tank\.along"):
        small.changed({**loaded(mine), "motion.turning": {}})


@pytest.mark.slow
def test_a_run_goes_on_bit_for_bit_and_not_without_its_plugin(mine, small, tmp_path):
    preset = small.changed({**loaded(mine), **MINE_TEN, "motion.tilt": False})
    whole = preset.run(tmp_path / "whole", video=False, plots=False, quiet=True).recording
    with cargolab.Simulation(preset, tmp_path / "parts", quiet=True) as first:
        first.run("0.1 s")
    with cargolab.Simulation.resume(tmp_path / "parts", quiet=True) as second:
        second.run()
    parts = cargolab.open(tmp_path / "parts")
    for name in ("pose", "centre_of_mass"):
        assert np.array_equal(whole.series[name], parts.series[name])
    table = to_table(preset.values) | {"plugins": []}
    table["motion"]["elsewhere"] = table["motion"].pop("rocking")
    with pytest.raises(cargolab.Error, match=r"motion\.elsewhere: is of a plug-in that is not loaded"):
        from_table(table)


@pytest.mark.slow
def test_a_sweep_varies_its_parameter(mine, small, tmp_path):
    preset = small.changed({**loaded(mine), **MINE_TEN})
    sizes = {"motion.rocking.amplitude": "5 deg, 10 deg"}
    result = preset.sweep(sizes, tmp_path / "sweep", video=False, plots=False, quiet=True)
    folders = {path.parent for path in (tmp_path / "sweep").rglob("recording.h5")}
    rolls = sorted(np.abs(cargolab.open(at).series["pose"][..., 2]).max() for at in folders)
    assert len(result.rows) == len(rolls) == 2 and rolls[1] == pytest.approx(2.0 * rolls[0], rel=1e-6)
