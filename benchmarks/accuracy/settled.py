"""Settled beds for studies that start all runs from the same places."""

from collections.abc import Mapping
from dataclasses import replace
from functools import cache

import numpy as np

from benchmarks.accuracy.beds import SWAY, SWAYED, TILT, TILTED
from lab.assembly.scene import build
from lab.preset.find import load
from solvers.scene import Scene
from solvers.simulation import Simulation

PRESETS = {"sway": (SWAYED, SWAY), "tilt": (TILTED, TILT)}


@cache
def settled_places(kind: str, beds: int, scale: float) -> tuple[Scene, np.ndarray]:
    """The scene of several beds of a kind, "sway" or "tilt", and their settled positions (W, n, 2) m."""
    name, overrides = PRESETS[kind]
    asked = {**overrides, "run.repeats": beds, "contact.stiffness_scale": scale}
    scene, start = build(load(name, asked).resolved)
    run = Simulation(scene, start, arch="cpu")
    run.settle(1e-6, 5.0)
    place = run.snapshot()["position"]
    run.close()
    return scene, place


def settled_scene(
    integrator: str = "verlet", kind: str = "sway", beds: int = 1, scale: float = 1e-3, **changes: object
) -> tuple[Scene, np.ndarray]:
    """The scene of settled beds with an integrator and other changes, and the places (W, n, 2) m they start from."""
    scene, place = settled_places(kind, beds, scale)
    grains = replace(scene.grains, integrator=integrator)
    return scene.holding(grains, schedule="per-world", **changes), place


def deviation(found: Mapping[str, np.ndarray], expected: Mapping[str, np.ndarray], diameter: float) -> float:
    """Root mean square distance of the grains of two snapshots, in diameters."""
    apart = found["position"] - expected["position"]
    return float(np.sqrt((apart**2).sum(axis=-1).mean()) / diameter)
