"""Restitution: collisions have the material's given value; the viscoelastic law over its whole range of damping."""

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from lab.preset.accuracy import DRAFT_RESTITUTION, LEVELS, RESTITUTION
from lab.report.plots import BELOW, BLUE, GREY, VERMILION, canvas
from lab.studies.case import Case, Found, Line, Picture
from lab.studies.verify.impacts.meetings import Meetings, Substance
from lab.studies.verify.references import first_order_loss, viscoelastic_rebound

SECTION = "Collisions"
RADIUS, SPEED = 2.5e-3, 3.9
# Aluminium oxide, as in the tests 3 and 4 of Chung and Ooi (2011).
OXIDE = Substance("aluminium oxide", 380e9, 0.23, 4000.0)
GIVEN = (0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
DAMPINGS = (0.02, 0.04, 0.08, 0.15, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0)
PHASES = (0.05, 0.3, 0.55, 0.8)  # of a step, when contact begins
BODIES = {"two grains": "twin", "wall": "plane"}
# Of one dissipative time: β ∝ (k/m)^(2/5), k ∝ √R; two grains have half the mass and half the radius.
WALL_SHARE = 2.0**-0.2
ALLOWED = RESTITUTION
REASON = f"the automatic step is derived for {100 * RESTITUTION:g} %"


def rebounds(body: str, restitutions: Sequence[float], longer: float = 1.0, **how: object) -> np.ndarray:
    """Restitutions (PHASES, n) of collisions that should have these, at the step derived for each times `longer`."""
    wanted = np.array(restitutions)
    pair = Meetings(OXIDE, RADIUS, SPEED, 0.0, wanted, mate=BODIES[body], wall=OXIDE.young, phases=PHASES, **how)
    return pair.run((longer,))[0, ..., 1] / SPEED


def farthest(values: np.ndarray, expected: float) -> float:
    """The one of the values (n,) that is farthest from the expected value."""
    return float(values[np.abs(values - expected).argmax()])


def given(law: str, fast: bool) -> Found:
    """Restitution out equals restitution in, of two grains and at a wall (Chung and Ooi's test 3, at a wall)."""
    lines, draft = [], LEVELS["draft"].longer_steps
    for name in BODIES:
        found = rebounds(name, GIVEN, normal=law, told=True)
        lines += [
            Line(f"restitution, {name}, {e:g} given", farthest(found[:, k], e), e, "what is given", ALLOWED, REASON)
            for k, e in enumerate(GIVEN)
        ]
        if not fast:
            error = np.abs(rebounds(name, GIVEN, draft, normal=law, told=True) / GIVEN - 1.0).max()
            what, reason = f"largest error, {name}, draft", f"{draft:g} times the derived step"
            lines.append(Line.off(what, "what is given", error, DRAFT_RESTITUTION, reason))
    return Found(lines)


def over_damping(_: bool) -> Found:
    """The viscoelastic law against its own integration, where the contact ends with the force."""
    source = "DOP853 at 1e-12, contact ends where F = 0"
    lines, places = [], []
    for name, at in (("two grains", np.array(DAMPINGS)), ("wall", WALL_SHARE * np.array(DAMPINGS))):
        expected = [viscoelastic_rebound(x)[0] for x in at]
        for x, e, found in zip(at, expected, rebounds(name, expected).T, strict=True):
            value = farthest(found, e)
            lines.append(Line(f"restitution, {name}, x = {x:.3g}", value, e, source, ALLOWED, REASON))
            places.append((x, value, e))
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
    figure, (upper, lower) = canvas((6.4, 4.4), 2, sharex=True, height_ratios=(2, 1))
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
