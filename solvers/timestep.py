"""The step size, derived from the scene: waves, and what its contact laws bear at the highest credible speed."""

from collections.abc import Iterable
from dataclasses import dataclass
from math import pi, sqrt

from solvers.materials import Interface, Material

RAYLEIGH_SHARE = 0.2


@dataclass(frozen=True)
class Limit:
    """A bound on the step and what sets it."""

    step: float  # s
    reason: str


def rayleigh_time(radius: float, density: float, shear: float, poisson: float) -> float:
    """Time (s) of a Rayleigh wave over half a grain, π R √(ρ/G)/(0.1631 ν + 0.8766) (Thornton and Randall 1988)."""
    return pi * radius * sqrt(density / shear) / (0.1631 * poisson + 0.8766)


def limits(
    smallest: float,
    grain: Material,
    interfaces: tuple[Interface, Interface],
    scale: float,
    speed: float,
    laws: Iterable,
    share: float = 1.0,
) -> list[Limit]:
    """All bounds on the step for grains of at least the radius `smallest` (m) that meet at up to `speed` (m/s).

    `laws` are the contact laws of the scene; each says which steps it bears (`limits`). `share` is the smallest part of
    its mass with which a grain resists a push on its outline: less than 1 where the push also turns it.
    """
    mass = share * 4.0 / 3.0 * pi * smallest**3 * grain.density
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
        for law in laws:
            for step, reason in law.limits(between, m_eff, r_eff, speed):
                found.append(Limit(step, f"{reason} of {name} at {speed:.3g} m/s"))
    return sorted(found, key=lambda limit: limit.step)
