"""The skin of the neighbour lists: it changes only the speed."""

from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.accuracy.settled import settled_scene
from benchmarks.speed.workers import in_turn, worked
from lab.report.page import Page
from solvers.grains.lists.skin import TOGETHER
from solvers.machine.quantity import PLANE
from solvers.simulation import Simulation

BY_SPEED = 0.0  # no fixed skin but the default one
SKINS = (0.02, 0.05, 0.1, 0.2, 0.4, BY_SPEED)  # of the mean diameter
TURNS, STEPS = 9, 6000


def study(page: Page, work: Path, fast: bool) -> None:
    """Add the section to the page."""
    still, swayed = _speeds(0.0), _speeds(0.5)
    least, most, *_ = TOGETHER[PLANE]
    page.section("Skin of the neighbour lists")
    page.say(f"""Grain-steps a second of processor time with a fixed skin, relative to the default, which goes with the
        root of the speed of the fastest grain from {least:g} to {most:g} mean diameters: medians of the ratios of
        {TURNS} runs in turn, one core, on a bed at rest and on one thrown against the wall at 0.5 m/s. The forces are
        the same.""")
    rows = [[f"{skin:g}", f"{still[skin]:.2f}", f"{swayed[skin]:.2f}"] for skin in SKINS if skin != BY_SPEED]
    page.table(["skin (d)", "at rest", "thrown"], rows)


def _speeds(push: float) -> dict[float, float]:
    scene, place = settled_scene()
    velocity = np.zeros(place.shape)
    velocity[..., 0] = push
    diameter = 2.0 * scene.grains.mean_radius
    runs = {skin: Simulation(scene, place, 1, skin * diameter or None, arch="cpu") for skin in SKINS}

    def speed(run: Simulation) -> float:
        run.place(place, velocity)
        return worked(run, STEPS)

    found = in_turn({skin: partial(speed, run) for skin, run in runs.items()}, TURNS)
    for run in runs.values():
        run.close()
    return {skin: float(np.median(speeds / found[BY_SPEED])) for skin, speeds in found.items()}
