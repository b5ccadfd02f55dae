"""Pore pressure of a shaken bed against how fast it drains, with real cargoes marked where they lie.

The sand is that of Spandonidis (2016), section 9.4: 0.5 mm, 115 mm deep, porosity 0.477, in a roll of 2 s. The ore
fines conduct 1e-6 m/s and lie 10 m deep in a ship that rolls in 10 s. Both have a modulus of 20 MPa: of Hertz contacts
at 1 kPa, own estimate.
"""

from matplotlib.figure import Figure

from lab.assembly.scene import build
from lab.preset.sections.wet.states import state
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION
from lab.report.wet.bed import half_time, half_times, period
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome

MODULUS, VISCOSITY = 2.0e7, 1.0e-3  # Pa, Pa s
CARGOES = {  # depth (m), permeability (m²), period of the roll (s), colour
    "sand of 0.5 mm in a box": (0.115, 0.477**3 * 0.5e-3**2 / (180.0 * 0.523**2), 2.0, GREEN),
    "ore fines in a ship": (10.0, 1.0e-6 * VISCOSITY / 9810.0, 10.0, VERMILION),
}


def share_of_period(one: Outcome) -> float:
    """t50 over the period of the motion of a run, as it was computed."""
    preset = one.recording.preset
    scene, _ = build(preset)
    return half_times(preset, scene, state(preset))[0] / period(preset)


def figure(found: Found) -> Figure:
    """The largest pore-pressure ratio of each run against its t50 over the period."""
    drawn = Figure(figsize=SIZE, layout="constrained")
    axes = drawn.add_subplot()
    for outcomes in found.values():
        known = [one for one in outcomes if one["pore_pressure_ratio_peak"] is not None]
        points = sorted((share_of_period(one), one["pore_pressure_ratio_peak"].value) for one in known)
        axes.plot(*zip(*points, strict=True), "o-", color=BLUE, label="shaken bed, loosely poured")
    for name, (deep, permeability, lasts, colour) in CARGOES.items():
        at = half_time(deep, VISCOSITY, permeability, MODULUS) / lasts
        axes.axvline(at, color=colour, ls=":", label=name)
    axes.set(xscale="log", xlabel="time in which half of a pressure drains, over the period", ylim=(0.0, None))
    axes.set_ylabel("largest pore-pressure ratio")
    drawn.legend(loc=BELOW, ncols=3)
    return drawn
