"""Friction never exceeds μ F_n, whatever the step; creep of a held load under each law."""

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import hertz_stiffness, resting_overlap, sphere_mass
from lab.studies.verify.scenes import ACETATE, G, Setup, Track, again, grain, simulated, track

SECTION = "Friction"
RADIUS, SPEED, FRICTION = 1.5e-3, 0.5, 0.3  # m, m/s
MASS = sphere_mass(RADIUS, ACETATE["density"])
STIFFNESS = hertz_stiffness(ACETATE["young"], ACETATE["poisson"], RADIUS)
CAPPED = ("mindlin", "haff-werner", "cundall-strack", "coulomb")
SHARES = (1.0, 0.5, 0.2)  # of the derived step
LOOKS = 80  # at the derived step: two collisions' time
SLIDES, BOUNCES = range(2)
SPINNING = -400.0  # rad/s
# A load squeezed between two walls, held up by friction alone.
SOFT, SQUEEZED, DAMPERS = 1e-3, 0.002, (20.0, 5.0)  # of the stiffness; overlap in radii; N s/m


def cap(fast: bool) -> Found:
    """A sliding grain slows down by μ g, and |F_t| ≤ μ F_n in every step of its slide and of an oblique impact."""
    height = RADIUS - resting_overlap(MASS * G, STIFFNESS)
    rows = [
        grain(0.0, height, RADIUS, SPEED),
        grain(0.01, RADIUS + 1e-7, RADIUS, 0.4 * SPEED, -SPEED, SPINNING),
    ]
    lines = []
    for law in CAPPED[:1] if fast else CAPPED:
        setup = Setup(
            np.array(rows),
            ACETATE | {"friction": FRICTION},
            {"width": 0.1, "height": 0.02},
            contact={"tangential": law},
        )
        with simulated(setup) as run:
            start, step = run.snapshot(), run.dt
            for share in SHARES:
                again(run, start["position"], share * step, start["velocity"], start["spin"])
                lines += cap_lines(f"{law}, {share:g} Δt", track(run, round(LOOKS / share)))
    note = """Forces are the second differences of the grains' places: what Verlet's scheme made of them, to rounding.
    Δt is the derived step, which is the longest that a run takes unless it is forced."""
    return Found(lines, notes=[note])


def cap_lines(name: str, path: Track) -> list[Line]:
    """Deceleration of the sliding grain, and the largest friction of both in units of its cap."""
    acceleration = path.acceleration()[:, 0]
    slowing = -acceleration[len(acceleration) // 2 :, SLIDES, 0].mean()
    pressing, shearing = acceleration[..., 1] + G, np.abs(acceleration[..., 0])
    beyond = (shearing - FRICTION * pressing).max(axis=0) / (FRICTION * pressing.max(axis=0))
    rounding = "rounding of places, 1e-18 m/Δt², at Δt/5"
    lines = [Line(f"deceleration, {name}", slowing, FRICTION * G, "μ g", 1e-4, rounding, "m/s²")]
    for grain_name, excess in zip(("slide", "impact"), beyond, strict=True):
        quantity = f"|F_t| beyond μ F_n, {grain_name}, {name}"
        lines.append(Line.off(quantity, "Coulomb", max(0.0, excess), 1e-4, rounding))
    return lines


def held_load(_: bool) -> Found:
    """A grain squeezed between two walls creeps at m g/(2 γ_s) under Haff and Werner's law, and stands with history."""
    width = 2.0 * RADIUS * (1.0 - SQUEEZED)
    rows, tank = [grain(0.0, 0.01, RADIUS)], {"width": width, "height": 0.02}
    lines = []
    for law in ("haff-werner", "mindlin"):
        contact = {"tangential": law, "stiffness_scale": SOFT}
        setups = [Setup(np.array(rows), ACETATE | {"shear_damping": d}, tank, contact=contact) for d in DAMPERS]
        with simulated(*setups) as run:
            path = track(run, 2, round(0.05 / run.dt))
        sunk = -(path.position[2] - path.position[1])[:, 0, 1] / (path.time[2] - path.time[1])
        for damper, speed in zip(DAMPERS, sunk, strict=True):
            name = f"creep, {law}, γ_s = {damper:g} N s/m"
            if law == "mindlin":
                still = Line.off(name, "a spring holds", abs(speed), 1e-12, "rounding", "m/s")
                lines.append(still)
                break
            lines.append(Line(name, speed, MASS * G / (2.0 * damper), "m g/(2 γ_s)", 1e-3, "start died away", "m/s"))
    note = """Haff and Werner's friction, the source's, has no memory: what it holds sinks, at 4.6 µm/s here. For long
    rests and slow tilts take a law with history."""
    return Found(lines, notes=[note])


CASES = (
    Case("friction-cap", SECTION, "Friction within its cap at every step", cap),
    Case("held-load", SECTION, "A load that friction alone holds", held_load, quick=False),
)
