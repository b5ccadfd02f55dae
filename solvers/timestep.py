"""The step size, derived from the scene: the stiffest contact at the highest credible speed, waves, dampers."""

from dataclasses import dataclass
from math import pi, sqrt

from solvers.materials import Interface, Material

# Steps a collision takes: an elastic one, and one with viscoelastic damping x = β v^(1/5) (times √x). The error of
# the restitution falls as Δt² and grows with x; these keep it under 0.1 % wherever in a step the contact begins.
ELASTIC_STEPS = 36.0
DAMPED_STEPS = 105.0
RAYLEIGH_SHARE = 0.2


@dataclass(frozen=True)
class Limit:
    """A bound on the step and what sets it."""

    step: float  # s
    reason: str


def hertz_duration(mass: float, radius: float, young: float, speed: float) -> float:
    """Duration (s) of an elastic Hertz collision, 2.87 (m*²/(R* E*² v))^(1/5) (Johnson 1985, eq. 11.24)."""
    return 2.87 * (mass**2 / (radius * young**2 * speed)) ** 0.2


def rayleigh_time(radius: float, density: float, shear: float, poisson: float) -> float:
    """Time (s) of a Rayleigh wave over half a grain, π R √(ρ/G)/(0.1631 ν + 0.8766) (Thornton and Randall 1988)."""
    return pi * radius * sqrt(density / shear) / (0.1631 * poisson + 0.8766)


def damping(between: Interface, mass: float, radius: float, speed: float) -> float:
    """x = β v^(1/5), β = (γ_n/m_eff)(m_eff/k)^(3/5): how much of its energy a viscoelastic collision loses."""
    k = 4.0 / 3.0 * between.young_modulus * sqrt(radius)
    return 1.5 * between.dissipative_time * (k / mass) ** 0.4 * speed**0.2


def limits(
    smallest: float,
    grain: Material,
    interfaces: tuple[Interface, Interface],
    scale: float,
    speed: float,
) -> list[Limit]:
    """All bounds on the step for grains of at least the radius `smallest` (m) that meet at up to `speed` (m/s)."""
    mass = 4.0 / 3.0 * pi * smallest**3 * grain.density
    shear = grain.young * scale / (2.0 * (1.0 + grain.poisson))
    found = [
        Limit(
            RAYLEIGH_SHARE * rayleigh_time(smallest, grain.density, shear, grain.poisson),
            f"{RAYLEIGH_SHARE:g} of the Rayleigh time of the smallest grain",
        )
    ]
    for between, m_eff, r_eff, name in (
        (interfaces[0], mass / 2.0, smallest / 2.0, "two of the smallest grains"),
        (interfaces[1], mass, smallest, "the smallest grain and a wall"),
    ):
        collision = hertz_duration(m_eff, r_eff, between.young_modulus, speed)
        steps = max(ELASTIC_STEPS, DAMPED_STEPS * sqrt(damping(between, m_eff, r_eff, speed)))
        reason = f"1/{steps:.0f} of the Hertz collision of {name} at {speed:.3g} m/s"
        found.append(Limit(collision / steps, reason))
    return sorted(found, key=lambda limit: limit.step)
