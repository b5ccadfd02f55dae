"""Oblique impacts of a sphere on a wall, from steep to grazing (Chung and Ooi 2011, test 4)."""

from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lab.report.plots import BELOW, BLUE, GREY, VERMILION, canvas
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.impacts.meetings import Meetings, Substance
from lab.studies.verify.references import damping_of, sphere_mass, viscoelastic_rebound

SECTION = "Oblique impacts"
# From the wall's normal, in degrees.
ANGLES = (
    2.0, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 50.0, 60.0, 70.0, 80.0, 82.0, 84.0, 86.0, 87.0, 88.0, 89.0
)  # fmt: skip
DAMPER = 20.0  # N s/m
REFERENCES = {"mindlin": "DOP853 at 1e-11", "haff-werner": "Radau at 1e-10"}
# Allowed errors of the speed along the wall, as shares of the speed that the sphere comes with, where it sticks.
# Of Mindlin's spring see `stuck`. Of the damper some (Δt/T)², 1.6e-3, for each kink at the cap, two or three of them.
DAMPED = 4e-3, "scheme O(Δt²), kinks at the cap"
SLID = 5e-4, "half of the restitution's 0.1 %"
FINER = 8  # divisor of the step, to see the error fall
FALLS = {"mindlin": FINER**2, "haff-werner": FINER}  # least factors: a second order, with the damper's kinks a first
SPUN = 2.5  # the error of R ω over that of the speed: both come from one impulse


def throws(substance: Substance, radius: float, speed: float, friction: float, restitution: float, **how) -> Meetings:
    """A sphere thrown at a wall at all ANGLES; its restitution is given at this speed (m/s)."""
    angle = np.radians(ANGLES)
    along = speed * np.sin(angle)
    return Meetings(substance, radius, speed * np.cos(angle), friction, restitution, along, given_at=speed, **how)


# The sphere of aluminium oxide of Chung and Ooi's test 4, and a grain of the source's acetate.
OXIDE_OF_4 = Substance("aluminium oxide", 380e9, 0.23, 4000.0), 2.5e-3, 3.9, 0.092, 0.98
OXIDE = {"mindlin": throws(*OXIDE_OF_4), "haff-werner": throws(*OXIDE_OF_4, damper=DAMPER)}
ACETATE = throws(Substance("acetate", 3.2e9, 0.28, 1319.0), 1.5e-3, 1.0, 0.25, 0.6, wall=3.2e9, damper=DAMPER)


def slides(throw: Meetings, angle: float) -> bool:
    """Whether it slides all the time at an angle (deg): tan θ > (7/2) μ (1 + e), a tenth of the angle beyond."""
    return angle > 1.1 * np.degrees(np.arctan(3.5 * throw.friction * (1.0 + throw.restitution)))


@cache
def thrown(throw: Meetings) -> np.ndarray:
    """Speeds along the wall and from it, and R ω (2, angles, 3) m/s after impacts: at the derived step, and FINER."""
    return throw.run((1.0, 1.0 / FINER))[:, 0, :, :3] * [1.0, 1.0, throw.radius]


def integrated(throw: Meetings) -> np.ndarray:
    """Speed along the wall and R ω (angles, 2) m/s of the same impacts, by the law's own integration."""
    return throw.expected[:, [0, 2]] * [1.0, throw.radius]


def stuck(throw: Meetings, law: str) -> tuple[float, str]:
    """The error of e_t that a contact which sticks may have, and why: with a spring 2/7 of that of its slip."""
    return (2.0 / 7.0 * float(throw.late.max()), "leapfrog: 2/7 (Δt²/24) ∫ ω_t³ dt") if law == "mindlin" else DAMPED


def sliding(_: bool) -> Found:
    """Where the sphere slides all the time: e_t = 1 − μ(1 + e)/tan θ, ω = (5/2) μ (1 + e) v_n/R."""
    lines, throw = [], OXIDE["mindlin"]
    for angle, (_, forwards, _, down), (along, _, spun) in zip(ANGLES, throw.all, thrown(throw)[0], strict=True):
        if not slides(throw, angle):
            continue
        e = viscoelastic_rebound(damping_of(throw.restitution) * (down / throw.given_at) ** 0.2)[0]
        shock = throw.friction * (1.0 + e) * down
        source, reason = "closed form, Chung and Ooi (2011)", "half of the restitution's 0.1 %"
        lines.append(Line(f"e_t at {angle:g}°", along / forwards, 1.0 - shock / forwards, source, 5e-4, reason))
        spin, expected = -spun / throw.radius, 2.5 * shock / throw.radius
        reason = f"{reason}; its lever is R, here R − ξ/2"
        lines.append(Line(f"spin at {angle:g}°", spin, expected, source, 2e-3, reason, "rad/s"))
    note = "The restitution e is that of the viscoelastic law at each normal speed v_n, by DOP853: 0.98 at 3.9 m/s."
    return Found(lines, notes=[note])


def integration_lines(throw: Meetings, law: str) -> list[Line]:
    """Tangential restitution and spin at all angles against the law's own integration; the energy that is left."""
    source, forwards = REFERENCES[law], throw.all[:, 1]
    (here, finer), expected = thrown(throw), integrated(throw)
    lines = []
    for angle, speed, found, wanted in zip(ANGLES, forwards, here, expected, strict=True):
        tolerance, reason = SLID if slides(throw, angle) else stuck(throw, law)
        kept, spun = found[0] / speed, found[2] / speed
        lines.append(Line(f"e_t at {angle:g}°", kept, wanted[0] / speed, source, tolerance, reason, relative=False))
        name, allowed = f"R ω/v_t at {angle:g}°", SPUN * tolerance
        lines.append(Line(name, spun, wanted[1] / speed, source, allowed, reason, relative=False))
    tolerance, reason = stuck(throw, law)
    worst = np.abs((finer[:, 0] - expected[:, 0]) / forwards).max()
    name, allowed = f"largest error of e_t at Δt/{FINER}", tolerance / FALLS[law]
    lines.append(Line.off(name, source, worst, allowed, f"{reason}, /{FALLS[law]:g}"))
    left = (here[:, 0] ** 2 + here[:, 1] ** 2 + 0.4 * here[:, 2] ** 2) / throw.given_at**2
    made = max(0.0, left.max() - 1.0)
    lines.append(Line.off("energy made, largest share", "an impact makes none", made, 1e-9, "rounding"))
    return lines


def oxide(law: str) -> Found:
    """The sphere of oxide under a law, with a figure."""
    throw = OXIDE[law]
    errors = np.abs(thrown(throw)[..., 0] - integrated(throw)[:, 0]) / throw.all[:, 1]
    note = f"""Largest error of e_t at any angle: {errors[0].max():.2g} at the derived step and {errors[1].max():.2g} at
    an eighth of it."""
    if law == "mindlin":
        note += """ Where the contact sticks the spring's history is of second order in the step. Where it slides, from
        32° on, the step hardly matters."""
    caption = f"Tangential restitution and spin after oblique impacts, {law}: here and by the law's own integration"
    picture = Picture(f"oblique-{law}", impacts_figure(throw, law), caption)
    return Found(integration_lines(throw, law), [picture], [note])


def acetate(_: bool) -> Found:
    """A grain of acetate, whose damper no explicit step can follow."""
    rate = DAMPER / (2.0 / 7.0 * sphere_mass(ACETATE.radius, ACETATE.substance.density))
    slowest = 1e6 / rate
    note = f"""A damper of {DAMPER:g} N s/m stops the slip of this grain within {slowest:.2f} µs, too soon for any
    explicit step; the solver splits it into a part that the step resolves and a slow one. The reference does not."""
    return Found(integration_lines(ACETATE, "haff-werner"), notes=[note])


def impacts_figure(throw: Meetings, law: str) -> Figure:
    """Tangential restitution, spin and their errors over the angle."""
    forwards = throw.all[:, 1, None]
    (here, finer), expected = thrown(throw)[:, :, [0, 2]] / forwards, integrated(throw) / forwards
    figure, (upper, lower) = canvas((6.4, 4.6), 2, sharex=True, height_ratios=(2, 1))
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
    upper.set_title(f"{law}, μ = {throw.friction:g}, e = {throw.restitution:g} at {throw.given_at:g} m/s")
    lower.axhline(stuck(throw, law)[0], color=GREY, ls=":", lw=1.0)
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
