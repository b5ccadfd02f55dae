"""The loss of a ship is reported in texts, measures, summary, figures, video and window."""

from dataclasses import replace
from math import atan, atan2, degrees, pi, radians

import imageio.v2 as imageio
import numpy as np
import pytest

from lab.assembly.scene import vessels
from lab.assembly.ship import flooding_angles
from lab.base.errors import LabError
from lab.measures import measure_all
from lab.paint import palette
from lab.paint.film import Film, choose_beds, choose_look
from lab.paint.footage import open_footage
from lab.paint.video import HELD, render_recording
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.recording import Recorder, open_recording
from lab.recording.ship_end import End, end_of, ends, losses_sentence
from lab.report.plots import figures
from lab.report.summary import terminal_summary, write_summary
from lab.view.shown import Look, Shown
from solvers.machine.runtime import initialise
from solvers.ship.hydrostatics import buoyancy, turned
from solvers.ship.motion import sail, start
from tests.oracles.synthetic import frame, of_a_ship, recorder, sample

MAP = "ship/capsize-map"
WHEN, OVER, LASTS = 1.2, radians(-40.0), 1.25  # s, rad: she lies at 40 deg to starboard from then on
SENTENCE = "She floods at 1.2 s, 40 deg to starboard."


@pytest.fixture(scope="module")
def flooded(tmp_path_factory):
    """A recording of the barge with a hatch that rolls over to 40 deg in 1.2 s and floods there."""
    folder = tmp_path_factory.mktemp("flooded")
    said = to_table(load(MAP).resolved)
    outline = np.array(load(MAP).resolved.tank.corners)
    with recorder(folder, resolved=said, outline=outline, radius=np.full((1, 4), 0.003)) as writer:
        for now in np.arange(0.0, LASTS + 1e-9, 0.05):
            pose = np.array([[0.0, 0.0, OVER * min(1.0, now / WHEN)]])
            lost = [WHEN if now >= WHEN else -1.0]
            writer.sample(sample(now, pose=pose, **of_a_ship(flooded=lost)))
            writer.frame(frame(now, pose=pose))
    return folder


def test_the_text_on_a_loss():
    assert end_of(-1.0, -1.0, 0.3) is None
    assert end_of(4.5156, -1.0, 0.5 * pi).words == "capsizes at 4.516 s, 90 deg to port"
    assert end_of(-1.0, -1.0, 0.1, 7.0).words == "sinks at 7 s, 5.73 deg to port"
    assert end_of(5.0, 4.0, -0.5) == End("flooded", 4.0, -0.5)
    assert losses_sentence([None, None]) == losses_sentence([None]) == ""
    found = [End("capsized", 3.0, 1.6), None, End("flooded", 5.0, 0.7), End("flooded", 4.0, 0.7)]
    assert losses_sentence(found) == "With 1 of 4 beds she capsizes at 3 s; with 2 of 4 beds she floods after 4 to 5 s."


def test_the_roll_of_a_lost_ship_is_that_of_the_next_sample():
    """Her world stands still from the step at which she was lost, which is between two samples."""
    pose = np.zeros((4, 1, 3))
    pose[:, 0, 2] = [0.0, 0.5, 0.6, 0.6]
    flooded = np.array([[-1.0], [-1.0], [1.03], [1.03]])
    series = {
        "time": np.array([0.9, 1.0, 1.1, 1.2]),
        "pose": pose,
        "flooded": flooded,
        "capsized": np.full((4, 1), -1.0),
    }
    assert ends(series) == [End("flooded", 1.03, 0.6)]


def test_measures_of_a_flooded_ship(flooded):
    with open_recording(flooded) as recording:
        found = measure_all(recording)
    assert found["flooded_at"].worlds == (WHEN,) and found["capsized_at"].worlds == (None,)
    assert found["roll_amplitude"].value is None and found["roll_amplitude"].note.startswith("flooded")
    assert found["frozen_flooded_at"].value is not None or found["frozen_largest_roll"].value < 90.0


def test_a_recording_names_the_point_of_reference(flooded):
    """Enough to find sway and heave of the axis from the poses, which are of the tank's origin."""
    import h5py

    with h5py.File(flooded / "recording.h5") as file:
        said = dict(file.attrs)
    assert said["pose_is_of"] == b"the origin of the tank's axes"
    assert said["ship_axis"] == pytest.approx([0.0, 0.11]) and said["ship_axis_in_tank"] == pytest.approx([0.0, 0.09])
    assert said["sway_and_heave_are_of"] == b"the ship's axis, 110 mm above her origin, in the waterline"


def test_the_summary_begins_with_the_loss(flooded, tmp_path):
    with open_recording(flooded) as recording:
        write_summary(recording, {}, {}, tmp_path)
        assert SENTENCE in terminal_summary(recording, {}, {}).splitlines()[0]
    page = (tmp_path / "summary.md").read_text().splitlines()
    assert page[0].startswith("# ") and page[2] == f"**{SENTENCE}**"
    assert any("those of her axis, 110 mm above her origin, in the waterline" in line for line in page)


def test_figures_mark_the_loss(flooded):
    """The time in that of the roll; in the curve of levers where deck and hatch meet the water."""
    with open_recording(flooded) as recording:
        values = measure_all(recording)
        drawn = dict(figures(recording, values))
    roll, levers = (drawn[name].axes[0] for name in ("roll", "lever"))
    assert WHEN in [line.get_xdata()[0] for line in roll.lines if len(line.get_xdata()) == 2]
    assert [text.get_text() for text in roll.texts] == ["floods at 1.2 s, 40 deg to starboard"]
    upright = {line.get_label(): line.get_xdata()[0] for line in levers.lines}
    assert upright["deck immersion angle 10.0 deg"] == pytest.approx(degrees(atan(30.0 / 170.0)))
    assert upright["downflooding angle 39.4 deg"] == pytest.approx(values["downflooding_angle"].value)


def test_the_last_seconds_of_the_video_show_the_loss(flooded, tmp_path):
    """Across the foot of the picture from then on, and the last one stays."""
    initialise(fields=False)
    with open_footage(flooded) as footage:
        look = choose_look(footage, width=640, height=360)
        film = Film(choose_beds(footage), look)
        before, after = (film.picture(int(np.searchsorted(film.time, now - 1e-6))) for now in (WHEN - 0.05, WHEN))
        assert film.lost
    assert not (before == palette.LOST).all(axis=2).any()
    rows = np.flatnonzero((after == palette.LOST).all(axis=2).sum(axis=1) > 100)
    assert len(rows) > 15 and rows.min() > 180
    made = render_recording(flooded, tmp_path / "v.mp4", width=640, height=360)
    pictures = imageio.mimread(made, memtest=False)
    assert len(pictures) == len(film.time) + round(HELD / 0.05)
    assert np.abs(pictures[-1].astype(int) - pictures[len(film.time)]).mean() < 1.0


def test_the_window_shows_the_loss_as_long_as_the_ship_is_lost():
    rows = [
        {"capsized": -1.0, "flooded": -1.0, "pose": [0.0, 0.0, 0.2]},
        {"capsized": -1.0, "flooded": 3.0, "pose": [0.0, 0.0, 0.7]},
    ]
    shown = Shown()
    shown.settling, shown.look = False, Look("kind", "earth")
    shown.footage = type(
        "Footage",
        (),
        {"sea": True, "leaks": False, "row": lambda _, frame, name: rows[frame][name], "__len__": lambda _: 2},
    )()
    assert shown.lost == End("flooded", 3.0, 0.7)
    shown.playhead = 0
    assert shown.lost is None


def test_in_a_recording_without_the_column_no_ship_floods(tmp_path):
    """As earlier versions left them; such a run is not gone on with."""
    import h5py

    said = to_table(load(MAP).resolved)
    with recorder(tmp_path, resolved=said) as writer:
        for now in (0.0, 1.0, 2.0):
            writer.sample(sample(now, **of_a_ship()))
        writer.frame(frame(0.0))
    with h5py.File(tmp_path / "recording.h5", "r+") as file:
        del file["series/flooded"]
        file.attrs["format"] = "cargo-shift-lab 2"
    with open_recording(tmp_path) as recording:
        assert recording.series["flooded"].tolist() == [[-1.0]] * 3
    with pytest.raises(LabError, match="begun by another version: start the run again"):
        Recorder(tmp_path, samples=3, frames=1)


def vessel_of(changes: dict):
    resolved = load("ship/barge-roll", changes).resolved
    return resolved, vessels(resolved)[0]


def test_angles_of_deck_and_opening():
    """Of a box whose bilge and deck stay where they are by the waterline's turning about its middle."""
    given, vessel = vessel_of({"ship.openings": [["100 mm", "150 mm"], ["0 mm", "290 mm"]]})
    angles = flooding_angles(given.ship, vessel)
    assert angles["downflooding_angle"] == pytest.approx(atan2(0.04, 0.1), rel=1e-9)
    bilge = atan2(0.11, 0.17)
    assert angles["deck_immersion_angle"] > bilge  # when the bilge is out already: the water cut is a triangle, then
    shallow, vessel = vessel_of({"ship.height": "160 mm", "tank.height": "100 mm", "grains.depth": "60 mm"})
    assert flooding_angles(shallow.ship, vessel) == {
        "deck_immersion_angle": pytest.approx(atan2(0.05, 0.17), rel=1e-9),
        "downflooding_angle": None,
    }


def test_at_the_downflooding_angle_the_hull_floats_with_the_edge_at_the_surface():
    """Of the barge with a hatch, her deck long in the water."""
    resolved = load(MAP).resolved
    (vessel,) = vessels(resolved)
    angle = flooding_angles(resolved.ship, vessel)["downflooding_angle"]
    edge = np.array([-0.06, 0.19])  # to port, where a positive heel puts her under
    heave = -float(turned(tuple(edge), angle)[1])
    floating = vessel.ship.load
    carried = buoyancy(floating.section, floating.water, heave, angle)[1]
    assert carried == pytest.approx(37.4 * 9.81, rel=1e-9)
    assert resolved.ship.flooding_points == ((0.06, 0.19), (-0.06, 0.19))
    assert resolved.ship.deck_edges == ((0.17, 0.14), (-0.17, 0.14))


def test_the_deck_of_an_outline_is_at_its_height():
    outline = [
        [f"{y} mm", f"{z} mm"] for y, z in ((-150, 0), (150, 0), (170, 200), (170, 300), (-170, 300), (-170, 200))
    ]
    changes = {"ship.breadth": False, "ship.height": False, "ship.outline": outline, "ship.deck": "100 mm"}
    given = replace(load("ship/barge-roll", {**changes, "ship.deck": "290 mm", "tank.width": "200 mm"}).resolved.ship)
    assert np.array(given.deck_edges) == pytest.approx(np.array([[0.17, 0.29], [-0.17, 0.29]]))
    assert np.array(replace(given, deck=0.1).deck_edges) == pytest.approx(np.array([[0.16, 0.1], [-0.16, 0.1]]))
    assert np.array(replace(given, deck=0.3).deck_edges) == pytest.approx(np.array([[0.17, 0.3], [-0.17, 0.3]]))


def test_a_ship_with_a_large_heel_floods():
    """Rolling freely in calm water: at once where the heel puts the edge under, never where it does not."""
    resolved = load(MAP, {"waves.amplitude": "0 mm", "ship.heel": "50 deg", "ship.release": "1 s"}).resolved
    (vessel,) = vessels(resolved)
    limit = degrees(atan2(0.08, 0.06))  # about the fixed axis, in the waterline

    def end(heel: float):
        state = start(vessel.ship, vessel.heave(vessel.ship.body, radians(heel)), radians(heel))
        return sail(vessel.ship, state, 0.01, 1.0, openings=vessel.openings).flooded

    assert end(limit + 1.0) is not None and end(limit - 1.0) is None
