"""Viscous roll damping of a section without forward speed, from its shape: bilge eddies and skin friction.

After Ikeda's component method (Himeno 1981; ITTC 7.5-02-07-04.5, 2011). Both components are empirical, for model ships,
and good to some tens of per cent. The friction formula is for a laminar boundary layer.
"""

from math import acos, cos, exp, pi, sin, sqrt, tanh

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.motion import RollDamping

VISCOSITY = 1.1e-6  # m²/s, of fresh water at 16 °C
COMMON = 0.02, 0.05  # of critical damping, without bilge keels: linear alone, and with quadratic at COMMON_ANGLE
COMMON_ANGLE = np.radians(15.0)


def common_damping(frequency: float, inertia: float) -> tuple[RollDamping, RollDamping]:
    """The usual range of damping of hulls without bilge keels, for a roll frequency (rad/s) and inertia (kg m).

    From 2 % of critical damping to 5 % at 15 deg, the increase being quadratic: an engineer's choice that covers the
    decay tests of bare hulls. By the energy of a cycle −b φ̇|φ̇| at an amplitude a is (4/3π) b a of the critical.
    """
    low, high = COMMON
    linear = 2.0 * low * frequency * inertia
    return RollDamping(linear), RollDamping(linear, 0.75 * pi * (high - low) / COMMON_ANGLE * inertia)


def estimated_damping(
    breadth: float, draught: float, radius: float, centre: float, frequency: float, density: float = 1000.0
) -> RollDamping:
    """Eddy (Ikeda, Himeno and Tanaka 1978) and friction damping (Kato 1957) of a box with bilge `radius` (m).

    `centre` (m): the height of the roll axis above the keel. Per metre of length.
    """
    coefficient = eddy_coefficient(breadth, draught, radius, centre)
    friction = friction_damping(breadth, draught, radius, centre, frequency, density)
    return RollDamping(friction, 0.5 * density * draught**4 * coefficient)


def friction_damping(
    breadth: float, draught: float, radius: float, centre: float, frequency: float, density: float = 1000.0
) -> float:
    """B₁ (N s) of skin friction per metre: B = (4/3π) ρ s r³ ω a C_f, C_f = 1.328 (3.22 r² a²/T ν)^(−1/2) (Kato 1957).

    ITTC 7.5-02-07-04.5, eqs. 2.9 to 2.13. C_f is proportional to 1/a, so the amplitude a cancels.
    """
    girth, arm = friction_arm(breadth, draught, _fullness(breadth, draught, radius), centre)
    layer = 1.328 * sqrt(2.0 * pi / frequency * VISCOSITY / 3.22) / arm  # a C_f
    return 4.0 / (3.0 * pi) * density * girth * arm**3 * frequency * layer


def friction_arm(breadth: float, draught: float, fullness: float, centre: float) -> tuple[float, float]:
    """Girth s and arm r (m) of skin friction, of a section or, with her block coefficient, of a ship (Kato 1957)."""
    girth = 1.7 * draught + fullness * breadth
    return girth, ((0.887 + 0.145 * fullness) * girth - 2.0 * (draught - centre)) / pi


def eddy_coefficient(breadth: float, draught: float, radius: float, centre: float) -> float:
    """C_R of the moment ½ ρ d⁴ C_R φ̇|φ̇| per metre, d the draught (Ikeda, Himeno and Tanaka 1978; Himeno 1981).

    C_R = {(1 − f₁R/d)(1 − OG/d − f₁R/d) + f₂ (H₀ − f₁R/d)²} C_P (r/d)², r the distance of the furthest point from the
    axis. C_P is the pressure coefficient behind it, from the ratio γ of the potential flow's speed there to the mean.
    """
    return section_eddies(breadth, draught, radius, _fullness(breadth, draught, radius), centre)


def section_eddies(breadth: float, draught: float, radius: float, fullness: float, centre: float) -> float:
    """`eddy_coefficient` of a section with a bilge `radius` (m) and any `fullness`, area over breadth and draught."""
    half, deep, bilge = 0.5 * breadth / draught, (draught - centre) / draught, radius / draught
    furthest, ratio = _lewis_flow(breadth, draught, fullness, deep)
    pressure = 0.5 * (0.87 * exp(-ratio) - 4.0 * exp(-0.187 * ratio) + 3.0)
    f1 = 0.5 * (1.0 + tanh(20.0 * (fullness - 0.7)))
    f2 = 0.5 * (1.0 - cos(pi * fullness)) - 1.5 * (1.0 - exp(-5.0 * (1.0 - fullness))) * sin(pi * fullness) ** 2
    lever = (1.0 - f1 * bilge) * (1.0 - deep - f1 * bilge) + f2 * (half - f1 * bilge) ** 2
    return lever * pressure * (furthest / draught) ** 2


def _fullness(breadth: float, draught: float, radius: float) -> float:
    if not 0.0 <= radius <= min(0.5 * breadth, draught):
        raise Unavailable("the bilge's radius must lie between 0 and the smaller of half the breadth and the draught.")
    return 1.0 - (2.0 - 0.5 * pi) * radius**2 / (breadth * draught)


def _lewis_flow(breadth: float, draught: float, fullness: float, deep: float) -> tuple[float, float]:
    """Distance (m) of the Lewis section's furthest point from the axis, and γ there (Ikeda et al. 1978, A-1 to A-10).

    The Lewis form's coefficients a₁, a₃ follow from breadth, draught and fullness (von Kerczek and Tuck 1969).
    """
    half = 0.5 * breadth / draught
    shape = 3.0 + 4.0 * fullness / pi + (1.0 - 4.0 * fullness / pi) * ((half - 1.0) / (half + 1.0)) ** 2
    if shape > 4.5:
        raise Unavailable("no Lewis form is as full as this section.")
    a3 = (3.0 - shape + sqrt(9.0 - 2.0 * shape)) / shape
    a1 = (1.0 + a3) * (half - 1.0) / (half + 1.0)
    scale = 0.5 * breadth / (1.0 + a1 + a3)

    def distance(psi: float) -> float:
        y = (1.0 + a1) * sin(psi) - a3 * sin(3.0 * psi)
        z = (1.0 - a1) * cos(psi) + a3 * cos(3.0 * psi)
        return scale * sqrt(y * y + z * z)

    corner = 0.5 * acos(max(-1.0, min(1.0, a1 * (1.0 + a3) / (4.0 * a3)))) if a3 else 0.0
    psi = max(0.0, corner, key=distance)
    along = -2.0 * a3 * cos(5.0 * psi) + a1 * (1.0 - a3) * cos(3.0 * psi)
    along += ((6.0 - 3.0 * a1) * a3**2 + (a1**2 - 3.0 * a1) * a3 + a1**2) * cos(psi)
    across = -2.0 * a3 * sin(5.0 * psi) + a1 * (1.0 - a3) * sin(3.0 * psi)
    across += ((6.0 + 3.0 * a1) * a3**2 + (3.0 * a1 + a1**2) * a3 + a1**2) * sin(psi)
    stretch = 1.0 + a1**2 + 9.0 * a3**2 + 2.0 * a1 * (1.0 - 3.0 * a3) * cos(2.0 * psi) - 6.0 * a3 * cos(4.0 * psi)
    sharp = 1.0 + 4.0 * exp(-1.65e5 * (1.0 - fullness) ** 2)
    furthest = distance(psi)
    speed = furthest + 2.0 * scale / stretch * sqrt(along**2 + across**2)
    mean = 2.0 * draught * (1.0 - deep) * sqrt(half / (1.0 - deep) * (fullness - deep) / (1.0 - deep))
    return furthest, sharp * sqrt(pi) * speed / mean
