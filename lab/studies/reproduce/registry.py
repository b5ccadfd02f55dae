"""The names that claims may use for what needs code.

A row names a number (`of`) that no measure gives, or a function that gives rows (`by`); an experiment names the
function that draws its figure (`by`), or the one that tells all of it (`report`).
"""

from collections.abc import Callable, Mapping, Sequence

from lab.measures.value import Value, over_worlds
from lab.studies.reproduce import figures
from lab.studies.reproduce.experiment import Found, ReportSection, Row
from lab.studies.reproduce.grains import beds, outlines, stack
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.ships import (
    breaking,
    capsizes,
    coupled,
    damping,
    four_ways,
    low_sides,
    rolls,
    section,
    tuning,
)
from lab.studies.reproduce.water import (
    chamfer,
    dam_break,
    damper,
    drag,
    drainage,
    flooded,
    impact,
    prismatic,
    response,
    sinking,
    surfaces,
    waves,
)


def _alone(unit: str, number: Callable[[Outcome, object], float]) -> Callable[[Sequence[Outcome], object], Value]:
    return lambda outcomes, given: over_worlds([number(outcomes[0], given)], unit)


def _of_starts(unit: str, number: Callable[[Outcome, object], float]) -> Callable[[Sequence[Outcome], object], Value]:
    """As `_alone`, of all the starts of a run: impacts scatter from start to start."""
    return lambda outcomes, given: over_worlds([number(one, given) for one in outcomes], unit)


# Numbers of single runs without scatter from bed to bed; NaN where a run has none.
OF_ONE_RUN = {name: _of_starts(*number) for name, number in impact.NUMBERS.items()} | {
    name: _alone(*number)
    for of in (
        dam_break,
        waves,
        damper,
        prismatic,
        chamfer,
        drag,
        flooded,
        sinking,
        surfaces,
        coupled,
        four_ways,
        breaking,
    )
    for name, number in of.NUMBERS.items()
}
DERIVED: Mapping[str, Callable[[Sequence[Outcome], object], Value]] = {
    **OF_ONE_RUN,
    "spill_lag": beds.spill_lag,
    "onset": beds.onset,
    "early_shift": outlines.early_shift,
    "early_range": outlines.early_range,
    "cycle_peaks": prismatic.cycle_peaks,
    "peak_at": prismatic.peak_at,
    "wet_cycles": prismatic.wet_cycles,
}
ROWS: Mapping[str, Callable[[Found], list[Row]]] = {
    "stack_lag": stack.stack_lag,
    "tanks_span": beds.tanks_span,
    "memory_effects": beds.memory_effects,
    "largest_rolls": rolls.largest_rolls,
    "section_amplitudes": section.section_amplitudes,
    "order of roll": coupled.order_of_roll,
    "tank tuning": tuning.rows,
    "chamfers": chamfer.rows,
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
    "impacts": impact.figure,
    "dam break": dam_break.figure,
    "sway beat": waves.beat,
    "pitch": waves.swings,
    "damper": damper.figure,
    "liquid_damper": damper.liquid,
    "drag": drag.figure,
    "sinking": sinking.figure,
    "afloat": flooded.figure,
    "profiles": surfaces.profiles,
    "waves": surfaces.waves,
    "pressures at P1": prismatic.figure,
    "chamfers": chamfer.figure,
    "coupled response": coupled.figure,
    "coupled spectra": coupled.spectra,
    "coupled heave and roll": coupled.heave_and_roll,
    "roll in four ways": four_ways.figure,
    "tank tuning": tuning.figure,
    "drainage": drainage.figure,
}
SECTIONS: Mapping[str, Callable[[Found], ReportSection]] = {
    "section": section.report,
    "damping": damping.report,
    "capsizes": capsizes.report,
    "low sides": low_sides.report,
    "map": low_sides.report_map,
    "map with a tank": low_sides.report_tank,
    "convergence": prismatic.convergence,
    "thirty seconds": prismatic.thirty_seconds,
    "repeated impacts": impact.repeats,
    "response": response.report,
}
