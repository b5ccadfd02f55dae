"""What grains and walls are made of, and what two of them are to each other."""

from dataclasses import dataclass
from typing import Annotated

from solvers.quantity import Interval, Unit
from solvers.restitution import dissipative_time_for


@dataclass(frozen=True)
class Material:
    """An elastic, dissipative, frictional material (SI).

    Exactly one of `restitution` and `dissipative_time` is given. `restitution` is that of two equal grains of the
    scene's mean diameter meeting head-on at `restitution_speed`; the dissipative time A of Brilliantov et al. (1996)
    follows from it.
    """

    density: Annotated[float, Unit("kg/m^3"), Interval(gt=0)]
    young: Annotated[float, Unit("Pa"), Interval(gt=0)]
    poisson: Annotated[float, Unit("1"), Interval(ge=0, lt=0.5)]
    friction: Annotated[float, Unit("1"), Interval(ge=0)]
    restitution: Annotated[float | None, Unit("1"), Interval(gt=0, le=1)] = None
    restitution_speed: Annotated[float, Unit("m/s"), Interval(gt=0)] = 1.0
    dissipative_time: Annotated[float | None, Unit("s"), Interval(ge=0)] = None
    shear_damping: Annotated[float, Unit("N s/m"), Interval(ge=0)] = 20.0


@dataclass(frozen=True)
class Interface:
    """Contact properties of two materials (SI)."""

    young_modulus: float  # E*, Pa
    shear_modulus: float  # G*, Pa
    friction: float
    dissipative_time: float  # A, s
    shear_damping: float  # γ_s, N s/m


def effective_young(a: Material, b: Material) -> float:
    """E* (Pa) of Hertz contact, 1/E* = (1 − ν_a²)/Y_a + (1 − ν_b²)/Y_b (Johnson 1985, eq. 4.22)."""
    return 1.0 / ((1.0 - a.poisson**2) / a.young + (1.0 - b.poisson**2) / b.young)


def effective_shear(a: Material, b: Material) -> float:
    """G* (Pa) of Mindlin contact, 1/G* = (2 − ν_a)/G_a + (2 − ν_b)/G_b, G = Y/(2(1 + ν)) (Johnson 1985, eq. 7.43)."""
    compliance = sum(2.0 * (2.0 - m.poisson) * (1.0 + m.poisson) / m.young for m in (a, b))
    return 1.0 / compliance


def interface(grain: Material, other: Material, mass: float, radius: float, scale: float) -> Interface:
    """Contact of a grain with another material, for an effective mass (kg) and radius (m) typical of the scene.

    Friction, shear damping and dissipation are those of `other`: a wall's material says how grains touch that wall.
    `scale` multiplies Young's moduli; the dissipative time then grows by scale^(−2/5), so that every collision keeps
    its restitution (x = β v^(1/5) is unchanged).
    """
    young = effective_young(grain, other)
    if other.restitution is not None:
        stiffness = 4.0 / 3.0 * young * radius**0.5
        time = dissipative_time_for(other.restitution, other.restitution_speed, stiffness, mass)
    else:
        time = other.dissipative_time
    return Interface(
        young_modulus=young * scale,
        shear_modulus=effective_shear(grain, other) * scale,
        friction=other.friction,
        dissipative_time=time * scale**-0.4,
        shear_damping=other.shear_damping,
    )
