"""End-wall friction: the walls before and behind the water of a narrow tank that is computed in the plane."""

from math import pi

import taichi as ti

from solvers.fluid.given import Water

PROFILE = 12.0  # of laminar flow between two walls: its mean friction over ν u/b² (Hele-Shaw 1898; Lamb 1932, § 330)
MODES = 8


def _modes() -> list[tuple[float, float]]:
    """Shares w_n and rates λ_n (π² ν/b²) of the modes of flow between two walls, those from 2^n to 2^(n+1) as one.

    One by one they are w = 8/(π k)² and k², k odd (Carslaw & Jaeger 1959, § 3.3). A group has the sums of its members'
    w and w/λ, so that friction is exact both of what starts at once and of what flows steadily.
    """
    found, left, slow = [], 1.0, pi**2 / 12.0
    for n in range(MODES - 1):
        odd = [k for k in range(2**n, 2 ** (n + 1)) if k % 2]
        share, slowness = (sum(8.0 / (pi * k**power) ** 2 for k in odd) for power in (1, 2))
        found.append((share, share / slowness))
        left, slow = left - share, slow - slowness
    return [*found, (left, left / slow)]


SHARES, RATES = zip(*_modes(), strict=True)


@ti.data_oriented
class EndWallFriction:
    """du/dt = … − Σ_n w_n λ_n u_n: the drag of laminar flow between two walls, a gap b apart, on its mean u.

    Stokes' flow ∂v/∂t = ν ∂²v/∂x² + a under any force a per mass, v = 0 on both walls, is a sum of modes that forget at
    rates λ_n: du_n/dt = a − λ_n u_n, and its mean is u = Σ w_n u_n (Carslaw & Jaeger 1959, § 3.3). Particles carry
    the u_n with them, relative to the tank. For a slow flow the drag is 12 ν u/b², with a fifth of the liquid's inertia
    on top (Ruyer-Quil 2001), for a fast one that of boundary layers, 2 √(νω/2) u/b and as much inertia (Keulegan 1959
    for waves), at any ω with F = iω/(1 − tanh z/z), z = (b/2) √(iω/ν). Eight modes have F − iω to 5 % up to
    b²ω/ν = 10⁵. What the walls take from the water is on the tank, and its power counts as viscosity's, the energy
    that the profile holds over that of its mean included.

    Limits: laminar flow; what the profile carries along is carried with the mean.
    """

    def __init__(self, particles, constants):
        self.particles, self.constants = particles, constants

    @staticmethod
    def rate(water: Water) -> float:
        """12 ν/b² (1/s); 0 where no such walls are."""
        return PROFILE * water.kinematic / water.gap**2 if water.gap else 0.0

    @ti.func
    def drag(self, b, past: ti.template(), kick, found: ti.template()):
        """Take the modes of a block to its velocities `past` the walls; their mean drag (m/s²) in the coming kick.

        In each kick a is one number, which follows from how u has changed. Modes are stepped by 1/(1 + λΔt + (λΔt)²/2),
        of second order and without overshoot; the next kick is taken to have the same a.
        """
        p = self.particles
        slowest = self.constants.get("end_walls") * (pi**2 / PROFILE)
        for axis in ti.static(range(p.axes)):
            kept, gained = p.zeros(), ti.cast(0.0, p.real)
            for n in ti.static(range(MODES)):
                x = ti.static(RATES[n]) * slowest * kick
                less = 1.0 / (1.0 + x + 0.5 * x * x)
                kept += (ti.static(SHARES[n]) * less) * p.load(p.end_wall_modes[n][axis], b)
                gained += ti.static(SHARES[n]) * less * (1.0 + 0.5 * x) * kick
            force = (past[axis] - kept) / gained
            for n in ti.static(range(MODES)):
                rate = ti.static(RATES[n]) * slowest
                x = rate * kick
                less = 1.0 / (1.0 + x + 0.5 * x * x)
                during = less * (1.0 + 0.5 * x)
                mode = less * p.load(p.end_wall_modes[n][axis], b) + (during * kick) * force
                p.store(p.end_wall_modes[n][axis], b, mode)
                found[axis] += ti.static(SHARES[n]) * ((rate * during) * mode + (less * 0.5 * x * (1.0 + x)) * force)
