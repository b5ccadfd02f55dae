"""How a ship answers a random sea: transfer functions of her motions, with coherence and confidence bands.

By Welch's (1967) method, after the soft start: cross- and autospectra S of the waves ζ at her axis, wherever she has
drifted to, and of each motion x of that axis, means over SEGMENTS pieces of the record that overlap by half, each
with a Hann window. With them the transfer function |H| = |S_ζx|/S_ζζ, roll per metre of wave (RAO), and the coherence
γ² = |S_ζx|²/(S_ζζ S_xx), the share of the motion's power that is linear in the waves. The standard error of |H| is
√((1 − γ²)/(2 n γ²)) of it, n the number of independent pieces (Bendat & Piersol 2010, section 9.2.4); that of S_xx is
1/√n.

rao_peak: the largest |H| of roll (rad/m) where the sea has a twentieth or more of its highest density. Error: that of
the formula. rao_peak_frequency: where that is; error: half the distance of two lines. rao_coherence: γ² there.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from lab.measures.drawing import BLUE, GREEN, GREY, VERMILION, Sheet
from lab.measures.ship import has_ship, in_random_sea, moved_axis
from lab.measures.value import Value, half_width, over_worlds
from lab.recording import Recording
from lab.recording.ship_end import ends

SEGMENTS = 11  # half of them beside each other: a sixth of the record each
LEAST_PERIODS = 5.0  # of the sea's peak in a segment; a shorter record tells nothing
HALF_HANN = 1.0 / 36.0  # square of the correlation of two Hann windows that overlap by half (Welch 1967)
STRONG = 0.05  # of the sea's highest density: weaker lines are not used
ROLL = 2
MANY = 10**6  # degrees of freedom of a normal distribution


@dataclass(frozen=True, eq=False)
class Transfer:
    """At frequencies (n,) rad/s: densities of waves and answer, complex transfer function, coherence, pieces n."""

    frequency: np.ndarray
    wave: np.ndarray
    answer: np.ndarray
    ratio: np.ndarray
    coherence: np.ndarray
    pieces: float

    @property
    def error(self) -> np.ndarray:
        """Standard error (n,) of the size of the transfer function."""
        square = np.clip(self.coherence, 1e-12, 1.0)
        return np.abs(self.ratio) * np.sqrt((1.0 - square) / (2.0 * self.pieces * square))

    @property
    def strong(self) -> np.ndarray:
        """Where (n,) the sea is strong enough."""
        return self.wave >= STRONG * self.wave.max()


def transfer(time: np.ndarray, wave: np.ndarray, answer: np.ndarray) -> Transfer:
    """From waves to an answer, both (T,) at even times (s); one-sided densities over angular frequency."""
    length = 2 * (len(time) // (SEGMENTS + 1))
    begin = (length // 2) * np.arange(SEGMENTS)
    window = np.hanning(length + 1)[:-1]
    step = (time[-1] - time[0]) / (len(time) - 1)
    pieces = np.array([[one[b : b + length] for b in begin] for one in (wave, answer)])
    spectra = np.fft.rfft((pieces - pieces.mean(axis=-1, keepdims=True)) * window, axis=-1)[..., 1:-1]
    scale = step / (np.pi * (window**2).sum())
    of_wave, of_answer = scale * (np.abs(spectra) ** 2).mean(axis=1)
    both = scale * (spectra[0].conj() * spectra[1]).mean(axis=0)
    frequency = 2.0 * np.pi * np.fft.rfftfreq(length, step)[1:-1]
    floor = 1e-300
    independent = SEGMENTS / (1.0 + 2.0 * HALF_HANN * (SEGMENTS - 1) / SEGMENTS)
    coherence = np.abs(both) ** 2 / np.maximum(of_wave * of_answer, floor)
    return Transfer(frequency, of_wave, of_answer, both / np.maximum(of_wave, floor), coherence, independent)


def applies(recording: Recording) -> bool:
    """There is a ship in a random sea, long enough."""
    if not (has_ship(recording) and in_random_sea(recording)):
        return False
    waves, time = recording.preset.waves, recording.series["time"]
    whole = 0.5 * (SEGMENTS + 1) * LEAST_PERIODS * 2.0 * np.pi / waves.frequency
    return time[-1] - max(time[0], waves.soft_start) > whole


def measure(recording: Recording) -> dict[str, Value]:
    """rao_peak (rad/m), rao_peak_frequency (rad/s) and rao_coherence; none for a ship that was lost."""
    numbers = np.full((recording.worlds, 4), np.nan)
    lost = [end is not None for end in ends(recording.series)]
    for world in np.flatnonzero(np.logical_not(lost)):
        found = met(recording, int(world), ROLL)
        k = int(np.argmax(np.where(found.strong, np.abs(found.ratio), 0.0)))
        numbers[world] = np.abs(found.ratio[k]), found.error[k], found.frequency[k], found.coherence[k]
        spacing = float(found.frequency[1] - found.frequency[0])
    size, error, frequency, coherence = numbers.T
    half = [0.5 * spacing] * recording.worlds if not all(lost) else []
    gone = "lost"
    return {
        "rao_peak": over_worlds(size, "rad/m", uncertainties=error, kind="coherence", missing=gone),
        "rao_peak_frequency": over_worlds(frequency, "rad/s", uncertainties=half, kind="resolution", missing=gone),
        "rao_coherence": over_worlds(coherence, "", missing=gone),
    }


def met(recording: Recording, world: int, mode: int) -> Transfer:
    """From the waves that meet her axis to sway, heave (m) or roll (rad) of her axis."""
    from lab.assembly.ship import make_water, make_waves

    preset, time = recording.preset, recording.series["time"]
    rows = time >= preset.waves.soft_start
    waves = make_waves(preset.waves, make_water(preset.sea, preset.run.gravity))
    moved = moved_axis(recording, rows)[:, world]
    rise = waves.elevation(preset.ship.about[0] + moved[:, 0], time[rows])
    return transfer(time[rows], rise, moved[:, mode])


def draw(sheet: Sheet, recording: Recording, values: Mapping[str, Value]) -> None:
    """Density of waves and roll, roll per metre of wave with its 95 % band, and coherence, of the first ship."""
    if ends(recording.series)[0] is not None:
        return
    found = met(recording, 0, ROLL)
    upper, middle, lower = sheet.panels(heights=(2, 2, 1), columns=3)[:, 0]
    omega, kept = found.frequency, found.strong
    band = half_width(1.0, MANY)
    upper.plot(omega, found.wave / found.wave.max(), color=GREY, label="waves")
    upper.plot(omega, found.answer / found.answer.max(), color=BLUE, label="roll")
    upper.set_ylabel("density,\nof its largest")
    size, error = np.abs(found.ratio), band * found.error
    middle.plot(omega[kept], size[kept], color=VERMILION, label="roll per metre of wave")
    low = np.maximum(size - error, 0.0)
    middle.fill_between(omega, low, size + error, where=kept, color=VERMILION, alpha=0.2, lw=0, label="95 % confidence")
    middle.set_ylabel("roll per metre\nof wave (rad/m)")
    lower.plot(omega[kept], found.coherence[kept], color=GREEN, label="coherence")
    lower.set_ylim(0.0, 1.05)
    lower.set_ylabel("coherence")
    lower.set_xlabel("frequency (rad/s)")
    lower.set_xlim(0.0, 1.3 * omega[kept].max())


FIGURES = {"sea-response": draw}
