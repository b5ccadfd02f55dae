"""Liquid bridges over a water table: whole where no free water is, none in it."""

from dataclasses import replace

import numpy as np
import pytest

from lab.studies.verify.wet.scenes import SPACING, glass
from solvers.fluid.given import Water, particles
from solvers.grains.given import Grains
from solvers.mixture.given import Mixture
from solvers.simulation import Simulation
from tests.oracles.scenes import box
from tests.oracles.soaked import DIAMETER, wet

LEVEL, THROWN = 0.05, 0.01  # m, m/s
VOLUME = 1e-3 * (0.5 * DIAMETER) ** 3  # m³, of a bridge
HEIGHTS = 0.5 * LEVEL, LEVEL + 4.0 * SPACING  # m: in the water, and over it


@pytest.mark.slow
def test_grains_that_part_are_held_by_their_bridge_over_the_water_and_not_in_it():
    """Two of glass that touch and are thrown apart without weight.

    The bridge's work is more than 0.4 of f₀ times its range, 2e-7 J, and they have 2 (m/2) v² = 8e-9 J: it holds them
    within its range of 0.2 mm. In the water drag alone stops them, after v m/κ, which is over 1 mm.
    """
    tension = glass(surface_tension=0.072, contact_angle=0.0, bridge_volume=VOLUME)
    side = 0.5 * DIAMETER * (1.0 - 1e-4)
    place = np.array([[(way, height) for height in HEIGHTS for way in (-side, side)]])
    grains = Grains(np.full((1, 4), 0.5 * DIAMETER), tension, tension, cohesion="bridge", stiffness_scale=1e-3)
    drops = particles(1, 62)
    drops["volume"][0] = SPACING**2
    scene = wet(box(0.08, 0.12), grains, Water(SPACING, 10.0), drops, Mixture(level=LEVEL), thickness=DIAMETER)
    run = Simulation(replace(scene, gravity=0.0), place, 1, arch="cpu")
    run.advance(run.exchange_interval)
    run.launch(np.array([[(way, 0.0) for _ in HEIGHTS for way in (-THROWN, THROWN)]]))
    run.advance(run.whole(round(0.1 / run.dt)))
    where, dry = run.snapshot()["position"][0, :, 0], run.grains.grains.dry.to_numpy()[0, :4]
    run.close()
    in_water, over_it = where[1] - where[0] - DIAMETER, where[3] - where[2] - DIAMETER
    np.testing.assert_array_equal(dry, [0.0, 0.0, 1.0, 1.0])
    assert over_it < VOLUME ** (1.0 / 3.0) < 2.0 * VOLUME ** (1.0 / 3.0) < in_water
