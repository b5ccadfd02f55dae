"""Restitution: collisions have the material's given value; the viscoelastic law over its whole range of damping."""

from functools import cache

import numpy as np
from matplotlib.figure import Figure

from lab.preset.accuracy import DRAFT_RESTITUTION, LEVELS, RESTITUTION
from lab.report.plots import BELOW, BLUE, GREY, VERMILION
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.references import (
    HertzCollision,
    dissipative_time,
    first_order_loss,
    hertz_stiffness,
    sphere_mass,
    viscoelastic_rebound,
)
from lab.studies.verify.scenes import WEIGHTLESS, Setup, again, each_at_its_step, grain

SECTION = "Collisions"
RADIUS, SPEED = 2.5e-3, 3.9
# Aluminium oxide, as in the tests 3 and 4 of Chung and Ooi (2011).
OXIDE = {"young": 380e9, "poisson": 0.23, "density": 4000.0, "friction": 0.092, "restitution_speed": SPEED}
GIVEN = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
DAMPINGS = (0.02, 0.04, 0.08, 0.15, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0)
GAP, SLOWEST = 2e-8, 12.0  # m; elastic collisions
PHASES = (0.05, 0.3, 0.55, 0.8)  # of a step, when contact begins
BODIES = ("two grains", "wall")
BOX = {"width": 0.1, "height": 0.1}
# Two grains of which one rests, and one that meets the floor.
ROWS = (
    grain(-RADIUS - GAP / 2, 0.05, RADIUS, SPEED),
    grain(RADIUS + GAP / 2, 0.05, RADIUS),
    grain(0.03, RADIUS + GAP, RADIUS, 0.0, -SPEED),
)
MASS = sphere_mass(RADIUS, OXIDE["density"])
# Effective mass (kg) and stiffness (N/m^1.5) of two grains, and of a grain and a wall of the same material.
PAIR = MASS / 2.0, hertz_stiffness(OXIDE["young"], OXIDE["poisson"], RADIUS / 2.0)
WALL = MASS, hertz_stiffness(OXIDE["young"], OXIDE["poisson"], RADIUS)
ALLOWED = RESTITUTION
REASON = f"the automatic step is derived for {100 * RESTITUTION:g} %"


@cache
def rebounds(law: str, dampings: tuple[float, ...], longer: float = 1.0) -> np.ndarray:
    """Restitutions (PHASES, 2, count), two grains and a wall: of materials of the GIVEN ones, then of these dampings x.

    A damping is that of two grains. Each collision takes the step that is derived for it, times `longer`.
    """
    losses = [{"restitution": e} for e in GIVEN]
    losses += [{"dissipative_time": dissipative_time(x, *PAIR, SPEED)} for x in dampings]
    contact = {"normal": law, "tangential": "none"}
    found = []
    setups = [Setup(np.array(ROWS), OXIDE | loss, BOX, contact=contact, run={"gravity": WEIGHTLESS}) for loss in losses]
    for k, run in each_at_its_step(*setups):
        start, step = run.snapshot(), longer * run.dt
        for phase in PHASES:
            place = start["position"].copy()
            place[:, 0, 0] -= (0.5 + phase) * SPEED * step - GAP
            place[:, 2, 1] += (0.5 + phase) * SPEED * step - GAP
            again(run, place, step, start["velocity"], start["spin"])
            # The slowest collisions are those of the strongest damping.
            run.advance(int(SLOWEST * HertzCollision(*WALL, SPEED).duration / step))
            velocity = run.snapshot()["velocity"][k]
            found.append([(velocity[1, 0] - velocity[0, 0]) / SPEED, velocity[2, 1] / SPEED])
    return np.moveaxis(np.array(found).reshape(len(losses), len(PHASES), 2), 0, 2)


def farthest(values: np.ndarray, expected: float) -> float:
    """The one of the values (n,) that is farthest from the expected value."""
    return float(values[np.abs(values - expected).argmax()])


def given(law: str, fast: bool) -> Found:
    """Restitution out equals restitution in, of two grains and at a wall (Chung and Ooi's test 3, at a wall)."""
    found = rebounds(law, DAMPINGS if law == "hertz-viscoelastic" else ())[..., : len(GIVEN)]
    lines = [
        Line(f"restitution, {name}, {e:g} given", farthest(found[:, row, k], e), e, "what is given", ALLOWED, REASON)
        for row, name in enumerate(BODIES)
        for k, e in enumerate(GIVEN)
    ]
    if not fast:
        draft = rebounds(law, (), LEVELS["draft"].longer_steps)
        errors = np.abs(draft / np.array(GIVEN) - 1.0).max(axis=(0, 2))
        reason = f"{LEVELS['draft'].longer_steps:g} times the derived step"
        lines += [
            Line.off(f"largest error, {name}, draft", "what is given", error, DRAFT_RESTITUTION, reason)
            for name, error in zip(BODIES, errors, strict=True)
        ]
    return Found(lines)


def over_damping(_: bool) -> Found:
    """The viscoelastic law against its own integration, where the contact ends with the force."""
    found = rebounds("hertz-viscoelastic", DAMPINGS)[..., len(GIVEN) :]
    # With one dissipative time a wall's collision has another damping: β ∝ (k/m)^(2/5).
    at_wall = (WALL[1] / WALL[0] * PAIR[0] / PAIR[1]) ** 0.4
    source = "DOP853 at 1e-12, contact ends where F = 0"
    lines, places = [], []
    for row, (name, share) in enumerate(zip(BODIES, (1.0, at_wall), strict=True)):
        for k, damping in enumerate(share * np.array(DAMPINGS)):
            expected = viscoelastic_rebound(damping)[0]
            value = farthest(found[:, row, k], expected)
            lines.append(Line(f"restitution, {name}, x = {damping:.3g}", value, expected, source, ALLOWED, REASON))
            places.append((damping, value, expected))
    series = 1.0 - first_order_loss() * DAMPINGS[0] + 0.6 * (first_order_loss() * DAMPINGS[0]) ** 2
    where, law = f"x = {DAMPINGS[0]:g}", "1 − C x + (3/5) C² x², Schwager and Pöschel (1998)"
    kept = viscoelastic_rebound(DAMPINGS[0])[1]
    lines.append(Line(f"the integration itself, to ξ = 0, {where}", kept, series, law, 5e-6, "next term, 0.49 x³"))
    force, overlap = viscoelastic_rebound(1.0)
    note = f"""A viscoelastic contact may end where its force vanishes, or where the overlap does: between the two the
    grains would pull at one another. At x = 1 that is a restitution of {force:.5f} or of {overlap:.5f}. Dry grains do
    not pull, and the lab cuts the force at zero: its contacts end with the force, and the lines below are of that end.
    Series in x in print are of the other end."""
    caption = "Restitution of the viscoelastic law over its damping, and the error at the automatic step"
    return Found(lines, [Picture("restitution", damping_figure(np.array(places)), caption)], [note])


def damping_figure(places: np.ndarray) -> Figure:
    """Both references over x; the restitutions found, rows (x, found, expected), and their errors below."""
    figure = Figure(figsize=(6.4, 4.4), layout="constrained")
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    x = np.geomspace(DAMPINGS[0] * 0.9, places[:, 0].max() * 1.05, 40)
    ends = np.array([viscoelastic_rebound(float(value)) for value in x])
    upper.plot(x, ends[:, 0], color=BLUE, label="integration, contact ends with its force")
    upper.plot(x, ends[:, 1], color=GREY, ls="--", label="integration, contact ends with its overlap")
    upper.plot(places[:, 0], places[:, 1], "o", color=VERMILION, ms=4, label="here")
    upper.set_ylabel("restitution")
    upper.set_ylim(bottom=0)
    lower.plot(places[:, 0], 100.0 * (places[:, 1] / places[:, 2] - 1.0), "o", color=VERMILION, ms=4)
    for side in (-1.0, 1.0):
        lower.axhline(side * 100.0 * ALLOWED, color=GREY, ls=":", lw=1.0)
    lower.set_ylabel("error (%)")
    lower.set_xscale("log")
    lower.set_xlabel("damping x = β v$^{1/5}$")
    figure.legend(loc=BELOW, ncols=2)
    return figure


def _given_case(law: str, title: str, quick: bool = False) -> Case:
    return Case(f"restitution-{law}", SECTION, f"Restitution as given, {title}", lambda fast: given(law, fast), quick)


CASES = (
    Case("restitution-damping", SECTION, "Restitution of the viscoelastic law against its damping x", over_damping),
    _given_case("hertz-viscoelastic", "viscoelastic Hertz contact (Chung and Ooi 2011, test 3)", quick=True),
    _given_case("hertz-dashpot", "Hertz contact with a linear dashpot"),
    _given_case("linear", "linear spring and dashpot"),
    _given_case("hysteretic", "hysteretic contact"),
)
