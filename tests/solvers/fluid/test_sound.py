"""The first vertical mode of sound in a column of water at rest must die."""

import numpy as np
import pytest

from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.rest import at_rest, hydrostatic_deviation
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of

DEPTH, WIDTH, ROWS, G = 0.3, 0.3, 40, 9.81
SOUND = 10.0 * np.sqrt(G * DEPTH)
PERIOD = 4.0 * DEPTH / SOUND
OUTLINE = np.array([(-0.15, 0.0), (0.15, 0.0), (0.15, 0.45), (-0.15, 0.45)])
SHARE = 3e-3  # of the density, the mode's amplitude


def shape(z: np.ndarray) -> np.ndarray:
    """cos(π z/2H): no flow through the floor, no pressure at the surface."""
    return np.cos(0.5 * np.pi * z / DEPTH)


def ringing(**models) -> Scene:
    """Water at rest whose density has the mode on top, its particles as heavy as before plus the mode's share."""
    water = Water(DEPTH / ROWS, SOUND, **models)
    drops = at_rest(OUTLINE, DEPTH, water, G)[None].copy()
    mass = (1.0 + drops["deviation"]) * drops["volume"]
    drops["deviation"] += SHARE * shape(drops["position"][..., 1])
    drops["volume"] = mass / (1.0 + drops["deviation"])
    return scene_of(radius=np.zeros((1, 0)), outline=OUTLINE, fluid=Fluid(water, drops), gravity=G)


def swings(scene: Scene) -> tuple[float, float]:
    """The standard deviation of the mode's pressure in some of its periods, early and 3 s later."""
    run = Simulation(scene, threads=1, arch="cpu")
    try:
        found, every = [], max(1, round(PERIOD / 12.0 / run.dt))
        run.advance(round(1.0 / run.dt))
        for start in (0.0, 3.0):
            if start:
                run.advance(round(start / run.dt))
            amplitudes = []
            for _ in range(60):
                run.advance(every)
                state = run.snapshot()
                below = np.maximum(DEPTH - state["water_position"][0, :, 1], 0.0)
                still = 1000.0 * SOUND**2 * hydrostatic_deviation(below, G, SOUND, "linear")
                error = state["water_pressure"][0] - still
                amplitudes.append((error * shape(state["water_position"][0, :, 1])).mean())
            found.append(float(np.std(amplitudes)))
    finally:
        run.close()
    return found[0], found[1]


@pytest.mark.slow
@pytest.mark.parametrize("diffusion", ["fourtakas", "none", "antuono"])
def test_sound_dies_in_a_deep_column(diffusion):
    early, late = swings(ringing(diffusion=diffusion))
    assert early > 0.01 * 1000.0 * G * DEPTH  # there is a wave at all
    assert late < early
