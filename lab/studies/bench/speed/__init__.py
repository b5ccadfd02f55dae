"""cargolab bench speed: cost of a grain-step by grains, worlds, precision, schedule, threads and law, and its causes.

Each study is one module with a title and a function `study(page, work, fast)` that adds a section to the page. The
settled beds and the curves of the slow study are kept in the folder `work`; times are always measured again.
"""

from collections.abc import Sequence
from pathlib import Path

from lab.report.page import Page
from lab.studies.bench.speed import choices, curves, grains, parts, peers, worlds
from lab.studies.engine import add_studies

# In the order of the page, which is also that of time.
STUDIES = {
    "grains": grains.study,
    "worlds": worlds.study,
    "choices": choices.study,
    "parts": parts.study,
    "peers": peers.study,
    "curves": curves.study,
}


def run_page(names: Sequence[str], out: Path, fast: bool) -> Path:
    """Do the studies whose names begin like one of `names`, or all, and write the page; returns its file."""
    page = Page(out, "speed", "Speed")
    page.say("""All times are of runs taken in turn, so that a machine whose speed drifts slows all alike: medians, and
        of the ratios of runs of the same turn the median, with the smallest and the largest in brackets. M stands for
        a million grain-steps a second.""")
    return add_studies(page, STUDIES, names, fast)
