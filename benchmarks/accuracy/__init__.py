"""cargolab bench accuracy: error against cost, by integrator, step, stiffness, precision, tilt rate, law and repeats.

Each study is one module with a function `study(page, work, fast)` that adds a section to the page. Its sweeps are kept
in the folder `work` and not run again, so that an interrupted study can be continued.
"""

from benchmarks.accuracy import (
    asked,
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
from benchmarks.bench import Bench

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
    "asked": asked.study,
    "asked-ship": asked.study_ship,
    "levels": levels.study,
    "defaults": levels.study_defaults,
}
BENCH = Bench("accuracy", "Speed against error", STUDIES, shown="collisions")
