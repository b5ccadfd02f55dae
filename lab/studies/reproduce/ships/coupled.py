"""Ships with water in their tanks: roll for each metre of wave, and the frequencies at which it is largest.

Beside the runs stands linear theory: the hull's coefficients by potential flow and the liquid's (`SloshingLiquid`) in
one equation at each frequency, with the same damping.
"""

import numpy as np
from matplotlib.figure import Figure

from lab.assembly.ship import make_water, make_waves
from lab.naval.linear_water import linear_motion, peaks
from lab.preset.schema import Preset
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.reproduce.experiment import Found
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome

ROLL = 2
HALVES = 3e-2  # least amplitude of a packet's components, of the largest, at which a response is told
FINER = 8  # zeros after a record, in its lengths, so that a peak lies between its lines
LOW, HIGH, STEP = 2.5, 8.5, 0.005  # rad/s, of the linear response
CYCLES = 10
ROLL_UNIT = "rad/m"


def roll_per_wave(one: Outcome, _: object) -> float:
    """Amplitude of roll over that of the waves, rad/m: √2 times the standard deviation over the last CYCLES waves.

    Not the component at the waves' frequency: a ship that is free drifts along, and meets them less often.
    """
    waves, series = one.recording.preset.waves, one.recording.series
    time, roll = series["time"], series["pose"][:, 0, ROLL]
    last = time > time[-1] - CYCLES * 2.0 * np.pi / waves.frequency
    return float(np.sqrt(2.0) * roll[last].std() / waves.amplitude)


def response(one: Outcome) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (n,) rad/s and roll over wave amplitude (n,) rad/m of a run in a packet of waves.

    The ratio of the Fourier transforms of roll and of the waves at the ship's place at rest, where the packet has at
    least HALVES of its largest amplitude.
    """
    preset, series = one.recording.preset, one.recording.series
    time, roll = series["time"], series["pose"][:, 0, ROLL]
    waves = make_waves(preset.waves, make_water(preset.sea, preset.run.gravity))
    rise = np.array([float(waves.elevation(np.zeros(1), t)[0]) for t in time])
    length = FINER * len(time)
    omega = 2.0 * np.pi * np.fft.rfftfreq(length, time[1] - time[0])
    driven, answer = np.abs(np.fft.rfft(rise, length)), np.abs(np.fft.rfft(roll - roll.mean(), length))
    kept = (driven > HALVES * driven.max()) & (omega > LOW)
    return omega[kept], answer[kept] / driven[kept]


def linear_response(preset: Preset) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (n,) rad/s and roll over wave amplitude (n,) rad/m of a preset's ship by linear theory."""
    omega = np.arange(LOW, HIGH, STEP)
    return omega, np.abs(linear_motion(preset, omega)[:, ROLL])


def nearest_peak(one: Outcome, wanted: float) -> float:
    """The frequency (rad/s) of the run's peak of roll that is nearest to the one `wanted`; NaN without peaks."""
    found = peaks(*response(one))
    return min((omega for omega, _ in found), key=lambda omega: abs(omega - wanted), default=np.nan)


def nearest_linear_peak(one: Outcome, wanted: float) -> float:
    """As `nearest_peak`, by linear theory."""
    found = peaks(*linear_response(one.recording.preset))
    return min((omega for omega, _ in found), key=lambda omega: abs(omega - wanted), default=np.nan)


def linear_roll(one: Outcome, _: object) -> float:
    """Roll over wave amplitude (rad/m) at the run's wave frequency by linear theory."""
    return float(np.interp(one.recording.preset.waves.frequency, *linear_response(one.recording.preset)))


NUMBERS = {
    "roll_per_wave": (ROLL_UNIT, roll_per_wave),
    "linear_roll": (ROLL_UNIT, linear_roll),
    "roll_peak": ("rad/s", nearest_peak),
    "linear_roll_peak": ("rad/s", nearest_linear_peak),
}


def figure(found: Found) -> Figure:
    """Roll for each metre of wave against frequency: runs in packets, and linear theory, dashed."""
    drawn, axes = canvas(SIZE)
    for colour, (label, outcomes) in zip((BLUE, GREEN, VERMILION, GREY), found.items(), strict=False):
        one = outcomes[0]
        if one.recording.preset.waves.kind == "packet":
            axes.plot(*response(one), color=colour, lw=1.3, label=label)
            axes.plot(*linear_response(one.recording.preset), color=colour, lw=1.0, ls="--")
    axes.set_xlabel("wave frequency (rad/s)")
    axes.set_ylabel("roll per metre of wave (rad/m)")
    axes.set_xlim(LOW, HIGH)
    drawn.legend(loc=BELOW, ncols=2)
    return drawn
