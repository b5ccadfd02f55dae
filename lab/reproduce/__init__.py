"""cargolab reproduce: every granular experiment of the source, run, and held against what the source states.

An experiment is a module of this package with an EXPERIMENTS list, and a line in MODULES. Its runs lie in a folder of
their own and are not run again; one that was cut short is gone on with.
"""

from collections.abc import Sequence
from pathlib import Path

from lab.errors import LabError
from lab.progress import Progress
from lab.reproduce import heaps, humidity, laws, shaking, tilting, validation
from lab.reproduce.experiment import Experiment
from lab.reproduce.report import write_report
from lab.reproduce.runs import carry_out

MODULES = (validation, tilting, humidity, laws, shaking, heaps)
EXPERIMENTS: dict[str, Experiment] = {one.name: one for module in MODULES for one in module.EXPERIMENTS}


def reproduce(names: Sequence[str], out: Path | str, quick: bool, quiet: bool = False) -> Path:
    """Run the experiments whose names begin like one of `names`, or all, and write the report of all that is there.

    The report is written anew after each experiment. Returns its file. Raises LabError, one sentence, and
    KeyboardInterrupt; what was run stays.
    """
    for name in names:
        if not any(known.startswith(name) for known in EXPERIMENTS):
            raise LabError(f"there is no experiment {name}; there are {', '.join(EXPERIMENTS)}.")
    out, work = Path(out), Path(out) / ("quick" if quick else "full")
    progress = Progress(quiet)
    chosen = [name for name in EXPERIMENTS if not names or name.startswith(tuple(names))]
    for number, name in enumerate(chosen, start=1):
        progress.say(f"{name} ({number} of {len(chosen)})")
        for key, batch in EXPERIMENTS[name].batches(quick).items():
            carry_out(batch, work / name / key, quiet)
        page = write_report(EXPERIMENTS, work, out, quick)
    return page
