"""Processes killed at random times, continued, killed again, and compared with undisturbed ones."""

import random
import shutil
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from lab.recording import FILE_NAME
from lab.studies.bench.survival.child import RUN, SET, SETTINGS, begin, bits, call, end, kill
from lab.studies.bench.survival.tally import Tally

BLOWS = 5  # a run at most
SWEEP = ("sweep", "tilting/quick", "--no-video", *SET, "--set", "material.friction=0.2, 0.3, 0.4")
ANEW = ("--set", "grains.reuse_bed=false")  # so that settling may be cut short, too
WORKERS = f"""
import sys
from pathlib import Path
from lab.base.progress import Progress
from lab.studies.reproduce.runs import Batch
from lab.studies.reproduce.workers import carry_out_all

batches = [Batch("tilting/quick", {SETTINGS!r} | {{"run.seed": seed}}) for seed in (1, 2)]
folders = [Path(sys.argv[1]) / str(k) for k in range(2)]
list(carry_out_all(dict(zip(folders, batches)), Progress(quiet=True)))
"""
GALLERY = ("gallery", "tilting/quick", "--quiet", "--out")


def run(work: Path, kills: int) -> Tally:
    """Runs."""
    return _tour(work, kills, "runs", [*RUN, *ANEW, "--out"], ["resume", "--no-video"])


def sweep(work: Path, kills: int) -> Tally:
    """Sweeps of three points."""
    return _tour(work, kills, "sweeps", [*SWEEP, "--out"], ["resume", "--no-video"])


def reproduce(work: Path, kills: int) -> Tally:
    """Two batches in processes side by side, as `cargolab reproduce` runs them."""
    return _tour(work, kills, "two batches side by side", [], [], code=WORKERS)


def gallery(work: Path, kills: int) -> Tally:
    """A gallery of one preset, with its clip; it takes long, so a fifth of the kills."""
    return _tour(work, max(1, kills // 5), "a gallery", GALLERY, GALLERY)


def _tour(work: Path, kills: int, what: str, first: Sequence, again: Sequence, code: str | None = None) -> Tally:
    """Kill the command `kills` times in all; each tour is continued until it is done."""
    tally = Tally(f"kill -9 of {what} at random times, then resumed: the same bits as undisturbed")
    how = {"code": code} if code else {}
    whole, cut = work / "whole", work / "cut"
    begun = time.monotonic()
    ended = call([*first, whole], **how)
    lasts = time.monotonic() - begun
    if not ended.done:
        tally.count(False, "", f"undisturbed: {ended.code}: {ended.said}")
        return tally
    expected, chance, done, tours = _all_bits(whole), random.Random(1), 0, 0
    while done < kills:
        shutil.rmtree(cut, ignore_errors=True)
        tours += 1
        for _ in range(min(chance.randint(1, BLOWS), kills - done)):
            start = partial(begin, [*(again if _recorded(cut) else first), cut], **how)
            done += _blow(start, chance.uniform(0.0, lasts), chance.random() < 0.5)
        ended = call([*(again if _recorded(cut) else first), cut], **how)
        fine = ended.done or "there is nothing to resume" in ended.said
        same = fine and _all_bits(cut) == expected
        tally.count(same, "resumed to the same bits", f"tour {tours}: code {ended.code}: {ended.said[-500:]}")
    tally.says += f" ({done} kills)"
    return tally


def _blow(start: Callable, after: float, all_at_once: bool) -> int:
    """Kill a process after some time (s); 1, or 0 where it had ended before."""
    process = start()
    time.sleep(after)
    if process.poll() is None:
        kill(process, all_at_once)
        return 1
    end(process)
    return 0


def _recorded(folder: Path) -> bool:
    return (folder / FILE_NAME).exists() or (folder / "sweep.json").exists()


def _all_bits(folder: Path) -> dict[str, dict[str, str]]:
    return {str(path.relative_to(folder)): bits(path.parent) for path in sorted(folder.rglob(FILE_NAME))}
