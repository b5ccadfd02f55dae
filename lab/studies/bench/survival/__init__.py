"""cargolab bench survival: kill the lab at random times, deprive it of resources, and count how it ends.

The cases are in `kills` and in `straits`. Everything runs in processes of its own.
"""

import shutil
from collections.abc import Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from lab.report.page import Page
from lab.studies.bench.survival import kills, straits
from lab.studies.engine import choose

CASES = {f"kill-{one.__name__}": one for one in (kills.run, kills.sweep, kills.reproduce, kills.gallery)}
CASES |= straits.CASES
FAST = ("kill-run", "lacks", "places")
KILLS, FEW = 50, 3


def run_cases(names: Sequence[str], out: Path, fast: bool = False, blows: int | None = None) -> bool:
    """Try the cases whose names begin like one of `names`, or all, print the counts, write the page; whether all held.

    blows: how often each kind of command is killed. Raises LabError for a name that is none.
    """
    chosen = choose(names, CASES, "case", FAST if fast else None)
    blows = blows or (FEW if fast else KILLS)
    page, rows = Page(out, "survival", "Survival"), []
    Path(out).mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix="survival-", dir=out) as work:
        for name in chosen:
            folder = Path(work) / name
            folder.mkdir()
            tally = CASES[name](folder, blows)
            shutil.rmtree(folder, ignore_errors=True)
            for line in tally.lines():
                print(f"{name}: {line}", flush=True)
            ended = ", ".join(f"{count} {outcome}" for outcome, count in tally.outcomes.items())
            rows.append((name, tally.says, str(tally.tried), ended, not tally.failed))
    page.table(["case", "what", "tried", "how it ended"], [row[:4] for row in rows])
    page.write()
    return all(row[4] for row in rows)
