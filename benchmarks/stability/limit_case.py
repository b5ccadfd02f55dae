"""The map of limits as a suite tells it: a case an integrator, with lines, a table and a figure of its limits."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from benchmarks.stability.limit_map import (
    DAMPINGS,
    DISTURBED,
    FINE,
    GROWTH,
    NEAR_EXACT,
    STEPS,
    WIDEST,
    Limit,
    found,
)
from benchmarks.stability.packings import SPEED
from lab.preset.accuracy import LEVELS
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.case import Found, Line, Picture, Table
from solvers.machine.quantity import PLANE

SAYS = f"""Six grains round a seventh in a hexagonal tank that squeezes them, so that every contact is as deep as the
impact at {SPEED:g} m/s that the derived step is meant for; μ is so large that nothing slides. Unstable: the kinetic
energy, spin included, of a disturbance of {DISTURBED:g} of that speed grows {GROWTH:g}-fold within {STEPS:g} steps, or
the watch stops the run. The longest stable step is bracketed to {100 * (FINE - 1):.0f} %, by bisection; the tables say
how many derived steps it is. 0: none that was tried, down to 1/{WIDEST:g} of the derived step, is stable. Below 1 the
derived step itself is not. Friction laws are on top of hertz-viscoelastic. Without losses and friction the limit is
2/ω, ω the highest frequency of the packing (eigenvalues)."""
IN_SPACE = """In space the packing is a block of a cubic crystal of 63 grains in a box: those inside have twelve such
contacts, those at edges some a quarter deeper."""
DRAFT = LEVELS["draft"].longer_steps
TICKS = (0.5, 1, 2, 5, 10, 20, 50)  # derived steps
LOOKS = dict(zip(DAMPINGS, ((BLUE, "o"), (GREEN, "s"), (VERMILION, "D")), strict=True))  # colours and marks


def check(fast: bool, integrator: str, axes: int = PLANE) -> Found:
    """The limits of an integrator: derived and forced steps must be stable, and known limits be found."""
    limits = list(found(integrator, fast, axes))
    lines = [line for one in limits for line in _lines(one)]
    ratios = {(_laws(one), one.damping): f"{one.ratio:.2g}" for one in limits}
    laws = list(dict.fromkeys(map(_laws, limits)))
    rows = [(law, *(ratios.get((law, damping), "") for damping in DAMPINGS)) for law in laws]
    draft = sum(one.ratio >= DRAFT for one in limits)
    note = f"{draft} of {len(limits)} are stable at the {DRAFT:g}-fold step of draft accuracy, too."
    where, name = ("", "limits") if axes == PLANE else (" in space", "limits-space")
    caption = f"Longest stable steps of {integrator}{where} in derived steps, by law and damping"
    picture = Picture(f"{name}-{integrator}", limit_figure(limits), caption)
    return Found(lines, [picture], [note] if axes == PLANE else [IN_SPACE, note], [Table(("law", *DAMPINGS), rows)])


def _lines(one: Limit) -> list[Line]:
    missing, name = max(0.0, 1.0 - one.ratio), f"{_laws(one)}, {one.damping}"
    lines = [Line.off(f"{name}: missing of a derived step", "it is stable", missing, 0.0, "what it is derived for")]
    missing, most = max(0.0, 1.0 - one.true / one.forced), f"{one.forced / one.derived:.3g} derived steps"
    lines.append(Line.off(f"{name}: missing of {most}", "it is stable", missing, 0.0, "the longest that may be forced"))
    if one.exact:
        reason = "the bracket, slow growth next to it"
        lines.append(Line(f"{name}: longest step", 1e6 * one.true, 1e6 * one.exact, "2/ω", NEAR_EXACT, reason, "µs"))
    return lines


def _laws(one: Limit) -> str:
    return one.normal if one.tangential == "none" else f"+ {one.tangential}"


def limit_figure(limits: Sequence[Limit]) -> Figure:
    """Ratios of true to derived limits: a row a law, a colour a damping; a cross where no step is stable."""
    laws = list(dict.fromkeys(map(_laws, limits)))
    lowest = min([0.5, *(0.7 * one.ratio for one in limits if one.ratio)])
    figure, axes = canvas((6.4, 1.4 + 0.3 * len(laws)))
    for damping, (colour, mark) in LOOKS.items():
        shown = [one for one in limits if one.damping == damping]
        for stable, how in ((True, mark), (False, "x")):
            points = [(one.ratio or lowest, laws.index(_laws(one))) for one in shown if bool(one.ratio) is stable]
            label = damping if stable else None
            axes.plot(*(zip(*points, strict=True) if points else ((), ())), how, color=colour, ms=5, label=label)
    axes.axvline(1.0, color=GREY, lw=1.0, label="derived step")
    axes.set_xscale("log")
    axes.set_xlim(lowest, TICKS[-1])
    axes.set_xticks(TICKS, [f"{tick:g}" for tick in TICKS])
    axes.minorticks_off()
    axes.set_yticks(range(len(laws)), laws)
    axes.invert_yaxis()
    axes.set_xlabel("longest stable step (derived steps); ×: none is stable")
    figure.legend(loc=BELOW, ncols=len(LOOKS) + 1)
    return figure
