"""Ships with water in their tanks: roll for each metre of wave, and the frequencies at which it is largest.

Beside the runs stands linear theory: the hull's coefficients by potential flow and the liquid's (`SloshingLiquid`) in
one equation at each frequency, with the same damping.
"""

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from lab.assembly.ship import make_water, make_waves
from lab.measures.sea_response import MANY, met
from lab.measures.value import half_width
from lab.naval.linear_water import linear_motion, peaks
from lab.preset.schema import Preset
from lab.report.plots import BELOW, BLUE, GREEN, GREY, VERMILION, canvas
from lab.studies.reproduce.experiment import Found, Row
from lab.studies.reproduce.figures import SIZE
from lab.studies.reproduce.runs import Outcome

HEAVE, ROLL = 1, 2
HALVES = 3e-2  # least amplitude of a packet's components, of the largest, at which a response is told
FINER = 8  # zeros after a record, in its lengths, so that a peak lies between its lines
LOW, HIGH, STEP = 2.5, 8.5, 0.005  # rad/s, of the linear response
CYCLES = 10
ROLL_UNIT = "rad/m"
LATER = 30.0  # s, some three of the vessel's own periods of roll
LEAST_SPACINGS = 3
ORDERS = np.arange(0.25, 4.01, 0.01)


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

    The ratio of the Fourier transforms of roll and of the waves at the ship's place at rest, y = 0, where the packet
    has at least HALVES of its largest amplitude. A place further on turns the phases alone; a ship that a mooring
    holds stays within some hundredths of a wavelength.
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


def linear_response(preset: Preset, low: float = LOW, high: float = HIGH) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies (n,) rad/s and roll over wave amplitude (n,) rad/m of a preset's ship by linear theory."""
    omega = np.arange(low, high, STEP)
    return omega, np.abs(linear_motion(preset, omega)[:, ROLL])


def nearest_peak(one: Outcome, wanted: float) -> float:
    """The frequency (rad/s) of the run's peak of roll that is nearest to the one `wanted`; NaN without peaks."""
    found = peaks(*response(one))
    return min((omega for omega, _ in found), key=lambda omega: abs(omega - wanted), default=np.nan)


def nearest_linear_peak(one: Outcome, wanted: float) -> float:
    """As `nearest_peak`, by linear theory."""
    found = peaks(*linear_response(one.recording.preset))
    return min((omega for omega, _ in found), key=lambda omega: abs(omega - wanted), default=np.nan)


def nearest_sea_peak(one: Outcome, wanted: float) -> float:
    """As `nearest_peak`, of roll for each metre of wave in a random sea, where the sea is strong enough."""
    heard = met(one.recording, 0, ROLL)
    found = peaks(heard.frequency[heard.strong], np.abs(heard.ratio[heard.strong]))
    return min((omega for omega, _ in found), key=lambda omega: abs(omega - wanted), default=np.nan)


def linear_roll(one: Outcome, _: object) -> float:
    """Roll over wave amplitude (rad/m) at the run's wave frequency by linear theory."""
    return float(np.interp(one.recording.preset.waves.frequency, *linear_response(one.recording.preset)))


def roll_left(one: Outcome, _: object) -> float:
    """Largest roll LATER (s) and more after the release, over that at the release."""
    preset, series = one.recording.preset, one.recording.series
    time, roll = series["time"], series["pose"][:, 0, ROLL]
    let_go = preset.ship.release
    return float(np.abs(roll[time > let_go + LATER]).max() / np.abs(roll[np.searchsorted(time, let_go)]))


def heave_per_wave(one: Outcome, _: object) -> float:
    """Heave over wave, root mean square of the transfer function's size where the sea is strong enough."""
    heard = met(one.recording, 0, HEAVE)
    return float(np.sqrt(np.mean(np.abs(heard.ratio[heard.strong]) ** 2)))


def particle_steps(one: Outcome, _: object) -> float:
    """Particles times steps of a run, its cost whatever the processor."""
    return one.cost["grain_steps"]


def run_seconds(one: Outcome, _: object) -> float:
    """Wall-clock time (s) of a run's steps."""
    return one.cost["wall_s"]


def order_of_roll(found: Found) -> list[Row]:
    """How roll changes with the particles' spacing: limit and order of r = r₀ − C Δx^p; through three runs exactly."""
    alike = [one for name, (one,) in found.items() if name.endswith(" mm") and "," not in name]
    runs = [(one.recording.preset, roll_per_wave(one, None)) for one in alike]
    spacing = np.array([preset.water.spacing for preset, _ in runs])
    rolls = np.array([roll for _, roll in runs])
    if len(runs) < LEAST_SPACINGS:
        return []
    limit, order = limit_and_order(spacing, rolls)
    ours = f"{limit:.3f} rad/m, order {order:.2f}"
    return [Row("roll as the spacing goes to nothing, and order", "2.7 rad/m", ours, "", "", None)]


def limit_and_order(spacing: np.ndarray, value: np.ndarray) -> tuple[float, float]:
    """r₀ and p of r = r₀ − C Δx^p (Roache 1998, section 5.10) by least squares of several spacings; p within ORDERS."""

    def fit(order: float) -> tuple[np.ndarray, float]:
        columns = np.stack([np.ones(len(spacing)), -(spacing**order)], axis=1)
        numbers = np.linalg.lstsq(columns, value, rcond=None)[0]
        return numbers, float(((columns @ numbers - value) ** 2).sum())

    order = min(ORDERS, key=lambda one: fit(one)[1])
    return float(fit(order)[0][0]), float(order)


NUMBERS = {
    "particle_steps": ("", particle_steps),
    "run_seconds": ("s", run_seconds),
    "roll_left": ("", roll_left),
    "heave_per_wave": ("", heave_per_wave),
    "roll_per_wave": (ROLL_UNIT, roll_per_wave),
    "linear_roll": (ROLL_UNIT, linear_roll),
    "roll_peak": ("rad/s", nearest_peak),
    "linear_roll_peak": ("rad/s", nearest_linear_peak),
    "sea_roll_peak": ("rad/s", nearest_sea_peak),
}


def figure(found: Found) -> Figure:
    """Roll for each metre of wave against frequency: runs in packets, and linear theory, dashed."""
    drawn, axes = canvas(SIZE)
    for colour, (label, outcomes) in zip((BLUE, GREEN, VERMILION, GREY, "k"), found.items(), strict=False):
        one = outcomes[0]
        if one.recording.preset.waves.kind == "packet":
            axes.plot(*response(one), color=colour, lw=1.3, label=label)
            axes.plot(*linear_response(one.recording.preset), color=colour, lw=1.0, ls="--")
    axes.set_xlabel("wave frequency (rad/s)")
    axes.set_ylabel("roll per metre of wave (rad/m)")
    axes.set_xlim(LOW, HIGH)
    drawn.legend(loc=BELOW, ncols=2)
    return drawn


def spectra(found: Found) -> Figure:
    """Roll for each metre of wave in a random sea with its 95 % band, and its coherence.

    The frequency domain (dashed) is drawn for the ship whose water is by linear theory in the run, too.
    """
    drawn, (upper, lower) = canvas((SIZE[0], 1.5 * SIZE[1]), 2, 1, sharex=True, height_ratios=(2, 1))
    _draw_spectra(found, lower, {ROLL: upper})
    drawn.legend(loc=BELOW, ncols=3)
    return drawn


def heave_and_roll(found: Found) -> Figure:
    """As `spectra`, with heave for each metre of wave above."""
    drawn, (top, middle, lower) = canvas((SIZE[0], 2.1 * SIZE[1]), 3, 1, sharex=True, height_ratios=(2, 2, 1))
    _draw_spectra(found, lower, {HEAVE: top, ROLL: middle})
    drawn.legend(loc=BELOW, ncols=3)
    return drawn


def _draw_spectra(found: Found, lower: Axes, panels: Mapping[int, Axes]) -> None:
    """Motions over waves on the panel of each, and the coherence of roll, which is the last of them."""
    for colour, (label, (one, *_)) in zip((GREY, BLUE, VERMILION), found.items(), strict=False):
        for motion, axes in panels.items():
            heard = met(one.recording, 0, motion)
            kept, wide = heard.strong, half_width(1.0, MANY) * heard.error
            omega, size = heard.frequency[kept], np.abs(heard.ratio)
            axes.plot(omega, size[kept], color=colour, lw=1.3, label=label if motion == ROLL else None)
            low, high = np.maximum(size - wide, 0.0)[kept], (size + wide)[kept]
            axes.fill_between(omega, low, high, color=colour, alpha=0.2, lw=0)
            if one.recording.preset.water.model == "linear":
                domain = np.arange(omega[0], omega[-1], STEP)
                exact = np.abs(linear_motion(one.recording.preset, domain)[:, motion])
                axes.plot(domain, exact, color=colour, lw=1.0, ls="--")
        lower.plot(omega, heard.coherence[kept], color=colour)
    for motion, axes in panels.items():
        axes.set_ylabel("roll per metre of wave\n(rad/m)" if motion == ROLL else "heave over wave")
    lower.set_ylabel("coherence")
    lower.set_ylim(0.0, 1.05)
    lower.set_xlabel("wave frequency (rad/s)")
