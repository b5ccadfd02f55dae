import json

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures import measure_all
from lab.measures.value import Value
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.recording import open_recording
from lab.report.summary import headlines, terminal_summary, write_summary
from tests.oracles.synthetic import DEPTH, preset, record, recorder, sample


def tilt_run(folder, worlds=2, **options):
    """A recording of a tilt to 40 deg and back in which the bed steps at 21 deg."""
    tilt = np.concatenate([np.linspace(0, 40, 801), np.linspace(40, 0, 801)])
    pose = np.zeros((len(tilt), 3))
    pose[:, 2] = np.radians(tilt)
    centre = np.zeros((len(tilt), worlds, 2))
    step = 0.004 * np.clip((tilt - 21) / 0.3, 0, 1)
    centre[:, :, 0] = -np.maximum.accumulate(step)[:, None]
    centre[:, :, 1] = DEPTH / 2
    motion = {"tilt": {"rate": np.radians(4), "angle": np.radians(40), "hold": 0.0}}
    options = {"resolved": preset(**motion), **options}
    kinetic = np.where((tilt > 21) & (tilt < 22), 1e-6, 1e-12)[:, None] * np.ones(worlds)
    time = np.linspace(0, 20, len(tilt))
    record(folder, time, pose=pose, centre=centre, kinetic=kinetic, **options)
    return folder


def sway_run(folder):
    """A recording of a tank that sways, its bed answering."""
    time = np.linspace(0, 8, 801)
    angle = 2 * np.pi * 1.5 * time
    pose = np.zeros((len(time), 3))
    pose[:, 0] = 0.04 * np.sin(angle)
    centre = np.stack([-0.004 * np.sin(angle), 0.0005 * np.sin(2 * angle)], axis=1)[:, None]
    kinetic = 1e-6 * np.cos(angle)[:, None] ** 2
    motion = {"sway": {"amplitude": 0.04, "frequency": 1.5, "phase": 0.0}}
    record(folder, time, pose=pose, centre=centre, kinetic=kinetic, resolved=preset(**motion))
    return folder


def summed_up(folder, **options):
    """Page, data and terminal text of a recording."""
    with open_recording(folder) as recording:
        values = measure_all(recording)
        files = {"recording": recording.path, "shift": folder / "pictures" / "shift.png"}
        written = write_summary(recording, values, files, folder, **options)
        text = terminal_summary(recording, values, files, **options)
    page = written["summary"].read_text(encoding="utf-8")
    return page, json.loads(written["summary_json"].read_text()), text


def test_the_data_have_the_promised_form(tmp_path):
    _, data, _ = summed_up(tilt_run(tmp_path))
    assert data["preset"] == "tilting/acetate"
    assert data["status"] == "complete"
    assert data["cost"] == {
        "wall_s": 12.5,
        "grain_steps": 25_000_000,
        "grain_steps_per_s": 2_000_000,
        "dt_s": 1e-5,
    }
    angle = data["measures"]["critical_angle"]
    assert angle["value"] == pytest.approx(21.0, abs=0.1)
    assert (angle["unit"], angle["std"], angle["n"], angle["standard_error"]) == ("deg", 0.0, 2, 0.0)
    assert angle["interval_95"] == [angle["value"]] * 2
    assert angle["uncertainty"] > 0.0 and angle["uncertainty_kind"] == "detector"
    assert len(angle["worlds"]) == 2
    assert Value.from_json(angle).as_json() == angle
    assert data["files"] == {"recording": "recording.h5", "shift": "pictures/shift.png"}


def test_the_page_begins_with_the_main_number(tmp_path):
    page, _, _ = summed_up(tilt_run(tmp_path, worlds=1))
    lines = page.splitlines()
    assert lines[0] == "# Acetate grains in a tank"
    assert lines[2].startswith("- critical angle: **21.0")
    assert lines[2].endswith(" deg)**") and "(1 bed; detector 0." in lines[2]
    for part in (
        "is complete.",
        "![shift](pictures/shift.png)",
        "- 1 bed of 4 grains, 3 mm in diameter",
        "- tank 180 mm wide and 150 mm high",
        "- tilt: rate 4 deg/s, angle 40 deg",
        "Spandonidis 2016, 5.4\n\n24 deg",
        "2.0 million a second, time step 10 µs",
        "[recording](recording.h5)",
        'title = "Acetate grains in a tank"',
    ):
        assert part in page
    assert "Warning" not in page


def test_one_bed_has_no_plus_minus_anywhere(tmp_path):
    """What a measure knows of its own uncertainty does not stand in for the scatter of beds."""
    page, data, text = summed_up(tilt_run(tmp_path, worlds=1))
    told = page.partition("± is the standard deviation over beds")[0]  # the rule itself
    assert "±" not in told and "±" not in text
    assert "| critical angle |" in told and " | 1 | detector 0." in told
    angle = data["measures"]["critical_angle"]
    assert angle["n"] == 1 and (angle["std"], angle["standard_error"], angle["interval_95"]) == (None, None, None)


def test_warnings_appear_in_all_outputs(tmp_path):
    resolved = preset(tilt={"rate": 0.07, "angle": 0.7})
    resolved["contact"]["stiffness_scale"] = 1e-3
    folder = tilt_run(tmp_path, resolved=resolved, status="stopped: Grain 7 left the hold.")
    said = ["The grains still moved."]
    for text in summed_up(folder, warnings=said)[::2]:
        assert "The grains still moved." in text
        assert "Young's moduli times 0.001, set by contact.stiffness_scale." in text
        assert "stopped: Grain 7 left the hold; the numbers cover what was recorded" in text


def test_the_softness_of_a_quick_variant_is_reported_once(tmp_path):
    """The variants' own words on what differs leave it to the warning, which says what the run was made with."""
    loaded = load("tilting/acetate-quick")
    page, _, _ = summed_up(tilt_run(tmp_path, resolved=to_table(loaded.resolved)))
    said = [line for line in page.splitlines() if "stiff" in line or "softer" in line]
    assert said == [
        "**Warning:** The grains are softer than their material: Young's moduli times 0.001, "
        'set by run.accuracy = "draft".'
    ]


@pytest.mark.parametrize(
    ("machine", "said"),
    [
        ({"arch": "cpu", "threads": 1, "cores": 2}, ", on 1 of 2 cores, "),
        ({"arch": "cpu", "threads": 1, "cores": 1}, ", on 1 of 1 core, "),
        ({"arch": "cuda", "cores": 2}, ", on a graphics processor (cuda), "),
        ({"cores": 2}, ", on a machine of 2 cores, "),
    ],
)
def test_the_page_names_the_device(tmp_path, machine, said):
    page, _, _ = summed_up(tilt_run(tmp_path, machine=machine))
    assert said in page


def test_the_page_names_the_base_of_a_preset(tmp_path):
    page, data, _ = summed_up(
        tilt_run(tmp_path, resolved=preset(tilt={"rate": 0.07, "angle": 0.7}) | {"based_on": "tilting/acetate"})
    )
    assert "- based on the preset `tilting/acetate`, whose source and reports are its own" in page
    assert data["based_on"] == "tilting/acetate"


def test_a_missing_number_is_explained_in_words(tmp_path):
    tilt = np.linspace(0, 30, 301)
    pose = np.zeros((301, 3))
    pose[:, 2] = np.radians(tilt)
    resolved = preset(tilt={"rate": 0.07, "angle": 0.5})
    record(tmp_path, tilt / 4, pose=pose, centre=np.full((301, 1, 2), 0.03), resolved=resolved)
    page, data, text = summed_up(tmp_path)
    assert data["measures"]["critical_angle"]["value"] is None
    for shown in (page, text):
        assert "the bed does not flow up to 30 deg" in shown


def test_the_terminal_shows_numbers_cost_and_files(tmp_path):
    _, _, text = summed_up(sway_run(tmp_path))
    assert text.splitlines()[0] == "Acetate grains in a tank (tilting/acetate): complete"
    assert "response amplitude" in text
    assert "4 mm" in text
    assert "180" in text
    assert "recording.h5" in text
    assert "million a second" in text


def test_a_run_stopped_before_its_first_sample_has_a_summary(tmp_path):
    recorder(tmp_path).close("stopped: interrupted by the user")
    page, data, text = summed_up(tmp_path)
    assert data["measures"] == {}
    assert "interrupted by the user" in page
    assert "interrupted by the user" in text


def test_headline_numbers_come_first_and_the_terminal_shows_no_others(tmp_path):
    rest = {f"number_{k}": Value(float(k), "mm") for k in range(20)}
    told = headlines({**rest, "response_amplitude": Value(1.0, "mm"), "spilled_fraction": Value(2.0, "%")}, 3)
    assert list(told) == ["spilled_fraction", "response_amplitude", "number_0"]
    of_a_ship = dict.fromkeys(("final_shift", "contact_number", "largest_roll", "capsized_at"), Value(1.0, "1"))
    assert list(headlines(of_a_ship, 2)) == ["capsized_at", "largest_roll"]
    _, data, text = summed_up(sway_run(tmp_path))
    assert text.count("\n  ") < 12 < len(data["measures"])
    assert f"and {len(data['measures']) - 6} more numbers in the summary" in text


def test_the_page_describes_special_features_of_the_tank(tmp_path):
    scene = {"open_edges": (2,), "fixed": np.array([(0.0, 0.0, 1e-3)]), "parts": {"gate": np.zeros((2, 2))}}
    writer = recorder(tmp_path, **scene)
    writer.sample(sample(0.0))
    writer.close()
    page, _, _ = summed_up(tmp_path)
    assert "150 mm high, open at the top, its walls lined with fixed grains" in page
    assert "moving parts: gate" in page


def test_a_lost_folder_is_named(tmp_path):
    with open_recording(sway_run(tmp_path)) as recording:  # noqa: SIM117
        with pytest.raises(LabError, match="nowhere"):
            write_summary(recording, {}, {}, tmp_path / "nowhere")
