"""Water that sloshes a little in a rectangular tank: what a moved tank feels of it, by linear potential flow."""

from dataclasses import dataclass

import numpy as np

MODES = 50  # odd ones; their sums converge as n⁻⁵ beside the modes near the frequency
TERMS = 200  # of the inertia under a lid, which converge as n⁻⁵


@dataclass(frozen=True)
class SloshingLiquid:
    """Liquid of a `depth` d (m) in a rectangular tank of a `width` l (m): its added mass, damping and stiffness.

    Per metre of the tank's length. `centre` (y, z) m is the middle of the level surface as seen from the point P about
    which the tank rolls and forces turn. Every mode has the share `share` of critical damping; with none, the liquid
    takes no energy and is infinite at its own frequencies ω_n² = g κ_n, κ_n = q tanh q d, q = n π/l.

    The potential is that of a tank that moves on with a lid at the level surface, sway U y and roll Ω ψ (Joukowski),
    and of modes that swing at the surface (Faltinsen & Timokha 2009, ch. 5; for sway the sum is that of Graham &
    Rodriguez 1952: F = ω² m y (1 + Σ m_n ω²/(ω_n² − ω²)), m_n = 8 tanh(nπd/l)/(n³π³ d/l), n odd).
    With a_n = −4 l/(nπ)² and b_n = −8 l² tanh(nπd/2l)/(nπ)³, the shares of mode n in y and in ψ at the surface, the
    force and moment about its middle of sway and roll with amplitudes x, as e^(−iωt), are

        X = [ω² M − C + (m/2d) Σ κ_n v_n v_nᵀ/(ω_n² − ω² − 2iζ ω_n ω)] x,   v_n = (ω² a_n, ω² b_n − g a_n),

    M = (m, m d/2; m d/2, J), C = (0, 0; 0, m g d/2), J = ρ (d l³/12 + 64 d⁴ Σ tanh(nπl/2d)/(nπ)⁵).

    Limits: small motion; rectangular tanks; heave moves the liquid as a solid.
    """

    width: float
    depth: float
    centre: tuple[float, float] = (0.0, 0.0)
    density: float = 1000.0
    gravity: float = 9.81
    share: float = 0.0

    @property
    def mass(self) -> float:
        """Mass (kg/m)."""
        return self.density * self.width * self.depth

    @property
    def rates(self) -> np.ndarray:
        """ω_n (1/s) of the odd modes, those that a moved tank sets going."""
        number = _odd(MODES) * np.pi / self.width
        return np.sqrt(self.gravity * number * np.tanh(number * self.depth))

    def added_mass(self, omega: np.ndarray) -> np.ndarray:
        """A (n, 3, 3) of sway, heave and roll about P at frequencies (n,) rad/s: kg/m, kg, kg m.

        In X = −(−ω² A − iω B + C) x with `damping` and `stiffness`. The limit at zero of sway is the liquid's mass.
        """
        omega = np.atleast_1d(np.asarray(omega, dtype=float))
        return (self._answer(omega).real - self._answer(np.zeros(1)).real) / omega[:, None, None] ** 2

    def damping(self, omega: np.ndarray) -> np.ndarray:
        """B (n, 3, 3) at frequencies (n,) rad/s, per metre of length: N s/m, N s, N m s."""
        omega = np.atleast_1d(np.asarray(omega, dtype=float))
        return self._answer(omega).imag / omega[:, None, None]

    def stiffness(self) -> np.ndarray:
        """C (3, 3): the liquid's weight at its centre, and its free surface, ρ g l³/12, which both turn a tank over."""
        height = self.centre[1] - 0.5 * self.depth
        turning = self.mass * self.gravity * height + self.density * self.gravity * self.width**3 / 12.0
        found = np.zeros((3, 3))
        found[2, 2] = -turning
        return found

    def _answer(self, omega: np.ndarray) -> np.ndarray:
        """X/x (n, 3, 3) about P, complex."""
        n, g, m = _odd(MODES), self.gravity, self.mass
        steep = self.rates**2 / g
        across = -4.0 * self.width / (n * np.pi) ** 2
        turned = -8.0 * self.width**2 * np.tanh(0.5 * n * np.pi * self.depth / self.width) / (n * np.pi) ** 3
        square = omega[:, None] ** 2
        vectors = np.stack([square * across, 0.0 * square * across, square * turned - g * across], axis=-1)
        below = self.rates**2 - square - 2j * self.share * self.rates * omega[:, None]
        swings = np.einsum("kn,kna,knb->kab", 0.5 * m / self.depth * steep / below, vectors, vectors)
        solid = np.array([[m, 0.0, 0.5 * m * self.depth], [0.0, m, 0.0], [0.5 * m * self.depth, 0.0, self._lidded()]])
        found = swings + solid * square[..., None]
        found[:, 2, 2] -= 0.5 * m * g * self.depth
        y, z = self.centre
        shift = np.array([[1.0, 0.0, -z], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
        found = shift.T @ found @ shift
        found[:, 2, 2] += m * g * z
        return found

    def _lidded(self) -> float:
        """J (kg m): the inertia in roll about the middle of a lid at the surface."""
        n = _odd(TERMS)
        series = (np.tanh(0.5 * n * np.pi * self.width / self.depth) / (n * np.pi) ** 5).sum()
        return self.density * (self.depth * self.width**3 / 12.0 + 64.0 * self.depth**4 * series)


def _odd(count: int) -> np.ndarray:
    """The first odd numbers."""
    return 2.0 * np.arange(count) + 1.0
