"""cargolab bench speed: cost of a grain-step by grains, worlds, precision, schedule, threads and law, and its causes.

Each study is one module with a function `study(page, work, fast)` that adds a section to the page. The settled beds and
the curves of the slow study are kept in the folder `work`; times are measured again wherever a study is done again.
"""

from collections.abc import Sequence
from pathlib import Path

from benchmarks.bench import Bench
from benchmarks.speed import choices, curves, equal_error, grains, parts, peers, processors, worlds

# In the order of the page, which is also that of time.
STUDIES = {
    "grains": grains.study,
    "worlds": worlds.study,
    "choices": choices.study,
    "parts": parts.study,
    "peers": peers.study,
    "equal-error": equal_error.study,
    "equal-large": equal_error.study_large,
    "equal-spheres": equal_error.study_spheres,
    "equal-many-spheres": equal_error.study_many_spheres,
    "curves": curves.study,
    "slow-tilts": curves.study_slow,
}
ABOUT = """All times are of runs taken in turn, so that a machine whose speed drifts slows all alike: medians, and of
the ratios of runs of the same turn the median, with the smallest and the largest in brackets. M stands for a million
grain-steps a second."""
BENCH = Bench("speed", "Speed", STUDIES, ABOUT, "grains")


def run_page(names: Sequence[str], out: Path | str, fast: bool, page_only: bool = False) -> Path:
    """Do the studies as `Bench.run` does, and write the page of ratios to other codes, too; returns the first page."""
    page = BENCH.run(names, out, fast, page_only)
    processors.write_page(Path(out))
    return page
