"""Replays, resumptions and descriptions of recordings by strangers."""

import json

import h5py
import numpy as np
import pytest

from lab.preset.find import load
from lab.recording import Recorder
from lab.runs.run import prepare
from lab.view.live import steerable
from tests.lab.preset.test_malformed import SMALL, call, copied, refused
from tests.lab.recording.test_trust_recordings import sound  # noqa: F401 (a fixture)
from tests.oracles.synthetic import frame, sample
from tests.oracles.tampering import sealed


@pytest.fixture(scope="module")
def steered(tmp_path_factory):
    """A recording of a steered run."""
    folder = tmp_path_factory.mktemp("steered") / "run"
    preset = steerable(load("tilting/quick", {**SMALL, "run.settle": False, "run.threads": 1}))
    prepare(preset, folder).make_recording(steered=True)
    with Recorder(folder) as run:
        for k in range(4):
            run.sample(sample(0.01 * k))
        run.frame(frame(0.0, count=3, position=np.full((1, 3, 2), 0.004)))
        run.steer(0.0, "tilt", 0.1)
        run.close()
    return folder


STEPS = [
    (0.0, "nonsense", 1.0),
    (0.0, "diameter", 1.0),
    (0.0, "", 1.0),
    (0.0, "__class__", 1.0),
    (0.0, "wave_height", 1.0),
    (0.0, "humidity", 0.5),
    (0.0, "tilt", np.nan),
    (0.0, "tilt", np.inf),
    (0.0, "tilt", 1e300),
    (0.0, "friction", -1.0),
    (0.0, "friction", 1e30),
    (0.0, "gravity", 1e30),
    (0.0, "gravity", -1.0),
    (np.nan, "tilt", 0.1),
    (-np.inf, "tilt", 0.1),
]


@pytest.mark.parametrize("step", STEPS)
def test_a_replay_with_impossible_actions_is_refused(steered, tmp_path, step):
    folder = copied(steered, tmp_path / "run")
    with h5py.File(folder / "recording.h5", "r+") as file:
        for name, value in zip(("time", "name", "value"), step, strict=True):
            file[f"steering/{name}"][0] = value
        sealed(file)
    assert "steering" in refused(call("run", "--replay", folder, "--out", tmp_path / "again", "--no-video", "--quiet"))
    assert not list(tmp_path.glob("again/*"))


@pytest.mark.parametrize(
    "times", [[0.0, 0.0, 0.0, 0.0], [np.nan] * 4, [0.0, 1e300, 2e300, 3e300], [3.0, 2.0, 1.0, 0.0]]
)
def test_a_replay_with_invalid_times_is_refused(steered, tmp_path, times):
    folder = copied(steered, tmp_path / "run")
    with h5py.File(folder / "recording.h5", "r+") as file:
        file["series/time"][...] = times
        sealed(file)
    refused(call("run", "--replay", folder, "--out", tmp_path / "again", "--no-video", "--quiet"))


OTHERS = [
    {"grains.count": 5},
    {"run.repeats": 2},
    {"parts": {"gate": {"points": [[0.0, 0.01], [0.001, 0.01]]}}},
    {"tank.width": 0.04, "tank.height": 0.03},
]


@pytest.mark.parametrize("changes", OTHERS)
def test_a_recording_that_does_not_match_its_preset_is_not_continued(sound, tmp_path, changes):  # noqa: F811
    folder = copied(sound, tmp_path / "run")
    (folder / "checkpoint.npz").unlink()
    with h5py.File(folder / "recording.h5", "r+") as file:
        for table in ("series", "frames"):
            for name in file[table]:
                file[table][name].resize(0, axis=0)
        table = json.loads(file["preset/resolved"].asstr()[0])
        for key, value in changes.items():
            holder = table
            *outer, last = key.split(".")
            for part in outer:
                holder = holder[part]
            holder[last] = value
        del file["preset/resolved"]
        file["preset/resolved"] = json.dumps(table)
    before = (folder / "recording.h5").read_bytes()
    assert "does not belong to the preset in it" in refused(call("resume", folder, "--quiet", "--no-video"))
    assert (folder / "recording.h5").read_bytes() == before
