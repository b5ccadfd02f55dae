"""Measures and curves of bodies that float and of hulls' rooms, on motions that are known."""

import numpy as np
import pytest
from PIL import Image

from lab.measures import measure_all
from lab.paint.curves import plots
from lab.paint.footage import Bed, Footage
from lab.paint.page.theme import LIGHT
from lab.paint.painter import Camera
from lab.paint.scene.openings import name_openings
from lab.recording import open_recording
from lab.report.plots import figures
from tests.oracles.recorded_water import pool, record_pool

TIME = np.arange(101) / 10.0
CORNERS = [["-100 mm", "100 mm"], ["100 mm", "100 mm"], ["100 mm", "300 mm"], ["-100 mm", "300 mm"]]
OUTLINE = np.array([(-0.1, 0.1), (0.1, 0.1), (0.1, 0.3), (-0.1, 0.3)])
HOLE = {"points": [["-50 mm", "110 mm"], ["50 mm", "110 mm"]], "opens": "2 s"}
HULL = {"closed": True, "density": "900 kg/m^3", "points": CORNERS, "wall": "20 mm", "openings": {"a-hole": HOLE}}


@pytest.fixture
def recorded(tmp_path):
    """A hull that turns to −0.2 rad and back to 0.1, sinks by 30 mm, and takes in 4 kg."""
    turn = np.interp(TIME, [0.0, 4.0, 10.0], [0.0, -0.2, 0.1])
    place = np.stack([0.0 * TIME, 0.2 - 0.003 * TIME, turn], axis=-1)
    series = {"body_place": place[:, None, None], "room_water": 0.4 * TIME[:, None, None]}
    frames = {"part_turn": np.zeros((2, 1, 1))}
    preset, outline = pool(parts={"hull": HULL}), {"hull": OUTLINE}
    with open_recording(record_pool(tmp_path / "run", TIME, series, frames, preset, parts=outline)) as recording:
        yield recording


def test_how_a_body_lies_and_what_is_in_her_is_told(recorded):
    values = measure_all(recorded)
    assert values["heel_hull"].value == pytest.approx(np.degrees(0.1))
    assert values["heel_hull"].note == "largest -11.5 deg at 4 s"
    assert values["heave_hull"].value == pytest.approx(-30.0)
    assert values["room_water_hull_inside"].value == pytest.approx(4.0)
    (figure,) = (figure for name, figure in figures(recorded, values) if name == "floating")
    assert [axes.get_ylabel() for axes in figure.axes] == ["heel (deg)", "heave (mm)", "water in rooms (kg)"]


def test_a_body_without_rooms_has_heel_and_heave_alone(tmp_path):
    preset = pool(parts={"box": {"closed": True, "density": "500 kg/m^3", "points": CORNERS}})
    with open_recording(record_pool(tmp_path / "run", TIME, {}, preset=preset, parts={"box": OUTLINE})) as recording:
        (figure,) = (figure for name, figure in figures(recording, measure_all(recording)) if name == "floating")
    assert [axes.get_ylabel() for axes in figure.axes] == ["heel (deg)", "heave (mm)"]


def test_the_film_has_heel_and_water_beside_it_and_the_name_of_the_opening_in_it(recorded):
    bed = Bed(Footage(recorded), 0, "")
    heel, water = plots([bed], [(0, 0, 0)])
    assert (heel.labels[1], water.labels[1]) == ("heel of hull (deg)", "water (kg)")
    assert heel.curves[0][1].min() == pytest.approx(np.degrees(-0.2))
    assert water.curves[0][1][-1] == pytest.approx(4.0)
    camera, colours = Camera(400.0, (200.0, 200.0)), []
    for time in (0.0, 3.0):  # covered, and open: below the hole, pale and then in the colour of what counts
        image = Image.new("RGB", (400, 240), LIGHT.paper)
        name_openings(image, camera, bed, 0, time, 20.0, LIGHT)
        painted = np.argwhere((np.asarray(image) != LIGHT.paper).any(axis=-1))
        hole = camera.pixels(np.array([(0.0, 0.1)]))[0]
        assert painted[:, 0].min() > hole[1] and abs(painted[:, 1].mean() - hole[0]) < 5.0
        colours.append(np.asarray(image)[tuple(painted.T)])
    assert (colours[0] == LIGHT.quiet).all(axis=-1).any() and (colours[1] == LIGHT.accent).all(axis=-1).any()
