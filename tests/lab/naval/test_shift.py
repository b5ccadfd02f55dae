"""Where the cargo of a run lies beside what the code assumes, and the page of a run for the file."""

import re
from dataclasses import replace
from hashlib import sha256

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.measures import ship_grain
from lab.naval import sheet
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.recording import open_recording
from lab.report import file, plots, ship
from lab.report.cargo import coarse
from solvers.ship.cargo import filling_centre
from solvers.ship.hydrostatics import Loading, equilibrium
from solvers.ship.naval.criteria import Criterion
from solvers.ship.naval.holds import Hold
from solvers.ship.section import Section
from tests.oracles.synthetic import frame, of_a_ship, recorder, sample

SHIP = "ship/handysize-grain"
COUNT, LASTS = 2312, 20.0
ASIDE, UP, MOST = 0.3, 0.02, 0.5  # m: where the cargo lies at last, and the farthest aside on the way


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run of the Handysize whose cargo goes 0.5 m to port, then to 0.3 m to starboard, and stays there."""
    folder = tmp_path_factory.mktemp("shift")
    preset = load(SHIP).resolved
    outline = np.array(preset.tank.corners)
    settled = filling_centre(Section(outline), 150.0, 0.0)
    with recorder(
        folder, count=COUNT, preset=SHIP, resolved=to_table(preset), outline=outline, radius=np.full((1, COUNT), 0.125)
    ) as writer:
        for now in np.linspace(0.0, LASTS, 201):
            aside = np.interp(now, [0.0, 0.3 * LASTS, 0.6 * LASTS, LASTS], [0.0, -MOST, ASIDE, ASIDE])
            up = np.interp(now, [0.0, 0.6 * LASTS, LASTS], [0.0, UP, UP])
            pose = np.array([[0.0, 0.0, -0.1 * np.sin(now)]])
            writer.sample(sample(now, pose=pose, centre_of_mass=np.add(settled, [[aside, up]]), **of_a_ship()))
        writer.frame(frame(0.0, count=COUNT))
        writer.close("complete")
    return folder


@pytest.fixture(scope="module")
def measured(run):
    with open_recording(run) as recording:
        return ship_grain.measure(recording), ship_grain.shift(recording)


def test_volumetric_moment_is_volume_times_way(measured):
    values, found = measured
    assert found.condition.cargo.volume == pytest.approx(150.0 * 25.0, rel=1e-6)
    assert values["shifted_moment"].value == pytest.approx(3750.0 * ASIDE, rel=1e-6)  # to starboard: positive
    assert values["largest_shifted_moment"].value == pytest.approx(3750.0 * MOST, rel=1e-2)
    assumed = Hold(found.condition.hold.section, 25.0).volumetric_moment(3750.0, np.radians(25.0))
    assert values["assumed_moment"].value == pytest.approx(assumed, rel=1e-6)
    assert values["shifted_share"].value == pytest.approx(100.0 * 3750.0 * ASIDE / assumed, rel=1e-6)


def test_list_is_that_of_the_moved_centre_of_gravity(measured):
    """By the hydrostatics of the section with G as when the cargo lay farthest, to port: the lab's positive roll."""
    values, found = measured
    condition = found.condition
    share = COUNT * np.pi / 6.0 * 0.25**3 * 1400.0 / 0.25 * 25.0 / (condition.displacement * 1000.0)
    assert found.share == pytest.approx(share, rel=1e-9)
    section = condition.form.sections[0]
    mass = condition.displacement * 1000.0 / 130.7
    loading = Loading(mass, (-share * MOST, condition.gravity_height + share * 0.5 * UP))
    roll = np.degrees(equilibrium(section, loading, condition.water)[1])
    assert roll > 0.0 and values["list_as_it_lay"].value == pytest.approx(roll, rel=1e-4)
    assert values["area_as_it_lay"].value > values["assumed_area"].value


def test_figures_are_drawn(run, measured):
    with open_recording(run) as recording:
        for draw in ship_grain.FIGURES.values():
            sheet = plots.Sheet(recording)
            draw(sheet, recording, measured[0])
            labels = " ".join(text.get_text() for text in sheet.finished().legends[0].get_texts())
            assert "assumed" in labels


def test_page_for_the_file_is_whole_and_signed(run):
    (path,) = file.write_report(run)
    page = path.read_text(encoding="utf-8")
    assert sha256((run / "recording.h5").read_bytes()).hexdigest() in page
    assert not re.findall(r"(?:src|href)=\"(?!data:)", page)  # nothing outside of it
    assert page.count("Grain Code A 7.1.2") == 2 and "(as it lay farthest aside)" in page and "starboard down" in page
    assert page.count("data:image/png;base64,") >= 2


def lists(*degrees: float) -> list[Criterion]:
    """The Grain Code's heel of equilibrium, at most 12 deg, of some beds."""
    return [Criterion("", "heel of equilibrium", "at most", 12.0, one, "deg") for one in degrees]


def test_a_verdict_is_that_of_the_beds():
    """Student's interval of three beds is 4.303 s/√3 to either side: of 6, 7, 8 it is 7 ± 2.5, of 8, 10, 12 10 ± 5."""
    assert ship.verdict_of(lists(7.0)) == ship.verdict_of(lists(20.0)) == "cannot tell"
    assert ship.verdict_of(lists(6.0, 7.0, 8.0)) == "pass"
    assert ship.verdict_of(lists(8.0, 10.0, 12.0)) == "cannot tell"
    assert ship.verdict_of(lists(17.0, 18.0, 19.0)) == "fail"
    assert ship.verdict_of(lists(np.inf, np.inf, 30.0)) == "fail"  # two that never come to rest
    assert ship.verdict_of(lists(np.inf, 3.0, 3.0)) == "cannot tell"


def test_a_run_of_one_bed_is_not_green(run):
    """The page says so, and on how many grains, for how long; what follows from the preset alone is judged."""
    with open_recording(run) as recording:
        judged, _, notes = ship.judged(recording)
    of_run = [row for row in judged if row.shift == sheet.AS_IT_LIES]
    assert of_run and {row.verdict for row in of_run} == {"cannot tell"}
    assert all(row.grounds.startswith("1 bed of 2312 grains") and row.grounds.endswith("20 s") for row in of_run)
    assert {row.verdict for row in judged if not row.grounds} <= {"pass", "fail"}
    assert any(note.startswith("One bed cannot tell") for note in notes)
    page = file.write_report(run)[0].read_text(encoding="utf-8")
    assert '<span class="cannot-tell">cannot tell</span>' in page and "1 bed of 2312 grains" in page


def test_two_masses_of_grain_are_told(run, measured, monkeypatch):
    """3750 m³ at the stated 1.3 m³/t are 2885 t; the bed of the run weighs another mass, as its grains do."""
    found = measured[1].condition
    mass = found.cargo.mass
    assert abs(mass / (3750.0 / 1.3) - 1.0) > ship.SAME_MASS
    with open_recording(run) as recording:
        notes = " ".join(ship.judged(recording)[2])
        assert "Two masses of grain" in notes and "2884.6 t" in notes and f"{mass:.5g} t" in notes
        alike = replace(found, cargo=replace(found.cargo, mass=2880.0))
        monkeypatch.setattr(ship_grain, "shift", lambda _: replace(measured[1], condition=alike))
        assert "Two masses" not in " ".join(ship.judged(recording)[2])


def test_list_is_drawn_at_every_time(measured):
    """The list in calm water: starboard down, positive, at the end; to port when the cargo lay farthest, at 6 s."""
    found = measured[1]
    lists = ship_grain.listed(found, np.array([0, 60, 200]))[:, 0]
    assert lists[0] == pytest.approx(0.0, abs=1e-6) and lists[1] == pytest.approx(-measured[0]["list_as_it_lay"].value)
    assert 0.0 < lists[2] < -lists[1]


def test_ore_is_judged_by_its_unevenness(tmp_path):
    """Of more than 35 deg of repose: 2 m at most. Level as loaded, 2.6 m higher to starboard at the end."""
    preset, y = load("ship/handysize-ore").resolved, np.arange(-13.0, 13.1, 0.25)
    outline, count = np.array(preset.tank.corners), len(y)
    settled = filling_centre(Section(outline), 90.0, 0.0)
    with recorder(
        tmp_path,
        count=count,
        preset="ore",
        resolved=to_table(preset),
        outline=outline,
        radius=np.full((1, count), 0.125),
    ) as writer:
        for now, slope in ((0.0, 0.0), (1.0, 0.05), (2.0, 0.1)):
            writer.sample(sample(now, centre_of_mass=[settled], **of_a_ship()))
            writer.frame(frame(now, count=count, position=[np.column_stack([y, 5.0 + slope * y])]))
        writer.close("complete")
    with open_recording(tmp_path) as recording:
        judged, _, notes = ship.judged(recording)
    rows = [row for row in judged if row.criterion.rule == "IMSBC Code 5"]
    assert any("36 deg of repose is no grain" in note for note in notes)
    assert [(row.shift, row.criterion.verdict) for row in rows] == [
        ("as loaded", "pass"),
        ("as it lay at the end", "fail"),
    ]
    assert {row.verdict for row in rows} == {"cannot tell"}  # of one bed
    assert rows[1].criterion.limit == 2.0 and rows[1].criterion.attained == pytest.approx(2.5, abs=0.2)


def test_without_the_library_of_pdf_the_remedy_is_said(run, monkeypatch):
    monkeypatch.setattr(file, "_data", lambda _: {})  # of the page, which takes long
    monkeypatch.setattr(file, "render_text", lambda *_, **__: "")
    monkeypatch.setitem(__import__("sys").modules, "weasyprint", None)
    with pytest.raises(LabError, match=r"--pdf: needs WeasyPrint .* print report.html"):
        file.write_report(run, pdf=True)


def test_page_as_pdf(run):
    """Where WeasyPrint is installed the page is laid out on sheets of A4, its figures in it."""
    pytest.importorskip("weasyprint", reason="WeasyPrint is not installed: pip install 'cargo-shift-lab[pdf]'")
    page, pdf = file.write_report(run, pdf=True)
    data = pdf.read_bytes()
    assert pdf.name == "report.pdf" and data.startswith(b"%PDF-") and data.rstrip().endswith(b"%%EOF")
    assert len(data) > 0.2 * len(page.read_bytes())  # figures are most of either


def test_coarse_grains_side_by_side():
    rows = dict(coarse.described(load(SHIP, {"grains.stands_for": "5 mm"}).resolved))
    assert rows["grain"] == "250 mm; 5 mm, s = 50" and rows["across the tank"] == "106; 5320, 1/s"
    assert coarse.described(load("tilting/quick").resolved) == []
    wet = {
        "contact.cohesion": "humid",
        "material.humidity": "70 %",
        "contact.tangential": "haff-werner",
        "material.shear_damping": "25 N s/m",
    }
    rows = dict(coarse.described(load(SHIP, {"grains.stands_for": "5 mm", **wet}).resolved))
    assert rows["shear damping"].startswith("25 N s/m; 0.01 N s/m, s^2")
