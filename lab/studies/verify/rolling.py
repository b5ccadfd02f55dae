"""Sliding and rolling on a floor and down a slope, with and without friction and rolling friction."""

from functools import cache

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import hertz_stiffness, resting_overlap, sphere_mass
from lab.studies.verify.scenes import ACETATE, G, Setup, Track, grain, simulated, track

SECTION = "Sliding and rolling"
RADIUS, SOFT = 3e-3, 1e-3  # m; of the stiffness, for longer steps
SLOPE = np.radians(20.0)
UP, AWAY = np.array([np.cos(SLOPE), np.sin(SLOPE)]), np.array([-np.sin(SLOPE), np.cos(SLOPE)])
FOOT = 0.4  # m, where the slope begins
OUTLINE = [[-0.5, 0.0], [FOOT, 0.0], [FOOT + 1.0, np.tan(SLOPE)], [FOOT + 1.0, 0.6], [-0.5, 0.6]]
SLIDER, ROLLER, SPINNER, DESCENDER = range(4)
SPEED, ROLLS, SPIN = 0.4, 0.3, 150.0  # m/s, m/s, rad/s
ROUGH, SMOOTH, ROLLING = 0.6, 0.05, 0.1  # friction, friction, rolling friction
# The worlds: friction and rolling friction.
GRIPS, SLIPS, RESISTS, TURNS = range(4)
SURFACES = ((ROUGH, 0.0), (SMOOTH, 0.0), (ROUGH, ROLLING), (0.0, ROLLING))
LAWS = (
    ("mindlin", "elastic-plastic"),
    ("haff-werner", "constant-torque"),
    ("cundall-strack", "none"),
    ("coulomb", "none"),
)
LOOK, LOOKS = 0.01, 55  # s
LEVER = "the lever is R − ξ/2, ξ/(2R) = 0.09 %"
EARLY, LATE = 10, 50  # looks between which speeds are compared, after the start has died away


@cache
def moved(tangential: str, rolling: str) -> Track:
    """Half a second of four grains that do not meet, each resting on its overlap, in worlds of all SURFACES."""
    mass = sphere_mass(RADIUS, ACETATE["density"])
    stiffness = hertz_stiffness(SOFT * ACETATE["young"], ACETATE["poisson"], RADIUS)
    height = RADIUS - resting_overlap(mass * G, stiffness)
    away = RADIUS - resting_overlap(mass * G * np.cos(SLOPE), stiffness)
    start = np.array([FOOT, 0.0]) + 0.7 * UP + away * AWAY
    rows = [
        grain(-0.3, height, RADIUS, SPEED),
        grain(0.0, height, RADIUS, ROLLS, 0.0, -ROLLS / RADIUS),
        grain(0.2, height, RADIUS, spin=SPIN),
        grain(*start, RADIUS),
    ]
    contact = {"tangential": tangential, "rolling": rolling, "stiffness_scale": SOFT}
    materials = [ACETATE | {"friction": mu, "rolling_friction": resists} for mu, resists in SURFACES]
    setups = [Setup(np.array(rows), material, {"outline": OUTLINE}, contact=contact) for material in materials]
    with simulated(*setups) as run:
        return track(run, LOOKS, round(LOOK / run.dt))


def slip_to_roll(fast: bool) -> Found:
    """A sphere set sliding: −μ g while it slides, 5/7 of its speed once it rolls, after 2 v/(7 μ g) (Euler)."""
    lines = []
    for tangential, rolling in _laws(fast):
        path = moved(tangential, rolling)
        time, end = path.time[1], path.time[-1]
        speed, spin = path.velocity[:, GRIPS, SLIDER, 0], path.spin[:, GRIPS, SLIDER]
        way = path.position[-1, GRIPS, SLIDER, 0] - path.position[0, GRIPS, SLIDER, 0]
        rolls = 2.0 * SPEED / (7.0 * ROUGH * G)
        far = SPEED * rolls - 0.5 * ROUGH * G * rolls**2 + 5.0 / 7.0 * SPEED * (end - rolls)
        lines += [
            _line(f"speed while it slides, {tangential}", speed[1], SPEED - ROUGH * G * time, "m/s"),
            _line(f"spin while it slides, {tangential}", -spin[1], 2.5 * ROUGH * G * time / RADIUS, "rad/s"),
            _line(f"speed once it rolls, {tangential}", speed[-1], 5.0 / 7.0 * SPEED, "m/s"),
            _line(f"spin once it rolls, {tangential}", -spin[-1], 5.0 / 7.0 * SPEED / RADIUS, "rad/s"),
            _line(f"way in {end:.2f} s, {tangential}", way, far, "m"),
        ]
    return Found(lines)


def incline(fast: bool) -> Found:
    """Down a slope of 20°: (5/7) g sin θ, (5/7) g (sin θ − μ_r cos θ), and g (sin θ − μ cos θ) where it slides."""
    rolls, slides = 5.0 / 7.0 * G * np.sin(SLOPE), G * (np.sin(SLOPE) - SMOOTH * np.cos(SLOPE))
    resisted = 5.0 / 7.0 * G * (np.sin(SLOPE) - ROLLING * np.cos(SLOPE))
    spun = 2.5 * SMOOTH * G * np.cos(SLOPE) / RADIUS
    lines = []
    for tangential, rolling in _laws(fast):
        path = moved(tangential, rolling)
        span = path.time[LATE] - path.time[EARLY]
        gained = -(path.velocity[LATE] - path.velocity[EARLY])[:, DESCENDER] @ UP / span
        turned = (path.spin[LATE] - path.spin[EARLY])[SLIPS, DESCENDER] / span
        lines += [
            _line(f"rolling, {tangential}", gained[GRIPS], rolls, "m/s²"),
            _line(f"sliding, {tangential}", gained[SLIPS], slides, "m/s²"),
            _line(f"spin while sliding, {tangential}", turned, spun, "rad/s²"),
        ]
        if rolling != "none":
            lines.append(_line(f"rolling with rolling friction, {rolling}", gained[RESISTS], resisted, "m/s²"))
    return Found(lines)


def rolling_decay(fast: bool) -> Found:
    """Rolling friction alone: a spin falls by 5 μ_r g t/(2 R), a rolling sphere's speed by (5/7) μ_r g t, to rest."""
    lines = []
    for tangential, rolling in _laws(fast):
        if rolling == "none":
            continue
        path = moved(tangential, rolling)
        time = path.time[EARLY]
        spin, slowing = path.spin[EARLY, TURNS, SPINNER], 5.0 / 7.0 * ROLLING * G
        speed, way = path.velocity[:, RESISTS, ROLLER, 0], np.ptp(path.position[:, RESISTS, ROLLER, 0])
        lines += [
            _line(f"spin after {time:.2f} s, {rolling}", spin, SPIN - 2.5 * ROLLING * G * time / RADIUS, "rad/s"),
            _line(f"speed after {time:.2f} s, {rolling}", speed[EARLY], ROLLS - slowing * time, "m/s"),
            _line(f"way until it rests, {rolling}", way, 0.5 * ROLLS**2 / slowing, "m"),
            Line.off(
                f"speed left at rest, {rolling}",
                "none",
                abs(speed[-1]),
                1e-6 * ROLLS,
                "its own swing has died away",
                "m/s",
            ),
        ]
    return Found(lines)


def _laws(fast: bool) -> tuple[tuple[str, str], ...]:
    return LAWS[:1] if fast else LAWS


def _line(quantity: str, value: float, reference: float, unit: str) -> Line:
    return Line(quantity, value, reference, "closed form", 1e-3, LEVER, unit)


CASES = (
    Case("slip-to-roll", SECTION, "A sphere that slides, then rolls", slip_to_roll),
    Case("incline", SECTION, "A sphere on a slope of 20°", incline),
    Case("rolling-decay", SECTION, "A sphere that rolling friction brings to rest", rolling_decay),
)
