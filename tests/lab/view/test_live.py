"""A steered experiment: recorded, and repeated bit for bit."""

import json
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from types import SimpleNamespace

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.paint.footage import open_footage
from lab.preset.find import load
from lab.recording import open_recording
from lab.view import worker
from lab.view.live import Live, own_motion, steerable
from lab.view.replay import replay

pytestmark = pytest.mark.usefixtures("no_plots")

SMALL = {"tank.width": "40 mm", "tank.height": "40 mm", "grains.depth": "12 mm", "run.accuracy": "draft"}
HAND = {3: ("sway", 0.02), 8: ("friction", 0.6), 12: ("gravity", 5.0), 15: ("tilt", -0.3), 20: ("roll", 0.2)}
PIECES = 30


@pytest.fixture(scope="module")
def steered(tmp_path_factory):
    folder, loaded = tmp_path_factory.mktemp("view") / "hand", load("tilting/quick", SMALL)
    with Live(steerable(loaded), folder, Progress(quiet=True)) as live:
        for name, value in own_motion(loaded.resolved).items():
            live.set(name, value)
        for k in range(PIECES):
            if k in HAND:
                live.set(*HAND[k])
            live.advance(most=100 + 37 * k)  # how often it is looked at must not matter
        with pytest.raises(LabError, match="start the experiment again"):
            live.set("diameter", 4e-3)
        live.close()
    return folder


@pytest.mark.slow
def test_a_bed_can_be_watched_while_it_settles(tmp_path, monkeypatch):
    """Its grains fall, and stand still at the end, a centre of mass ever lower."""

    said = []
    box = SimpleNamespace(send=lambda word, what, newest=False: said.append((word, what)))
    monkeypatch.setattr(worker, "PICTURE_INTERVAL", 0.0)
    loaded = steerable(load("tilting/quick", {**SMALL, "grains.reuse_bed": False}))
    with Live(loaded, tmp_path / "run", worker.SentProgress(box, loaded, tmp_path / "run")) as live:
        lies = live.frame().grains["position"]
    words = [word for word, _ in said if word != "message"]
    assert words[0] == "settling" and words.count("settling") in (1, 2) and words.count("frame") > 5
    static = next(what for word, what in said if word == "settling")
    assert static.preset.ship is None and static.radius.shape == lies.shape[:2]
    places = [what[0].grains["position"] for word, what in said if word == "frame"]
    heights = [place[..., 1].mean() for place in places]
    assert heights[0] > heights[-1] + 1e-3
    assert np.abs(places[-1] - lies).max() < 1e-5


def test_the_recording_has_the_users_actions(steered):
    with open_recording(steered) as recording:
        done = [(name, value) for _, name, value in recording.steering]
        times = [time for time, name, _ in recording.steering if name == "friction"]
        assert len(recording.series["time"]) == PIECES + 1
        assert np.ptp(recording.series["pose"][:, 0, 0]) > 5e-3
        assert times == [pytest.approx(8 / recording.preset.record.series_rate)]
    assert [entry for entry in done if entry in HAND.values()] == list(HAND.values())


def check_same_bits(folder, other):
    with open_recording(folder) as first, open_recording(other) as second:
        assert first.steering == second.steering
        for name in first.series:
            assert first.series[name].tobytes() == second.series[name].tobytes(), name
        for name in first.frames:
            assert first.frames[name][:].tobytes() == second.frames[name][:].tobytes(), name


@pytest.mark.slow  # as far as it was recorded, one is below
def test_a_replay_has_the_same_bits(steered, tmp_path):
    again = replay(steered, tmp_path / "again", video=False, quiet=True)
    check_same_bits(steered, again.folder)
    assert json.loads((again.folder / "summary.json").read_text())["status"] == "complete"


def test_a_killed_run_replays_as_far_as_it_was_recorded(steered, tmp_path):
    """The last rows cut off, as a killed process leaves them."""
    folder = tmp_path / "killed"
    folder.mkdir()
    (folder / "recording.h5").write_bytes((steered / "recording.h5").read_bytes())
    with h5py.File(folder / "recording.h5", "r+") as file:
        for data in file["series"].values():
            data.resize(11, axis=0)
    again = replay(folder, tmp_path / "again", video=False, quiet=True)
    with open_recording(steered) as first, open_recording(again.folder) as second:
        assert len(second.series["time"]) == 11
        assert second.series["kinetic"].tobytes() == first.series["kinetic"][:11].tobytes()


def test_a_run_that_was_not_steered_is_not_replayed(steered, tmp_path):
    folder = tmp_path / "plain"
    folder.mkdir()
    (folder / "recording.h5").write_bytes((steered / "recording.h5").read_bytes())
    with h5py.File(folder / "recording.h5", "r+") as file:
        del file["steering"], file["checks/steering"]
    with pytest.raises(LabError, match="not steered by a user"):
        replay(folder, quiet=True)


TOOLS = [name for name in ("Xvfb", "xdotool") if not shutil.which(name)]


@pytest.mark.skipif(bool(TOOLS), reason=f"{' and '.join(TOOLS)} not installed")
@pytest.mark.slow
@pytest.mark.parametrize("window", ["gui", "ggui"])
def test_a_real_window_takes_keys(window, tmp_path):
    """On a virtual screen: forces appear with O, Escape closes, also from the panel."""
    from PIL import ImageGrab

    display = f":{90 + os.getpid() % 900}"
    screen = subprocess.Popen(["Xvfb", display, "-screen", "0", "1400x900x24"], stderr=subprocess.DEVNULL)
    environment = {**os.environ, "DISPLAY": display, "PYTHONPATH": str(Path(__file__).parents[3])}

    def tool(*words: str) -> str:
        return subprocess.run(["xdotool", *words], env=environment, capture_output=True, text=True).stdout

    def reds() -> int:
        seen = np.asarray(ImageGrab.grab(xdisplay=display))
        return int(((seen[..., 0] > 180) & (seen[..., 1] < 60)).sum())

    settings = [word for key, value in SMALL.items() for word in ("--set", f"{key}={value}")]  # compiled already
    asked = ["tilting/quick", *settings, "--window", window, "--out", str(tmp_path / "v")]
    begun = {"env": environment, "cwd": tmp_path, "stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    program = subprocess.Popen([sys.executable, "-m", "lab", "view", *asked], **begun)
    try:
        recording, until = tmp_path / "v" / "recording.h5", time.monotonic() + 150
        while not recording.exists() and program.poll() is None and time.monotonic() < until:
            time.sleep(0.1)
        until, found = time.monotonic() + 150, []
        while not found and program.poll() is None and time.monotonic() < until:
            time.sleep(0.2)
            found = tool("search", "--name", "Cargo Shift Lab").split()
        assert found, program.communicate(timeout=5)[0] if program.poll() is not None else "no window"
        tool("windowfocus", found[0])
        before = reds()
        tool("key", "--window", found[0], "o")
        while reds() <= before + 100 and time.monotonic() < until:
            time.sleep(0.2)
        assert reds() > before + 100
        tool("key", "--window", found[0], "p")  # imgui's panel, where there is one
        time.sleep(0.5)
        tool("key", "--window", found[0], "Escape")
        folder = program.communicate(timeout=60)[0].strip()
    finally:
        program.kill()
        screen.terminate()  # kill would leave its lock
        screen.wait(timeout=30)
    assert folder == str(tmp_path / "v")
    assert [path.name for path in tmp_path.iterdir()] == ["v"]
    assert program.returncode == 0


@pytest.mark.slow
def test_a_steered_random_sea_replays_with_the_same_bits(tmp_path):
    folder, loaded = tmp_path / "sea", load("ship/irregular-sea-quick", {"grains.diameter": "12 mm"})
    with Live(steerable(loaded), folder, Progress(quiet=True)) as live:
        for k in range(60):
            if k in (5, 40):
                live.set("wave_height", 0.06 if k == 5 else 0.01)
            live.advance(most=50 + 11 * k)
        waves = live.frame().rows["waves"]
        live.close()
    assert 0.01 < waves[0] < 0.06
    with open_footage(folder) as footage:  # what a video of it shows
        assert footage.sea_of(0).waves[0] == loaded.resolved.waves.height
        assert footage.sea_of(len(footage.time) - 1).waves[0] == pytest.approx(waves[0], abs=2e-3)
    check_same_bits(folder, replay(folder, tmp_path / "again", video=False, quiet=True).folder)
