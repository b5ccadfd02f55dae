"""Integrator and step against the restitution of collisions, and what a step of each integrator costs."""

from collections.abc import Sequence
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.accuracy.settled import settled_scene
from benchmarks.speed.workers import in_turn, worked
from lab.preset.accuracy import LEVELS
from lab.report.page import Page
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.verify.impacts.meetings import Meetings, Substance
from solvers.grains.integrators import INTEGRATORS
from solvers.simulation import Simulation

STEPS = (6, 9, 13, 23, 40, 60, 80, 160)  # a Hertz collision; those of the levels are added
SPEED, RADIUS = 0.3, 1.5e-3  # m/s, m
PHASES = tuple(np.arange(24) / 24.0)
ACETATE = Substance("acetate", 3.2e6, 0.28, 1319.0)
COLOURS = dict(zip(INTEGRATORS, (BLUE, VERMILION, GREY), strict=True))


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    usual = steps_of_levels()
    steps = sorted([*(STEPS[::3] if fast else STEPS), *usual])
    errors = {name: worst_errors(name, steps) for name in INTEGRATORS}
    cost = costs()
    page.section("Integrator and step: a collision")
    page.say(f"""Two grains meet head-on at {SPEED:g} m/s, the contact beginning at {len(PHASES)} moments of a step:
        largest relative error of the restitution (0.6) against the same law integrated by an 8th-order scheme.
        The levels of accuracy stand at the steps that the lab derives for them. The cost of a step is its processor
        time on a settled bed, runs in turn, relative to Verlet.""")
    page.table(
        ["steps a collision", *errors, "level"],
        [
            [f"{count:.3g}", *(f"{errors[name][k]:.1e}" for name in errors), usual.get(count, "")]
            for k, count in enumerate(steps)
        ],
    )
    page.table(["cost of a step", *cost], [["relative to Verlet", *(f"{value:.2f}" for value in cost.values())]])
    figure, axes = canvas((4.6, 3.0))
    for name, found in errors.items():
        axes.loglog(np.array(steps) * cost[name], found, "o-", markersize=4, color=COLOURS[name], label=name)
    for count, levels in usual.items():
        place = count, errors["verlet"][steps.index(count)]
        axes.plot(*place, "o", markersize=11, fillstyle="none", color="k")
        axes.annotate(levels, place, (-6, -14), textcoords="offset points", ha="right")
    axes.set(xlabel="cost: steps a collision × cost of a step", ylabel="error of the restitution")
    axes.legend()
    page.figure("collisions", figure, "Error of the restitution against cost by integrator")


def steps_of_levels() -> dict[float, str]:
    """Levels of accuracy by the steps a collision that the lab derives for this one, with Verlet's scheme."""
    pair = _pair("verlet")
    derived = pair.elastic().duration / float(pair.steps()[0])
    found: dict[float, list[str]] = {}
    for name, level in LEVELS.items():
        found.setdefault(derived / level.longer_steps, []).append(name)
    return {count: " and ".join(names) for count, names in found.items()}


def worst_errors(integrator: str, steps: Sequence[float]) -> list[float]:
    """Largest relative errors of the restitution with so many steps a collision, over contacts that begin anywhere."""
    pair = _pair(integrator)
    found = pair.run([pair.elastic().duration / (count * pair.steps()[0]) for count in steps])
    return [float(np.abs(one[..., 1] / pair.expected[:, 1] - 1.0).max()) for one in found]


def _pair(integrator: str) -> Meetings:
    return Meetings(ACETATE, RADIUS, SPEED, 0.0, 0.6, mate="twin", integrator=integrator, phases=PHASES)


def costs(turns: int = 5, steps: int = 4000) -> dict[str, float]:
    """Processor times of a step by integrator on a settled bed, relative to Verlet: medians of runs in turn."""
    _, place = settled_scene("verlet")
    runs = {name: Simulation(settled_scene(name)[0], place, 1, arch="cpu") for name in INTEGRATORS}
    speeds = in_turn({name: partial(worked, run, steps) for name, run in runs.items()}, turns)
    for run in runs.values():
        run.close()
    return {name: float(np.median(speeds["verlet"] / found)) for name, found in speeds.items()}
