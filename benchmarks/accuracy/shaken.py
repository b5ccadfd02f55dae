"""Integrator and step against the motion of a shaken bed, before chaos takes over."""

from math import isnan, nan
from pathlib import Path

import numpy as np

from benchmarks.accuracy.collisions import COLOURS, costs
from benchmarks.accuracy.settled import deviation, settled_scene
from lab.preset.accuracy import LEVELS
from lab.report.page import Page
from lab.report.plots import canvas
from solvers.grains.integrators import INTEGRATORS
from solvers.machine.errors import BadState
from solvers.simulation import Simulation

# Steps, in derived ones; the shortest of Verlet, a quarter of the last of these, is the reference.
DRAFT = LEVELS["draft"].longer_steps
STEPS = (4.0, 2.75, 2.0, DRAFT, 1.0, 0.5, 0.25, 0.125)
TIME = 0.01  # s


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    steps = STEPS[2:6] if fast else STEPS
    scene, _ = settled_scene()
    diameter = 2.0 * scene.grains.mean_radius
    reference = _end("verlet", 0.25 * steps[-1])

    def error(name: str, share: float) -> float:
        try:
            return deviation(_end(name, share), reference, diameter)
        except BadState:
            return nan

    errors = {name: [error(name, share) for share in steps] for name in INTEGRATORS}
    cost = costs()
    page.section("Integrator and step: a shaken bed")
    page.say(f"""A settled bed that is thrown at the walls of its tank, at 0.5 m/s: root mean square distance of the
        grains, after {1e3 * TIME:g} ms, from where a Verlet run with a step of {0.25 * steps[-1]:g} of the
        derived one has them, in diameters. Contacts that open and close in mid-step hold every scheme to first
        or second order, however high its own. Where nothing stands the watch stopped the run: grains gained energy.""")
    page.table(
        ["step (derived = 1)", *errors],
        [[f"{share:g}", *(_told(errors[name][k]) for name in errors)] for k, share in enumerate(steps)],
    )
    figure, axes = canvas((4.6, 3.0))
    for name, found in errors.items():
        axes.loglog(cost[name] / np.array(steps), found, "o-", markersize=4, color=COLOURS[name], label=name)
    for share, name in ((DRAFT, "draft"), (1.0, "standard")):
        usual = 1.0 / share, errors["verlet"][steps.index(share)]
        axes.plot(*usual, "o", markersize=11, fillstyle="none", color="k")
        axes.annotate(name, usual, (-6, -14), textcoords="offset points", ha="right")
    axes.set(xlabel="cost (standard = 1)", ylabel="distance from the reference (d)")
    axes.legend()
    page.figure("shaken", figure, "Error of a shaken bed against cost by integrator")


def _told(error: float) -> str:
    return "–" if isnan(error) else f"{error:.1e}"


def _end(integrator: str, share: float) -> dict[str, np.ndarray]:
    """The bed after TIME, the step being `share` of the derived one."""
    scene, place = settled_scene(integrator)
    count = round(TIME / (share * scene.step))
    scene.step = TIME / count
    run = Simulation(scene, place, 1, arch="cpu")
    velocity = np.zeros(place.shape)
    velocity[...] = [0.5, 0.0]
    run.launch(velocity)
    try:
        run.advance(count)
        return run.snapshot()
    finally:
        run.close()
