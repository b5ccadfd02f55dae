"""Waves at the ship: regular waves, wave packets or a random sea, as sums of linear waves travelling to starboard."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from solvers.ship.water import Water

PACKET_REACH = 4.0  # standard deviations to which a packet's spectrum is summed
SEA_RANGE = 0.5, 5.0  # of the peak frequency: 99.8 % of a Pierson–Moskowitz sea's energy
FINE = 50  # points for the integral of a spectrum over one band


@dataclass(frozen=True, eq=False)
class Waves:
    """Wave components (n,): elevation ζ = D(t) Σ Re a e^(i(ky − ωt)), D the soft start of a length (s), none if 0.

    Amplitudes (m) are complex: the argument is the phase ε of |a| cos(ky − ωt + ε).
    """

    amplitude: np.ndarray
    frequency: np.ndarray
    wave_number: np.ndarray
    soft_start: float = 0.0

    def later(self, time: float) -> "Waves":
        """The same waves with the clock set to zero at a time (s): a' = a e^(−iω time)."""
        return replace(self, amplitude=self.amplitude * np.exp(-1j * self.frequency * time))

    def elevation(self, y, time) -> np.ndarray:
        """Height (m) of the surface at y (m) and times (s) that broadcast together."""
        return self.sums(np.ones((len(self.amplitude), 1)), y, time)[..., 0]

    def slope(self, y, time) -> np.ndarray:
        """Slope ∂ζ/∂y of the surface at y (m) and times (s) that broadcast together."""
        return self.sums(1j * self.wave_number[:, None], y, time)[..., 0]

    def force(self, excitation: np.ndarray, y, time) -> np.ndarray:
        """Force and moment (…, 3) on a hull whose origin is at y, from its excitation (n, 3) at these frequencies."""
        return self.sums(excitation, y, time)

    def sums(self, factors: np.ndarray, y, time) -> np.ndarray:
        """D(t) Σ Re f a e^(i(ky − ωt)) (…, m) for m complex factors f of each component (n, m)."""
        y, time = np.asarray(y, dtype=float), np.asarray(time, dtype=float)
        phase = self.wave_number * y[..., None] - self.frequency * time[..., None]
        start = soft_start(time, self.soft_start)[..., None]
        return start * ((self.amplitude * np.exp(1j * phase)) @ factors).real


def soft_start(time, length: float) -> np.ndarray:
    """Transition function D(τ) = exp(1 − 1/(1 − (τ − 1)²)), τ = t/T, from 0 to 1 (Spandonidis 2016, eq. F.1)."""
    time = np.asarray(time, dtype=float)
    if length == 0.0:
        return np.ones_like(time)
    tau = np.clip(time / length, 0.0, 1.0)
    rest = tau * (2.0 - tau)  # 1 − (τ − 1)²
    with np.errstate(divide="ignore"):
        return np.exp(1.0 - 1.0 / rest)


def regular(amplitude: float, frequency: float, water: Water, soft_start: float = 0.0) -> Waves:
    """One wave of amplitude (m) and angular frequency (rad/s) with a crest at y = 0 at t = 0."""
    omega = np.array([frequency])
    return Waves(np.array([amplitude], complex), omega, water.wave_number(omega), soft_start)


def packet(
    amplitude: float, frequency: float, spread: float, water: Water, time: float, y: float = 0.0, count: int = 200
) -> Waves:
    """A Gaussian packet whose components, of standard deviation `spread` (rad/s), all crest at `y` (m) at `time` (s).

    There and then its elevation is `amplitude` (m). The sum recurs after 2π/Δω, Δω the spacing of its components.
    """
    omega = frequency + spread * PACKET_REACH * np.linspace(-1.0, 1.0, count)
    omega = omega[omega > 0.0]
    share = np.exp(-0.5 * ((omega - frequency) / spread) ** 2)
    k = water.wave_number(omega)
    return Waves(amplitude * share / share.sum() * np.exp(1j * (omega * time - k * y)), omega, k)


def pierson_moskowitz(height: float, frequency: float) -> Callable[[np.ndarray], np.ndarray]:
    """Spectrum S(ω) (m² s) of a fully developed sea (Pierson and Moskowitz 1964), ∫S dω = H_s²/16.

    S = (5/16) H_s² ω_p⁴ ω⁻⁵ exp(−(5/4)(ω_p/ω)⁴) of significant height H_s (m) and peak frequency ω_p (rad/s).
    """

    def density(omega: np.ndarray) -> np.ndarray:
        ratio = frequency / omega
        return 5.0 / 16.0 * height**2 / frequency * ratio**5 * np.exp(-1.25 * ratio**4)

    return density


def jonswap(height: float, frequency: float, peakedness: float = 3.3) -> Callable[[np.ndarray], np.ndarray]:
    """Spectrum S(ω) (m² s) of a growing sea (Hasselmann et al. 1973), ∫S dω = H_s²/16.

    The Pierson–Moskowitz spectrum times γ^(exp(−(ω/ω_p − 1)²/2σ²)), σ = 0.07 below the peak and 0.09 above, normalised.
    """
    from scipy.integrate import quad

    def shape(omega: np.ndarray) -> np.ndarray:
        ratio = np.asarray(omega) / frequency
        sigma = np.where(ratio <= 1.0, 0.07, 0.09)
        return peakedness ** np.exp(-0.5 * ((ratio - 1.0) / sigma) ** 2)

    developed = pierson_moskowitz(height, frequency)
    parts = [(0.2, 0.7), (0.7, 1.0), (1.0, 1.5), (1.5, np.inf)]
    energy = sum(quad(lambda r: float(developed(r * frequency) * shape(r * frequency)), a, b)[0] for a, b in parts)
    factor = height**2 / 16.0 / (energy * frequency)
    return lambda omega: factor * developed(omega) * shape(omega)


def random_sea(
    density: Callable[[np.ndarray], np.ndarray],
    frequency: float,
    water: Water,
    seed: int,
    soft_start: float = 0.0,
    count: int = 200,
) -> Waves:
    """A sea of `count` components of a spectrum with a peak frequency (rad/s), the same for the same seed.

    The range from 0.5 to 5 times the peak is cut into bands. Each band has one component with all of its energy, at a
    random frequency in the band, so that the sea does not recur, and with a random phase.
    """
    return _of_bands(density, frequency * np.geomspace(*SEA_RANGE, count + 1), water, seed, soft_start)


def white_noise(
    height: float, frequency: float, spread: float, water: Water, seed: int, soft_start: float = 0.0, count: int = 200
) -> Waves:
    """A sea of even density S = (H_s²/16)/2s from ω − s to ω + s, ω the middle `frequency` and s the `spread` (rad/s).

    Components as of `random_sea`, in bands of one breadth.
    """
    level = height**2 / 32.0 / spread
    edges = np.linspace(frequency - spread, frequency + spread, count + 1)
    return _of_bands(lambda omega: np.full_like(omega, level), edges, water, seed, soft_start)


def _of_bands(density: Callable, edges: np.ndarray, water: Water, seed: int, soft_start: float) -> Waves:
    """A component for each band between edges (rad/s), at a random place in it."""
    random, count = np.random.default_rng(seed), len(edges) - 1
    fine = edges[:-1, None] + np.diff(edges)[:, None] * (np.arange(FINE) + 0.5) / FINE
    energy = density(fine).mean(axis=1) * np.diff(edges)
    omega = edges[:-1] + np.diff(edges) * random.uniform(size=count)
    phase = random.uniform(0.0, 2.0 * np.pi, size=count)
    return Waves(np.sqrt(2.0 * energy) * np.exp(1j * phase), omega, water.wave_number(omega), soft_start)


def froude_factors(scale: float) -> dict[str, float]:
    """Factors from a model's quantities to full scale, `scale` times as long, in the same water and gravity.

    ω √(l/g) and n/l are kept (Spandonidis 2016, eq. C.1). Forces, masses and moments are per metre of length.
    """
    return {
        "length": scale,
        "time": scale**0.5,
        "frequency": scale**-0.5,
        "speed": scale**0.5,
        "acceleration": 1.0,
        "angle": 1.0,
        "mass": scale**2,
        "force": scale**2,
        "moment": scale**3,
        "inertia": scale**4,
        "energy": scale**3,
    }
