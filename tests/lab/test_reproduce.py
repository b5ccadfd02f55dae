"""The report on the source's experiments: every batch can be run, results are read as they are, nothing runs twice."""

import json
import signal
import subprocess
import sys
import time
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from lab import reproduce as package
from lab.errors import LabError
from lab.measures.value import over_worlds
from lab.presets import load
from lab.reproduce import REPORTS, experiments, outlines, reproduce, runs, workers
from lab.reproduce.experiment import Experiment, Told, counted, observed, ordered, stated
from lab.reproduce.report import write_report
from lab.reproduce.runs import Batch, Outcome
from lab.reproduce.shaking import FREQUENCY, onset
from lab.scene import build
from lab.sweeps import ask
from solvers import runtime

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


EXPERIMENTS = {name: one for report in REPORTS for name, one in experiments(report).items()}


@pytest.mark.parametrize("name", EXPERIMENTS)
def test_every_batch_of_every_experiment_can_be_built(name):
    for quick in (True, False):
        for batch in EXPERIMENTS[name].batches(quick).values():
            points = (
                ask(batch.preset, batch.axes, batch.changes).points
                if batch.axes
                else [load(batch.preset, {**batch.changes, "run.repeats": 1})]
            )
            assert points[0].resolved.run.accuracy in ("draft", "standard")
    assert EXPERIMENTS[name].shown[0] in EXPERIMENTS[name].batches(True)
    one = load(batch.preset, {**batch.changes, "run.repeats": 1}).resolved
    assert build(one)[0].step > 0.0


@pytest.mark.slow
def test_a_report_has_the_results_and_nothing_is_run_twice(tmp_path, monkeypatch):
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)  # all in this process

    def tell(found):
        numbers = [one["contact_number_start"] for one in found["rates"]]
        return Told([observed("contacts", "none", ", ".join(map(counted, numbers)), None)])

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
    with pytest.raises(LabError, match="holds another run than this experiment asks for: remove it"):
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


def test_what_two_experiments_share_is_run_once(tmp_path, monkeypatch):
    ran = []
    monkeypatch.setattr(workers, "carry_out", lambda batch, folder, quiet: ran.append(folder.relative_to(tmp_path)))
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    reproduce("granular", ["tilt-surface", "tilt-low-walls"], tmp_path, quick=False, quiet=True)
    assert len(ran) == len(set(ran)) == 4
    shared = tmp_path / "full" / "tilt-surface" / "slightly disturbed"
    assert package.places(experiments("granular"), tmp_path / "full", False)["tilt-low-walls"]["high walls"] == shared


def test_what_is_not_run_yet_is_said(tmp_path, monkeypatch):
    monkeypatch.setattr(workers, "carry_out", lambda *_: None)
    monkeypatch.setattr(runtime, "available_cores", lambda: 1)
    text = reproduce("granular", ["stack"], tmp_path, quick=False, quiet=True).read_text()
    assert text.count("| not run |") == len(experiments("granular"))
    with pytest.raises(LabError, match="there is no experiment tilt-x; there are stack-fall, "):
        reproduce("granular", ["tilt-x"], tmp_path, quick=False)


def test_numbers_agree_within_what_is_allowed_and_trends_by_their_order():
    value = over_worlds([20.0, 22.0], "deg")
    row = stated("angle", 18.0, value, 3.0)
    assert row.agrees and row.difference == "+3.0 ± 1.0 deg" and row.ours == "21.0 ± 1.4 deg (2 beds)"
    assert not stated("angle", 18.0, value, 2.9).agrees
    assert not stated("angle", 18.0, over_worlds([np.nan], "deg"), 99.0).agrees
    low = over_worlds([19.0], "deg")
    assert ordered(value, low) and not ordered(low, value) and not ordered(value, None)


def test_the_onset_is_each_beds_own_and_lies_between_two_frequencies():
    def at(frequency, *responses):
        return outcome({FREQUENCY: f"{frequency} Hz"}, response_amplitude=over_worlds(responses, "mm"))

    found = onset([at(1, 0.0, 0.0), at(2, 0.0, 4.0), at(3, 1.6, 8.0)], 40.0)
    assert found.worlds == pytest.approx((2.5, 1.2))  # 2 % of 40 mm is 0.8 mm
    assert onset([at(1, 0.1), at(2, 0.2)], 40.0).value is None


def test_round_outlines_are_judged_bed_by_bed_before_they_slide(monkeypatch):
    """Six beds of which some shift half as far again: 36 nodes lag by 5 %, 120 by 2 %, as the source does not say."""
    tilt = np.linspace(0.0, 30.0, 61)
    monkeypatch.setattr(outlines, "shift_curve", lambda recording, world: (tilt, 1e-4 * tilt * recording.slopes[world]))

    def ran(stretch, **setting):
        one = outcome(setting, critical_angle=over_worlds(np.full(6, 25.0), "deg"))
        one.__dict__["recording"] = SimpleNamespace(worlds=6, slopes=stretch * np.tile((1.0, 1.5), 3))
        return one

    nodes = [ran(0.95, **{outlines.NODES: 36}), ran(0.98, **{outlines.NODES: 120})]
    told = outlines.round_ones({"discs": [ran(1.0)], "smooth": [ran(1.0)], "nodes": nodes})
    said = [(row.ours, row.agrees) for row in told.rows[:4]]
    assert said == [
        ("1.25 ± 0.27 mm (6 beds)", None),
        ("1.000 ± 0.000", None),
        ("0.950 ± 0.004", True),
        ("0.980 ± 0.002", False),
    ]


@pytest.mark.parametrize(
    ("heaps", "agrees"),
    [((21.9, 22.1, 22.0, 22.2), True), ((29.0, 29.3, 28.8, 29.2), False), ((17.3, 21.5), None), ((22.0,), None)],
)
def test_heaps_are_judged_by_what_their_scatter_allows(heaps, agrees):
    discs, outlined = (over_worlds(angles, "deg") for angles in ((19.1, 19.4, 18.2, 20.1), heaps))
    found = {"discs": [outcome(heap_angle=discs)], "outlines": [outcome(heap_angle=outlined)]}
    assert outlines.heaps(found).rows[-1].agrees is agrees


def test_what_numpy_judged_can_be_kept():
    row = observed("angle", "", "20 deg", np.float64(1.0) < 2.0)
    assert json.loads(json.dumps(row.agrees)) is True
