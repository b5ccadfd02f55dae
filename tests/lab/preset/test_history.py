"""Motion from a file: the tank follows the record; records that it cannot follow are refused."""

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.recorded import from_table, to_table
from lab.preset.sections import history
from lab.preset.sections.history import in_si
from lab.report.explain import explain
from lab.runs.runner import run_preset
from solvers.motion.rounded import last_digits
from tests.oracles.presets import MATERIAL, error_of

TANK = f"""
title = "a record"
[tank]
width = "40 mm"
height = "40 mm"
[grains]
diameter = "4 mm"
count = 20
{MATERIAL}
[contact]
stiffness_scale = 1e-3
"""
PRESET = (
    TANK
    + """
[motion.history]
file = "record.csv"
length_unit = "mm"
angle_unit = "deg"
"""
)
TIME = np.linspace(0.0, 0.6, 61)
WINDOW = np.sin(np.pi * TIME / 0.6) ** 2
SWAY, ROLL = 10.0 * WINDOW * np.sin(20.0 * TIME), 6.0 * WINDOW * np.sin(12.0 * TIME)  # mm, deg: at rest at both ends


def csv(folder, name="record.csv", **columns):
    names = ",".join(columns)
    np.savetxt(folder / name, np.column_stack(list(columns.values())), "%.17g", ",", header=names, comments="")
    return folder / name


@pytest.fixture
def preset(tmp_path):
    """A preset beside its record of sway and roll."""
    csv(tmp_path, time=TIME + 7.0, sway=SWAY, roll=ROLL)
    (tmp_path / "mine.toml").write_text(PRESET)
    return tmp_path / "mine.toml"


def fault(preset, **overrides) -> str:
    return error_of(load, preset, {key.replace("__", "."): value for key, value in overrides.items()})


def test_the_record_is_stored_in_si_with_the_preset(preset):
    loaded = load(preset)
    kept = loaded.resolved.motion.history.history
    assert kept.time == pytest.approx(TIME + 7.0, abs=1e-15)
    assert kept.sway == pytest.approx(1e-3 * SWAY, abs=1e-18)
    assert kept.roll == pytest.approx(np.radians(ROLL), abs=1e-16)
    assert kept.heave is None
    assert list(loaded.resolved.motion.parts) == ["history.roll", "history.sway"]
    assert 'file = "record.csv"' in loaded.given_text and str(preset.parent) not in loaded.given_text.split("\n", 1)[1]


def test_resolved_goes_to_json_and_back_to_the_last_bit(preset):
    resolved = load(preset).resolved
    (preset.parent / "record.csv").unlink()
    again = from_table(to_table(resolved))
    assert again == resolved
    assert again.motion.parts["history.sway"].parameters(0.0) == resolved.motion.parts["history.sway"].parameters(0.0)


def test_run_lasts_as_long_as_the_record_unless_given(preset):
    assert load(preset).resolved.duration == pytest.approx(0.6, abs=1e-12)
    assert load(preset, {"run.duration": "2 s"}).resolved.duration == 2.0


def test_history_can_be_removed_and_combined_with_other_motions(preset):
    sway = {"amplitude": "1 mm", "frequency": "2 Hz"}
    assert load(preset, {"motion.history": False, "run.duration": "1 s"}).resolved.motion.parts == {}
    both = load(preset, {"motion.sway": sway}).resolved.motion.parts
    assert list(both) == ["sway", "history.roll", "history.sway"]


@pytest.mark.slow
def test_a_run_moves_as_recorded_and_its_recording_needs_no_csv(preset, tmp_path, monkeypatch):
    monkeypatch.setenv("CARGOLAB_CACHE", str(tmp_path / "cache"))
    centre = (0.0, 0.1)
    overrides = {"motion.history.centre": ["0 mm", "100 mm"], "run.threads": 1}
    result = run_preset(preset, overrides, tmp_path / "out", video=False, quiet=True)
    (tmp_path / "record.csv").unlink()
    recording = result.recording
    time, pose = recording.series["time"], recording.series["pose"][:, 0]
    sway, roll = (CubicSpline(TIME, c, bc_type="clamped") for c in (1e-3 * SWAY, np.radians(ROLL)))
    assert time[-1] == pytest.approx(0.6)
    assert pose[:, 2] == pytest.approx(roll(time), abs=1e-14)
    assert pose[:, 0] == pytest.approx(sway(time) + centre[1] * np.sin(roll(time)), abs=1e-14)
    assert pose[:, 1] == pytest.approx(centre[1] * (1 - np.cos(roll(time))), abs=1e-14)
    rate = recording.series["pose_rate"][:, 0, 2]
    assert rate == pytest.approx(roll(time, 1), abs=1e-11)
    kept = recording.preset.motion.history.history
    assert kept.sway == pytest.approx(1e-3 * SWAY)
    assert result.measures and (result.folder / "shift.png").exists() and (result.folder / "summary.md").exists()


def test_paths_are_relative_to_their_preset(preset, tmp_path, monkeypatch):
    (tmp_path / "heirs").mkdir()
    heir = tmp_path / "heirs" / "heir.toml"
    heir.write_text('based_on = "../mine.toml"\n[run]\nseed = 2\n')
    assert load(heir).resolved.motion.history == load(preset).resolved.motion.history
    csv(tmp_path / "heirs", "own.csv", time=TIME, heave=SWAY)
    heir.write_text('based_on = "../mine.toml"\n[motion.history]\nfile = "own.csv"\n')
    assert list(load(heir).resolved.motion.parts) == ["history.heave"]
    # What a person types starts from where they stand.
    monkeypatch.chdir(tmp_path / "heirs")
    assert list(load("../mine.toml", {"motion.history.file": "own.csv"}).resolved.motion.parts) == ["history.heave"]
    assert "no.csv: cannot be read: No such file" in fault("../mine.toml", motion__history__file="no.csv")
    absolute = str(tmp_path / "heirs" / "own.csv")
    assert list(load(preset, {"motion": {"history": {"file": absolute}}}).resolved.motion.parts) == ["history.heave"]


@pytest.mark.parametrize(
    ("columns", "words"),
    [
        ({"time": TIME}, "nothing but times; a column sway, heave or roll is needed."),
        ({"time": TIME[:3], "sway": SWAY[:3]}, "from 4 to 100000 samples are possible (got 3)."),
        ({"time": TIME[::-1], "sway": SWAY}, "times must rise from row to row, but 0.59 s follows 0.6 s."),
        ({"time": [0, 1, 1, 2], "sway": [0, 1, 1, 0]}, "times must rise from row to row, but 1 s follows 1 s."),
        ({"time": TIME, "sway": SWAY + 3}, "sway starts at 3 mm, not at zero; let it come up by motion.soft_start"),
        ({"time": TIME, "roll": SWAY - 3}, "roll starts at -3 deg, not at zero; let it come up by motion.soft_start"),
        ({"time": TIME, "heave": np.sin(9 * TIME)}, "heave starts at 0.009 m/s, not at rest; let it come up by"),
        ({"time": TIME, "sway": 1e306 * SWAY}, "sway moves too fast to be followed; look at its numbers and units."),
        ({"time": TIME * 1e-300, "sway": SWAY}, "sway moves too fast to be followed"),
        ({"time": TIME / 6000, "sway": SWAY}, "sway moves too fast to be followed"),
        ({"time": [0, 1, 2, 3], "sway": [0, np.nan, 0, 0]}, "record.csv, line 3: sway must be a finite number"),
        ({"sway": SWAY}, "record.csv, line 1: the column time is missing."),
        ({"time": TIME, "tilt": SWAY}, 'record.csv, line 1: unknown column "tilt"; known here: time, sway, heave,'),
        ({"time": TIME, "pitch": ROLL}, "column pitch: a tank moves so in space alone; give tank.along"),
    ],
)
def test_invalid_records_are_refused(preset, tmp_path, columns, words):
    csv(tmp_path, **columns)
    sentence = fault(preset)
    assert sentence.startswith("motion.history.file: ") and words in sentence


@pytest.mark.parametrize(
    ("overrides", "sentence"),
    [
        ({"length_unit": "deg"}, 'motion.history.length_unit: "1 deg" is an angle, but mm (a length) is needed'),
        ({"angle_unit": "furlong"}, 'motion.history.angle_unit: "1 furlong" has an unknown unit'),
        ({"length_unit": ""}, 'motion.history.length_unit: "1 " has no unit'),
        ({"length_unit": "2 mm"}, 'motion.history.length_unit: "1 2 mm" cannot be read'),
        ({"file": 3}, "motion.history.file: a text in quotes is needed (got 3)."),
        ({"file": ""}, "motion.history.file: "),
        ({"fil": "x.csv"}, "motion.history.fil: unknown key; did you mean 'file'?"),
    ],
)
def test_errors_of_the_section_name_the_key(preset, overrides, sentence):
    assert fault(preset, **{f"motion__history__{key}": value for key, value in overrides.items()}).startswith(sentence)


def test_soft_start_permits_a_record_that_starts_in_motion(preset, tmp_path):
    csv(tmp_path, time=TIME, sway=5 + np.sin(9 * TIME))
    motion = load(preset, {"motion.soft_start": "0.2 s"}).resolved.motion.parts["history.sway"]
    assert motion.rests == (False, False)
    # It may then run as long as the record, but no longer.
    sentence = fault(preset, motion__soft_start="0.2 s", run__duration="0.7 s")
    assert sentence.startswith(
        "run.duration: 700 ms is longer than the motion's record, 600 ms, which ends with sway at"
    )
    assert load(preset, {"motion.soft_start": "0.2 s", "run.duration": "0.6 s"}).resolved.duration == 0.6


LOGGED = np.arange(0.0, 8.005, 0.01)
MOVED = 0.02 * np.sin(np.pi * LOGGED) * np.minimum(1.0, LOGGED) ** 2  # m: 20 mm at 0.5 Hz
LARGEST = 0.2872  # m/s², of this formula


def printed(folder, form="%.2f,%.3f", time=LOGGED, **columns):
    """A record as a logger prints it."""
    name, values = next(iter(columns.items()))
    rows = [form % row for row in zip(time, values, strict=True)]
    (folder / "record.csv").write_text("\n".join([f"time,{name}", *rows]) + "\n")


def logged(**units) -> dict:
    """Overrides of a preset whose history has these units and no others."""
    return {f"motion.history.{key}": units.get(key, False) for key in ("length_unit", "angle_unit", "time_unit")}


def untold(preset) -> str:
    return error_of(load, preset, logged())


@pytest.mark.parametrize("rate", [60.0, 100.0])
def test_a_record_of_few_digits_moves_the_tank_smoothly(preset, tmp_path, rate):
    """Printed to 1 mm and 10 ms; a spline through the digits has 6 · 1 mm/(10 ms)² = 60 m/s² at most.

    Two smooth curves that print alike differ by less than q, hence in their second derivative by some √(q d⁴x/dt⁴)
    (Landau & Kolmogorov), √(1 mm · 20 mm π⁴/s⁴) = 0.044 m/s²; three times as much is allowed.
    """
    time = np.arange(0.0, 8.0, 1.0 / rate)
    moved = np.interp(time, LOGGED, MOVED)
    printed(tmp_path, time=time, sway=moved)
    motion = load(preset, logged()).resolved.motion.parts["history.sway"]
    assert motion.hardest() == pytest.approx(LARGEST, abs=3 * 0.044)
    assert np.abs(np.subtract(motion.values, np.round(moved, 3))).max() <= 0.5001e-3
    assert np.diff(motion.time) == pytest.approx(1.0 / rate, rel=1e-3)


def test_explain_tells_the_largest_acceleration(preset, tmp_path):
    printed(tmp_path, sway=MOVED)
    loaded = load(preset, logged())
    hardest = loaded.resolved.motion.parts["history.sway"].hardest()
    assert f"and {hardest:.3g} m/s²" in explain(loaded)


def records(preset) -> list:
    """Every record of a preset: of its tank, its parts and the mass that slides on it."""
    slide = preset.axle and preset.axle.slide
    found = [preset.motion.history, *(part.history for part in preset.parts.values())]
    return [one for one in [*found, slide.record if slide and slide.file else None] if one]


SHIPPED = "sloshing/drop", "sloshing/impact", "sloshing/roll-damper"
SHIPPED += "validation/standing-wave", "validation/wave-flume", "validation/flap-flume"


def test_shipped_records_keep_their_motion_within_their_digits():
    tried = {name: record for name in SHIPPED for record in records(load(name).resolved)}
    assert len(tried) == 6
    for record in tried.values():
        length, angle = in_si(record.length_unit, "", "m"), in_si(record.angle_unit, "", "rad")
        for motion in record.history.motions.values():
            name, unit = {"turn": ("roll", angle), "y": ("sway", length), "z": ("heave", length)}[motion.coordinate]
            raw = np.array(record.file.columns[name])
            away = np.abs(np.array(motion.values) / unit - raw)
            assert (away <= 0.5001 * last_digits(raw) + 1e-15 * np.abs(raw).max()).all()


@pytest.mark.parametrize(
    ("columns", "form", "time", "key", "unit"),
    [
        ({"sway": 1e3 * MOVED}, "%.2f,%.2f", LOGGED, "length_unit", "mm"),
        ({"heave": 1e3 * MOVED}, "%.2f,%.2f", LOGGED, "length_unit", "mm"),
        ({"roll": 200.0 * MOVED}, "%.2f,%.2f", LOGGED, "angle_unit", "deg"),
        ({"sway": MOVED}, "%.0f,%.4f", 1e3 * LOGGED, "time_unit", "ms"),
        ({"sway": MOVED}, "%.0f,%.4f", 1e3 * LOGGED[::2], "time_unit", "ms"),
    ],
)
def test_a_record_in_other_units_is_asked_about(preset, tmp_path, columns, form, time, key, unit):
    name, values = next(iter(columns.items()))
    values = values[:: len(values) // len(time)][: len(time)]
    printed(tmp_path, form, time=time, **{name: values})
    sentence = untold(preset)
    assert sentence.startswith(f"motion.history.{key}: ") and f'{key} = "{unit}"' in sentence
    motion = load(preset, logged(**{key: unit})).resolved.motion.parts[f"history.{name}"]
    factor = {"mm": 1e-3, "deg": np.radians(1.0), "ms": 1.0}[unit]
    assert np.abs(np.array(motion.values) - factor * values).max() <= 0.011 * factor
    assert motion.duration() == pytest.approx(8.0)


def test_a_unit_that_is_said_is_believed(preset, tmp_path):
    printed(tmp_path, "%.2f,%.2f", roll=200.0 * MOVED)
    assert "history.roll" in load(preset, logged(angle_unit="rad")).resolved.motion.parts
    printed(tmp_path, "%.0f,%.4f", time=1e3 * LOGGED, sway=MOVED)
    assert load(preset, logged(time_unit="s")).resolved.duration == pytest.approx(8000.0)


def test_accelerations_that_no_tank_has_are_refused(preset, tmp_path):
    """Noise of 1 mm in 10 ms, to many digits, makes some 6 · 1 mm/(10 ms)² = 60 m/s²; of 30 mm more than 100 g."""
    noise = np.random.default_rng(1).standard_normal(len(LOGGED)) * np.minimum(1.0, LOGGED) ** 2
    printed(tmp_path, "%.2f,%.9f", sway=MOVED + 1e-3 * noise)
    assert load(preset, logged(length_unit="m")).resolved.motion.parts["history.sway"].hardest() < 400.0
    printed(tmp_path, "%.2f,%.9f", heave=MOVED + 0.03 * noise)
    sentence = error_of(load, preset, logged(length_unit="m"))
    assert "heave has accelerations of" in sentence and "length_unit and time_unit" in sentence


def test_the_name_of_a_file_stands_for_the_table(preset, tmp_path):
    printed(tmp_path, sway=MOVED)
    (tmp_path / "short.toml").write_text(TANK + '[motion]\nhistory = "record.csv"\n')
    (tmp_path / "long.toml").write_text(TANK + '[motion.history]\nfile = "record.csv"\n')
    short = load(tmp_path / "short.toml").resolved
    assert short.motion == load(tmp_path / "long.toml").resolved.motion
    assert list(short.motion.parts) == ["history.sway"]


def test_too_many_samples_are_refused(preset, tmp_path):
    (tmp_path / "record.csv").write_text("time,sway\n" + "0,0\n" * (history.MOST_SAMPLES + 1))
    assert "more than 100000 rows" in fault(preset)


NUMBERS = st.floats() | st.floats(-1, 1) | st.just(0.0)


@settings(max_examples=60, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.lists(st.tuples(NUMBERS, NUMBERS), min_size=1, max_size=8), st.booleans(), st.sampled_from(["0 s", "1 s"]))
def test_any_record_gives_a_preset_or_one_sentence(preset, rows, rising, soft):
    columns = np.array(sorted(rows) if rising else rows).T
    csv(preset.parent, time=columns[0], sway=columns[1])
    try:
        resolved = load(preset, {"motion.soft_start": soft}).resolved
    except LabError as error:
        assert "\n" not in str(error) and str(error)[-1] in ".?"
    else:
        motion = resolved.motion.parts["history.sway"]
        assert np.isfinite(motion.parameters(1.0)).all() and np.isfinite(motion.fastest(1.0))


def test_a_part_has_no_motion_along_x(preset, tmp_path):
    file = str(csv(tmp_path, "part.csv", time=TIME, yaw=ROLL))
    part = {"points": [["-5 mm", "5 mm"], ["5 mm", "5 mm"]], "history": {"file": file, "angle_unit": "deg"}}
    said = fault(preset, parts__gate=part)
    assert said == "parts.gate.history.file: a part has no yaw of its own; leave out that column."


def test_a_record_may_have_all_six_motions_in_space(preset, tmp_path):
    """In the order innermost first, in SI."""
    csv(tmp_path, time=TIME, sway=SWAY, heave=SWAY, surge=SWAY, roll=ROLL, pitch=ROLL, yaw=ROLL)
    motions = load(preset, {"tank.along": "40 mm"}).resolved.motion.history.history.motions
    assert list(motions) == ["roll", "pitch", "yaw", "sway", "heave", "surge"]
    assert [motion.coordinate for motion in motions.values()] == ["turn", "pitch", "yaw", "y", "z", "x"]
    assert np.abs(motions["pitch"].values).max() == pytest.approx(np.radians(np.abs(ROLL).max()), rel=1e-6)
