"""Roll damping of bilge keels without speed: their own drag, and the pressure that they cause on the hull.

After Ikeda, Himeno and Tanaka (1976 to 1978), as in ITTC Recommended Procedure 7.5-02-07-04.5. The keels stand in the
middle of the bilges, at a distance l from the axis of roll. The flow there is faster than l φ̇ by a factor f. With the
section's fullness σ, the keels' breadth b, the amplitude of roll a, and a pressure C⁺ before a keel and C⁻ behind it,

    f = 1 + 0.3 exp(−160 (1 − σ))
    C⁻ = −22.5 b/(π l f a) − 1.2,  C⁺ = 1.2,  C_D = C⁺ − C⁻
    M_N = ρ l³ b f² C_D φ̇|φ̇|,  M_H = ½ ρ l² f² I φ̇|φ̇|

M_N is the moment of the drag of both keels, M_H that of the pressure on both sides of the hull, each per metre of keel;
I = ∫ C_p h ds, h the arm of the hull's normal. Behind a keel C⁻ acts along S₀ = 0.3 π l f a + 1.95 b, at most to the
waterline on one side and to amidships on the other. Before a keel C⁺ falls evenly to nil at the same places. The
procedure's coefficients m₁ to m₈ are these integrals along a section of two straight lines and a quarter circle; here
they are exact, not rounded.

Limits: model ships of usual form; keels of one breadth, at right angles to the bilge. The bare hull's eddies are not
changed by them.
"""

from dataclasses import dataclass
from math import cos, exp, pi, sqrt

EQUIVALENT = 8.0 / (3.0 * pi)  # linear over quadratic damping, per ω a, by the energy of a cycle
MIDDLE = 1.0 - sqrt(0.5)  # of the bilge's radius: from its outer corner to its middle, along y and z
FRONT = 1.2  # C⁺
EIGHTH = 0.25 * pi  # rad: half of the bilge


@dataclass(frozen=True)
class Midship:
    """The section that carries the keels: `breadth`, `draught` and bilge `radius` (m), and its `fullness`.

    `centre` (m) is the height of the axis of roll above the keel line.
    """

    breadth: float
    draught: float
    radius: float
    fullness: float
    centre: float

    @property
    def arm(self) -> float:
        """Distance l (m) of the bilge's middle from the axis."""
        cut = MIDDLE * self.radius
        return sqrt((0.5 * self.breadth - cut) ** 2 + (self.centre - cut) ** 2)

    @property
    def faster(self) -> float:
        """The factor f of the flow's speed at the bilge."""
        return 1.0 + 0.3 * exp(-160.0 * (1.0 - min(self.fullness, 1.0)))


@dataclass(frozen=True)
class Keels:
    """A pair of bilge keels of a `breadth` and a `length` (m)."""

    breadth: float
    length: float


def bilge_radius(breadth: float, draught: float, fullness: float) -> float:
    """Radius (m) of the bilges of a section of that fullness with straight sides and bottom, at most what fits.

    1 − σ = (2 − π/2) R²/(B d).
    """
    whole = sqrt(max(1.0 - fullness, 0.0) * breadth * draught / (2.0 - 0.5 * pi))
    return min(whole, 0.5 * breadth, draught)


def drag(midship: Midship, breadth: float, frequency: float, amplitude: float, density: float) -> float:
    """Linear damping (N s) per metre of both keels by their drag, equivalent at an amplitude (rad)."""
    arm, faster = midship.arm, midship.faster
    coefficient = FRONT + _suction(midship, breadth, amplitude)
    return EQUIVALENT * density * arm**3 * frequency * amplitude * breadth * faster**2 * coefficient


def hull_pressure(midship: Midship, breadth: float, frequency: float, amplitude: float, density: float) -> float:
    """Linear damping (N s) per metre of keels by the pressure on the hull, equivalent at an amplitude (rad)."""
    moment = FRONT * _front(midship) + _suction(midship, breadth, amplitude) * _behind(midship, breadth, amplitude)
    speed = (midship.arm * midship.faster) ** 2
    return EQUIVALENT * 0.5 * density * speed * moment * frequency * amplitude


def _suction(midship: Midship, breadth: float, amplitude: float) -> float:
    """−C⁻."""
    return 22.5 * breadth / (pi * midship.arm * midship.faster * amplitude) + FRONT


def _behind(midship: Midship, breadth: float, amplitude: float) -> float:
    """∫ (lever) ds (m²) along S₀ behind both keels: up the side behind the one that sinks, inboard behind the other."""
    radius = midship.radius
    along = 0.3 * pi * midship.arm * midship.faster * amplitude + 1.95 * breadth
    deep, wide = midship.centre - radius, 0.5 * midship.breadth - radius  # of the bilge circle's middle from the axis
    if along <= EIGHTH * radius:
        return radius * (deep + wide) * sqrt(2.0) * (1.0 - cos(along / radius))
    up, inward = (min(along - EIGHTH * radius, most) for most in (midship.draught - radius, wide))
    bent = radius * (deep + wide) * (sqrt(2.0) - 1.0)
    return bent + up * deep - 0.5 * up**2 + inward * wide - 0.5 * inward**2


def _front(midship: Midship) -> float:
    """∫ (lever) (C_p/C⁺) ds (m²) before both keels, C_p falling evenly from a keel to the waterline and amidships.

    Along the bilge u is the angle from its middle, and S, C are sine and cosine of π/4 + u.
    """
    radius, below = midship.radius, midship.draught - midship.centre
    deep, wide = midship.centre - radius, 0.5 * midship.breadth - radius  # of the bilge circle's middle from the axis
    side = midship.draught - radius
    up, inward = side + EIGHTH * radius, wide + EIGHTH * radius  # the whole way from the bilge's middle
    sine, cosine = sqrt(0.5), 1.0 - sqrt(0.5)  # ∫ S du, ∫ C du
    sines, cosines = 1.0 - sqrt(0.5), EIGHTH - sqrt(0.5)  # ∫ u S du, ∫ u C du
    bend = deep * sine - wide * cosine - radius / up * (deep * sines - wide * cosines)
    bend += wide * sine - deep * cosine - radius / inward * (wide * sines - deep * cosines)
    return radius * bend + side**2 * (2.0 * deep - below) / (6.0 * up) + wide**3 / (3.0 * inward)
