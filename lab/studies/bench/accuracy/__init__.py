"""cargolab bench accuracy: error against cost, by integrator, step, stiffness, precision, tilt rate, law and repeats.

Each study is one module with a title and a function `study(page, work, fast)` that adds a section to the page. Sweeps
are kept in the folder `work` and not run again, so an interrupted page can be continued.
"""

from collections.abc import Sequence
from pathlib import Path

from lab.report.page import Page
from lab.studies.bench.accuracy import (
    collisions,
    creep,
    laws,
    levels,
    precision,
    rate,
    repeats,
    shaken,
    skin,
    stiffness,
)
from lab.studies.engine import add_studies

# In the order of the page, which is also that of time.
STUDIES = {
    "collisions": collisions.study,
    "shaken": shaken.study,
    "stiffness": stiffness.study,
    "precision": precision.study,
    "rate": rate.study,
    "laws": laws.study,
    "creep": creep.study,
    "repeats": repeats.study,
    "skin": skin.study,
    "levels": levels.study,
}


def run_page(names: Sequence[str], out: Path, fast: bool) -> Path:
    """Do the studies whose names begin like one of `names`, or all, and write the page; returns its file."""
    return add_studies(Page(out, "accuracy", "Speed against error"), STUDIES, names, fast)
