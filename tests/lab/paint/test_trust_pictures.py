"""Pictures of recordings by strangers: sizes are bounded before they are painted, odd numbers end in a sentence."""

import json

import h5py
import numpy as np
import pytest

from lab.paint.video import playback
from tests.lab.preset.test_malformed import call, copied, ends_well, refused, unpainted  # noqa: F401 (a fixture)
from tests.lab.recording.test_trust_recordings import little_memory, sound  # noqa: F401 (fixtures)
from tests.oracles.tampering import sealed

VIDEOS = [
    {"width": 10**6, "height": 10**6},
    {"width": 10**12},
    {"width": 640.5},
    {"width": "640"},
    {"width": None},
    {"width": True},
    {"height": [360]},
    {"width": float("nan")},
    {"colour": "<script>" * 1000},
    {"colour": ["speed"]},
    {"colour": {}},
    {"frame": 3},
    {"speed": float("nan")},
    {"speed": "fast"},
    {"speed": float("inf")},
]


def changed(folder, key, value):
    """The recording with another part of its preset."""
    with h5py.File(folder / "recording.h5", "r+") as file:
        table = json.loads(file["preset/resolved"].asstr()[0])
        table[key] = value
        del file["preset/resolved"]
        file["preset/resolved"] = json.dumps(table)
    return folder


@pytest.mark.parametrize("video", VIDEOS)
def test_an_impossible_video_is_refused(sound, unpainted, tmp_path, video, little_memory):  # noqa: F811
    folder = changed(copied(sound, tmp_path / "run"), "video", {"width": 320, "height": 180} | video)
    refused(call("render", folder))


@pytest.mark.parametrize("value", [3, "x", [1], None])
@pytest.mark.parametrize("key", ["video", "title", "kinds", "shapes", "ship", "waves", "run", "contact", "motion"])
def test_invalid_parts_of_a_preset_are_refused_in_one_sentence(sound, unpainted, tmp_path, key, value):  # noqa: F811
    ends_well(call("render", changed(copied(sound, tmp_path / "run"), key, value)))


@pytest.mark.parametrize("size", [["--width", "1000000", "--height", "1000000"], ["--width", "9000"]])
def test_pictures_larger_than_the_limit_are_refused(sound, tmp_path, size, little_memory):  # noqa: F811
    said = refused(call("render", sound, "--out", tmp_path / "x.mp4", *size))
    assert "7680 x 4320 at most" in said


NUMBERS = {
    "kind": ("grains/kind", 255),
    "times-nan": ("frames/time", np.nan),
    "times-equal": ("frames/time", 1.0),
    "times-falling": ("frames/time", -np.arange(4.0)),
    "times-vast": ("frames/time", [0.0, 1e300, 2e300, 1e308]),
    "series-times-nan": ("series/time", np.nan),
    "series-times-equal": ("series/time", 0.0),
    "pose-nan": ("frames/pose", np.nan),
    "pose-vast": ("frames/pose", 1e300),
    "position-inf": ("frames/position", np.inf),
    "position-vast": ("frames/position", 1e30),
    "velocity-inf": ("frames/velocity", np.inf),
    "angle-inf": ("frames/angle", np.inf),
    "centre-vast": ("series/centre_of_mass", 1e300),
    "centre-nan": ("series/centre_of_mass", np.nan),
    "radius-vast": ("grains/radius", 1e300),
    "radius-tiny": ("grains/radius", 1e-300),
    "outline-vast": ("tank/outline", 1e300),
    "outline-point": ("tank/outline", 0.0),
}


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.filterwarnings("ignore::RuntimeWarning")
def test_odd_numbers_of_a_recording_give_one_sentence_or_a_picture(sound, unpainted, tmp_path, name, little_memory):  # noqa: F811
    folder = copied(sound, tmp_path / "run")
    where, value = NUMBERS[name]
    with h5py.File(folder / "recording.h5", "r+") as file:
        file[where][...] = value
        sealed(file)
    ends_well(call("render", folder))


@pytest.mark.parametrize("time", [[0.0, 0.0, 0.0], [0.0, np.nan], [0.0, -1.0], [0.0, 1e-300], [0.0, 1e300], [0.0]])
@pytest.mark.parametrize("speed", [1.0, 1e-300, 1e300])
def test_the_rate_of_a_video_is_always_one_that_can_be_played(time, speed):
    rate, stride = playback(np.array(time), speed)
    assert 0.01 <= rate <= 60.0 and 1 <= stride <= max(2, len(time))
