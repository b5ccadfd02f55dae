"""The command line: exit codes, one sentence for every fault, and what reaches the runner and the painter."""

import errno
import re
import subprocess
import sys
from contextlib import nullcontext
from pathlib import Path
from types import ModuleType, SimpleNamespace

import pytest
from click.testing import CliRunner
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lab.base.errors import LabError
from lab.cli import main
from lab.cli.options import read_overrides
from solvers.machine.errors import BadState, Unavailable


def call(*arguments: str):
    return CliRunner().invoke(main, list(arguments), prog_name="cargolab")


def stand_in(monkeypatch, module: str, name: str, act):
    """Put a function that records its arguments in place of a heavy one."""
    calls = []

    def function(*arguments, **options):
        calls.append((arguments, options))
        if isinstance(act, BaseException):
            raise act
        return act

    fake = ModuleType(module)
    setattr(fake, name, function)
    monkeypatch.setitem(sys.modules, module, fake)
    return calls


@pytest.fixture
def runner(monkeypatch):
    result = SimpleNamespace(summary_text="12.3 deg", folder=Path("renders/tilting/quick"))
    monkeypatch.setattr("lab.paint.beside.second_process", nullcontext)
    return stand_in(monkeypatch, "lab.runs.runner", "run_preset", result)


@pytest.mark.parametrize("command", ["run", "sweep", "reproduce granular", "poster x", "render x", "hull x", "schema"])
def test_an_empty_name_is_refused_and_not_the_current_folder(command):
    """As of a variable of the shell that is not set."""
    done = call(*command.split(), "--out", "")
    assert done.exit_code == 2 and "the name is empty; write . for the current folder" in done.stderr


def test_help_version_and_list():
    for command in ("run", "render", "explain", "sweep", "resume"):
        assert f"cargolab {command}" in call(command, "-h").stdout
    for arguments in (["--help"], ["run", "--help"]):
        shown = call(*arguments)
        assert shown.exit_code == 0 and "cargolab" in shown.stdout
    assert call("--version").stdout.startswith("cargolab ")
    listed = call("list")
    assert listed.exit_code == 0
    assert re.search(r"^tilting/quick +Quick tilt", listed.stdout, re.MULTILINE)
    assert re.search(r"^funnel/fixed\[-quick\] +Heap", listed.stdout, re.MULTILINE)
    assert "funnel/fixed-quick" not in listed.stdout
    assert "[-quick]: also available under that longer name" in listed.output


def test_without_a_command_the_help_is_shown():
    shown = call()
    assert shown.exit_code == 2 and "Commands:" in shown.output and "Traceback" not in shown.output


def test_run_passes_on_all_options(runner):
    done = call("run", "tilting/quick", "--set", "grains.diameter=4 mm", "--set", "run.repeats=12",
                "--set", 'motion.tilt.centre=["0 mm", "5 mm"]', "--set", "motion.tilt.reverse=true",
                "--set", "title=4 = four", "--out", "there", "--no-video", "--no-plots")  # fmt: skip
    assert done.exit_code == 0, done.output
    assert done.stdout == "12.3 deg\nrenders/tilting/quick\n"
    overrides = {
        "grains.diameter": "4 mm",
        "run.repeats": 12,
        "motion.tilt.centre": ["0 mm", "5 mm"],
        "motion.tilt.reverse": True,
        "title": "4 = four",
    }
    expected = (
        ("tilting/quick", overrides, Path("there")),
        {"video": False, "plots": False, "quiet": False, "beside": None},
    )
    assert runner == [expected]


def test_repeats_and_arch_override_their_keys(runner):
    assert call("run", "tilting/quick", "--set", "run.repeats=3", "--repeats", "12", "--arch", "cpu").exit_code == 0
    assert runner[0][0][1] == {"run.repeats": 12, "run.arch": "cpu"}


def test_sweep_passes_on_the_texts_of_the_values(monkeypatch):
    result = SimpleNamespace(summary_text="4 points", folder=Path("there"))
    calls = stand_in(monkeypatch, "lab.sweeps.sweep", "run_sweep", result)
    done = call("sweep", "shaking/sway", "--set", "motion.sway.frequency=0.2:1.5:14 Hz", "--set", "run.seed=1,2",
                "--repeats", "4", "--out", "there", "--cluster", "tcp://node1:8786")  # fmt: skip
    assert done.exit_code == 0 and done.stdout == "4 points\nthere\n"
    axes = {"motion.sway.frequency": "0.2:1.5:14 Hz", "run.seed": "1,2"}
    options = {"video": True, "plots": True, "quiet": False, "cluster": "tcp://node1:8786"}
    assert calls == [(("shaking/sway", axes, {"run.repeats": 4}, Path("there")), options)]


def test_resume_passes_on_the_folder(monkeypatch):
    result = SimpleNamespace(summary_text="12.3 deg", folder=Path("there"))
    calls = stand_in(monkeypatch, "lab.sweeps.resume", "resume_any", result)
    assert call("resume", "there", "--no-video", "--no-plots", "--quiet").stdout == "there\n"
    assert calls == [((Path("there"),), {"video": False, "plots": False, "quiet": True})]


def test_quiet_prints_only_the_folder(runner):
    assert call("run", "tilting/quick", "--quiet").stdout == "renders/tilting/quick\n"
    (how,) = (keys for _, keys in runner)
    assert how["video"] and how["quiet"] and how["beside"]  # the number of cores, by the stand-in


@pytest.mark.parametrize(
    ("value", "read"),
    [
        ("4 mm", "4 mm"), ("'4 mm'", "4 mm"), ("4", 4), ("0.5", 0.5), ("false", False), ("", ""),
        ("2020-01-01", "2020-01-01"), ("1\nrun.seed=2", "1\nrun.seed=2"), ("[" * 5000, "[" * 5000),
        ("{a = 1}", {"a": 1}),
    ],
)  # fmt: skip
def test_values_are_toml_or_text(value, read):
    assert read_overrides(None, None, (f"grains.x = {value}",)) == {"grains.x": read}


@pytest.mark.parametrize(
    "arguments",
    [
        ["frobnicate"],
        ["run"],
        ["run", "tilting/quik"],
        ["run", "tilting/quick", "--nope"],
        ["run", "tilting/quick", "--repeats", "0"],
        ["run", "tilting/quick", "--repeats", "many"],
        ["run", "tilting/quick", "--arch", "abacus"],
        ["run", "tilting/quick", "--set"],
        ["run", "tilting/quick", "--set", "grains.diameter"],
        ["run", "tilting/quick", "--set", "=3"],
        ["run", "tilting/quick", "--set", "grains.diamter=3 mm"],
        ["run", "tilting/quick", "--out", __file__],
        ["run", "absent.toml"],
        ["explain", "tilting/quick", "--set", "run.repeats=0"],
        ["render"],
        ["render", "x", "--width", "wide"],
    ],
)
def test_bad_input_gives_one_sentence_and_exit_code_2(arguments, monkeypatch):
    runs = stand_in(monkeypatch, "lab.runs.runner", "run_preset", None)
    stand_in(monkeypatch, "lab.report.explain", "explain", "")
    result = call(*arguments)
    assert result.exit_code == 2 and isinstance(result.exception, SystemExit)
    assert result.stderr.startswith("cargolab: ") and result.stderr.count("\n") == 1
    assert result.stdout == "" and runs == []


@pytest.mark.parametrize(
    "arguments",
    [
        ["sweep", "tilting/quick"],
        ["sweep", "tilting/quick", "--set", "run.seed=1"],
        ["sweep", "tilting/quick", "--set", "run.seed=1:9:1"],
        ["sweep", "tilting/quick", "--set", "run.sed=1,2"],
        ["sweep", "tilting/quick", "--set", "grains.diameter=2 m, 3 m"],
        ["resume", "nowhere"],
    ],
)
def test_bad_sweeps_and_folders_give_one_sentence(arguments):
    result = call(*arguments)
    assert result.exit_code == 2 and isinstance(result.exception, SystemExit)
    assert result.stderr.startswith("cargolab: ") and result.stderr.count("\n") == 1


@pytest.mark.parametrize(
    ("error", "code", "sentence"),
    [
        (LabError("no\nsuch thing."), 2, "no such thing."),
        (Unavailable("no such device."), 2, "no such device."),
        (BadState(0, "grain 3 left the tank at 0.2 s."), 1, "world 0: grain 3 left the tank at 0.2 s."),
        (KeyboardInterrupt(), 130, "interrupted; everything written so far is kept."),
        (KeyboardInterrupt("interrupted at 1 s; go on"), 130, "interrupted at 1 s; go on"),
        (OSError(errno.ENOSPC, "No space left on device", "/full/recording.h5"), 2,
         "/full/recording.h5: no space left on device; free some space or choose another folder "
         "with --out."),
        (PermissionError(errno.EACCES, "Permission denied", "/etc/x"), 2,
         "/etc/x: permission denied; choose another folder with --out."),
        (OSError("unable to\nlock file"), 2, "unable to lock file."),
        (MemoryError(), 2, "there is not enough memory for this: ask for fewer grains or repeats, or free some."),
    ],
)  # fmt: skip
def test_errors_during_a_run_have_their_exit_codes(error, code, sentence, monkeypatch):
    stand_in(monkeypatch, "lab.runs.runner", "run_preset", error)
    result = call("run", "tilting/quick")
    assert result.exit_code == code
    assert result.stderr.strip().splitlines() == [f"cargolab: {sentence}"]


def test_a_bug_is_not_hidden(monkeypatch):
    stand_in(monkeypatch, "lab.runs.runner", "run_preset", ZeroDivisionError())
    assert isinstance(call("run", "tilting/quick").exception, ZeroDivisionError)


def test_render_passes_on_all_options(monkeypatch):
    monkeypatch.setattr("lab.cli.pictures.check_recording", lambda _: None)
    monkeypatch.setattr("lab.paint.edit.batches.batches_for", lambda *_: 1)
    calls = stand_in(monkeypatch, "lab.paint.video", "render_recording", Path("out.mp4"))
    sys.modules["lab.paint.video"].target_of = lambda path, out, png: out or path
    done = call("render", "there", "--out", "out.mp4", "--colour", "layer", "--frame", "earth",
                "--width", "640", "--height", "360", "--world", "2", "--theme", "dark", "--cargo", "coal",
                "--overlay", "trails", "--inset", "surface", "--speed", "0.5", "--hero", "--azimuth", "-40 deg",
                "--elevation", "10 deg", "--orbit", "-0.5", "--cut", "-3 mm", "--slice", "20 mm")  # fmt: skip
    assert done.exit_code == 0 and done.stdout == "out.mp4\n"
    (arguments, options), = calls  # fmt: skip
    assert arguments == (Path("there"), Path("out.mp4"))
    assert callable(options.pop("progress"))
    look = {"colour": "layer", "frame": "earth", "width": 640, "height": 360, "world": 2}
    style = {"theme": "dark", "cargo": "coal", "overlay": "trails", "inset": "surface"}
    space = {"azimuth": "-40 deg", "elevation": "10 deg", "orbit": "-0.5", "cut": "-3 mm", "slice": "20 mm"}
    assert options == {**look, **style, **space, "speed": 0.5, "hero": True, "png": False, "sound": False}
    call("render", "there", "--png")
    assert calls[1][0] == (Path("there"), None) and calls[1][1]["png"] is True


def test_poster_sheet_and_beside_pass_on_their_options(monkeypatch):
    monkeypatch.setattr("lab.cli.pictures.check_recording", lambda _: None)
    painted, fake = {}, ModuleType("lab.paint.video")
    made = {"poster": "p.png", "contact_sheet": "s.png", "render_grid": "b.mp4", "telling_time": 2.5}
    for name, act in made.items():
        painted[name] = stand_in(monkeypatch, "lab.paint.video", name, act)
        setattr(fake, name, getattr(sys.modules["lab.paint.video"], name))
    monkeypatch.setitem(sys.modules, "lab.paint.video", fake)
    posters, sheets, grids = painted["poster"], painted["contact_sheet"], painted["render_grid"]
    assert call("poster", "there", "--event", "--theme", "dark").stdout == "p.png\n"
    assert posters[0][0] == (Path("there"), None) and posters[0][1]["time"] == 2.5 and posters[0][1]["theme"] == "dark"
    assert call("sheet", "there", "--world", "1").stdout == "s.png\n" and sheets[0][1]["world"] == 1
    assert call("beside", "a/one", "a/two", "--out", "b.mp4").stdout == "b.mp4\n"
    assert grids[0][0] == ((Path("a/one"), Path("a/two")), ["one", "two"], Path("b.mp4"))
    refused = call("beside", "a", "b", "--out", "b.mp4", "--caption", "one")
    assert refused.exit_code and "1 for 2 recordings" in refused.output


def test_explain_gets_the_loaded_preset(monkeypatch):
    calls = stand_in(monkeypatch, "lab.report.explain", "explain", "all about it")
    assert call("explain", "tilting/quick", "--set", "run.seed=5").stdout == "all about it\n"
    assert calls[0][0][0].resolved.run.seed == 5


def test_render_of_several_exits_with_2_if_one_fails(monkeypatch, tmp_path):
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "recording.h5").write_bytes(b"")
    calls = []

    def paint_all(_jobs, wishes, _progress):
        calls.append(wishes)
        return {tmp_path / "a": "a is bad."}

    monkeypatch.setattr("lab.paint.many.paint_all", paint_all)
    done = call("render", str(tmp_path / "*"), "--colour", "layer")
    assert done.exit_code == 2 and done.stdout == f"{tmp_path / 'b' / 'video.mp4'}\n"
    said = done.stderr.strip().splitlines()
    assert said[-2:] == ["a is bad.", "cargolab: 1 of 2 were not painted: see above."]
    assert calls[0]["colour"] == "layer"
    assert call("render", str(tmp_path / "c*")).exit_code == 2


def test_the_module_is_the_command():
    root = Path(__file__).parents[2]
    command = [sys.executable, "-m", "lab", "frobnicate"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=False)
    assert done.returncode == 2 and done.stderr == "cargolab: No such command 'frobnicate'.\n"


@settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.lists(st.text() | st.sampled_from(["run", "explain", "--set", "tilting/quick"]), max_size=5))
def test_any_command_line_ends_cleanly(monkeypatch, arguments):
    monkeypatch.setattr("lab.paint.beside.second_process", nullcontext)
    stand_in(monkeypatch, "lab.runs.runner", "run_preset", SimpleNamespace(summary_text="", folder=""))
    stand_in(monkeypatch, "lab.report.explain", "explain", "")
    stand_in(monkeypatch, "lab.paint.video", "render_recording", "")
    result = call(*arguments)
    assert result.exit_code in (0, 2) and isinstance(result.exception, SystemExit | None)
