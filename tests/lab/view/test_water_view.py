"""Water in the window: its surface as the tank tilts, its colours and curves, driven by events without a window."""

from multiprocessing import Pipe
from types import SimpleNamespace

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.progress import Progress
from lab.paint.water.gauges import hues_of
from lab.paint.water.layer import DEEP, LIT
from lab.preset.find import load
from lab.view import session as sessions
from lab.view.footage import StaticScene
from lab.view.live import Live, LiveFrame, own_motion, steerable
from lab.view.panel.readings import readings
from lab.view.session import Session
from solvers.grains.pressing import UNTOUCHED
from solvers.machine.runtime import initialise

SIZE = 1280, 720
PRESET = """
format = 3
title = "Water in a small tank"
tank = { width = "400 mm", height = "240 mm" }
water = { depth = "100 mm", spacing = "10 mm" }
run = { duration = "1 s" }
[gauges]
port = { place = ["-200 mm", "50 mm"] }
L1 = { kind = "level", y = "150 mm" }
"""


@pytest.fixture
def preset(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(PRESET)
    return str(path)


@pytest.fixture
def opened(monkeypatch, tmp_path, preset):
    """A session whose experiment is played by the test, the other end of its pipe, and the particles at rest."""
    initialise(fields=False)
    here, there = Pipe()
    gone = SimpleNamespace(is_alive=lambda: False, join=lambda _: None, terminate=lambda: None)
    monkeypatch.setattr(sessions, "begin", lambda *_: (gone, here))
    session = Session(preset, {}, SIZE, tmp_path / "out")
    loaded = load(preset)
    live = steerable(loaded)
    scene, _ = build(live.resolved)
    static = StaticScene.of(live, tmp_path, SimpleNamespace(scene=scene, dt=1e-4))
    there.send(("ready", (static, own_motion(loaded.resolved))))
    for k in range(5):
        there.send(("frame", (seen(scene.fluid.particles, 0.1 * k, 0.0), 0.5)))
        session.tick()  # a pipe holds a few frames only
    yield session, there, scene.fluid.particles
    session.close()


def seen(drops, time, tilt, depth=0.1):
    """Water whose surface stays level over the earth in a tank that has tilted about the middle of its floor."""
    place = drops["position"].copy()
    place[..., 1] *= 1.0 - np.tan(tilt) * place[..., 0] / depth
    moving = np.stack([np.full(place.shape[:2], 0.1), np.zeros(place.shape[:2])], axis=-1)
    drawn = {"water_position": place, "water_velocity": moving, "water_pressure": 9810.0 * (depth - place[..., 1])}
    rows = {"pose": np.array([[0.0, 0.0, tilt]]), "water_centre": np.array([[0.01 * time, 0.05]])}
    rows |= {"gauge_peak": np.array([[500.0 + time]]), "level_depth": np.array([[depth - 0.15 * np.tan(tilt)]])}
    return LiveFrame(time, {**rows, "part": np.zeros((1, 0, 2)), "part_turn": np.zeros((1, 0))}, drawn, UNTOUCHED)


def surface(session, picture):
    """Slope of the water's surface in the picture, upwards to the right."""
    _, top, _, bottom = session.page.view
    camera = session.page.tank_camera(session)
    (x0, _), (x1, _) = camera.pixels(np.array([[-0.15, 0.2], [0.1, 0.2]]))
    line = np.array(LIT) + np.linspace(0.0, 1.0, 40)[:, None] * (np.array(DEEP) - LIT)
    box = picture[top:bottom, round(x0) : round(x1)].astype(float)
    blue = np.min([np.abs(box - colour).max(axis=2) for colour in line], axis=0) < 8.0
    assert blue.any(axis=0).all()
    highest = blue.argmax(axis=0)
    return -np.polyfit(np.arange(blue.shape[1]), highest, 1)[0]


@pytest.mark.parametrize("tilt", [0.2, *(pytest.param(tilt, marks=pytest.mark.slow) for tilt in (0.0, -0.15))])
@pytest.mark.parametrize("frame", ["tank", "earth"])
def test_water_stays_level_as_the_tank_tilts(opened, frame, tilt):
    session, pipe, drops = opened
    pipe.send(("frame", (seen(drops, 0.6, tilt), 0.5)))
    session.tick()
    session.look.frame, session.look.inset = frame, "nothing"
    expected = 0.0 if frame == "earth" else -np.tan(tilt)
    assert surface(session, session.picture()) == pytest.approx(expected, abs=0.02)


def test_the_window_says_how_much_water_there_is_and_offers_its_controls(opened):
    session, _, drops = opened
    assert session.look.colour == "water"
    assert readings(session)[-1] == f"{drops.shape[1]} particles of water, 10 mm apart"
    assert {"tilt", "sway", "roll", "gravity", "depth", "spacing"} <= set(session.values)
    assert not {"friction", "diameter"} & set(session.values)
    assert session.footage.water.volume.sum() == pytest.approx(drops["volume"].sum())


def test_keys_go_through_the_colours_and_the_curves_of_water(opened):
    session, _, _ = opened
    colours, curves = [], []
    for _ in range(6):
        pictures = session.picture()
        assert pictures.shape == (720, 1280, 3)
        colours.append(session.look.colour)
        session.key("c")
    for _ in range(5):
        session.picture()
        curves.append(session.look.inset)
        session.key("i")
    assert colours == ["water", "pressure", "speed", "vorticity", "particles", "excess-pressure"]
    assert sorted(curves) == ["depths", "nothing", "pressures", "turn", "water"]


def test_gauges_and_their_curves_have_one_colour(opened):
    session, _, _ = opened
    hue = hues_of(session.footage.water)["port"]
    session.look.inset = "pressures"
    picture = session.picture()
    left, top, _, _ = session.page.view
    x, y = session.page.tank_camera(session).pixels([[-0.2, 0.05]])[0].astype(int)
    there = np.abs(picture.astype(int) - hue).max(axis=2) < 12
    assert there[y - 8 : y + 9, x - 12 : x + 9].sum() > 30
    assert there[top : top + 150, left : left + 260].sum() > 60


def test_a_click_on_water_picks_nothing_and_other_cargo_is_refused(opened):
    session, _, _ = opened
    left, _, right, bottom = session.page.view
    middle = 0.5 * (left + right), 0.7 * bottom
    session.press(*middle)
    session.release(*middle)
    assert session.look.picked is None
    session.key("o")
    session.key("s")
    assert session.picture().shape == (720, 1280, 3)


def test_water_under_the_hand_is_stiff_enough_for_a_fall_through_the_tank(preset):
    """A hit at v compresses it by v/c0; what a preset says, as that of a replay does, stays."""
    fall = np.sqrt(2.0 * 9.81 * 0.24)
    assert steerable(load(preset)).resolved.water.sound_speed == pytest.approx(8.0 * fall)
    stays = load(preset, {"water.sound_speed": "12 m/s"})
    assert steerable(stays).resolved.water.sound_speed == 12.0


@pytest.mark.slow
def test_live_water_flows_to_the_lower_side(preset, tmp_path):
    """The tank tilts counter-clockwise, its port side down: water gathers at negative y."""
    loaded = steerable(load(preset))
    with Live(loaded, tmp_path / "run", Progress(quiet=True)) as live:
        before = live.frame().grains["water_position"][0, :, 0].mean()
        live.set("tilt", 0.3)
        live.set("tilt_rate", 1.0)
        for _ in range(60):
            live.advance()
        after = live.frame().grains["water_position"][0, :, 0].mean()
        live.close()
    assert abs(before) < 1e-3
    assert after < -0.02


@pytest.mark.slow
def test_live_water_sloshes_as_the_hand_sways_the_tank(preset, tmp_path):
    """At 1 Hz, near its first frequency of 1.13 Hz, water goes farther in the tank than the tank; then that stops."""
    with Live(steerable(load(preset)), tmp_path / "run", Progress(quiet=True)) as live:
        courses = []
        for amplitude in (0.0, 0.01, 0.0):
            live.set("sway", amplitude)
            live.set("sway_frequency", 1.0)
            rows, begin = [], live.time
            while live.time < begin + 3.0:
                live.advance()
                rows.append((live.time - begin, live.rows["pose"][0, 0], live.rows["water_centre"][0, 0]))
            courses.append(np.ptp([row[1:] for row in rows if row[0] > 1.8], axis=0))
        live.close()
    (still, calm), (swayed, sloshed), (stopped, _) = courses
    assert still == 0.0 and calm < 1e-3
    assert swayed == pytest.approx(0.02, rel=0.05) and sloshed > 0.02
    assert stopped < 1e-3
