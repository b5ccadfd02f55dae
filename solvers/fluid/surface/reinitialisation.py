"""Density re-initialisation: the density that a particle carries, tied to how close its neighbours are."""

import numpy as np
import taichi as ti

from solvers.fluid.state import Particles
from solvers.machine.quantity import PLANE
from solvers.machine.state import State

SLOW = 0.01  # of δ c0/h, the rate at which diffusion evens the densities of neighbours
FELT = 10.0  # of |ρ/ρ0 − 1|, the most that counts of F/F_0 − 1
SEEN = 0.1  # of F that a surface takes off the trace: from there on it is too near

VOID = -0.1  # what F of air may lack: to fill a void is left to the flow


@ti.data_oriented
class Reinitialisation:
    """dρ_i/dt has the term a_i ρ_i (F_i/F_0 − 1)/τ, F of `VoidIndicator`, τ = 100 h/(δ c0): it keeps the volume.

    Density that follows from the motion of neighbours is not tied to where they are. Errors of many cycles add up:
    water ends packed too close at the density of rest, and its level sinks. Colagrossi & Landrini (2003) set the
    density anew every 20 steps, from a sum of masses over neighbours, so that mass, density and the room that is taken
    agree again. Here that is slow and steady (own derivation): F is the density by the places of neighbours over the
    density that they carry, with their volumes m/ρ. F_0 is that of a square, or cubic, lattice of the run's h/Δx.

    Sound and waves change both densities alike, so that the term does not feel them. τ is a hundred times that in
    which diffusion evens neighbours (h/(δ c0)): what F is off in single particles comes to the pressure by a hundredth.
    Near a surface F is not certain enough: with L = b |Σ V ∇W|, what it lacks there, a_i is 1 − L/SEEN, at least 0: at
    rest nothing in the first two rows, three quarters in the third. Diffusion carries the term to the surface. In
    broken water a_i is 0. The energy counts as diffused.

    What F is off in single particles comes to a pressure ρ c0²/100 times as large. That is little where c0² = 100 g H,
    and can be ten times the pressure of the water where it is shallow for its sound: a film that came of a drop, of
    three rows and c0² = 20 000 g H, burst by itself, time after time, and did not without the term. So |F_i/F_0 − 1|
    counts up to FELT |ρ_i/ρ_0 − 1|: the pressure is off by at most a tenth. Beside air F is certain, and all counts.

    Air fills what water leaves, so that F of all that is about it, water and walls, is 1 wherever air is (own
    derivation): there F is of both phases, a_i = 1, and τ has the air's speed of sound. F/F_0 − 1 counts down to VOID.

    Limits: water that loses volume faster than in τ, or of two rows or less, is not kept. Not where `VoidIndicator`
    does not act, nor without diffusion of density, which the term needs.

    Units: ρ kg/m³, τ s, h m, c0 m/s.
    """

    def __init__(self, arrays: State, particles: Particles, constants, acts: bool):
        self.particles, self.constants = particles, constants
        self.acts = acts and constants.diffusion.acts
        if self.acts:
            (self.drift,) = arrays.under("water").wide(particles.of_water, "drift", kept=False)

    @staticmethod
    def numbers(kernel, water, axes: int = PLANE) -> dict[str, float]:
        """The constants of the term, for a scene's water."""
        return {
            "keeping": SLOW * water.delta * water.sound_speed / water.length,
            "lattice": 1.0 / lattice(kernel, water.smoothing, axes),
            "seen": 1.0 / SEEN,
        }

    @ti.func
    def note(self, b, indicator, lacking, gas: ti.template()):
        """Store a_i (F_i/F_0 − 1)/τ (1/s) of a block, from its F and what of it a surface makes it lack."""
        p, c = self.particles, self.constants
        deep = ti.select(indicator > c.get("packing"), ti.max(1.0 - c.get("seen") * lacking, 0.0), p.zeros())
        off = c.get("lattice") * indicator - 1.0
        if ti.static(c.two):
            deep = (1.0 - gas) * deep + gas
            off = ti.max(off, gas * VOID - (1.0 - gas))
        else:
            s = p.load(p.deviation, b)
            most = FELT * ti.max(s, 0.0 - s)
            off = ti.min(ti.max(off, 0.0 - most), most)
        p.store(self.drift, b, (c.of("keeping", gas) * deep) * off)

    @ti.func
    def rate(self, b, s):
        """The rate (1/s) of a block's density deviations s."""
        return (1.0 + s) * self.particles.load(self.drift, b)


def lattice(kernel, smoothing: float, axes: int = PLANE) -> float:
    """F of a square or cubic lattice with h/Δx `smoothing`: Σ V (−W'/r) r²/D."""
    n = np.arange(-np.ceil(2.0 * smoothing), np.ceil(2.0 * smoothing) + 1.0)
    r = np.hypot(n[:, None], n)
    if axes > PLANE:
        r = np.hypot(r[..., None], n)
    r = r[(r > 0.0) & (r < 2.0 * smoothing)]
    step = 1e-6 * smoothing
    drop = kernel.printed(r - step, smoothing, axes) - kernel.printed(r + step, smoothing, axes)
    return float((r * drop).sum() / axes / (2.0 * step))
