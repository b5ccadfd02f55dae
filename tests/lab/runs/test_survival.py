"""The lab in processes that are killed at random times or lack something: the same bits, or one sentence."""

import os
import platform
import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

import pytest

from lab.recording import FILE_NAME, open_recording
from tests.oracles.processes import COMMAND, RUN, SET, SETTINGS, Ended, begin, bits, call, end, kill

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="needs Linux's limits and its lists of processes")

# Of each command in all, and of one run of it at most; KILLS=40 before a release
KILLS, BLOWS = int(os.environ.get("KILLS", 10)), 5
OFFSETS = Path(__file__).parents[3] / "presets" / "ship" / "s175-supply-vessel.csv"
WARM = 0.6  # of the time of a command that compiles its kernels, about that of one that finds them
ANEW = ("--set", "grains.reuse_bed=false")  # so that settling may be cut short, too
NO_FIGURES = """
import sys
from types import SimpleNamespace
sys.modules["lab.report.plots"] = SimpleNamespace(write_plots=lambda *_: {})
"""
TANK = """
format = 3
title = "An empty tank"
tank = { width = "0.3 m", height = "0.2 m", lid = false }
motion.sway = { amplitude = "10 mm", frequency = "1 Hz" }
run = { duration = "1 s", repeats = 2, threads = 1 }
record.checkpoint_every = "0 s"
"""
CUP = """
format = 3
title = "A closed cup of water and air"
tank = { width = "60 mm", height = "60 mm" }
water = { depth = "24 mm", spacing = "6 mm", sound_speed = "12 m/s" }
air = {}
gauges.P1 = { place = ["-30 mm", "12 mm"] }
motion.sway = { amplitude = "3 mm", frequency = "3 Hz" }
run = { duration = "0.4 s", threads = 1, schedule = "per-world" }
record.checkpoint_every = "0 s"
"""
SHIP = """
format = 3
title = "A ship by her lines in waves, with coarse water in her tank"
based_on = "ship/anti-roll-s175"
ship.offsets = "OFFSETS"
water.spacing = "0.3 m"
run = { duration = "20 s", threads = 1, schedule = "per-world" }
record.checkpoint_every = "0 s"
"""
SCENES = {
    "a cup of water and air": CUP,
    "a ship with water in her tank": SHIP.replace("OFFSETS", str(OFFSETS)),
}
BATCHES = f"""
import sys
from pathlib import Path
from lab.base.progress import Progress
from lab.studies.reproduce.runs import Batch
from lab.studies.reproduce.workers import carry_out_all

batches = [Batch("tilting/quick", {SETTINGS!r} | {{"run.seed": seed}}) for seed in (1, 2)]
folders = [Path(sys.argv[1]) / str(k) for k in range(2)]
list(carry_out_all(dict(zip(folders, batches)), Progress(quiet=True)))
"""
SWEEP = ("sweep", "tilting/quick", "--no-video", *SET, "--set", "material.friction=0.2, 0.3, 0.4", "--out")
RESUME = ("resume", "--no-video")
GALLERY = ("gallery", "tilting/quick", "--quiet", "--out")
# Of each: what begins it, what goes on with it, the code if it is no command, and how often it is killed in all.
KILLED = {
    "run": ([*RUN, *ANEW, "--out"], RESUME, COMMAND, KILLS),
    "sweep": (SWEEP, RESUME, COMMAND, KILLS),
    "two batches side by side": ((), (), BATCHES, KILLS),
    "gallery": (GALLERY, GALLERY, COMMAND, 2),  # with its clip it takes long
}


def killed(work: Path, first, again, code: str, kills: int, before: str = "") -> None:
    """Begin, kill at a random time, go on, and so forth: in the end the bits are those of an undisturbed one."""

    def recorded(folder: Path) -> dict[str, dict[str, str]]:
        return {str(path.relative_to(folder)): bits(path.parent) for path in sorted(folder.rglob(FILE_NAME))}

    def asked() -> list:
        begun = (cut / FILE_NAME).exists() or (cut / "sweep.json").exists()
        return [*(again if begun else first), cut]

    begun, cut = time.monotonic(), work / "cut"
    assert call([*first, work / "whole"], before, code=code).done
    lasts, expected, chance, done = time.monotonic() - begun, recorded(work / "whole"), random.Random(1), 0
    while done < kills:
        shutil.rmtree(cut, ignore_errors=True)
        for _ in range(min(chance.randint(1, BLOWS), kills - done)):
            process = begin(asked(), before, code=code)
            time.sleep(chance.uniform(0.0, WARM * lasts))
            done += process.poll() is None
            kill(process, all_at_once=chance.random() < 0.5)
        ended = call(asked(), before, code=code)
        assert ended.done or "there is nothing to resume" in ended.said, ended
        assert recorded(cut) == expected


@pytest.mark.slow
def test_a_run_killed_at_random_times_gives_the_same_results(tmp_path):
    """Of an empty tank, which compiles fast, and without figures, which take as long as the rest of such a run."""
    (tmp_path / "tank.toml").write_text(TANK)
    killed(tmp_path, ["run", tmp_path / "tank.toml", "--no-video", "--out"], RESUME, COMMAND, 1, NO_FIGURES)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_water_air_and_ships_killed_at_random_times_give_the_same_results(name, tmp_path):
    (tmp_path / "scene.toml").write_text(SCENES[name])
    killed(tmp_path, ["run", tmp_path / "scene.toml", "--no-video", "--out"], RESUME, COMMAND, KILLS, NO_FIGURES)


SHEETS = {"stability": ("stability", "ship/handysize-grain", "--out"), "hull": ("hull", OFFSETS, "--out")}


@pytest.mark.slow
@pytest.mark.parametrize("name", SHEETS)
def test_a_sheet_that_is_cut_short_leaves_whole_files_alone(name, tmp_path):
    def files(folder: Path) -> dict[str, bytes]:
        return {path.name: path.read_bytes() for path in folder.glob("*") if ".part" not in path.name}

    begun, chance = time.monotonic(), random.Random(2)
    assert call([*SHEETS[name], tmp_path / "whole"]).done
    lasts, expected = time.monotonic() - begun, files(tmp_path / "whole")
    for _ in range(KILLS):
        process = begin([*SHEETS[name], tmp_path / "cut"])
        time.sleep(chance.uniform(0.4, 1.0) * lasts)
        kill(process, all_at_once=True)
        assert files(tmp_path / "cut").items() <= expected.items()
    assert call([*SHEETS[name], tmp_path / "cut"]).done
    assert {path.name: path.read_bytes() for path in (tmp_path / "cut").iterdir()} == expected


@pytest.mark.slow
@pytest.mark.parametrize("name", KILLED)
def test_what_is_killed_again_and_again_gives_the_same_results(name, tmp_path):
    killed(tmp_path, *KILLED[name])


LIMIT = "import resource; resource.setrlimit(resource.RLIMIT_{0}, ({1}, {1}))\n"
LIMITS = {
    "AS": (5e8, 1e9, 1.7e9, 1.8e9, 1.9e9, 2e9, 4e9),  # bytes of memory
    "NOFILE": (8, 16, 32, 64),  # open files
    "NPROC": (1, 4, 16),  # processes
    "FSIZE": (1e3, 3e4, 1e5, 2e5, 3e5, 1e6, 5e6, 12e6, 2e7),  # bytes of a file, as on a full disk
}


@pytest.mark.slow
@pytest.mark.parametrize(("what", "amount"), [(what, amount) for what in LIMITS for amount in LIMITS[what]])
def test_a_run_that_lacks_room_ends_in_a_sentence_and_what_it_left_can_be_read(what, amount, tmp_path):
    film = [word for word in RUN if word != "--no-video"] if what == "FSIZE" else RUN
    ended = call([*film, "--out", tmp_path / "run"], LIMIT.format(what, int(amount)))
    assert ended.done or ended.in_a_sentence, ended
    if what == "FSIZE" and (tmp_path / "run" / FILE_NAME).exists():
        with open_recording(tmp_path / "run") as recording:
            assert all(len(values) >= 0 for values in recording.series.values())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("what", "amount"), [("AS", 1.9e9), ("AS", 2.2e9), ("NOFILE", 16), ("FSIZE", 5e4), ("FSIZE", 3e5)]
)
def test_water_that_lacks_room_ends_in_a_sentence_and_what_it_left_can_be_read(what, amount, tmp_path):
    (tmp_path / "cup.toml").write_text(CUP)
    line = ["run", tmp_path / "cup.toml", "--no-video", "--out", tmp_path / "run"]
    ended = call(line, LIMIT.format(what, int(amount)))
    assert ended.done or ended.in_a_sentence, ended
    if what == "FSIZE" and (tmp_path / "run" / FILE_NAME).exists():
        with open_recording(tmp_path / "run") as recording:
            assert all(len(values) >= 0 for values in recording.series.values())


@pytest.fixture(scope="module")
def whole(tmp_path_factory) -> dict[str, str]:
    """The bits of an undisturbed run."""
    folder = tmp_path_factory.mktemp("survival") / "whole"
    assert call([*RUN, "--out", folder]).done
    return bits(folder)


def same(folder: Path, ended: Ended, whole: dict[str, str]) -> None:
    assert ended.done and bits(folder) == whole, ended


@pytest.mark.slow
@pytest.mark.parametrize("name", ["with spaces", "Füllung ₂ 積荷", "n" * 200, "--out", "a'b\"c$d", "new\nline"])
def test_a_folder_may_have_an_odd_name(name, whole, tmp_path):
    same(tmp_path / name, call([*RUN, "--out", tmp_path / name]), whole)


@pytest.mark.slow
@pytest.mark.parametrize("folder", ["/proc/nowhere/run", "/dev/null", "/sys/run", "x" * 300])
def test_a_folder_that_cannot_be_written_is_one_sentence(folder):
    assert call([*RUN, "--out", folder]).in_a_sentence


# A filter of system calls after which flock fails with ENOLCK, as in network folders without locks (Linux).
NO_LOCKS = """
import ctypes, errno, platform, struct
number = {"x86_64": 73, "aarch64": 32}[platform.machine()]
code = b"".join(struct.pack("HBBI", *line) for line in (
    (0x20, 0, 0, 0), (0x15, 0, 1, number), (0x06, 0, 0, 0x00050000 | errno.ENOLCK), (0x06, 0, 0, 0x7FFF0000)))
lines = ctypes.create_string_buffer(code)
class Program(ctypes.Structure):
    _fields_ = [("length", ctypes.c_ushort), ("lines", ctypes.c_void_p)]
program = Program(4, ctypes.addressof(lines))
libc = ctypes.CDLL(None, use_errno=True)
assert libc.prctl(38, 1, 0, 0, 0) == 0 and libc.prctl(22, 2, ctypes.byref(program)) == 0
"""
JUMPS = """
import itertools, time
true, days = time.time, itertools.cycle([0.0, 86400.0, -86400.0, 4e8, -4e8])
time.time = lambda: true() + next(days)
"""
NO_DISPLAY = {
    "DISPLAY": "",
    "WAYLAND_DISPLAY": "",
    "VK_ICD_FILENAMES": "/nonexistent",
    "VK_DRIVER_FILES": "/nonexistent",
}
LACKS = {
    "one core": ("import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})\n", {}),
    "no display": ("", NO_DISPLAY),
    "no home": ("", {"HOME": "/proc/nobody", "XDG_CACHE_HOME": "", "CARGOLAB_CACHE": "/proc/nobody"}),
    "a clock that jumps": (JUMPS, {}),
    "no locks": (NO_LOCKS, {}),
}


@pytest.mark.slow
@pytest.mark.parametrize("name", LACKS)
def test_what_a_run_can_do_without(name, whole, tmp_path):
    before, environment = LACKS[name]
    same(tmp_path / "run", call([*RUN, "--out", tmp_path / "run"], before, environment), whole)


@pytest.mark.slow
def test_a_window_without_a_display_is_one_sentence():
    assert call(["view", "tilting/quick"], environment=NO_DISPLAY).in_a_sentence


@pytest.mark.slow
@pytest.mark.parametrize("turn", range(3))
def test_two_processes_share_a_store_of_beds_and_not_a_folder(turn, whole, tmp_path):
    def at_once(*folders: Path) -> list[Ended]:
        store = {"CARGOLAB_CACHE": str(tmp_path / "store")}
        return [end(one) for one in [begin([*RUN, "--out", folder], environment=store) for folder in folders]]

    own = tmp_path / "first", tmp_path / "second"
    for folder, ended in zip(own, at_once(*own), strict=True):
        same(folder, ended, whole)
    first, second = sorted(at_once(tmp_path / "shared", tmp_path / "shared"), key=lambda one: one.code)
    same(tmp_path / "shared", first, whole)
    assert second.in_a_sentence and ("in use" in second.said or "already holds" in second.said)


TWENTY = """
import sys
from pathlib import Path
import lab
from tests.oracles.processes import SETTINGS, bits

settings = {key.replace(".", "__"): value for key, value in SETTINGS.items()}
found, memory = [], []
for k in range(20):
    folder = Path(sys.argv[1]) / str(k)
    lab.run("tilting/quick", folder, video=False, quiet=True, **settings)
    found.append(bits(folder))
    memory.append(int(Path("/proc/self/statm").read_text().split()[1]) * 4096 / 2**20)
sys.exit(any(one != found[0] for one in found) or memory[-1] - memory[3] > 64.0)
"""


@pytest.mark.slow
def test_twenty_runs_in_one_process_give_the_same_bits_and_keep_its_memory(tmp_path):
    """From the fourth run on it grows by less than 64 MiB."""
    ended = call([tmp_path], environment=PATHS, code=TWENTY)
    assert ended.done, ended


PATHS = {"PYTHONPATH": str(Path(__file__).parents[3])}
RECORD = """
import sys
from tests.oracles.synthetic import recorder, sample
from lab.recording import Recorder, open_recording

with recorder(sys.argv[1]) as run:
    run.sample(sample(0.0))
with Recorder(sys.argv[1], samples=1) as run:
    run.sample(sample(1.0))
    run.flush()
with open_recording(sys.argv[1]) as recording:
    print(recording.status, len(recording.series["time"]))
"""


@pytest.mark.skipif(platform.machine() not in ("x86_64", "aarch64"), reason="needs Linux's filters of calls")
def test_recordings_work_where_files_cannot_be_locked(tmp_path):
    line = [sys.executable, "-c", NO_LOCKS + RECORD, tmp_path / "run"]
    done = subprocess.run(line, env=os.environ | PATHS, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "complete 2\n"), done.stderr


@pytest.mark.parametrize(
    ("code", "said", "fine"),
    [
        (2, "settling …\ncargolab: no room there.\n", True),
        (1, "cargolab: world 0: grain 3 left.\n", True),
        (0, "cargolab: all is well.\n", False),
        (-11, "cargolab: about to break.\n", False),
        (2, "Traceback (most recent call last):\ncargolab: no.\n", False),
        (2, "", False),
    ],
)
def test_sentences_are_recognised(code, said, fine):
    assert Ended(code, said).in_a_sentence == fine
