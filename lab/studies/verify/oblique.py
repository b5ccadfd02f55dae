"""Oblique impacts of a sphere on a wall, from steep to grazing (Chung and Ooi 2011, test 4)."""

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREY, VERMILION
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.collisions import RIGID
from lab.studies.verify.impacts import Bodies, Impact, Normal, Shear
from lab.studies.verify.references import (
    HertzCollision,
    damping_of,
    dissipative_time,
    hertz_stiffness,
    mindlin_stiffness,
    sphere_mass,
    viscoelastic_rebound,
)
from lab.studies.verify.scenes import WEIGHTLESS, Setup, again, grain, simulated

SECTION = "Oblique impacts"
# From the wall's normal, in degrees.
ANGLES = (
    2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 70.0, 80.0, 82.0, 84.0, 86.0, 87.0, 88.0, 89.0
)  # fmt: skip
GAP, SPACING = 1e-5, 0.02  # m; more than half a step before first touch
DAMPER = 20.0  # N s/m
REFERENCES = {"mindlin": "DOP853 at 1e-11", "haff-werner": "Radau at 1e-10"}
# Allowed errors of the speed along the wall, as shares of the speed that the sphere comes with, where it sticks.
# Mindlin's spring is of second order in the step: (ω_t Δt)²/4 with ω_t T = 5, Δt = T/36.
STUCK = {
    "mindlin": (5e-3, "history O(Δt²): (ω_t Δt)²/4"),
    "haff-werner": (4e-3, "scheme O(Δt²), kinks at the cap"),
}
SLID = 5e-4, "half of the restitution's 0.1 %"
FINER = 8  # divisor of the step, to see the error fall
FALLS = {"mindlin": 30.0, "haff-werner": 8.0}  # least factors: half of FINER²; with the damper's kinks: FINER
SPUN = 2.5  # the error of R ω over that of the speed: both come from one impulse


@dataclass(frozen=True)
class Throw:
    """A sphere of a material thrown at a wall at a speed (m/s); its restitution is given at this speed."""

    radius: float
    speed: float
    young: float
    poisson: float
    density: float
    friction: float
    restitution: float
    wall: float  # Young's modulus (Pa) of the wall

    @cached_property
    def mass(self) -> float:
        """kg."""
        return sphere_mass(self.radius, self.density)

    @cached_property
    def stiffness(self) -> float:
        """k (N/m^1.5) of the sphere on the wall."""
        return hertz_stiffness(self.young, self.poisson, self.radius, self.wall)

    def impact(self, law: str) -> Impact:
        """The sphere and the wall as they are integrated apart from the solver."""
        time = dissipative_time(damping_of(self.restitution), self.mass, self.stiffness, self.speed)
        shear = Shear(self.friction, damper=DAMPER)
        if law == "mindlin":
            shear = Shear(self.friction, mindlin_stiffness(self.young, self.poisson, self.radius, self.wall), 0.5, time)
        return Impact(Bodies(self.radius, self.mass), Normal(self.stiffness, 1.5 * time * self.stiffness), shear)

    def normal(self, down: float) -> HertzCollision:
        """The elastic collision at a speed (m/s) towards the wall."""
        return HertzCollision(self.mass, self.stiffness, down)

    def restitution_at(self, down: float) -> float:
        """The viscoelastic restitution at a speed (m/s) towards the wall."""
        return viscoelastic_rebound(damping_of(self.restitution) * (down / self.speed) ** 0.2)[0]

    def slides(self, angle: float) -> bool:
        """Whether it slides all the time at an angle (deg): tan θ > (7/2) μ (1 + e), a tenth of the angle beyond."""
        limit = np.arctan(3.5 * self.friction * (1.0 + self.restitution))
        return angle > 1.1 * np.degrees(limit)

    def setup(self, law: str) -> Setup:
        """The sphere thrown at all ANGLES, side by side."""
        angle = np.radians(ANGLES)
        along, down = self.speed * np.sin(angle), self.speed * np.cos(angle)
        height = self.radius + GAP
        rows = [grain(SPACING * k, height, self.radius, along[k], -down[k]) for k in range(len(angle))]
        names = ("young", "poisson", "density", "friction", "restitution")
        material = {name: getattr(self, name) for name in names}
        material |= {"restitution_speed": self.speed, "shear_damping": DAMPER}
        tank = {"width": 2.0 * SPACING * (len(angle) + 2), "height": 0.1}
        contact = {"tangential": law}
        return Setup(np.array(rows), material, tank, {"young": self.wall}, contact, run={"gravity": WEIGHTLESS})


# The sphere of aluminium oxide of Chung and Ooi's test 4, and a grain of the source's acetate.
OXIDE = Throw(2.5e-3, 3.9, 380e9, 0.23, 4000.0, 0.092, 0.98, RIGID)
ACETATE = Throw(1.5e-3, 1.0, 3.2e9, 0.28, 1319.0, 0.25, 0.6, 3.2e9)


@cache
def thrown(throw: Throw, law: str) -> np.ndarray:
    """Speeds along the wall and from it, and R ω (2, angles, 3) m/s after impacts: at the derived step, and FINER."""
    slowest = throw.speed * np.cos(np.radians(ANGLES[-1]))
    found = []
    with simulated(throw.setup(law)) as run:
        start, step = run.snapshot(), run.dt
        for finer in (1, FINER):
            again(run, start["position"], step / finer, start["velocity"], start["spin"])
            run.advance(int((2.0 * throw.normal(slowest).duration + GAP / slowest) / run.dt))
            state = run.snapshot()
            found.append(np.column_stack([state["velocity"][0], throw.radius * state["spin"][0]]))
    return np.array(found)


@cache
def integrated(throw: Throw, law: str) -> np.ndarray:
    """Speed along the wall and R ω (angles, 2) m/s of the same impacts, by the law's own integration."""
    impact, found = throw.impact(law), []
    for angle in np.radians(ANGLES):
        speed, _, spin, _ = impact.meet(throw.speed * np.sin(angle), throw.speed * np.cos(angle))
        found.append([speed, throw.radius * spin])
    return np.array(found)


def sliding(_: bool) -> Found:
    """Where the sphere slides all the time: e_t = 1 − μ(1 + e)/tan θ, ω = (5/2) μ (1 + e) v_n/R."""
    lines = []
    for angle, (along, _, spun) in zip(ANGLES, thrown(OXIDE, "mindlin")[0], strict=True):
        if not OXIDE.slides(angle):
            continue
        down, forwards = OXIDE.speed * np.cos(np.radians(angle)), OXIDE.speed * np.sin(np.radians(angle))
        shock = OXIDE.friction * (1.0 + OXIDE.restitution_at(down)) * down
        source, reason = "closed form, Chung and Ooi (2011)", "half of the restitution's 0.1 %"
        lines.append(Line(f"e_t at {angle:g}°", along / forwards, 1.0 - shock / forwards, source, 5e-4, reason))
        spin, expected = -spun / OXIDE.radius, 2.5 * shock / OXIDE.radius
        reason = f"{reason}; its lever is R, here R − ξ/2"
        lines.append(Line(f"spin at {angle:g}°", spin, expected, source, 2e-3, reason, "rad/s"))
    note = "The restitution e is that of the viscoelastic law at each normal speed v_n, by DOP853: 0.98 at 3.9 m/s."
    return Found(lines, notes=[note])


def integration_lines(throw: Throw, law: str) -> list[Line]:
    """Tangential restitution and spin at all angles against the law's own integration; the energy that is left."""
    source, forwards = REFERENCES[law], throw.speed * np.sin(np.radians(ANGLES))
    (here, finer), expected = thrown(throw, law), integrated(throw, law)
    lines = []
    for angle, speed, found, wanted in zip(ANGLES, forwards, here, expected, strict=True):
        tolerance, reason = SLID if throw.slides(angle) else STUCK[law]
        kept, spun = found[0] / speed, found[2] / speed
        lines.append(Line(f"e_t at {angle:g}°", kept, wanted[0] / speed, source, tolerance, reason, relative=False))
        name, allowed = f"R ω/v_t at {angle:g}°", SPUN * tolerance
        lines.append(Line(name, spun, wanted[1] / speed, source, allowed, reason, relative=False))
    tolerance, reason = STUCK[law]
    worst = np.abs((finer[:, 0] - expected[:, 0]) / forwards).max()
    name, allowed = f"largest error of e_t at Δt/{FINER}", tolerance / FALLS[law]
    lines.append(Line.off(name, source, worst, allowed, f"{reason}, /{FALLS[law]:g}"))
    left = (here[:, 0] ** 2 + here[:, 1] ** 2 + 0.4 * here[:, 2] ** 2) / throw.speed**2
    made = max(0.0, left.max() - 1.0)
    lines.append(Line.off("energy made, largest share", "an impact makes none", made, 1e-9, "rounding"))
    return lines


def oxide(law: str) -> Found:
    """The sphere of oxide under a law, with a figure."""
    forwards = OXIDE.speed * np.sin(np.radians(ANGLES))
    errors = np.abs(thrown(OXIDE, law)[..., 0] - integrated(OXIDE, law)[:, 0]) / forwards
    note = f"""Largest error of e_t at any angle: {errors[0].max():.2g} at the derived step and {errors[1].max():.2g} at
    an eighth of it."""
    if law == "mindlin":
        note += """ Where the contact sticks the spring's history is of second order in the step. Where it slides, from
        32° on, the step hardly matters."""
    caption = f"Tangential restitution and spin after oblique impacts, {law}: here and by the law's own integration"
    picture = Picture(f"oblique-{law}", impacts_figure(OXIDE, law), caption)
    return Found(integration_lines(OXIDE, law), [picture], [note])


def acetate(_: bool) -> Found:
    """A grain of acetate, whose damper no explicit step can follow."""
    rate = DAMPER / (2.0 / 7.0 * ACETATE.mass)
    slowest = 1e6 / rate
    note = f"""A damper of {DAMPER:g} N s/m stops the slip of this grain within {slowest:.2f} µs, too soon for any
    explicit step; the solver splits it into a part that the step resolves and a slow one. The reference does not."""
    return Found(integration_lines(ACETATE, "haff-werner"), notes=[note])


def impacts_figure(throw: Throw, law: str) -> Figure:
    """Tangential restitution, spin and their errors over the angle."""
    forwards = throw.speed * np.sin(np.radians(ANGLES))[:, None]
    (here, finer), expected = thrown(throw, law)[:, :, [0, 2]] / forwards, integrated(throw, law) / forwards
    figure = Figure(figsize=(6.4, 4.6), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    for k, (colour, name) in enumerate(((BLUE, "tangential restitution"), (VERMILION, "spin, −R ω/v$_t$"))):
        sign = -1.0 if k else 1.0
        upper.plot(ANGLES, sign * expected[:, k], color=colour, lw=1.0, label=f"{name}, integration")
        upper.plot(ANGLES, sign * here[:, k], "o", color=colour, ms=4, label=f"{name}, here")
        for values, marker in ((here, "o"), (finer, "v")):
            error = np.maximum(np.abs(values[:, k] - expected[:, k]), 1e-9)
            lower.plot(ANGLES, error, marker, color=colour, ms=3.5, ls="-", lw=0.6)
    for marker, name in (("o", "error at the derived step"), ("v", "at an eighth of it")):
        lower.plot([], [], marker, color=GREY, ms=3.5, ls="-", lw=0.6, label=name)
    upper.set_ylim(bottom=0.0)
    upper.set_title(f"{law}, μ = {throw.friction:g}, e = {throw.restitution:g} at {throw.speed:g} m/s")
    lower.axhline(STUCK[law][0], color=GREY, ls=":", lw=1.0)
    lower.set_yscale("log")
    lower.set(xlabel="angle between the path and the wall's normal (deg)", ylabel="error")
    lower.set_xlim(0, 90)
    figure.legend(loc=BELOW, ncols=2)
    return figure


CASES = (
    Case("oblique-sliding", SECTION, "Sliding impacts on a rigid wall (Chung and Ooi 2011, test 4)", sliding),
    Case("oblique-mindlin", SECTION, "Impacts at all angles, spring with history", lambda _: oxide("mindlin")),
    Case(
        "oblique-haff-werner",
        SECTION,
        "Impacts at all angles, capped damper",
        lambda _: oxide("haff-werner"),
        quick=False,
    ),
    Case("oblique-acetate", SECTION, "Impacts of a 3 mm grain with the source's damper", acetate, quick=False),
)
