"""The names that claims may use for what needs code.

A row names a number (`of`) that no measure gives, or a function that gives rows (`by`); an experiment names the
function that draws its figure (`by`), or the one that tells all of it (`tell`).
"""

from collections.abc import Callable, Mapping, Sequence

from lab.measures.value import Value
from lab.studies.reproduce import figures
from lab.studies.reproduce.experiment import Found, Row, Told
from lab.studies.reproduce.grains import beds, outlines, stack
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships import capsizes, damping, low_sides, rolls, section
from lab.studies.reproduce.water import dam_break, damper, impact, prismatic, waves

DERIVED: Mapping[str, Callable[[Sequence[Outcome], float | None], Value]] = {
    "spill_lag": beds.spill_lag,
    "onset": beds.onset,
    "early_shift": outlines.early_shift,
    "early_range": outlines.early_range,
}
ROWS: Mapping[str, Callable[[Found], list[Row]]] = {
    "stack_lag": stack.stack_lag,
    "tanks_span": beds.tanks_span,
    "memory_effects": beds.memory_effects,
    "largest_rolls": rolls.largest_rolls,
    "section_amplitudes": section.section_amplitudes,
}
FIGURES: Mapping[str, Callable] = {
    "shift": figures.shift,
    "against": figures.against,
    "stack": stack.stack,
    "heaps": beds.heaps,
    "descriptors": outlines.descriptors,
    "courses": outlines.courses,
    "memory": beds.memory,
    "rolls": rolls.rolls_figure,
}
TELLS: Mapping[str, Callable[[Found], Told]] = {
    "section": section.tell,
    "damping": damping.tell,
    "capsizes": capsizes.tell,
    "low sides": low_sides.tell,
    "map": low_sides.tell_map,
    "impact": impact.tell,
    "dam break": dam_break.tell,
    "sway beat": waves.sway_beat,
    "pitch": waves.pitch,
    "damper": damper.tell,
    "convergence": prismatic.convergence,
    "roof": prismatic.contact,
}
