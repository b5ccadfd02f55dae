"""What is said of water that has left an open tank, and of what is squeezed."""

import numpy as np
import pytest

from solvers.fluid.checks import outside, refuse_state
from solvers.machine.errors import BadState
from solvers.tank.tank import Tank
from tests.oracles.water import box

NEAR = 0.02  # m
# In the tank, above its brim, beside it, below it, and at its wall's outside within the reach of water inside.
PLACES = np.array([[0.0, 0.1], [0.0, 0.7], [0.4, 0.1], [0.1, -0.5], [0.31, 0.3]])


def test_water_beside_and_below_a_tank_is_outside():
    tank = Tank(box(0.6, 0.6), 1.0, (2,))
    np.testing.assert_array_equal(outside(PLACES, [tank], NEAR), [False, False, True, True, False])
    beside = Tank(box(0.6, 0.6) + np.array([0.6, 0.0]), 1.0, (2,))
    np.testing.assert_array_equal(outside(PLACES, [tank, beside], NEAR), [False, False, False, True, False])


def test_spilled_water_that_falls_fast_is_told_as_such():
    """One sentence that says how much is out, and names the keys that keep it in."""
    spilled = outside(PLACES, [Tank(box(0.6, 0.6), 1.0, (2,))], NEAR)
    particles = {
        "place": PLACES,
        "speed": np.array([0.0, 1.0, 3.0, 9.0, 0.0]),
        "excess": np.zeros(5),
        "gas": np.zeros(5),
    }
    with pytest.raises(BadState) as error:
        refuse_state(0, {**particles, "span": np.ones(5), "spilled": spilled}, 1.5, 17.0)
    said = str(error.value)
    assert "40 % of the water has left the open tank" in said and "9 m/s by t = 1.5 s" in said
    assert "tank.lid" in said and said.count(". ") == 0
    with pytest.raises(BadState, match=r"Mach 0\.53"):
        refuse_state(0, {**particles, "span": np.ones(5), "spilled": np.zeros(5, dtype=bool)}, 1.5, 17.0)


@pytest.mark.parametrize(
    ("gas", "said"), [(1.0, r"air's density.*air\.sound_speed"), (0.0, r"water's density.*water\.sound_speed")]
)
def test_what_is_squeezed_is_named(gas, said):
    particles = {
        "place": PLACES,
        "speed": np.zeros(5),
        "excess": np.array([0.0, 0.1, 30.0, 0.0, 0.0]),
        "span": np.ones(5),
    }
    with pytest.raises(BadState, match=said):
        refuse_state(0, {**particles, "gas": np.full(5, gas), "spilled": np.zeros(5, dtype=bool)}, 1.5, 17.0)
