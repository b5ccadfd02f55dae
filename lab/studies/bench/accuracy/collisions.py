"""Integrator and step against the restitution of collisions, and what a step of each integrator costs."""

from functools import cache, partial
from pathlib import Path

import numpy as np

from lab.report.page import Page
from lab.report.plots import BLUE, GREY, VERMILION, canvas
from lab.studies.bench.accuracy.settled import settled_scene
from lab.studies.bench.speed.workers import in_turn, timed
from solvers.grains.integrators import INTEGRATORS
from solvers.grains.materials import Material
from solvers.grains.restitution import restitution
from solvers.scene import Scene
from solvers.simulation import Simulation

STEPS = (6, 9, 13, 20, 30, 45, 81, 160)  # a Hertz collision
DEFAULT_STEPS = 81
PHASES, SPEED, RADIUS = 24, 0.3, 1.5e-3
ACETATE = Material(density=1319.0, young=3.2e6, poisson=0.28, friction=0.25, restitution=0.6, restitution_speed=SPEED)
BOX = np.array([[-0.1, -0.1], [0.1, -0.1], [0.1, 0.1], [-0.1, 0.1]])
COLOURS = dict(zip(INTEGRATORS, (BLUE, VERMILION, GREY), strict=True))


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    steps = STEPS[::3] if fast else STEPS
    errors = {name: [worst_error(name, share) for share in steps] for name in INTEGRATORS}
    cost = costs()
    page.section("Integrator and step: a collision")
    page.say(f"""Two grains meet head-on at {SPEED:g} m/s, the contact beginning at {PHASES} moments of a step:
        largest relative error of the restitution (0.6) against the same law integrated by an 8th-order scheme.
        The cost of a step is measured on a settled bed, runs in turn, relative to Verlet.""")
    page.table(
        ["steps a collision", *errors],
        [[str(share), *(f"{errors[name][k]:.1e}" for name in errors)] for k, share in enumerate(steps)],
    )
    page.table(["cost of a step", *cost], [["relative to Verlet", *(f"{value:.2f}" for value in cost.values())]])
    figure, axes = canvas((4.6, 3.0))
    for name, found in errors.items():
        axes.loglog(np.array(steps) * cost[name], found, "o-", markersize=4, color=COLOURS[name], label=name)
    if DEFAULT_STEPS in steps:
        axes.plot(
            DEFAULT_STEPS, errors["verlet"][steps.index(DEFAULT_STEPS)], "o", markersize=11, fillstyle="none", color="k"
        )
        axes.annotate(
            "default", (DEFAULT_STEPS, errors["verlet"][steps.index(DEFAULT_STEPS)]), (6, 8), textcoords="offset points"
        )
    axes.set(xlabel="cost: steps a collision × cost of a step", ylabel="error of the restitution")
    axes.legend()
    page.figure("collisions", figure, "Error of the restitution against cost by integrator")


def worst_error(integrator: str, share: int) -> float:
    """Largest relative error of the restitution over contacts that begin anywhere in a step."""
    expected = _reference()
    rebound = _rebound(integrator, share) / SPEED
    return float(np.abs(rebound / expected - 1.0).max())


@cache
def _reference() -> float:
    pair = _scene("verlet", 1e-6).interfaces[0]
    stiffness = 4.0 / 3.0 * pair.young_modulus * np.sqrt(RADIUS / 2.0)
    mass = 0.5 * ACETATE.density * 4.0 / 3.0 * np.pi * RADIUS**3
    return restitution(1.5 * pair.dissipative_time * (stiffness / mass) ** 0.4 * SPEED**0.2)


def _scene(integrator: str, step: float) -> Scene:
    return Scene(
        np.full((PHASES, 2), RADIUS),
        BOX,
        ACETATE,
        ACETATE,
        gravity=0.0,
        integrator=integrator,
        step=step,
        start_speed=SPEED,
    )


def _rebound(integrator: str, share: int) -> np.ndarray:
    """Speeds (W,) at which the two part; in world w the contact begins w/W of a step later."""
    pair = _scene(integrator, 1e-6).interfaces[0]
    mass = 0.5 * ACETATE.density * 4.0 / 3.0 * np.pi * RADIUS**3
    duration = 2.87 * (mass**2 / (0.5 * RADIUS * pair.young_modulus**2 * SPEED)) ** 0.2
    step = duration / share
    gap = SPEED * step * (2.0 + np.arange(PHASES) / PHASES)
    place = np.zeros((PHASES, 2, 2))
    place[:, 1, 0] = 2.0 * RADIUS + gap
    velocity = np.zeros(place.shape)
    velocity[:, 0, 0] = SPEED
    run = Simulation(_scene(integrator, step), place, 1, arch="cpu")
    run.launch(velocity)
    run.advance(4 * share + 10)
    speed = run.snapshot()["velocity"][..., 0]
    run.close()
    return speed[:, 1] - speed[:, 0]


def costs(turns: int = 5, steps: int = 4000) -> dict[str, float]:
    """Times of a step by integrator on a settled bed, relative to Verlet: medians of runs in turn."""
    _, place = settled_scene("verlet")
    runs = {name: Simulation(settled_scene(name)[0], place, 1, arch="cpu") for name in INTEGRATORS}
    speeds = in_turn({name: partial(timed, run, steps) for name, run in runs.items()}, turns)
    for run in runs.values():
        run.close()
    return {name: float(np.median(speeds["verlet"] / found)) for name, found in speeds.items()}
