"""Creep of a bed that is tilted below its critical angle and held there for a minute, by tangential law."""

from pathlib import Path

import numpy as np

from benchmarks.accuracy.beds import TILT, TILTED, Point, sweep
from benchmarks.accuracy.laws import KEY, LAWS
from lab.measures.value import over_worlds
from lab.recording import open_recording
from lab.report.numbers import interval
from lab.report.page import Page
from lab.report.plots import canvas

RATE, ANGLE, HOLD, REST = 10.0, 10.0, 60.0, 5.0  # deg/s, deg, s, and the time (s) after which the hold is looked at


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    hold = 6.0 if fast else HOLD
    laws = LAWS[:2] if fast else LAWS[:-1]  # without friction nothing rests
    overrides = {
        **TILT,
        "motion.tilt.rate": f"{RATE:g} deg/s",
        "motion.tilt.angle": f"{ANGLE:g} deg",
        "motion.tilt.hold": f"{hold:g} s",
        "run.accuracy": "draft",  # a minute is long, and what creeps does so at any step
        "run.repeats": 2,
        "record.picture_rate": "1 Hz",
        "record.series_rate": "20 Hz",
    }
    points = sweep(TILTED, {KEY: list(laws)}, overrides, work / "creep", fast)
    page.section("Creep")
    page.say(f"""Two beds, at the steps of draft, tilted to {ANGLE:g} deg and held there for {hold:g} s: drift of the
        centre of mass downhill from {REST:g} s into the hold to its end, in grain diameters a minute. The laws without
        a spring creep as they should, at F_t/γ_s in each contact; those with a spring should stand still.""")
    figure, axes = canvas((4.6, 2.8))
    rows = []
    for law, point in zip(laws, points, strict=True):
        time, shift = _held(point)
        late = time > REST
        drift = 60.0 * np.array([np.polyfit(time[late], world[late], 1)[0] for world in -shift.T])
        rows.append([law, f"{drift.mean():.2g}", interval(*over_worlds(drift, "1").interval)])
        axes.plot(time, -shift.mean(axis=1), label=law)
    page.table(["law", "drift (diameters a minute)", "interval of the mean"], rows)
    axes.set(xlabel="time held (s)", ylabel="shift downhill (d)", yscale="symlog")
    axes.set_yscale("symlog", linthresh=1e-3)
    axes.legend(ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.1))  # above the springs', below the others
    page.figure("creep", figure, "Shift of the centre of mass while a bed is held at an angle")


def _held(point: Point) -> tuple[np.ndarray, np.ndarray]:
    """Times (T,) since the tilt ended (s) and shifts (T, W) since then, in diameters."""
    with open_recording(point.folder) as recording:
        time, centre = recording.series["time"], recording.series["centre_of_mass"][..., 0]
        shift = centre / recording.mean_diameter
    begun = time >= ANGLE / RATE + 0.2
    return time[begun] - time[begun][0], shift[begun] - shift[begun][0]
