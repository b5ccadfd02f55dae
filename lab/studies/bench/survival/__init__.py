"""cargolab bench survival: kill the lab at random times, deprive it of resources, and count how it ends.

The cases are in `kills` and in `straits`. Everything runs in processes of its own.
"""

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

from lab.studies.bench.survival import kills, straits
from lab.studies.engine import Kept, choose, write_sections

CASES = {f"kill-{one.__name__}": one for one in (kills.run, kills.sweep, kills.reproduce, kills.gallery)}
CASES |= straits.CASES
FAST = ("kill-run", "lacks", "places")
KILLS, FEW = 50, 3


def run_cases(
    names: Sequence[str], out: Path | str, fast: bool = False, blows: int | None = None, page_only: bool = False
) -> bool:
    """Try the cases whose names begin like one of `names`, or without names all that are not kept; whether all held.

    The counts are printed, kept in survival.json and written on the page. blows: how often each kind of command is
    killed. `page_only`: nothing is tried. Raises LabError for a name that is none.
    """
    chosen = choose(names, CASES, "case", FAST if fast else None)
    blows = blows or (FEW if fast else KILLS)
    kept = Kept(Path(out) / "survival.json", "bench survival", {"fast": fast, "blows": blows})
    Path(out).mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix="survival-", dir=out) as work:
        for name in kept.missing([] if page_only else chosen, anew=bool(names)):
            kept.keep(name, _tried(name, Path(work) / name, blows))
    shown = kept.shown(CASES)
    _write_page(Path(out) / "survival.md", shown)
    return all(shown[name]["passed"] for name in chosen if name in shown)


def _tried(name: str, folder: Path, blows: int) -> dict[str, object]:
    """The record of a case that has been tried in a folder, which is removed again."""
    folder.mkdir()
    tally = CASES[name](folder, blows)
    shutil.rmtree(folder, ignore_errors=True)
    for line in tally.lines():
        print(f"{name}: {line}", flush=True)
    ended = ", ".join(f"{count} {outcome}" for outcome, count in tally.outcomes.items())
    return {"says": tally.says, "tried": tally.tried, "ended": ended, "passed": not tally.failed}


def _write_page(path: Path, shown: Mapping[str, Mapping]) -> None:
    """One table; where the counts were not made together, each row says what made it."""
    rows = [[name, one["says"], one["tried"], one["ended"], one["said"]] for name, one in shown.items()]
    header, said = ["case", "what", "tried", "how it ended"], {row[-1] for row in rows}
    if len(said) > 1:
        header.append("made")
    table = {"header": header, "rows": [row[: len(header)] for row in rows]}
    write_sections(path, "Survival", {"": {"said": said.pop() if len(said) == 1 else "", "blocks": [table]}})
