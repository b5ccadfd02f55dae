"""Grains in water in a tank that moves: the water of a soaked bed goes along with it."""

import numpy as np
import pytest

from solvers.motion.harmonic import Roll, Sway
from tests.oracles.soaked import rows, soaked

WIDTH, LEVEL = 0.08, 0.05
AFTER = 0.1  # s


@pytest.mark.slow
@pytest.mark.parametrize(
    "motion", [Sway(amplitude=0.05, frequency=1.0), Roll(amplitude=0.3, frequency=1.0)], ids=["sway", "roll"]
)
def test_water_moves_by_its_own_velocity(motion):
    """In the tank's axes a particle goes from place to place as its velocity there says, to 2 % of the tank's speed.

    The steps of the water are many base steps long; where these count twice, it lags by the tank's whole way.
    """
    made = soaked(rows(19, 10, 1.03, 0.0021), WIDTH, 0.12, LEVEL, 40, motions=[(motion,)])
    try:
        assert made.exchange_interval > 8
        made.advance(made.whole(round(AFTER / made.dt)))
        first = made.snapshot()
        made.advance(made.exchange_interval)
        second, step = made.snapshot(), made.exchange_interval * made.dt
    finally:
        made.close()
    went = (second["water_position"] - first["water_position"])[0] / step
    said = 0.5 * (first["water_velocity"] + second["water_velocity"])[0]
    fastest = motion.fastest(0.0) * (1.0 if isinstance(motion, Sway) else WIDTH)
    assert np.abs((went - said).mean(axis=0)).max() < 0.02 * fastest
    assert np.abs(went - said).max() < 0.1 * fastest
