"""Tilt rate against the critical angle."""

from pathlib import Path

from benchmarks.accuracy.beds import TILT, TILTED, add_table, draw_bars, sweep
from lab.report.page import Page
from lab.report.plots import BLUE, GREEN, canvas

RATES = (1.0, 3.0, 10.0, 30.0)  # deg/s
KEY = "motion.tilt.rate"


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    rates = RATES[-2:] if fast else RATES
    draft = {**TILT, "run.accuracy": "draft"}
    points = sweep(TILTED, {KEY: [f"{rate:g} deg/s" for rate in rates]}, draft, work / "rate", fast)
    page.section("Tilt rate")
    page.say("""The same beds, tilted at other rates, at the accuracy "draft" (the thesis tilts at 0.15 to 5 deg/s). A
        fast tilt overtakes the avalanche: the angle at which it begins is read too late by about the rate times
        the time the surface takes to set off. Means of the beds with their [95 % intervals], which are the bars.""")
    names = ("critical_angle", "first_slip_angle", "one_diameter_angle")
    add_table(page, "rate (deg/s)", [f"{rate:g}" for rate in rates], points, names, points[-1].steps)
    figure, axes = canvas((4.2, 2.8))
    for name, colour in (("critical_angle", BLUE), ("first_slip_angle", GREEN)):
        draw_bars(axes, rates, points, name, (colour, name.replace("_", " ")))
    axes.set(xscale="log", xlabel="tilt rate (deg/s)", ylabel="angle (deg)")
    axes.legend()
    page.figure("rate", figure, "Critical angle against the tilt rate")
