"""Stiffness scale against the critical angle of tilted beds and the response of swayed ones."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.accuracy.beds import (
    SWAY,
    SWAYED,
    TILT,
    TILTED,
    Point,
    add_table,
    draw_bars,
    mean_and_interval,
    sweep,
)
from lab.report.page import Page
from lab.report.plots import BLUE, GREEN, VERMILION, canvas

SCALES = (1e-4, 1e-3, 1e-2, 1e-1, 1.0)
KEY = "contact.stiffness_scale"
TILT_MEASURES = {"critical_angle": BLUE, "first_slip_angle": GREEN, "largest_surface_slope": VERMILION}


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    scales = SCALES[:2] if fast else SCALES
    tilted = sweep(TILTED, {KEY: list(scales)}, TILT, work / "stiffness-tilt", fast)
    swayed = sweep(SWAYED, {KEY: list(scales if fast else scales[:-1])}, SWAY, work / "stiffness-sway", fast)
    page.section("Stiffness scale")
    page.say("""Young's modulus times the scale; the step follows from it. Critical angle, first slip and largest slope
        of the surface of beds of 3 mm acetate in a tank of 60 mm, tilted at 10 deg/s; response of the same beds
        to a sway of 15 mm at 3 Hz. Means of the beds with their [95 % intervals], which are the bars; cost is the
        number of grain-steps, relative to a thousandth. The full stiffness is not run for the sway.""")
    usual = _nearest(tilted, 1e-3).steps
    add_table(page, "scale", [f"{p.setting[KEY]:g}" for p in tilted], tilted, list(TILT_MEASURES), usual)
    page.table(
        ["scale", "response (mm)", "phase (deg)", "response in z (mm)"],
        [
            [
                f"{p.setting[KEY]:g}",
                *(
                    mean_and_interval(p, f"response_{name}", digits)
                    for name, digits in (("amplitude", 3), ("phase", 1))
                ),
                mean_and_interval(p, "response_amplitude_z", 3),
            ]
            for p in swayed
        ],
    )
    page.figure("stiffness", _figure(tilted, swayed), "Critical angle and sway response against the stiffness scale")


def _nearest(points: list[Point], scale: float) -> Point:
    return min(points, key=lambda p: abs(np.log(p.setting[KEY] / scale)))


def _scales(points: list[Point]) -> list[float]:
    return [p.setting[KEY] for p in points]


def _figure(tilted: list[Point], swayed: list[Point]) -> Figure:
    figure, (left, right) = canvas((6.4, 2.9), 1, 2)
    for name, colour in TILT_MEASURES.items():
        draw_bars(left, _scales(tilted), tilted, name, (colour, name.replace("_", " ")))
    draw_bars(right, _scales(swayed), swayed, "response_amplitude", (BLUE, "y"))
    draw_bars(right, _scales(swayed), swayed, "response_amplitude_z", (VERMILION, "z"))
    for axes, quantity in ((left, "angle (deg)"), (right, "response to the sway (mm)")):
        axes.set(xscale="log", xlabel="stiffness scale", ylabel=quantity)
        axes.set_ylim(bottom=0.0)  # leaves room for the legend
        axes.legend()
    return figure
