"""The gallery: every preset on one page that works from the disk."""

import json
import re

import pytest

from lab import __version__
from lab.base.errors import LabError
from lab.preset.find import names
from lab.studies import gallery
from lab.studies.gallery import make_gallery, repeats_of_twin
from lab.studies.reproduce import cached


@pytest.mark.parametrize("clip", ["tilting-quick.mp4", None])
def test_the_page_has_every_preset_and_the_results_of_those_that_ran(clip, tmp_path, monkeypatch):
    made = {"accuracy": "draft", "beds": 3, "version": "0.2.0", "date": "2026-01-02"}

    def show(name, out, beds, progress):
        told = {"status": "stopped: a grain <fell>", "numbers": {"final_shift": "2.0 diameters (1 bed)"}, **made}
        (out / f"{name.replace('/', '-')}.json").write_text(json.dumps(told))
        if clip:
            (out / clip).touch()

    monkeypatch.setattr(gallery, "_show", show)
    text = make_gallery(["tilting/quick"], tmp_path, quiet=True).read_text()
    presets = [name for name in names() if not name.endswith("-quick")]
    assert text.count("<figure>") == len(presets)
    assert text.count("not run yet</p>") == len(presets) - 1
    assert "final shift</td><td>2.0 diameters (1 bed)" in text
    assert "a grain &lt;fell&gt;" in text
    assert "draft accuracy, 3 beds; version 0.2.0, 2026-01-02" in text
    assert re.findall(r'(?:src|poster)="([^"]*)"', text) == ["tilting-quick.webp", *filter(None, [clip])]


def test_numbers_are_written_for_readers():
    found = {"std": None, "uncertainty": 0.03, "uncertainty_kind": "fit", "worlds": [0.0], "note": ""}
    angle, shift = {"value": 28.5, "unit": "deg", **found}, {"value": -2.47, "unit": "d", **found}
    told = gallery._telling({"status": "complete", "measures": {"critical_angle": angle, "final_shift": shift}})
    assert told["numbers"] == {
        "critical_angle": "28.500° (1 bed; fit 0.03°)",
        "final_shift": "−2.470 diameters (1 bed; fit 0.03 diameters)",
    }


def test_presets_that_differ_by_their_repeats_alone_are_run_with_these():
    """Else their pictures would be those of the presets on which they are based."""
    found = {name: repeats_of_twin(name) for name in ("shaking/roll-quick", "shaking/roll-centre-200-quick")}
    assert found == {"shaking/roll-quick": 1, "shaking/roll-centre-200-quick": 1}
    assert repeats_of_twin("shaking/roll-centre-500-quick") == 2
    assert repeats_of_twin("shaking/heave-materials-b-quick") == 2


def test_a_name_that_matches_no_preset_is_refused(tmp_path):
    with pytest.raises(LabError, match="no preset nonsense"):
        make_gallery(["nonsense"], tmp_path, quiet=True)


@pytest.mark.slow
def test_a_preset_is_run_filmed_and_not_run_again(tmp_path, monkeypatch):
    make_gallery(["tilting/quick"], tmp_path, quiet=True, beds=2)
    told = json.loads((tmp_path / "tilting-quick.json").read_text())
    assert told["accuracy"] == "draft" and told["beds"] == 2 and told["version"] == __version__
    assert "(2 beds)" in told["numbers"]["critical_angle"]
    made = {path.name for path in tmp_path.iterdir()}
    assert made == {"index.html", "runs", "tilting-quick.mp4", "tilting-quick.webp", "tilting-quick.json"}
    monkeypatch.setattr(gallery, "carry_out", None)
    make_gallery(["tilting/quick"], tmp_path, quiet=True, beds=2)


def test_a_card_of_another_preset_or_of_other_beds_is_made_anew(tmp_path, monkeypatch):
    """Its place alone says nothing. A run of another preset that lies in the gallery's folder is refused."""
    kept = {
        "status": "complete",
        "numbers": {},
        "accuracy": "draft",
        "beds": 2,
        "version": "0.1.0",
        "date": "2026-01-02",
    }
    batch = gallery.Batch("tilting/quick", {"run.repeats": 2})
    (tmp_path / "tilting-quick.json").write_text(json.dumps(kept | {"asked": gallery.asked({"": batch})}))
    (tmp_path / "tilting-quick.mp4").touch()
    made = []

    def carry_out(batch, folder, **_):
        made.append(batch)
        raise LabError("enough")

    monkeypatch.setattr(gallery, "carry_out", carry_out)
    make_gallery(["tilting/quick"], tmp_path, quiet=True, beds=2)
    assert made == []
    with pytest.raises(LabError, match="enough"):
        make_gallery(["tilting/quick"], tmp_path, quiet=True, beds=3)
    load = cached.load
    changed = {"material.friction": 0.1}
    monkeypatch.setattr(cached, "load", lambda name, changes: load(name, {**changes, **changed}))
    with pytest.raises(LabError, match="enough"):
        make_gallery(["tilting/quick"], tmp_path, quiet=True, beds=2)
    assert [batch.changes["run.repeats"] for batch in made] == [3, 2]
