"""What the laws of drag say, by themselves: speeds and flows at which drag bears a force."""

from collections.abc import Callable
from math import exp, log10, pi, sqrt

DENSITY, KINEMATIC = 1000.0, 1.0e-6  # kg/m³, m²/s: the water


def di_felice(speed: float, porosity: float, size: float, kinematic: float = KINEMATIC) -> float:
    """Drag per volume of grains and speed between grains and water, kg/(m³ s), as the law is usually written.

    F_d = C_D (π/8) ρ d² ε² w² ε^−χ, C_D = (0.63 + 4.8/√Re)², χ = 3.7 − 0.65 exp(−(1.5 − lg Re)²/2), Re = ε w d/ν (Di
    Felice 1994). `size` d is in m, the `speed` w in m/s.
    """
    reynolds = size * porosity * speed / kinematic
    coefficient = (0.63 + 4.8 / sqrt(reynolds)) ** 2
    power = 3.7 - 0.65 * exp(-0.5 * (1.5 - log10(reynolds)) ** 2)
    force = coefficient * pi / 8.0 * DENSITY * size**2 * (porosity * speed) ** 2 * porosity**-power
    return force / (pi / 6.0 * size**3) / speed


def ergun(speed: float, porosity: float, size: float, kinematic: float = KINEMATIC) -> float:
    """The same of Ergun (1952): 150 ρν (1 − ε)/(ε d²) + 1.75 ρ w/d, without its second part at no speed."""
    slow = 150.0 * DENSITY * kinematic * (1.0 - porosity) / (porosity * size**2)
    return slow + 1.75 * DENSITY * speed / size


def speed_between(driven: float, porosity: float, size: float, law: Callable[..., float] = di_felice) -> float:
    """The speed (m/s) between water and grains at which drag balances a force per volume of grains (N/m³)."""
    low, high = 1e-6, 10.0
    for _ in range(100):
        middle = sqrt(low * high)
        low, high = (middle, high) if law(middle, porosity, size) * middle < driven else (low, middle)
    return low


def settling_speed(heavier: float, porosity: float, size: float, gravity: float) -> float:
    """Speed (m/s) at which a suspension settles or, still, the flow per area that bears it.

    Its grains are `heavier` than water (kg/m³). They pass the water at w, which the pressure's gradient, that of water
    and grains together, bears with the drag: drag is ε (ρ_g − ρ) g per volume of grains. Where what sinks is replaced
    by what rises, grains sink with ε w.
    """
    return porosity * speed_between(porosity * heavier * gravity, porosity, size)


def bed_drop(flow: float, porosity: float, size: float) -> float:
    """Pressure's gradient (Pa/m) over that at rest along a bed that does not move, for a `flow` per area (m/s)."""
    between = flow / porosity
    return (1.0 - porosity) / porosity * di_felice(between, porosity, size) * between
