"""Laws of friction of bulk."""

import numpy as np
import pytest
import taichi as ti

from solvers.bulk.given import Granular
from solvers.bulk.laws import LAWS
from solvers.machine import runtime

SLOW, FAST, I_0, DIAMETER, DENSITY, PACKING, STEP = 0.38, 0.64, 0.279, 0.2, 850.0, 0.6, 3e-3
TRIED = np.array([4e3, 8e3, 3e4, 2e5])  # Pa
PRESSURE = 1e4


def held(law: str, step: float) -> np.ndarray:
    """The shear stress that stays, as the law's kernel finds it."""
    runtime.initialise(1, "cpu", "f64")
    chosen, material = LAWS[law](), Granular(DENSITY, SLOW, SLOW, 1e7, law, FAST, I_0, DIAMETER, PACKING)
    tried, found = (ti.field(ti.f64, len(TRIED)) for _ in range(2))
    tried.from_numpy(TRIED)

    @ti.kernel
    def find(share: ti.f64):
        for k in tried:
            found[k] = chosen.held(tried[k], PRESSURE, SLOW, FAST, share)

    find(material.alpha * step)
    return found.to_numpy()


def test_friction_follows_the_inertial_number_of_the_plastic_flow():
    """|s| = μ(I) p at the rate γ̇ = (|s_t| − |s|)/(G Δt) that the step itself finds."""
    shear = held("mu-of-i", STEP)
    modulus = 1e7 / 2.6
    rate = (TRIED - shear) / (modulus * STEP)
    inertial = rate * DIAMETER * np.sqrt(DENSITY / PACKING / PRESSURE)
    friction = SLOW + (FAST - SLOW) / (1.0 + I_0 / inertial)
    assert shear == pytest.approx(friction * PRESSURE, rel=1e-9)


def test_slow_flow_has_the_slow_friction_and_the_constant_law_always_has():
    assert held("mu-of-i", 1e6) == pytest.approx(SLOW * PRESSURE, rel=1e-4)
    assert held("constant", STEP) == pytest.approx(SLOW * PRESSURE, rel=1e-12)
