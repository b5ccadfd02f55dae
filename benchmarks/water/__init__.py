"""cargolab bench water: the lab's water beside DualSPHysics and PySPH on the same pools, in turn, with errors of both.

Each study is a function `study(page, work, fast)` that adds a section to the page. What was measured is in the page's
JSON.
"""

from benchmarks.bench import Bench
from benchmarks.water import accuracy, beside_air, front, levels, sizes, speed, terms, vector

STUDIES = {
    "speed": speed.study,
    "accuracy": accuracy.study,
    "levels": levels.study,
    "front": front.study,
    "sizes": sizes.study,
    "vector": vector.study,
    "air": beside_air.study,
    "terms": terms.study,
}
ABOUT = """Times are of runs taken in turn, so that a machine whose speed drifts slows all alike: medians, and of the
ratios of runs of the same turn the median, with the smallest and the largest in brackets. M stands for a million
particle-steps a second, of particles of water alone; a step is one evaluation of the forces. Other processes may have
shared the machine: on one core the time is the process's own. Section Speed has two tables of ratios. Which code is
done first with the same tank, spacing, smoothing length and physical time is what the second tells, times as fast in
simulated seconds: take that one. The first is of particle-steps: how much faster one step is. Codes whose steps are
longer gain nothing by it, so it compares programs and not answers."""
BENCH = Bench("water", "Water beside other codes", STUDIES, ABOUT, "front")
