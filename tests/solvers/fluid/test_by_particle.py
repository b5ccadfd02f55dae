"""The schedule for graphics processors, a thread for each particle, in 32 bits: the same tests of the same water.

What a step's error decides has the same tolerances; what rounding decides has those of 32 bits (`to_digits`). This
schedule looks at the state only now and then (`solvers.time.schedules.per_grain`): the watch is tested with others.
"""

from collections.abc import Iterator

import numpy as np
import pytest

from solvers.fluid.given import particles
from solvers.simulation import Simulation
from solvers.time.kept import RENAMED
from tests.oracles.water import still
from tests.solvers.fluid import test_step as same

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    run = Simulation(same.disturbed(schedule="per-grain", precision="f32"), threads=1, arch="cpu")
    run.advance(8)
    assert run.schedule_name == "per-grain" and run.water.particles.lanes == 1
    yield run
    run.close()


# In their order there: the first three go on from the disturbed water, the others place it anew.
test_load_on_the_tank = same.test_the_load_is_what_the_water_loses
test_loads_on_edges = same.test_the_loads_on_all_edges_are_the_load_on_the_tank
test_energy = same.test_energy_is_accounted_for
test_packed_too_close = same.test_water_that_is_packed_too_close_takes_its_room_again
test_drop_alone = same.test_a_drop_alone_falls_without_pressure
test_gravity_changes = same.test_gravity_may_change_while_water_runs
test_rest = same.test_water_at_rest_weighs_on_the_floor_and_its_gauges
test_behind_a_wall = same.test_a_wall_pushes_back_what_has_come_through_its_face


@pytest.mark.parametrize("spacing", [3e-3, 2e-4])  # m
def test_small_particles_move_in_32_bits_as_in_64(spacing):
    """What wall particles divide by that see no water must not be so small that its inverse times 1/h⁴ is infinite."""
    places = []
    for schedule, precision in (("per-world", "f64"), ("per-grain", "f32")):
        scene = still(30 * spacing, 15 * spacing, 10 * spacing, 10, schedule=schedule, precision=precision)
        run = Simulation(scene, threads=1, arch="cpu")
        run.advance(40)
        places.append(run.snapshot()["water_position"])
        run.close()
    np.testing.assert_allclose(places[1], places[0], rtol=0.0, atol=1e-3 * spacing)


def test_lists_are_made_anew_at_the_same_steps_after_a_resume():
    """How fast the fastest particle is decides how long lists last: a run that goes on from a file must know it.

    Here one that an earlier version has written, under other names.
    """
    scene, found = still(2.0, 1.0, 0.4, 10, schedule="per-grain", drops=falling()), []
    state: dict[str, np.ndarray] = {}
    for cut in (False, True):
        run = Simulation(scene, threads=1, arch="cpu")
        if cut:
            run.restore({EARLIER.get(name, name): values for name, values in state.items()})
        else:
            run.advance(60)
            state = run.state()
        run.advance(40)
        found.append(run.snapshot() | {"built": run.water.particles.built[1].to_numpy()})
        run.close()
    for name in ("built", "water_position", "water_velocity"):
        np.testing.assert_array_equal(found[0][name], found[1][name])


EARLIER = {new: old for old, new in RENAMED.items()}


def falling() -> np.ndarray:
    """A square of water beside the middle of a tank, above its floor."""
    side = (np.arange(20) + 0.5) * 0.02
    grid = np.stack(np.meshgrid(0.1 + side, 0.3 + side, indexing="ij"), axis=-1).reshape(-1, 2)
    drops = particles(1, len(grid))
    drops["position"][0], drops["volume"] = grid, 0.02**2
    return drops
