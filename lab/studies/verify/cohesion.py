"""Liquid bridges: the work to tear one, and the force that it carries."""

from dataclasses import replace
from math import atan, cos, log, pi, sqrt

import numpy as np

from lab.studies.case import Case, Found, Line
from lab.studies.verify.references import sphere_mass
from lab.studies.verify.scenes import ACETATE, WEIGHTLESS, Setup, again, grain, simulated

SECTION = "Cohesion"
RADIUS, BOX = 1.5e-3, {"width": 1.0, "height": 1.0}
TENSION, ANGLE, HUMIDITY, VOLUME = 0.072, 0.4, 0.7, 2e-12  # N/m, rad, 1, m³
LIQUID = {"surface_tension": TENSION, "contact_angle": ANGLE, "humidity": HUMIDITY, "bridge_volume": VOLUME}
MASS = sphere_mass(RADIUS, ACETATE["density"])
KELVIN = TENSION * 18.07e-6 / (8.314 * 298.15 * -log(HUMIDITY))  # m
RANGE = {"humid": KELVIN, "bridge": (1.0 + ANGLE / 2.0) * VOLUME ** (1.0 / 3.0)}  # m
SPEEDS = {"humid": 2e-3, "bridge": 0.12}  # m/s, some times what just tears a bridge
SHARES = (0.3, 1.0, 2.0)  # of the derived step
PLACES = 12  # where in a step the touch comes
LAWS = {"humid": "in humid air (Spandonidis 2016, eq. 4.9–4.11)", "bridge": "wet (Willett et al. 2000)"}
SHARP = 1e-2, "of a tenth and less of the energy, from 12 places of the touch within a step"
COARSE = 5e-2, "as before, at a step twice the derived one"
SOFT = 1e-3  # of the material's stiffness
SLOW = {"humid": 5e-3, "bridge": 0.12}  # m/s, of softened grains
MEAN = 5e-2, "mean over 12 places of the touch; of the collision's energy a five-hundredth or less"


def pull_off(law: str, effective: float) -> float:
    """f₀ (N) for an effective radius (m): 2π γ cos θ R_eff as the source prints it, or of two smooth spheres."""
    return (2.0 if law == "humid" else 4.0) * pi * TENSION * cos(ANGLE) * effective


def tearing(law: str, effective: float) -> float:
    """The work (J) of a bridge from touch to break: f₀ r_K/2, or the integral of f₀/(1 + 1.05 x + 2.5 x²)."""
    if law == "humid":
        return 0.5 * pull_off(law, effective) * KELVIN
    scale, root = sqrt(2.0 * effective / VOLUME), sqrt(4.0 * 2.5 - 1.05**2)
    turned = atan((5.0 * scale * RANGE[law] + 1.05) / root) - atan(1.05 / root)
    return pull_off(law, effective) * 2.0 / root * turned / scale


def make_and_break(law: str) -> Found:
    """Elastic grains collide, two of them and one with the floor: they lose the work of tearing the bridge."""
    speed, lines = SPEEDS[law], []
    rows = [grain(-0.1, 0.5, RADIUS, speed / 2.0), grain(0.1, 0.5, RADIUS, -speed / 2.0), grain(0.3, 0.5, RADIUS)]
    contact = {"normal": "hertz", "tangential": "none", "cohesion": law}
    material = ACETATE | LIQUID | {"restitution": 1.0}
    setup = Setup(np.array(rows), material, BOX, contact=contact, run={"gravity": WEIGHTLESS})
    with simulated(*[setup] * PLACES) as run:
        derived = run.dt
        for share in SHARES:
            lost = _losses(run, law, speed, share * derived)
            how = SHARP if share <= 1.0 else COARSE
            lines += _lines(law, lost, f"{share:g} of the derived step", how, farthest=True)
    lines += _softened(law, setup)
    note = f"""At {speed:g} m/s, {RANGE[law]:.3g} m of range; a step of the derived size goes {speed * derived:.2g} m.
    Each line is the farthest off of {PLACES} places of the first touch within a step; of softened grains, whose steps
    are so long that a bridge is a small part of one and of the energy, the mean."""
    return Found(lines, notes=[note])


def _softened(law: str, setup: Setup) -> list[Line]:
    """Lines on grains of SOFT times the stiffness, at their own derived step."""
    speed = SLOW[law]
    rows = setup.grains * [1.0, 1.0, 1.0, speed / SPEEDS[law], 1.0, 1.0]
    soft = replace(setup, grains=rows, contact=setup.contact | {"stiffness_scale": SOFT})
    with simulated(*[soft] * PLACES) as run:
        lost = _losses(run, law, speed, run.dt)
    return _lines(law, lost, f"stiffness × {SOFT:g}", MEAN)


def _lines(law: str, losses, words: str, how: tuple[float, str], farthest: bool = False) -> list[Line]:
    """A line for the losses (J) of two grains and one for those at the floor: the mean, or the `farthest` off."""
    lines = []
    for name, lost, effective in zip(("two grains", "floor"), losses, (RADIUS / 2.0, RADIUS), strict=True):
        expected = tearing(law, effective)
        value = lost[np.abs(lost - expected).argmax()] if farthest else lost.mean()
        quantity = f"energy lost, {name}, {words}"
        lines.append(Line(quantity, 1e12 * value, 1e12 * expected, "closed form", *how, "pJ"))
    return lines


def _losses(run, law: str, speed: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Energy (J) lost by two grains and by one at the floor, (PLACES,) each, whose gaps end all over a step."""
    place, velocity = run.snapshot()["position"], np.zeros((PLACES, 3, 2))
    gap = 2e-6 + np.arange(PLACES) / PLACES * speed * step
    place[:, 0], place[:, 1] = [0.0, 0.5], [0.0, 0.5]
    place[:, 0, 0], place[:, 1, 0] = -RADIUS - gap / 2.0, RADIUS + gap / 2.0
    place[:, 2] = np.stack([np.full(PLACES, 0.3), RADIUS + gap], axis=1)
    velocity[:, 0, 0], velocity[:, 1, 0], velocity[:, 2, 1] = speed / 2.0, -speed / 2.0, -speed
    again(run, place, step, velocity)
    run.advance(int((4.0 * RANGE[law] / speed + 1e-5 / speed + 2e-4) / step))
    if np.any(run.observe()["elastic"] != 0.0):
        raise RuntimeError("the grains have not come apart")
    after = run.snapshot()["velocity"]
    pair, wall = after[:, 1, 0] - after[:, 0, 0], after[:, 2, 1]
    return 0.25 * MASS * (speed**2 - pair**2), 0.5 * MASS * (speed**2 - wall**2)


CASES = tuple(
    Case(f"make-and-break-{law}", SECTION, f"A touch and a break, {title}", lambda _, law=law: make_and_break(law))
    for law, title in LAWS.items()
)
