"""Precision against the centre of mass of tilted beds in time, and against the critical angle."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from benchmarks.accuracy.beds import TILT, TILTED, mean_and_interval, sweep
from benchmarks.accuracy.settled import settled_scene
from benchmarks.remembered import remembered
from lab.report.page import Page
from lab.report.plots import BLUE, GREY, VERMILION
from solvers.motion import Tilt
from solvers.simulation import Simulation

PRECISIONS = ("f64", "mixed", "f32")
NUDGED = "f64, nudged"
NUDGE = 1e-12  # m
COLOURS = {NUDGED: GREY, "mixed": BLUE, "f32": VERMILION}
RATE, ANGLE, BEDS, LOOKS = 30.0, 36.0, 4, 120  # deg/s, deg
SCALES = (1e-3, 1.0)


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    scales, beds = (SCALES[:1], 2) if fast else (SCALES, BEDS)
    page.section("Precision")
    page.say(f"""Beds settled once and tilted at {RATE:g} deg/s in 64 bits, 32 bits and mixed (places in 64, the rest in
        32): root mean square distance of their centres of mass from that of the 64-bit run, in diameters, as in
        figures 6.1 and 6.2 of Spandonidis (2016). The grey line is chaos: a 64-bit run whose grains start
        {NUDGE:g} m off. In the table, means of the beds with their [95 % intervals].""")
    figure = Figure(figsize=(6.4, 2.9), layout="constrained")
    for axes, scale in zip(np.atleast_1d(figure.subplots(1, len(scales), sharey=True)), scales, strict=True):
        for name, (angle, apart) in drifts(work, scale, beds).items():
            axes.semilogy(angle, np.maximum(apart, 1e-16), color=COLOURS[name], label=name)
        axes.set(xlabel="tilt (deg)", title=f"stiffness × {scale:g}")
        axes.legend()
    figure.axes[0].set_ylabel("deviation of the centre of mass (d)")
    page.figure("precision", figure, "Deviation of the centre of mass by precision against the tilt")
    axes = {"contact.stiffness_scale": list(scales), "run.precision": list(PRECISIONS)}
    asked = {**TILT, "motion.tilt.rate": f"{RATE:g} deg/s", "run.repeats": 6}
    points = sweep(TILTED, axes, asked, work / "precision", fast)
    names = ("critical_angle", "first_slip_angle", "largest_surface_slope")
    page.table(
        ["scale", "precision", *(f"{name.replace('_', ' ')} (deg)" for name in names)],
        [[*map(str, p.setting.values()), *(mean_and_interval(p, name) for name in names)] for p in points],
    )


def drifts(work: Path, scale: float, beds: int) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """By run, tilts (T,) in degrees and deviations (T,) in diameters from the 64-bit run; kept in `work`."""
    centres = remembered(
        work / f"precision-drift-{scale:g}-{beds}.npz",
        f"precision: drift at a stiffness of {scale:g}",
        lambda: {name: _centres(name, scale, beds) for name in (*PRECISIONS, NUDGED)},
    )
    diameter = 2.0 * settled_scene(kind="tilt", beds=beds, scale=scale)[0].grains.mean_radius
    angle = ANGLE * np.arange(1, LOOKS + 1) / LOOKS
    usual = centres["f64"]
    return {
        name: (angle, np.sqrt(((centres[name] - usual) ** 2).sum(axis=-1).mean(axis=1)) / diameter) for name in COLOURS
    }


def _centres(name: str, scale: float, beds: int) -> np.ndarray:
    """Centres of mass (T, W, 2) m as the beds are tilted."""
    tilt = Tilt(np.radians(RATE), np.radians(ANGLE))
    precision = "f64" if name == NUDGED else name
    scene, place = settled_scene(kind="tilt", beds=beds, scale=scale, precision=precision, motions=[(tilt,)] * beds)
    random = np.random.default_rng(1)
    run = Simulation(scene, place + (name == NUDGED) * NUDGE * random.normal(size=place.shape), arch="cpu")
    steps = round(tilt.duration() / LOOKS / run.dt)
    centres = []
    for _ in range(LOOKS):
        run.advance(steps)
        rows = run.observe()
        centres.append(rows["centre_of_mass"])
    run.close()
    return np.array(centres)
