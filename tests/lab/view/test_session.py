"""The user's side of a live experiment: pictures and actions, driven by events without a window."""

from dataclasses import replace
from multiprocessing import Pipe

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.scene import build
from lab.preset.find import load
from lab.view import footage as footages
from lab.view import session as sessions
from lab.view.footage import StaticScene
from lab.view.live import LiveFrame, own_motion, steerable
from lab.view.overlays import force_strokes
from lab.view.page import PLOT
from lab.view.panel.controls import CONTROLS
from lab.view.panel.readings import clock, readings
from lab.view.session import KEYS, Session
from solvers.grains.pressing import NOBODY, Pressing
from solvers.machine.runtime import initialise

PRESET = "tilting/quick"
SMALL = {"tank.width": "60 mm", "tank.height": "40 mm", "grains.depth": "15 mm"}
SIZE = 1280, 720


# Grain 7 presses on grain 8 and on a wall.
PRESSING = Pressing(
    np.array([[7, 8], [7, NOBODY]]), np.array([[0.0, 0.003], [0.003, 0.0]]), np.array([[0.2, 0], [0, 0.1]])
)


class NoProcess:
    def is_alive(self) -> bool:
        return False

    def join(self, _: float) -> None:
        pass

    def terminate(self) -> None:
        pass


@pytest.fixture
def opened(monkeypatch, tmp_path):
    """A session whose experiment is played by the test: the session, the other end of its pipe, the scene's places."""
    initialise(fields=False)
    pipes = []

    def begin(name, overrides, folder):
        here, there = Pipe()
        pipes.append(there)
        return NoProcess(), here

    monkeypatch.setattr(sessions, "begin", begin)
    session = Session(PRESET, SMALL, SIZE, tmp_path / "out")
    loaded = load(PRESET, SMALL)
    live = steerable(loaded)
    scene, place = build(live.resolved)
    preset = live.resolved
    plain = np.zeros(scene.grains.radius.shape, dtype=int), scene.outline, (), scene.grains.fixed, {}, None, 1e-5
    static = StaticScene(preset, PRESET, tmp_path, scene.grains.radius, *plain)
    pipes[-1].send(("ready", (static, own_motion(loaded.resolved))))
    for k in range(5):
        pipes[-1].send(("frame", (seen(place, 0.1 * k), 0.5)))
    session.tick()
    yield session, pipes, place
    session.close()


def seen(place: np.ndarray, time: float) -> LiveFrame:
    """Grains that move to starboard, spinning, in a tank that stands still."""
    still = np.zeros(place.shape[:2])
    grains = {
        "position": place + np.array([1e-3 * time, 0.0]),
        "velocity": np.full_like(place, 1e-3) * [1.0, 0.0],
        "angle": still,
        "spin": still,
    }
    rows = {"pose": np.zeros((1, 3)), "centre_of_mass": np.full((1, 2), time)}
    rows |= {name: np.zeros(1) for name in ("kinetic", "contacts")}
    return LiveFrame(time, {**rows, "part": np.zeros((1, 0, 2)), "part_turn": np.zeros((1, 0))}, grains, PRESSING)


def asked(pipe) -> list:
    """What has come to the experiment's end of the pipe."""
    found = []
    try:
        while pipe.poll():
            found.append(pipe.recv())
    except EOFError:  # the other end is closed
        pass
    return found


def test_a_session_starts_running_with_the_presets_motion(opened):
    session, pipes, _ = opened
    said = asked(pipes[-1])
    assert ("set", ("tilt", pytest.approx(np.radians(40.0)))) in said
    assert said[-1] == ("go", True)
    assert session.going


def test_the_picture_shows_the_grains_and_the_state(opened):
    session, _, place = opened
    picture = session.picture()
    assert picture.shape == (SIZE[1], SIZE[0], 3)
    camera = session.page.tank_camera(session)
    at = np.round(camera.pixels(place[0] + [4e-4, 0.0])).astype(int)
    painted = picture[at[:, 1], at[:, 0]].astype(int)
    assert np.mean(np.abs(painted - [246, 247, 249]).max(axis=1) > 20) > 0.95


def test_keys_pause_and_move_back_and_forward(opened):
    session, pipes, _ = opened
    newest = session.picture()
    asked(pipes[-1])
    session.key("left")
    session.key("left")
    assert asked(pipes[-1]) == [("go", False)]
    assert session.frame == 2
    assert np.any(session.picture() != newest)
    session.key("g")
    assert session.frame == 4
    session.key("space")
    assert asked(pipes[-1]) == [("go", True)]


def test_a_slider_that_is_dragged_sets_its_control(opened):
    session, pipes, _ = opened
    session.picture()
    asked(pipes[-1])
    left, top, right, bottom = session.page._sliders["friction"]
    session.press(left + 0.25 * (right - left), 0.5 * (top + bottom))
    session.drag(left + 0.75 * (right - left), 0.0)
    session.release(right, top)
    session.drag(left, top)  # let go: nothing more
    values = [value for word, (name, value) in asked(pipes[-1]) if (word, name) == ("set", "friction")]
    assert values == [pytest.approx(0.25, abs=0.02), pytest.approx(0.75, abs=0.02)]
    assert session.values["friction"] == values[-1]


def test_a_slider_goes_from_the_lowest_to_the_highest_value(opened):
    session, _, _ = opened
    session.picture()
    left, top, right, bottom = session.page._sliders["tilt"]
    for x, value in ((left, CONTROLS["tilt"].low), (right, CONTROLS["tilt"].high)):
        session.press(x, 0.5 * (top + bottom))
        session.release(x, top)
        assert session.values["tilt"] == pytest.approx(value)
    assert CONTROLS["tilt"].low < 0.0


def test_no_control_can_leave_its_range(opened):
    session, _, _ = opened
    session.set("friction", 17.0)
    assert session.values["friction"] == CONTROLS["friction"].high


def test_the_centre_of_roll_is_dragged(opened):
    session, pipes, _ = opened
    session.look.frame = "earth"
    session.picture()
    x, y = session.page._centre(session)
    scale = session.page.camera(session).scale
    asked(pipes[-1])
    session.press(x, y)
    session.drag(x + 0.02 * scale, y - 0.03 * scale)
    session.release(x, y)
    last = dict(what for word, what in asked(pipes[-1]) if word == "set")
    assert last == {"centre_y": pytest.approx(0.02), "centre_z": pytest.approx(0.03)}


def test_the_centre_of_roll_is_an_earth_point_in_the_frame_of_a_tilted_tank_too(opened):
    session, pipes, place = opened
    tilted = seen(place, 0.5)
    tilted.rows["pose"] = np.array([[0.01, 0.0, 0.4]])
    pipes[-1].send(("frame", (tilted, 1.0)))
    session.tick()
    session.look.frame = "tank"
    session.picture()
    x, y = session.page._centre(session)
    asked(pipes[-1])
    session.press(x, y)
    session.release(x, y)
    last = dict(what for word, what in asked(pipes[-1]) if word == "set")
    assert last == {"centre_y": pytest.approx(0.0, abs=1e-9), "centre_z": pytest.approx(0.0, abs=1e-9)}


def test_a_click_picks_the_grain_below_it(opened):
    session, _, place = opened
    session.picture()
    x, y = session.page.tank_camera(session).pixels(place[0][7][None] + [4e-4, 0.0])[0]
    session.press(x, y)
    session.release(x, y)
    assert session.look.picked == 7
    assert readings(session)[-2:] == ["grain 7: 1.0 mm/s, 0.00 rad/s", "2 contacts, 0.2 N at most"]


def test_a_click_near_the_edge_picks_the_grain_that_is_there(opened):
    """Not a neighbour whose edge is nearer."""
    session, _, place = opened
    session.picture()
    camera, places, radius = session.page.tank_camera(session), place[0] + [4e-4, 0.0], session.footage.radius[0]
    radius[::2] *= 0.5
    for i in range(0, len(places), 9):
        for turn in np.arange(8) * np.pi / 4.0:
            point = places[i] + 0.9 * radius[i] * np.array([np.cos(turn), np.sin(turn)])
            inside = np.flatnonzero(np.hypot(*(places - point).T) < radius)
            if len(inside) == 1:
                assert session.page.grain_at(session, *camera.pixels(point[None])[0]) == i


def test_the_thickness_of_forces_is_proportional_to_them(opened):
    session, _, _ = opened
    session.look.overlay = "forces"
    session.picture()
    strokes = force_strokes(session, session.page.tank_camera(session))[0]
    weak, strong = np.unique(strokes[:, 2].round(9))
    assert strong == pytest.approx(2.0 * weak)  # 0.2 and 0.1 N


def test_a_row_of_grains_between_walls_has_two_contacts_each(opened):
    session, pipes, place = opened
    count = place.shape[1]
    order = np.arange(count)
    row = np.column_stack([order, np.append(order[1:], NOBODY)])
    grains = np.vstack([row, [[0, NOBODY]]])
    last = seen(place, 0.5)
    pipes[-1].send(
        ("frame", (LiveFrame(0.5, last.rows, last.grains, Pressing(grains, grains * 0.0, grains * 0.1)), 1.0))
    )
    session.tick()
    assert f"{count} grains, 2.00 contacts each" in readings(session)


def test_changes_that_need_a_restart_wait_for_it(opened):
    session, pipes, _ = opened
    asked(pipes[-1])
    session.set("diameter", 4e-3)
    assert asked(pipes[-1]) == []
    assert "start again" in session.said
    session.key("r")
    assert asked(pipes[0])[-1] == ("end", None)
    assert session.overrides["grains.diameter"] == "4 mm"


def test_s_starts_again_with_the_grains_of_another_cargo(opened):
    session, pipes, _ = opened
    session.key("s")
    assert asked(pipes[0])[-1] == ("end", None)
    shapes = load(PRESET, session.overrides).resolved.shapes
    assert list(shapes) == ["wheat"]
    for _ in range(9):
        session.key("s")
    assert list(load(PRESET, session.overrides).resolved.shapes) == ["disc"]


def test_s_reports_if_grains_cannot_have_outlines(opened):
    session, pipes, _ = opened
    wet = {
        "contact.cohesion": "bridge",
        "material.bridge_volume": "0.002 mm^3",
        "material.surface_tension": "0.072 N/m",
    }
    session.overrides = {**SMALL, **wet, "material.contact_angle": "0 deg"}
    session.key("s")
    assert "no liquid between irregular grains" in session.said
    assert session.going and "end" not in [word for word, _ in asked(pipes[-1])]


def test_the_reason_of_the_end_is_shown_and_rewinding_works(opened):
    session, pipes, _ = opened
    pipes[-1].send(("over", "world 0: a grain is too fast"))
    session.tick()
    assert session.said == "world 0: a grain is too fast"
    session.key("left")
    assert session.frame == 3


def test_an_aborted_experiment_is_reported_once_with_its_recording(opened):
    session, pipes, _ = opened
    pipes[-1].close()
    session.tick()
    assert session.said == f"the experiment broke off; {session.folder} has what was recorded."
    assert clock(session) == "t = 0.40 s, ended"
    assert not session.going
    for name in KEYS:  # none brings the window down
        if name not in ("escape", "r", "s"):
            session.key(name)
    assert session.picture().shape == (SIZE[1], SIZE[0], 3)


def test_memory_is_bounded_and_the_shown_frame_stays(opened, monkeypatch):
    session, pipes, place = opened
    session.key("left")
    session.key("left")
    looked_at, limit = session.footage.row_time(session.frame), 8 * seen(place, 0.0).bytes
    monkeypatch.setattr(footages, "MOST_BYTES", limit)
    for k in range(5, 9):
        pipes[-1].send(("frame", (seen(place, 0.1 * k), 0.5)))
    session.tick()
    assert session.footage.row_time(session.frame) == looked_at
    for k in range(9, 200):
        pipes[-1].send(("frame", (seen(place, 0.1 * k), 0.5)))
        session.tick()
    frames = session.footage._frames
    assert 7 <= len(frames) <= 8
    assert sum(frame.bytes for frame in frames) == session.footage._bytes <= limit
    assert frames[-1].time == pytest.approx(19.9)


def test_the_wheel_zooms_about_the_mouse(opened):
    session, _, _ = opened
    camera = session.page.camera(session)
    place = (300.0 - camera.offset[0]) / camera.scale, (camera.offset[1] - 400.0) / camera.scale
    session.wheel(3.0, 300.0, 400.0)
    nearer = session.page.camera(session)
    assert nearer.scale > 1.5 * camera.scale
    assert nearer.pixels(np.array([place]))[0] == pytest.approx([300.0, 400.0])


def test_the_plot_does_not_hide_the_tank(opened):
    session, _, _ = opened
    left, top, _, _ = session.page.view
    corners = session.page.tank_camera(session).pixels(session.footage.outline)
    width, height = (session.page.u(side) for side in PLOT)
    assert corners[:, 0].min() > left + width or corners[:, 1].min() > top + height


def test_long_sentences_stay_in_their_area(opened):
    session, _, _ = opened
    quiet = session.picture()
    session.say("world 0: a grain moved farther in a step than it may; " * 9)
    changed = np.argwhere((session.picture() != quiet).any(axis=2))
    left, _, right, bottom = session.page.view
    assert changed[:, 0].min() >= bottom
    assert left < changed[:, 1].min() and changed[:, 1].max() < right


@pytest.mark.parametrize("overlay", ["c", "f", "o", "i", "h"])
def test_keys_change_the_picture(opened, overlay):
    session, _, _ = opened
    before = session.picture()
    session.key(overlay)
    assert np.any(session.picture() != before)


def test_a_settling_bed_is_shown_and_keys_do_no_harm(opened):
    """After a restart the grains fall into a tank with raised walls, and the controls do not act yet."""
    session, pipes, place = opened
    static = session.footage.static
    session.look.inset = "levers"  # which a ship had
    session.restart()
    assert session.settling and session.footage is None
    made = replace(static, outline=static.outline * [1.0, 30.0]).for_filling(0.12)
    assert made.outline[:, 1].max() == 0.12 and len(made.open_edges) == 1  # no lid so high up that grains are specks
    for message in (
        ("message", "pouring …"),
        ("settling", made),
        ("frame", (seen(place + np.array([0.0, 0.05]), 0.0), 0.0)),
    ):
        pipes[-1].send(message)
    session.tick()
    high = session.picture()
    pipes[-1].send(("frame", (seen(place, 0.2), 0.0)))
    pipes[-1].send(("message", "pouring: 0.20 s"))
    session.tick()
    assert clock(session) == "pouring: 0.20 s" and readings(session) == [f"{place.shape[1]} grains"]
    low = session.picture()
    at = np.round(session.page.tank_camera(session).pixels(place[0] + [2e-4, 0.0])).astype(int)
    changed = np.abs(high.astype(int) - low)[at[:, 1], at[:, 0]].max(axis=1) > 20
    assert changed.mean() > 0.6
    for name in KEYS.keys() - {"escape", "r", "s"}:
        session.key(name)
        session.picture()
    session.press(*at[0])
    session.release(*at[0])
    session.wheel(1.0, 600, 400)
    pipes[-1].send(("ready", (static, {"tilt": 0.3})))
    pipes[-1].send(("frame", (seen(place, 0.0), 0.5)))
    session.tick()
    assert session.going and not session.settling and len(session.footage) == 1
    assert clock(session) == "t = 0.00 s, running"


def test_keys_do_no_harm_before_the_first_message(opened, tmp_path):
    session = Session(PRESET, SMALL, SIZE, tmp_path / "another")
    for name in KEYS.keys() - {"escape", "r", "s"}:
        session.key(name)
        session.picture()
    assert session.settling and session.left == "nothing was recorded yet"
    session.close()


def test_the_help_lists_every_key():
    assert all(says and callable(action) for says, action in KEYS.values())


def test_without_a_display_one_sentence_names_the_command_without_window(monkeypatch):
    from lab.cli import main

    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    result = CliRunner().invoke(main, ["view", PRESET])
    assert result.exit_code == 2
    assert result.output.strip().splitlines() == [
        f"cargolab: there is no display for a window here: `cargolab run {PRESET}` runs it and films it."
    ]
