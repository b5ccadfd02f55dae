"""The schedule for graphics processors, a thread for each particle, in 32 bits: the same tests of the same water.

What a step's error decides has the same tolerances; what rounding decides has those of 32 bits (`to_digits`). This
schedule looks at the state only now and then (`solvers.time.schedules.per_grain`): the watch is tested with others.
"""

from collections.abc import Iterator

import pytest

from solvers.simulation import Simulation
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
