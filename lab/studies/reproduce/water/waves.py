"""Waves that do not break, beside measured ones: the beat in a swaying tank, the slow swing in a pitching one.

Faltinsen, Rognebakke, Lukovsky & Timokha (2000), J. Fluid Mech. 407, 201, figure 7; Akyildiz & Ünal (2006), Ocean Eng.
33, 2135, figure 5. Both series were read off their figures, the first to some 3 mm and 0.02 s.
"""

from collections.abc import Callable, Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.measures.steady import harmonics
from lab.report.plots import BELOW, BLUE, GREEN, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome
from lab.studies.reproduce.water.measured import drawn
from lab.studies.reproduce.water.theory.wave_tank import WaveTank, rise_at

NEAR = 0.3  # s about a measured turn, where ours is sought
EARLY = 0.8  # s: the first trough comes before
CALM = 0.2  # s: means over it show the slow swing under the sound that rings in the tank
GAUGE = 0  # the wall at which the water falls first, as in the experiment
SWAY, PITCH = (
    "sloshing_sway_rectangular/faltinsen2000_h0.6_T1.3.csv",
    "sloshing_pitch_rectangular/akyildiz_unal2006_P2.csv",
)
COLOURS = BLUE, VERMILION, GREEN
NODES = 81  # of the surface of potential flow


def elevation(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the rise (mm) at the gauge over the level at the start."""
    depth = one.recording.series["level_depth"][:, 0, GAUGE]
    return one.recording.series["time"], 1e3 * (depth - depth[0])


def turn(one: Outcome, when: float, sign: float) -> tuple[float, float]:
    """The crest, with a negative sign the trough, near a time (s): how much later it comes (s), and its size (mm)."""
    time, rise = elevation(one)
    near = np.abs(time - when) <= NEAR
    at = int(np.argmax(sign * rise[near]))
    return float(time[near][at] - when), float(rise[near][at])


def nonlinear(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the rise (mm) at the gauge in nonlinear potential flow, of the tank as it sways in the run."""
    preset, time = one.recording.preset, one.recording.series["time"]
    tank = WaveTank(preset.water.depth, preset.tank.width, NODES, swayed=True)
    sway, place = preset.motion.sway, list(preset.gauges.values())[GAUGE].y + 0.5 * preset.tank.width
    spin = 2j * np.pi * sway.frequency

    def curve(instants: np.ndarray, order: int) -> np.ndarray:
        return np.imag(sway.amplitude * spin**order * np.exp(spin * instants + 1j * sway.phase))

    return time, 1e3 * rise_at(tank, curve, float(time[-1]), (place,))(time)[:, 0]


def crest_over_potential_flow(one: Outcome, when: float) -> float:
    """The crest near a time (s) over that of nonlinear potential flow."""
    (time, rise), ours = nonlinear(one), turn(one, when, 1.0)[1]
    return ours / float(rise[np.abs(time - when) <= NEAR].max())


def farthest(one: Outcome, times: Sequence[float]) -> float:
    """How much later (s) the turn comes that is farthest from its time of these; troughs and crests, trough first."""
    late = [turn(one, when, -1.0 if k % 2 == 0 else 1.0)[0] for k, when in enumerate(times)]
    return max(late, key=abs)


def first_trough(one: Outcome, _: object) -> float:
    """The lowest rise (mm) before EARLY."""
    time, rise = elevation(one)
    return float(rise[time < EARLY].min())


def beat(found: Found, crests: Sequence[Sequence[float]]) -> Figure:
    """The rise at the gauge beside measured crests, s and mm."""
    drawing, axes = canvas(SIZE)
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        axes.plot(*elevation(outcomes[0]), color=colour, lw=1.1, label=label)
    axes.plot(*nonlinear(next(iter(found.values()))[0]), color="0.4", lw=0.8, ls="--", label="potential flow")
    when, size = np.transpose(crests)
    axes.errorbar(when, size, 0.1 * size, fmt="none", ecolor="0.4", capsize=2.5, label="measured crests ± 10 %")
    if (measured := drawn(axes, SWAY)) is not None:
        axes.plot(measured[0], 1e3 * measured[1], "o", ms=2, color="black", label="measured")
    axes.set(xlabel="time (s)", ylabel="rise 50 mm from the wall (mm)")
    drawing.legend(loc=BELOW, ncols=3)
    return drawing


def swing(one: Outcome) -> tuple[float, float, float]:
    """The sine of the tank's frequency through the pressure at the gauge that rises first: kPa, deg, and the mean."""
    time, pressure = _pressure(one)
    frequency = one.recording.preset.motion.roll.frequency
    complex_size = harmonics(time, pressure[:, None], frequency, (1,))[0, 0]
    return abs(complex_size), float(np.degrees(np.angle(1j * complex_size))), float(pressure.mean())


def _pressure(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Times (s) and the pressure (kPa) over whole periods."""
    series = one.recording.series
    period = 1.0 / one.recording.preset.motion.roll.frequency
    whole = series["time"] <= period * np.floor(series["time"][-1] / period)
    both = 1e-3 * series["gauge_pressure"][whole, 0]
    early = series["time"][whole] < 0.25 * period
    return series["time"][whole], both[:, int(both[early].mean(axis=0).argmax())]


def _of_swing(part: int) -> Callable[[Outcome, object], float]:
    return lambda one, _: swing(one)[part]


NUMBERS = {
    "crest": ("mm", lambda one, when: turn(one, when, 1.0)[1]),
    "sway_crest_over_potential_flow": ("1", crest_over_potential_flow),
    "farthest_turn": ("s", farthest),
    "first_trough": ("mm", first_trough),
    "pressure_swing": ("kPa", _of_swing(0)),
    "pressure_phase": ("deg", _of_swing(1)),
    "pressure_mean": ("kPa", _of_swing(2)),
}


def swings(found: Found, swing: Sequence[float]) -> Figure:
    """The pressure less its mean beside a sine of so many kPa, so many deg ahead of the tank.

    The measured points are drawn about the mean of the sine through them.
    """
    drawing, axes = canvas(SIZE)
    for (label, outcomes), colour in zip(found.items(), COLOURS, strict=False):
        time, pressure = _pressure(outcomes[0])
        pressure = pressure - pressure.mean()
        samples = round(CALM / (time[1] - time[0]))
        axes.plot(time, pressure, color=colour, lw=0.4, alpha=0.4)
        means = np.convolve(pressure, np.full(samples, 1.0 / samples), "valid")
        middles = time[samples // 2 :][: len(means)]
        axes.plot(middles, means, color=colour, lw=1.2, label=f"{label}, means over {CALM} s")
    time = np.linspace(0.0, 10.0, 400)
    size, phase = swing
    sine = size * np.sin(2.0 * time + np.radians(phase))
    for share in (0.9, 1.1):
        label = "sine through the measured points, ± 10 %" if share < 1 else None
        axes.plot(time, share * sine, color="0.5", ls=":", lw=1.0, label=label)
    if (measured := drawn(axes, PITCH)) is not None:
        zero = np.mean(measured[1] - np.interp(measured[0], time, sine))
        axes.plot(measured[0], measured[1] - zero, "o", ms=3, color="black", label="measured")
    axes.set(xlabel="time (s)", ylabel="pressure on the end wall\nless its mean (kPa)")
    drawing.legend(loc=BELOW, ncols=3)
    return drawing
