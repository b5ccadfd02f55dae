"""Processes that lack something: memory, files, disk space, a home, a display, locks, or a reliable clock."""

from collections.abc import Callable, Sequence
from pathlib import Path

from lab.recording import open_recording
from lab.studies.bench.survival.child import RUN, Ended, begin, bits, call, end
from lab.studies.bench.survival.tally import Tally

SAME, SENTENCE, WAITS = "the same bits", "a sentence", "told that the folder is in use"
FILM = [word for word in RUN if word != "--no-video"]
LIMIT = "import resource; resource.setrlimit(resource.RLIMIT_{0}, ({1}, {1}))\n"
MEMORY, FILES, PROCESSES = (5e8, 1e9, 1.7e9, 1.8e9, 1.9e9, 2e9, 4e9), (8, 16, 32, 64), (1, 4, 16)
SIZES = (1e3, 3e4, 1e5, 2e5, 3e5, 1e6, 5e6, 12e6, 2e7)  # bytes
MISSING = {"DISPLAY": "", "WAYLAND_DISPLAY": "", "VK_ICD_FILENAMES": "/nonexistent", "VK_DRIVER_FILES": "/nonexistent"}
ONE_CORE = "import os; os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})\n"
JUMPS = """
import itertools, time
true, days = time.time, itertools.cycle([0.0, 86400.0, -86400.0, 4e8, -4e8])
time.time = lambda: true() + next(days)
"""
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
TWENTY = """
import sys
from pathlib import Path
import lab
from lab.studies.bench.survival.child import SETTINGS, bits

settings = {key.replace(".", "__"): value for key, value in SETTINGS.items()}
found, memory = [], []
for k in range(int(sys.argv[2])):
    folder = Path(sys.argv[1]) / str(k)
    lab.run("tilting/quick", folder, video=False, quiet=True, **settings)
    found.append(bits(folder))
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    memory.append(pages * 4096 / 2**20)
print(" ".join(f"{x:.0f}" for x in memory), file=sys.stderr)
sys.exit(any(one != found[0] for one in found))
"""


def limits(work: Path, _: int) -> Tally:
    """Memory, files, processes."""
    tally = Tally("limits on memory, files and processes: done, or a sentence")
    for name, amounts in {"AS": MEMORY, "NOFILE": FILES, "NPROC": PROCESSES}.items():
        for amount in amounts:
            folder = work / f"{name}-{amount:g}"
            ended = call([*RUN, "--out", folder], LIMIT.format(name, int(amount)))
            good = ended.done or ended.in_a_sentence
            tally.count(good, "done" if ended.done else SENTENCE, f"{name} {amount:g}: {ended.code}: {_tail(ended)}")
    return tally


def room(work: Path, _: int) -> Tally:
    """A full disk: the size of files is limited while recording, filming and summarising."""
    tally = Tally("files that may not grow: done, or a sentence and a recording that can be read")
    for size in SIZES:
        folder = work / f"{size:g}"
        ended = call([*FILM, "--out", folder], LIMIT.format("FSIZE", int(size)))
        good = ended.done or (ended.in_a_sentence and _readable(folder))
        tally.count(good, "done" if ended.done else SENTENCE, f"{size:g} bytes: {ended.code}: {_tail(ended)}")
    return tally


def places(work: Path, _: int) -> Tally:
    """Folders with odd names, and folders that cannot be written."""
    tally = Tally("odd folders: the same bits, or a sentence")
    expected = _undisturbed(work)
    for name in ("with spaces", "Füllung ₂ 積荷", "n" * 200, "--out", "a'b\"c$d", "new\nline"):
        folder = work / "odd" / name
        _compare(tally, expected, folder, call([*RUN, "--out", folder]), repr(name))
    for folder in ("/proc/nowhere/run", "/dev/null", "/sys/run", "x" * 300):
        ended = call([*RUN, "--out", folder])
        tally.count(ended.in_a_sentence, SENTENCE, f"{folder}: {ended.code}: {_tail(ended)}")
    return tally


def lacks(work: Path, _: int) -> Tally:
    """One core, no display, no Vulkan, no home, no locks, a clock that jumps."""
    tally = Tally("one core, no display and no Vulkan, no home, no locks, a clock that jumps: the same bits")
    expected = _undisturbed(work)
    homeless = {"HOME": "/proc/nobody", "XDG_CACHE_HOME": "", "CARGOLAB_CACHE": "/proc/nobody"}
    ways: dict[str, tuple[str, dict[str, str]]] = {
        "one core": (ONE_CORE, {}),
        "no display": ("", MISSING),
        "no home": ("", homeless),
        "clock": (JUMPS, {}),
        "locks": (NO_LOCKS, {}),
    }
    for name, (before, environment) in ways.items():
        folder = work / name
        _compare(tally, expected, folder, call([*RUN, "--out", folder], before, environment), name)
    ended = call(["view", "tilting/quick"], environment=MISSING)
    tally.count(ended.in_a_sentence, SENTENCE, f"view: {ended.code}: {_tail(ended)}")
    return tally


def together(work: Path, _: int) -> Tally:
    """Two processes on one store of beds, and on one folder."""
    tally = Tally("two processes at once on one store of beds, then on one folder: the same bits, or told to wait")
    expected = _undisturbed(work)
    for turn in range(3):
        store = {"CARGOLAB_CACHE": str(work / f"store-{turn}")}
        folders = [work / f"own-{turn}-{k}" for k in range(2)]
        for folder, ended in zip(folders, _at_once(folders, store), strict=True):
            _compare(tally, expected, folder, ended, folder.name)
        shared = work / f"shared-{turn}"
        first, second = sorted(_at_once([shared, shared], store), key=lambda one: one.code)
        _compare(tally, expected, shared, first, shared.name)
        told = second.in_a_sentence and ("in use" in second.said or "already holds" in second.said)
        tally.count(told, WAITS, f"{shared.name}: {second.code}: {_tail(second)}")
    return tally


def again(work: Path, kills: int) -> Tally:
    """`lab.run` again and again in one process: its memory from the fourth run on, and the bits."""
    times = 20 if kills > 5 else 6
    ended = call([work, times], code=TWENTY)
    memory = [float(word) for word in (ended.said.strip().splitlines() or [""])[-1].split() if word.isdigit()]
    grown = memory[-1] - memory[3] if len(memory) == times else float("nan")
    tally = Tally(f"lab.run {times} times in one process: the same bits, memory grown by {grown:.0f} MiB since the 4th")
    tally.count(ended.done and grown < 64.0, "process", f"{ended.code}: {_tail(ended)}")
    return tally


def _at_once(folders: Sequence[Path], environment: dict[str, str]) -> list[Ended]:
    started = [begin([*RUN, "--out", folder], environment=environment) for folder in folders]
    return [end(process) for process in started]


def _undisturbed(work: Path) -> dict[str, str]:
    ended = call([*RUN, "--out", work / "whole"])
    if not ended.done:
        raise RuntimeError(f"undisturbed: {ended.code}: {_tail(ended)}")
    return bits(work / "whole")


def _compare(tally: Tally, expected: dict[str, str], folder: Path, ended: Ended, name: str) -> None:
    same = ended.done and bits(folder) == expected
    tally.count(same, SAME, f"{name}: {ended.code}: {_tail(ended)}")


def _readable(folder: Path) -> bool:
    """Whether what was begun in a folder can be read, if anything was."""
    if not (folder / "recording.h5").exists():
        return True
    with open_recording(folder) as recording:
        return all(len(values) >= 0 for values in recording.series.values())


def _tail(ended: Ended) -> str:
    return ended.said[-500:]


CASES: dict[str, Callable[[Path, int], Tally]] = {
    one.__name__: one for one in (limits, room, places, lacks, together, again)
}
