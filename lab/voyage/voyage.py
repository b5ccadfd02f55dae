"""`cargolab voyage`: the runs of all seeds, the check of the worst with grains, and the page."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from lab.base.errors import LabError
from lab.base.progress import Progress
from lab.preset.find import load
from lab.recording import open_recording
from lab.report.cost import cost
from lab.runs.runner import report, run_preset
from lab.sweeps.point import Point
from lab.sweeps.result import point_folder
from lab.sweeps.sweep import complete
from lab.voyage.asked import Voyage
from lab.voyage.judged import Check, Judged, read
from lab.voyage.page import write

RENDERS = Path("renders/voyage")
CHECKS = "grains"
ONCE = "to start and compile", "of figures", "of pictures"  # parts of the cost that do not come with every seed


@dataclass(frozen=True)
class Outcome:
    """A voyage that was run: its folder, its page, and what its runs say."""

    folder: Path
    page: Path
    judged: Judged


def costs(voyage: Voyage) -> str:
    """What a voyage costs, in words, before it is run. Raises LabError."""
    found = cost(voyage.point(1)).seconds
    once = sum(spent for part, spent in found.items() if part in ONCE)
    each = sum(found.values()) - once
    return f"{voyage.seeds} runs of {voyage.span:g} s: about {(once + voyage.seeds * each) / 60.0:.0f} min on one core"


def sail(
    voyage: Voyage,
    out: Path | None = None,
    *,
    grains: str | None = None,
    sizes: Sequence[str] = (),
    video: bool = True,
    quiet: bool = False,
) -> Outcome:
    """Run a voyage, or go on with it in its folder, and write its page.

    grains: a preset of the same hold with grains, which runs the worst seed with each of the `sizes`, coarse first.
    Raises LabError and KeyboardInterrupt; finished runs are kept.
    """
    if bool(grains) != bool(sizes):
        raise LabError("--grains: give a preset of the same hold with grains, and a --size for each run of it.")
    sweep = voyage.sweep()
    folder = RENDERS / sweep.name if out is None else Path(out)
    complete(sweep, folder, video=False, plots=False, quiet=quiet)
    folders = [point_folder(folder, number) for number in range(voyage.seeds)]
    points = read(folders, range(1, voyage.seeds + 1))
    if not points:
        raise LabError(f"{folder}: none of its runs could be ended; their summaries say why.")
    preset = sweep.points[0].resolved
    judged = Judged(preset, voyage.limit, points, asked=voyage.seeds)
    worst = points[judged.worst]
    with Progress(quiet) as progress:
        report(worst.folder, progress, video=video, plots=True)
    if grains:
        begin = sweep.points[folders.index(worst.folder)].resolved.waves.begin
        checks = [_checked(voyage, folder, grains, size, worst.setting["waves.seed"], begin, quiet) for size in sizes]
        judged = replace(judged, checks=checks)
    return Outcome(folder, write(voyage, judged, sweep, folder), judged)


def _checked(voyage: Voyage, folder: Path, grains: str, size: str, seed: int, begin: float, quiet: bool) -> Check:
    """The worst seed with grains of a size; one that was run is read."""
    place = folder / CHECKS / load(grains).name.replace("/", "-") / size.replace(" ", "")
    if not _ended(place):
        changes = {"grains.diameter": size, "waves.seed": seed, "waves.begin": f"{begin!r} s"}
        run_preset(grains, voyage.sea | changes, place, video=False, quiet=quiet)
    return Check(size, Point({"grains.diameter": size}, place))


def _ended(folder: Path) -> bool:
    try:
        with open_recording(folder) as recording:
            return recording.complete and (folder / "summary.json").exists()
    except LabError:
        return False
