"""The report on the source's experiments: every batch can be run, results are read as they are, nothing runs twice."""

import json
import re
import signal
import subprocess
import sys
import time
import tomllib
from dataclasses import asdict
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from pydantic import TypeAdapter

import lab
from lab.assembly.scene import build
from lab.base.data import data_file
from lab.base.errors import LabError
from lab.measures import critical_angle
from lab.measures.value import over_worlds
from lab.preset.find import load
from lab.report.kept import Made
from lab.studies import reproduce as package
from lab.studies.reproduce import experiments, registry, report, reproduce, runs, workers
from lab.studies.reproduce.cached import CachedResult, asked, read_cached
from lab.studies.reproduce.claims import FOLDER, read, reports
from lab.studies.reproduce.estimates import Verdict, surely
from lab.studies.reproduce.experiment import EXACT, Experiment, ReportSection, Row, Tolerance, counted, observed, stated
from lab.studies.reproduce.grains import beds, outlines
from lab.studies.reproduce.report import write_report
from lab.studies.reproduce.runs import Batch, Outcome
from lab.sweeps.grid import define_sweep
from solvers.machine import runtime

ROOT = Path(lab.__file__).parents[1]
SMALL = {
    "tank.width": "30 mm",
    "tank.height": "30 mm",
    "grains.count": 25,
    "motion.tilt.angle": "15 deg",
    "motion.tilt.rate": "60 deg/s",
    "run.repeats": 2,
    "run.accuracy": "draft",
}


def outcome(setting=None, **measures) -> Outcome:
    """A run that gave these values."""
    return Outcome(setting or {}, None, "complete", measures, {"wall_s": 1.0, "grain_steps": 1e6})


EXPERIMENTS = {name: one for part in reports() for name, one in experiments(part).items()}
# The scenes of others, with so many particles or panels that they take seconds
FINE = (
    "dam-break-air",
    "impact-air-fine",
    "impact-air-finest",
    "prismatic-cost",
    "prismatic-air-cost",
    "anti-roll-s175",
)
FINE += ("section-test", "section-terms", "square", "cylinder")


@pytest.mark.usefixtures("roughly_packed")
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.slow) if name in FINE else name for name in EXPERIMENTS]
)
def test_every_batch_of_every_experiment_can_be_built(name):
    if EXPERIMENTS[name].needs and not data_file(EXPERIMENTS[name].needs):
        pytest.skip(f"{name} needs {EXPERIMENTS[name].needs}; see CARGOLAB_DATA")
    shown, quick_ones = EXPERIMENTS[name].shown[0], EXPERIMENTS[name].batches(True)
    for quick in (True, False):
        for batch in EXPERIMENTS[name].batches(quick).values():
            points = (
                define_sweep(batch.preset, batch.axes, batch.changes).points
                if batch.axes
                else [load(batch.preset, {**batch.changes, "run.repeats": 1})]
            )
            assert points[0].resolved.run.accuracy in ("draft", "standard")
    assert shown in (quick_ones or EXPERIMENTS[name].batches(False))  # some have none
    one = load(batch.preset, {**batch.changes, "run.repeats": 1}).resolved
    assert build(one)[0].step > 0.0


@pytest.mark.slow
def test_a_report_has_the_results_and_nothing_is_run_twice(tmp_path, monkeypatch):
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)  # all in this process

    def tell(found):
        numbers = [one["contact_number_start"] for one in found["rates"]]
        return ReportSection([observed("contacts", "none", ", ".join(map(counted, numbers)), None)])

    batches = {
        "one": Batch("tilting/quick", SMALL),
        "rates": Batch("tilting/quick", SMALL, {"motion.tilt.rate": ["60 deg/s", "90 deg/s"]}),
    }
    tried = Experiment(
        "tried", "A trial", "0.0", "nothing.", lambda quick: batches, tell, "much", ("one", 1.0), "As it is."
    )
    monkeypatch.setattr(package, "experiments", lambda _: {"tried": tried})
    text = reproduce("granular", ["tri"], tmp_path, quick=True, quiet=True).read_text()
    assert "## A trial" in text and "Quick: much" in text and "As it is." in text
    assert "(2 beds)" in text and "granular-quick-tried-picture.png" in text
    assert (tmp_path / "granular-quick-tried-picture.png").stat().st_size > 5000
    for name in ("run_preset", "resume_run"):
        monkeypatch.setattr(runs, name, None)
    assert reproduce("granular", [], tmp_path, quick=True, quiet=True).read_text() == text
    point = tmp_path / "quick" / "tried" / "rates" / "points" / "001" / "summary.json"
    point.rename(point.with_suffix(".kept"))
    (tmp_path / "granular-quick.json").unlink()
    folders = package.places({"tried": tried}, tmp_path / "quick", True)
    half = write_report("granular", {"tried": tried}, folders, tmp_path, True).read_text()
    assert "| A trial | 0.0 | not run |" in half
    point.with_suffix(".kept").rename(point)
    said, resumed = "stopped: interrupted by the user", []
    summary = tmp_path / "quick" / "tried" / "one" / "summary.json"
    with h5py.File(summary.with_name("recording.h5"), "r+") as file:
        file.attrs["status"] = said
    summary.write_text(json.dumps(json.loads(summary.read_text()) | {"status": said}))
    monkeypatch.setattr(runs, "resume_run", lambda folder, **_: resumed.append(folder))
    told = reproduce("granular", [], tmp_path, quick=True, quiet=True).read_text()
    assert "**Not complete** (one): stopped" in told
    assert resumed == [summary.parent]
    (tmp_path / "quick").rename(tmp_path / "removed")  # what was told of them stays
    assert reproduce("granular", [], tmp_path, quick=True, quiet=True).read_text() == told
    (tmp_path / "removed").rename(tmp_path / "quick")
    monkeypatch.setitem(batches, "one", Batch("tilting/quick", {**SMALL, "run.seed": 2}))
    with pytest.raises(LabError, match=r"another run than this experiment asks for, with another run\.seed"):
        reproduce("granular", [], tmp_path, quick=True, quiet=True)
    assert "| A trial | 0.0 | not run |" in (tmp_path / "granular-quick.md").read_text()


@pytest.mark.slow
def test_batches_run_side_by_side_stop_and_go_on(tmp_path):
    """By Ctrl-C to the process that gives out the work, as by a person; workers save what they have, and none stays."""
    ask_for = [sys.executable, "-m", "lab", "reproduce", "granular", "stack", "swelling", "--quick", "--out", tmp_path]
    process = subprocess.Popen(ask_for, stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
    begun = [tmp_path / "quick" / name / "checkpoint.npz" for name in ("stack-fall/stack", "swelling/shaken")]
    deadline = time.monotonic() + 300.0
    while not all(path.exists() for path in begun) and time.monotonic() < deadline:
        time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    assert process.wait(60.0) != 0
    before = [h5py.File(path.with_name("recording.h5"))["series/time"].shape[0] for path in begun]
    assert min(before) > 0
    subprocess.run(ask_for, check=True, capture_output=True, timeout=300.0)
    text = (tmp_path / "granular-quick.md").read_text()
    assert "## Guided fall" in text and "## Swelling" in text and "Not complete" not in text


IDLE = """
import os, signal, time
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import active_children, get_context
from lab.studies.reproduce import workers

def who(_):
    time.sleep(0.2)
    return os.getpid()

if __name__ == "__main__":
    with ProcessPoolExecutor(2, get_context("spawn"), workers._begin) as pool:
        while len(set(pool.map(who, range(4)))) < 2:  # until both have begun
            pass
        for child in active_children():
            os.kill(child.pid, signal.SIGINT)
        stopped = pool.submit(workers._work, None, None)
        print(type(stopped.exception()).__name__, len(active_children()))
"""


@pytest.mark.slow
def test_a_worker_without_work_is_asked_to_stop_and_says_nothing(tmp_path):
    """It takes no work after it, and leaves when the others do; it once said a traceback on Ctrl-C."""
    script = tmp_path / "idle.py"
    script.write_text(IDLE)
    ended = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120.0)
    assert ended.stdout.split() == ["KeyboardInterrupt", "2"]
    assert "Traceback" not in ended.stderr and ended.returncode == 0


def test_shared_runs_of_two_experiments_are_run_once(tmp_path, monkeypatch):
    ran = []
    monkeypatch.setattr(workers, "carry_out", lambda batch, folder, quiet: ran.append(folder.relative_to(tmp_path)))
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    reproduce("granular", ["tilt-surface", "tilt-low-walls"], tmp_path, quick=False, quiet=True)
    assert len(ran) == len(set(ran)) == 4
    shared = tmp_path / "full" / "tilt-surface" / "slightly disturbed"
    assert package.places(experiments("granular"), tmp_path / "full", False)["tilt-low-walls"]["high walls"] == shared


def test_what_has_no_quick_runs_is_left_out_of_them_and_refused_by_its_name(tmp_path, monkeypatch):
    ran = []
    monkeypatch.setattr(workers, "carry_out", lambda batch, folder, quiet: ran.append(folder.parent.name))
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    text = reproduce("water", ["prismatic-f", "prismatic-sw"], tmp_path, quick=True, quiet=True).read_text()
    assert set(ran) == {"prismatic-sway"} and "not among the quick ones" in text
    with pytest.raises(LabError, match="prismatic-fine: has no quick runs"):
        reproduce("water", ["prismatic-fine"], tmp_path, quick=True, quiet=True)


def test_missing_runs_are_reported(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "carry_out", lambda *_: None)
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    text = reproduce("granular", ["stack"], tmp_path, quick=False, quiet=True).read_text()
    assert text.count("| not run |") == len(experiments("granular"))
    monkeypatch.setattr(workers, "carry_out", None)  # nothing is run for a page alone
    assert reproduce("granular", [], tmp_path, quick=False, quiet=True, page_only=True).read_text() == text
    with pytest.raises(LabError, match="there is no experiment tilt-x; there are stack-fall, "):
        reproduce("granular", ["tilt-x"], tmp_path, quick=False)


BY_EYE = Tolerance(3.0, "read off a picture")


def test_a_number_agrees_where_its_interval_lies_within_the_tolerance():
    """Mean 21 of four beds, standard error 0.41: ± 1.3 deg at 95 %."""
    value = over_worlds([20.0, 22.0, 21.0, 21.0], "deg")
    row = stated("angle", 20.0, value, BY_EYE)
    assert row.verdict is Verdict.AGREES and row.ours == "21.00 ± 0.82 deg (4 beds)"
    assert row.apart == "+1, [-0.3, 2.3] deg (95 %)" and row.tolerance == "3 deg: read off a picture"
    assert stated("angle", 10.0, value, BY_EYE).verdict is Verdict.DIFFERS
    assert stated("angle", 18.5, value, BY_EYE).verdict is Verdict.CANNOT_TELL


def test_an_agreeing_mean_is_undecided_if_beds_scatter_widely_or_there_is_one():
    """Right by chance: 21 beside 21, from beds of 10 to 32 deg, or from one bed with however small an own error."""
    wide = over_worlds([10.0, 32.0, 15.0, 27.0], "deg")
    one = over_worlds([21.0], "deg", uncertainties=[0.01], kind="detector")
    for value in (wide, one, over_worlds([np.nan], "deg"), None):
        assert stated("angle", 21.0, value, BY_EYE).verdict is Verdict.CANNOT_TELL
    assert "±" not in stated("angle", 21.0, one, BY_EYE).ours


def test_values_without_scatter_are_judged_directly():
    """36 beside 5.9 deg is a difference, whatever else agrees."""
    row = stated("frozen", 36.0, over_worlds([5.9], "deg"), BY_EYE, exact=True)
    assert row.verdict is Verdict.DIFFERS and row.ours == "5.9 deg" and row.apart == "-30.1 deg"
    assert stated("frozen", 6.0, over_worlds([5.9], "deg"), BY_EYE, exact=True).verdict is Verdict.AGREES


def test_a_report_counts_its_verdicts_and_shows_each_with_its_tolerance(tmp_path):
    beds = {"near": [20.0, 22.0, 21.0, 21.0], "far": [30.0, 31.0, 30.0, 31.0], "wide": [10.0, 32.0, 15.0, 27.0]}
    rows = [stated(name, 20.0, over_worlds(angles, "deg"), BY_EYE) for name, angles in beds.items()]
    rows = [row.against(kind) for row, kind in zip(rows, ("measured", "measured", "sign"), strict=True)]
    rows = [*rows, observed("seen", "", "this", None).against("measured")]
    finding = CachedResult("asked", rows, (), 1.0, 1.0, "", "", Made("0.1.0"))
    tried = Experiment(
        "tried", "A trial", "0.0", "20 deg.", lambda quick: {}, lambda found: ReportSection([]), "much", ("", 1.0)
    )
    text = report.write_page("granular", {"tried": tried}, {"tried": finding}, tmp_path, quick=False).read_text()
    assert "Of 3 statements held against the source 1 agree, 1 differ, and of 1 these beds cannot tell." in text
    assert "| measured | 1 | 1 | 0 |" in text and "| sign | 0 | 0 | 1 |" in text  # what has no verdict does not count
    assert "| A trial | 0.0 | 1 | 1 | 1 |" in text
    for name, verdict in (
        ("near", "measured | agrees"),
        ("far", "measured | **differs**"),
        ("wide", "sign | cannot tell"),
    ):
        line = next(line for line in text.splitlines() if line.startswith(f"| {name} |"))
        assert line.endswith(f"| 3 deg: read off a picture | {verdict} |") and "(95 %)" in line


def test_the_page_begins_with_what_differs_most_and_its_explanation_follows_it(tmp_path):
    beds = {"good": [20.0, 20.1, 19.9, 20.0], "bad": [30.0, 31.0, 30.0, 31.0]}
    tried, findings = {}, {}
    for name, angles in beds.items():
        row = stated("angle", 20.0, over_worlds(angles, "deg"), BY_EYE)
        findings[name] = CachedResult("asked", [row], (), 1.0, 1.0, "", "", Made("0.1.0"))
        words = f"Title of {name}", "0.0", "20 deg."
        tried[name] = Experiment(
            name, *words, lambda quick: {}, lambda found: ReportSection([]), "much", ("", 1.0), "Softer.", "How soft?"
        )
    text = report.write_page("granular", tried, findings, tmp_path, quick=False).read_text()
    assert text.index("| Title of bad |") < text.index("| Title of good |")
    differs = text.index("**differs**")
    assert text.index("## Title of bad") < differs < text.index("Softer.") < text.index("**Open question:** How soft?")
    assert text.index("How soft?") < text.index("## Title of good")
    assert "version 0.1.0" in text


def kept_results(report_name: str) -> dict:
    """What the gallery keeps of a report, of its quick runs if there are no others; nothing if it has none yet."""
    folder = ROOT / "renders" / "gallery" / report_name
    kept = [path for path in (folder / f"{report_name}{part}.json" for part in ("", "-quick")) if path.exists()]
    return json.loads(kept[0].read_text()) if kept else {}


def test_what_differs_has_its_explanation_or_an_open_question_beside_it():
    found = {name: one["rows"] for part in reports() for name, one in kept_results(part).items()}
    differs = [name for name, rows in found.items() if any(row["verdict"] == "differs" for row in rows)]
    assert differs
    for name in differs:
        assert EXPERIMENTS[name].why or EXPERIMENTS[name].question, name


CLAIMS = """
tolerance.bed = { within = 2.0, origin = "by eye" }

[[experiment]]
name = "trial"
title = "A trial"
section = "1"
kind = "measured"
states = "A at 20 and B at 30 deg, later than A."
lost = "nothing"
shown = { run = "A", at = 0.5 }

[experiment.runs]
A = { preset = "tilting/quick", full = { "run.repeats" = 4 }, quick = { "run.repeats" = 2 } }
B = { preset = "tilting/quick", only = "full", axes = { "material.friction" = [0.3, 0.5] } }

[[experiment.rows]]
says = "{each} slides"
each = ["A", "B"]
of = "critical_angle"
runs = "{each}"
at = { B = "0.5" }
compare = "value"
value = { A = 20.0, B = 30.0 }
within = "bed"

[[experiment.rows]]
says = "later"
of = "critical_angle"
runs = ["B", "A"]
at = ["0.3", ""]
kind = "sign"
compare = "fall"
tolerance = "each step above zero"
"""


def test_a_claim_in_a_file_is_run_and_judged_by_its_number_and_tolerance():
    """Two runs, one of the full report alone, on a grid of which each row takes its point."""
    trial = read(CLAIMS)["trial"]
    assert trial.batches(True) == {"A": Batch("tilting/quick", {"run.repeats": 2})}
    assert trial.batches(False)["B"] == Batch("tilting/quick", {}, {"material.friction": [0.3, 0.5]})
    slides = {"A": [[20.0, 20.1, 19.9, 20.0]], "B": [[25.0, 25.1, 24.9, 25.0], [20.0, 20.2, 20.1, 20.1]]}
    found = {
        run: [
            outcome({"material.friction": mu} if run == "B" else {}, critical_angle=over_worlds(angles, "deg"))
            for mu, angles in zip((0.3, 0.5), beds, strict=False)
        ]
        for run, beds in slides.items()
    }
    rows = {row.quantity: row for row in trial.report(found).rows}
    assert [rows[name].verdict for name in ("A slides", "B slides", "later")] == ["agrees", "differs", "agrees"]
    assert [rows[name].kind for name in ("A slides", "B slides", "later")] == ["measured", "measured", "sign"]
    assert rows["B slides"].source == "30 deg" and rows["B slides"].tolerance == "2 deg: by eye"
    assert [row.quantity for row in trial.report({"A": found["A"]}).rows] == ["A slides"]  # a report may lack B
    unjudged = read(CLAIMS.replace('within = "bed"', 'within = "bed"\njudged = false'))["trial"].report(found).rows[1]
    assert unjudged.verdict is None and unjudged.apart == rows["B slides"].apart != "" and unjudged.kind is None


def test_a_claim_that_is_judged_says_what_it_is_held_against():
    with pytest.raises(ValueError, match="trial: A slides: say by `kind` what it is held"):
        read(CLAIMS.replace('kind = "measured"\n', ""))
    with pytest.raises(ValueError, match="guess"):
        read(CLAIMS.replace('kind = "measured"', 'kind = "guess"'))


@pytest.mark.parametrize(
    "wrong", ['compare = "equal"', "vaule = 3.0", "between = [1.0]", 'within = "beds"', 'by = "no such function"']
)
def test_a_claim_with_a_word_or_a_name_that_is_not_known_is_refused(wrong):
    with pytest.raises(ValueError):
        read(CLAIMS.replace('compare = "fall"', wrong))


def test_a_claim_on_a_run_that_there_is_not_is_refused():
    with pytest.raises(ValueError, match="trial: there is no run C"):
        read(CLAIMS.replace('["B", "A"]', '["C", "A"]'))


def test_a_number_of_a_claim_does_not_hide_a_measure_of_the_same_name():
    """A claim names both alike, and what needs code comes first."""
    files = Path(lab.measures.__file__).parent.glob("*.py")
    named = {name for file in files for name in re.findall(r'"([a-z]\w*)":', file.read_text())}
    assert {"critical_angle", "decay_frequency"} <= named
    assert not named & set(registry.DERIVED)


def test_columns_that_no_set_has_are_refused():
    with pytest.raises(ValueError, match="trial: there is no set of columns impacts"):
        read(CLAIMS.replace('lost = "nothing"', 'lost = "nothing"\ncolumns = "impacts"'))


@pytest.mark.parametrize("report_name", reports())
def test_every_verdict_of_the_shipped_reports_has_its_tolerance(report_name):
    """And what it is held against; no number of one bed has a ±."""
    rows = [Row(**row) for finding in kept_results(report_name).values() for row in finding["rows"]]
    assert rows
    for row in rows:
        assert row.tolerance or row.verdict is None, row
        assert bool(row.kind) == bool(row.verdict), row
        assert not re.search(r"±[^(;,]*\(1 bed", row.ours), row
        assert "±" not in row.ours or re.search(r"beds|\(s\.e\.\)", row.ours), row


def test_the_onset_is_each_beds_own_and_lies_between_two_frequencies():
    def at(frequency, *responses):
        return outcome({"motion.sway.frequency": f"{frequency} Hz"}, response_amplitude=over_worlds(responses, "mm"))

    found = beds.onset([at(1, 0.0, 0.0), at(2, 0.0, 4.0), at(3, 1.6, 8.0)], 40.0)
    assert found.worlds == pytest.approx((2.5, 1.2))  # 2 % of 40 mm is 0.8 mm
    assert beds.onset([at(1, 0.1), at(2, 0.2)], 40.0).value is None


def test_round_outlines_are_judged_bed_by_bed_before_they_slide(monkeypatch):
    """Six beds of which some shift half as far again: 36 nodes lag by 5 %, 120 by 2 %, as the source does not say."""
    tilt = np.linspace(0.0, 30.0, 61)
    curve = lambda recording, world: (tilt, 1e-4 * tilt * recording.slopes[world])  # noqa: E731
    monkeypatch.setattr(outlines, "shift_curve", curve)
    monkeypatch.setattr(critical_angle, "shift_curve", curve)

    def ran(stretch, **setting):
        one = outcome(setting, critical_angle=over_worlds(np.full(6, 25.0), "deg"))
        one.__dict__["recording"] = SimpleNamespace(worlds=6, slopes=stretch * np.tile((1.0, 1.5), 3))
        return one

    nodes = [ran(0.95, **{"contact.nodes": 36}), ran(0.98, **{"contact.nodes": 120})]
    told = EXPERIMENTS["outline-discs"].report({"discs": [ran(1.0)], "smooth": [ran(1.0)], "nodes": nodes})
    discs, *ratios = told.rows[:4]
    assert (discs.ours, discs.verdict) == ("1.25 ± 0.27 mm (6 beds)", None)
    assert [row.ours.partition(" ±")[0] for row in ratios] == ["1", "0.9500", "0.9800"]
    assert all(row.ours.endswith(" (s.e.)") for row in ratios)
    assert [row.verdict for row in ratios] == [None, Verdict.AGREES, Verdict.DIFFERS]


@pytest.mark.parametrize(
    ("heaps", "verdict"),
    [
        ((21.6, 21.8, 21.7, 21.9), Verdict.CANNOT_TELL),
        ((29.0, 29.3, 28.8, 29.2), Verdict.DIFFERS),
        ((17.3, 21.5), Verdict.CANNOT_TELL),
        ((22.0,), Verdict.CANNOT_TELL),
    ],
)
def test_heaps_are_judged_within_their_scatter(heaps, verdict):
    discs, outlined = (over_worlds(angles, "deg") for angles in ((19.1, 19.4, 18.2, 20.1), heaps))
    found = {"discs": [outcome(heap_angle=discs)], "outlines": [outcome(heap_angle=outlined)]}
    assert EXPERIMENTS["outline-heaps"].report(found).rows[-1].verdict is verdict


def test_a_verdict_can_be_kept():
    row = observed("angle", "", "20 deg", surely(np.float64(1.0) < 2.0), EXACT)
    kept = json.loads(json.dumps(asdict(row)))
    assert kept["verdict"] == "agrees" and TypeAdapter(Row).validate_python(kept) == row


def test_results_stored_under_another_rule_are_not_verdicts(tmp_path):
    """A file of rows that say true or false: it is to be made anew."""
    old = {"quantity": "angle", "source": "20", "ours": "21", "difference": "+1", "agrees": True}
    finding = {
        "asked": "",
        "rows": [old],
        "stopped": [],
        "grain_steps": 1,
        "wall_s": 1,
        "figure": "",
        "picture": "",
        "made": {"version": "0"},
    }
    (tmp_path / "granular.json").write_text(json.dumps({"tilt-fill": finding}))
    with pytest.raises(LabError, match="remove it"):
        read_cached(tmp_path / "granular.json", experiments("granular"), False)


def test_the_tolerance_of_one_bed_is_no_more_than_the_scatter_of_beds():
    """The root of the mean squared standard deviations over all beds that were tilted for the report, as is said."""
    kept = json.loads((ROOT / "renders" / "gallery" / "granular" / "granular.json").read_text())
    tilted = [row for name, finding in kept.items() if name.startswith("tilt-") for row in finding["rows"]]
    said = [row["ours"] for row in tilted if "after" not in row["quantity"]]
    found = [pair for text in said for pair in re.findall(r"± ([\d.]+) deg \((\d+) (?:of \d+ )?beds", text)]
    std, count = np.array(found, float).T
    scatter = np.sqrt(np.average(std**2, weights=count - 1))
    files = [tomllib.loads(path.read_text()) for path in FOLDER.glob("*.toml")]
    said = [one["tolerance"]["one bed"] for one in files if "one bed" in one.get("tolerance", {})]
    ((within, origin),) = {(one["within"], one["origin"]) for one in said}
    assert within < scatter + 0.1
    assert float(re.search(r"now ([\d.]+),", origin)[1]) == pytest.approx(scatter, abs=0.1)


def test_only_changes_of_a_presets_physics_require_a_new_run():
    plain = Batch("tilting/quick", {})
    reworded = Batch("tilting/quick", {"title": "Another title", "video.colour": "speed"})
    rougher = Batch("tilting/quick", {"material.friction": 0.3})
    assert asked({"one": plain}) == asked({"one": reworded}) != asked({"one": rougher})


@pytest.mark.parametrize(("report_name", "name"), [("granular", "stack-fall"), ("ship", "barge-roll")])
def test_the_kept_results_in_the_gallery_are_of_the_present_experiments(report_name, name):
    """Also where presets called the sea water: how a preset is written runs nothing again."""
    kept = Path(__file__).parents[3] / "renders" / "gallery" / report_name / f"{report_name}.json"
    assert name in read_cached(kept, {name: experiments(report_name)[name]}, quick=False)


def test_a_page_alone_keeps_results_of_other_runs_in_their_file(tmp_path):
    kept = tmp_path / "granular.json"
    gallery = Path(__file__).parents[3] / "renders" / "gallery"
    text = (gallery / "granular" / "granular.json").read_text().replace('"asked":"', '"asked":"0')
    kept.write_text(text)
    assert "not run" in reproduce("granular", [], tmp_path, quick=False, quiet=True, page_only=True).read_text()
    assert kept.read_text() == text
