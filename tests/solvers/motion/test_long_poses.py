"""How a matter in long steps sees a tank whose motion is prescribed."""

import numpy as np
import pytest
import taichi as ti

from solvers.machine import runtime
from solvers.machine.state import State
from solvers.motion.harmonic import Sway
from solvers.motion.poses import Poses
from solvers.motion.prescribed import Prescribed


def test_a_long_step_ends_with_the_last_short_one():
    """The walls' velocity in a step of 16 short ones is the way from its begin to its end over its length."""
    runtime.initialise(1)
    arrays, sway = State(), Sway(amplitude=0.1, frequency=1.0)
    carrier = Prescribed(arrays, [[sway]], 0.0, 9.81)
    poses = Poses(arrays, carrier, 1, long=True)
    arrays.finish()
    begin, short = 0.1, 2.0**-10

    @ti.kernel
    def step(begin: ti.f64, last: ti.f64, long: ti.f64):
        for w in range(1):
            poses.note_start(w, begin, long)
            poses.note_passage(w, last, long)

    step(begin, begin + 15.0 * short, 16.0 * short)
    found = poses.walls[0].to_numpy()[0]
    arrays.release()
    way = 0.1 * (np.sin(2.0 * np.pi * (begin + 16.0 * short)) - np.sin(2.0 * np.pi * begin))
    assert found == pytest.approx(way / (16.0 * short), rel=1e-9)
