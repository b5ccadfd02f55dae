"""A file with the name of a video is a whole video, whatever happens to the encoder."""

import os
import signal
import sys

import numpy as np
import pytest

from lab.base.errors import LabError
from lab.paint.encoder import says, write_video

PICTURES = [np.full((180, 320, 3), shade, np.uint8) for shade in range(0, 250, 10)]
OLDER = b"an older video"

pytestmark = pytest.mark.skipif(os.name != "posix", reason="stands in for ffmpeg with a script")


def stand_in(monkeypatch, tmp_path, script):
    """Have a Python script called in place of ffmpeg; `out` is the file that it is to write."""
    program = tmp_path / "ffmpeg"
    program.write_text(
        f"#!{sys.executable}\nimport os, signal, sys\nout = sys.argv[-1].removeprefix('file:')\n{script}"
    )
    program.chmod(0o755)
    monkeypatch.setattr("imageio_ffmpeg.get_ffmpeg_exe", lambda: str(program))


@pytest.mark.parametrize(
    ("script", "said"),
    [
        ("open(out, 'wb').write(b'torn'); sys.stdin.buffer.read(); sys.exit('out: No space left on device')",
         "out: No space left on device; make room there"),
        ("open(out, 'wb').write(b'torn'); sys.stdin.buffer.read(9); sys.exit('early')", "early; make room there"),
        ("open(out, 'wb').write(b'torn'); sys.stdin.buffer.read(); os.kill(os.getpid(), signal.SIGKILL)",
         "ffmpeg was ended by signal 9"),
        ("open(out, 'wb').write(b'torn'); os.kill(os.getpid(), signal.SIGKILL)", "ffmpeg was ended by signal 9"),
    ],
)  # fmt: skip
def test_a_torn_video_never_takes_the_place_of_a_whole_one(script, said, monkeypatch, tmp_path):
    out = tmp_path / "films" / "film.mp4"
    out.parent.mkdir()
    out.write_bytes(OLDER)
    stand_in(monkeypatch, tmp_path, script)
    with pytest.raises(LabError) as caught:
        write_video(out, PICTURES, 25.0)
    sentence = str(caught.value)
    assert str(out) in sentence and said in sentence and sentence.endswith(".") and "\n" not in sentence
    assert out.read_bytes() == OLDER and list(out.parent.iterdir()) == [out]


def test_an_interrupt_while_ffmpeg_ends_leaves_nothing_behind(monkeypatch, tmp_path):
    stand_in(monkeypatch, tmp_path, "open(out, 'wb').write(b'torn'); sys.stdin.buffer.read(); signal.pause()")
    signal.signal(signal.SIGALRM, signal.default_int_handler)
    signal.setitimer(signal.ITIMER_REAL, 1.0)
    with pytest.raises(KeyboardInterrupt):
        write_video(tmp_path / "film.mp4", PICTURES, 25.0)
    assert [one.name for one in tmp_path.iterdir()] == ["ffmpeg"]


def test_a_missing_ffmpeg_is_one_sentence(monkeypatch, tmp_path):
    def none():
        raise RuntimeError("No ffmpeg exe could be found.")

    monkeypatch.setattr("imageio_ffmpeg.get_ffmpeg_exe", none)
    with pytest.raises(LabError, match="no ffmpeg"):
        write_video(tmp_path / "film.mp4", PICTURES, 25.0)


def test_names_that_look_like_options_or_addresses_are_files(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    for name in ("--out", "pipe:1", "a'b\"c$d %03d"):
        out = tmp_path / f"{name}.mp4"
        assert write_video(out.relative_to(tmp_path), PICTURES, 25.0).stat().st_size > 1000


def test_a_video_says_what_it_was_made_with(tmp_path):
    out = write_video(tmp_path / "film.mp4", PICTURES, 25.0, 'cargolab 1 {"colour": "layer"}')
    assert says(out, 'cargolab 1 {"colour": "layer"}') and not says(out, 'cargolab 1 {"colour": "speed"}')
    out.write_bytes(b"")
    assert not says(out, "cargolab")
