"""Parts in several tanks of water that overlap in the plane: each tank has its own parts, and none of the others'."""

import numpy as np
import pytest
import taichi as ti

from solvers.fluid.given import Fluid, Water
from solvers.fluid.start.parts import clear_of
from solvers.motion.harmonic import Roll, Sway
from solvers.simulation import Simulation
from solvers.tank.parts import Body
from solvers.tank.tank import Tank
from tests.oracles.given import scene_of
from tests.oracles.water import GRAVITY, box, lattice

WIDE, HIGH, SPACING, SOUND, STEPS = 0.4, 0.3, 0.01, 12.0, 300
SQUARE = ((-0.08, 0.02), (0.04, 0.02), (0.04, 0.10), (-0.08, 0.10))
BAFFLE, TURN = ((0.05, 0.0), (0.05, 0.12)), (Roll(0.1, 2.0, centre=(0.05, 0.0)),)


def water_of(depth: float, part: Body) -> np.ndarray:
    """Particles (n,) at rest round a part."""
    drops = lattice(WIDE, depth, SPACING, SOUND)[0]
    return drops[clear_of(drops["position"], (part,), SPACING)]


def moved(tanks: list[tuple[np.ndarray, Body]]) -> dict[str, np.ndarray]:
    """Places of all water, and the loads on the walls of each tank, then on each part, after STEPS of a sway."""
    first, *others = (Tank(box(WIDE, HIGH), 1.0) for _ in tanks)
    drops = np.concatenate([drops for drops, _ in tanks])
    fluid = Fluid(Water(SPACING, SOUND), drops[None], tuple(len(drops) for drops, _ in tanks) if others else ())
    scene = scene_of(
        np.zeros((1, 0)), first.outline, gravity=GRAVITY, fluid=fluid, more_tanks=tuple(others), step=1e-4,
        parts=tuple(part for _, part in tanks), motions=[(Sway(0.02, 1.5),)],
    )  # fmt: skip
    run = Simulation(scene, threads=1, arch="cpu")
    run.advance(STEPS)
    run.observe()
    run.advance(20)
    found = run.observe() | run.snapshot() | {"loads": run.loads()[0]}
    run.close()
    return found


@pytest.mark.slow
def test_water_round_a_part_does_not_feel_the_parts_and_the_water_of_another_tank():
    """To rounding, which the order of sums makes, and 300 steps carry on: 1e-6 of a spacing and of the loads."""
    body, plate = Body(SQUARE, closed=True), Body(BAFFLE, motions=TURN, tank=1)
    low, high = water_of(0.15, body), water_of(0.20, plate)
    both = moved([(low, body), (high, plate)])
    alone = [moved([(low, body)]), moved([(high, Body(BAFFLE, motions=TURN))])]
    ends = len(low), len(low) + len(high)
    for k, (own, one) in enumerate(zip(np.split(both["water_position"][0], ends)[:2], alone, strict=True)):
        assert np.ptp(one["water_position"][0] - (low, high)[k]["position"], axis=0).min() > 0.1 * SPACING
        np.testing.assert_allclose(own, one["water_position"][0], atol=1e-6 * SPACING)
        np.testing.assert_allclose(both["loads"][[k, 2 + k]], one["loads"], atol=1e-6 * np.abs(one["loads"]).max())
    total = both["loads"].sum(axis=0)
    np.testing.assert_allclose(total, both["wall_force"][0], atol=1e-12 * np.abs(total).max())


def test_several_tanks_of_water_need_no_part_in_them():
    """No part stands in them, and what parts bear there is nothing: the function that all of water's steps ask."""
    drops = lattice(WIDE, 0.05, SPACING, SOUND)[0]
    fluid = Fluid(Water(SPACING, SOUND), np.concatenate([drops, drops])[None], (len(drops), len(drops)))
    scene = scene_of(
        np.zeros((1, 0)), box(WIDE, HIGH), gravity=GRAVITY, fluid=fluid, more_tanks=(Tank(box(WIDE, HIGH), 1.0),)
    )
    run = Simulation(scene, threads=1)
    bodies = run.water.bodies

    @ti.kernel
    def borne() -> ti.f64:
        return bodies.borne(0, 1).norm()

    try:
        assert run.parts.bodies.count == 0
        assert borne() == 0.0
    finally:
        run.close()
