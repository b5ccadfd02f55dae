"""Materials of grains and walls, and the contact properties of two materials."""

from dataclasses import dataclass, replace
from math import pi
from typing import Annotated

from solvers.grains.restitution import dissipative_time_for, restitution_from
from solvers.machine.marks import Doc, Interval, Unit, Usual

# Properties that are averaged for the contact of two kinds of grains; the moduli have their own rule.
MEANT = (
    "friction",
    "restitution_speed",
    "shear_damping",
    "rolling_friction",
    "rolling_damping",
    "surface_tension",
    "contact_angle",
    "asperities",
    "humidity",
    "bridge_volume",
)
LEAST_RESTITUTION = 0.01  # lower bound of the restitution from a dissipative time; laws need a positive one


@dataclass(frozen=True)
class Material:
    """An elastic, dissipative, frictional material (SI).

    Exactly one of `restitution` and `dissipative_time` is given. `restitution` is that of two equal grains of the
    scene's mean diameter in a head-on collision at `restitution_speed`. The dissipative time A of Brilliantov et al.
    (1996) follows from it, or it from A. Rolling friction μ_r is the tangent of the steepest slope that holds a sphere,
    and `rolling_damping` η_r a share of critical damping; only rolling laws use them. Only cohesion laws use the
    surface tension γ_s (of water unless given) and contact angle θ of the liquid, the height of the `asperities` that
    keep surfaces apart, the relative humidity of the air and the volume of a liquid bridge.
    """

    density: Annotated[float, Unit("kg/m^3"), Interval(gt=0), Doc("Density of the solid.")]
    young: Annotated[float, Unit("Pa"), Interval(gt=0), Doc("Young's modulus.")]
    poisson: Annotated[float, Unit("1"), Interval(ge=0, lt=0.5), Doc("Poisson's ratio.")]
    friction: Annotated[
        float, Unit("1"), Interval(ge=0), Usual(0.0, 1.0, "1"), Doc("Coefficient of friction between two surfaces.")
    ]
    restitution: Annotated[
        float | None,
        Unit("1"),
        Interval(gt=0, le=1),
        Doc("Restitution of two equal grains of mean diameter that meet head-on; give it or `dissipative_time`."),
    ] = None
    restitution_speed: Annotated[
        float,
        Unit("m/s"),
        Interval(gt=0),
        Doc("Closing speed at which `restitution` is given."),
    ] = 1.0
    dissipative_time: Annotated[
        float | None,
        Unit("s"),
        Interval(ge=0),
        Doc("Dissipative time A of Brilliantov et al. (1996), in place of `restitution`."),
    ] = None
    shear_damping: Annotated[
        float,
        Unit("N s/m"),
        Interval(ge=0),
        Doc("Tangential damping γ_s of the Haff-Werner law."),
    ] = 20.0
    rolling_friction: Annotated[
        float,
        Unit("1"),
        Interval(ge=0),
        Doc("Tangent of the steepest slope that holds a sphere; for rolling laws."),
    ] = 0.0
    rolling_damping: Annotated[
        float,
        Unit("1"),
        Interval(ge=0),
        Doc("Share of critical damping in rolling; for rolling laws."),
    ] = 0.3
    surface_tension: Annotated[
        float,
        Unit("N/m"),
        Interval(gt=0),
        Doc("Surface tension of the liquid between grains; for cohesion laws."),
    ] = 0.072
    contact_angle: Annotated[
        float,
        Unit("rad"),
        Interval(ge=0, lt=pi / 2),
        Doc("Contact angle of the liquid; for cohesion laws."),
    ] = 0.0
    asperities: Annotated[
        float,
        Unit("m"),
        Interval(ge=0),
        Doc("Height of the asperities that keep surfaces apart; for cohesion laws."),
    ] = 0.0
    humidity: Annotated[
        float | None,
        Unit("1"),
        Interval(gt=0, lt=1),
        Usual(0.3, 0.99, "%"),
        Doc("Relative humidity of the air; for the law humid."),
    ] = None
    bridge_volume: Annotated[
        float | None,
        Unit("m^3"),
        Interval(gt=0),
        Doc("Volume of a liquid bridge; for the law of given bridges."),
    ] = None


@dataclass(frozen=True)
class Interface:
    """Contact properties of two materials (SI)."""

    young_modulus: float  # E*, Pa
    shear_modulus: float  # G*, Pa
    friction: float
    restitution: float  # e, at the restitution speed
    restitution_speed: float  # m/s
    dissipative_time: float  # A, s
    shear_damping: float  # γ_s, N s/m
    rolling_friction: float  # μ_r
    rolling_damping: float  # η_r
    surface_tension: float  # γ_s, N/m
    contact_angle: float  # θ, rad
    asperities: float  # h, m
    humidity: float | None
    bridge_volume: float | None  # V, m³


def effective_young(a: Material, b: Material) -> float:
    """E* (Pa) of Hertz contact, 1/E* = (1 − ν_a²)/Y_a + (1 − ν_b²)/Y_b (Johnson 1985, eq. 4.22)."""
    return 1.0 / ((1.0 - a.poisson**2) / a.young + (1.0 - b.poisson**2) / b.young)


def effective_shear(a: Material, b: Material) -> float:
    """G* (Pa) of Mindlin contact, 1/G* = (2 − ν_a)/G_a + (2 − ν_b)/G_b, G = Y/(2(1 + ν)) (Johnson 1985, eq. 7.43)."""
    compliance = sum(2.0 * (2.0 - m.poisson) * (1.0 + m.poisson) / m.young for m in (a, b))
    return 1.0 / compliance


def hertz_stiffness(young: float, radius: float) -> float:
    """k (N/m^1.5) of Hertz contact, (4/3) E* √R_eff."""
    return 4.0 / 3.0 * young * radius**0.5


def touching(a: Material, b: Material, given: Material | None) -> Material:
    """Material of kind b as seen by kind a: b's elasticity, with the pair's own friction and losses.

    Friction and losses are those of `given`, or else the means of the two kinds. Raises ValueError if one kind has a
    restitution and the other a dissipative time.
    """
    if given is not None:
        return replace(given, young=b.young, poisson=b.poisson)
    known = [name for name in MEANT if None not in (getattr(a, name), getattr(b, name))]
    mean = {name: 0.5 * (getattr(a, name) + getattr(b, name)) for name in known}
    losses = "restitution" if a.restitution is not None and b.restitution is not None else "dissipative_time"
    other = "dissipative_time" if losses == "restitution" else "restitution"
    if None in (getattr(a, losses), getattr(b, losses)):
        raise ValueError("two materials, one with a restitution and one with a dissipative time, have no mean")
    mean |= {losses: 0.5 * (getattr(a, losses) + getattr(b, losses)), other: None}
    return replace(b, **mean)


def interface(grain: Material, other: Material, mass: float, radius: float, scale: float) -> Interface:
    """Contact of a grain with another material, for an effective mass (kg) and radius (m) typical of the scene.

    All properties except the moduli are those of `other`: a wall's material says how grains touch that wall.
    Restitution and dissipative time follow from each other by the viscoelastic law. `scale` multiplies Young's moduli;
    the dissipative time is multiplied by scale^(−2/5), so that every collision keeps its restitution (x = β v^(1/5) is
    unchanged).
    """
    young = effective_young(grain, other)
    speed, stiffness = other.restitution_speed, hertz_stiffness(young, radius)
    if other.restitution is not None:
        restitution = other.restitution
        time = dissipative_time_for(restitution, speed, stiffness, mass)
    else:
        time = other.dissipative_time
        restitution = max(LEAST_RESTITUTION, min(1.0, restitution_from(time, speed, stiffness, mass)))
    return Interface(
        young_modulus=young * scale,
        shear_modulus=effective_shear(grain, other) * scale,
        friction=other.friction,
        restitution=restitution,
        restitution_speed=speed,
        dissipative_time=time * scale**-0.4,
        shear_damping=other.shear_damping,
        rolling_friction=other.rolling_friction,
        rolling_damping=other.rolling_damping,
        surface_tension=other.surface_tension,
        contact_angle=other.contact_angle,
        asperities=other.asperities,
        humidity=other.humidity,
        bridge_volume=other.bridge_volume,
    )
