"""From a preset to water's particles: the pressure with which they begin, and what they weigh."""

import re

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.assembly.water import drops_of, fluid_of, water_aboard
from lab.preset.find import load
from lab.preset.schema import Preset, resolve
from lab.report.water import described
from solvers.fluid.given import Fluid
from solvers.motion.carrier import per_slab

BLOCK = [["-200 mm", "300 mm"], ["0 mm", "300 mm"], ["0 mm", "400 mm"], ["-200 mm", "400 mm"]]
COLUMN = [["-200 mm", "0 mm"], ["0 mm", "0 mm"], ["0 mm", "300 mm"], ["-200 mm", "300 mm"]]


def wet(**water) -> Preset:
    tank = {"width": "400 mm", "height": "400 mm"}
    run = {"duration": "1 s", "gravity": "10 m/s^2", "settle": False}
    return resolve({"format": 3, "title": "water", "tank": tank, "water": {"spacing": "10 mm"} | water, "run": run})


def test_a_block_that_is_let_go_under_a_lid_has_no_pressure_and_a_column_its_weights():
    """The block falls freely; the column stands, and begins as hydrostatics has it."""
    assert not drops_of(wet(region=BLOCK))["deviation"].any()
    drops = drops_of(wet(region=COLUMN, sound_speed="40 m/s"))
    np.testing.assert_allclose(
        40.0**2 * np.log1p(drops["deviation"]), 10.0 * (0.3 - drops["position"][:, 1]), rtol=1e-9
    )


def masses(fluid: Fluid) -> np.ndarray:
    """Masses (n,) kg/m of the particles of water of the first world."""
    start = fluid.particles[0]
    return fluid.water.density * (1.0 + start["deviation"]) * start["volume"]


@pytest.mark.parametrize("state", ["linear", "tait"])
def test_water_that_is_compressed_by_its_weight_has_its_level_and_its_mass(state):
    """Before, it weighed g H/(2 c0²) too much: 1 % here. Its pressure still balances what lies above, at each depth."""
    made = fluid_of(wet(depth="200 mm", sound_speed="10 m/s", state=state))
    drops, mass = made.particles[0], masses(made)
    assert mass.sum() == pytest.approx(1000.0 * 0.4 * 0.2, rel=1e-12)
    assert drops["volume"].sum() == pytest.approx(0.4 * 0.2, rel=1e-12) and drops["position"][:, 1].max() < 0.2
    assert np.ptp(drops["deviation"]) == pytest.approx(10.0 * 0.2 / 10.0**2, rel=0.1)
    assert masses(fluid_of(wet(region=BLOCK))).sum() == pytest.approx(1000.0 * 0.2 * 0.1, rel=1e-12)


def test_explain_tells_between_which_densities_water_starts():
    preset = wet(depth="200 mm", sound_speed="10 m/s")
    rows = dict(described(preset, build(preset)[0]))
    assert "200 mm deep, 1000 kg/m^3" in rows["water"]
    low, high = map(float, re.findall(r"([\d.]+) kg", rows["density"])[:2])
    assert (low, high) == pytest.approx((990.3, 1009.6), abs=1.0)  # ρ (1 ∓ g H/2c²) but for half a spacing
    dry = wet(region=BLOCK)
    assert "density" not in dict(described(dry, build(dry)[0]))


def test_the_water_in_tanks_of_two_depths_weighs_in_all_what_her_displacement_counts():
    """`water_aboard` is what the ship floats by; each tank's mass is off by what `explain` tells."""
    preset = load("ship/barge-two-levels-quick").resolved
    scene = build(preset)[0]
    mass = per_slab(scene)[0] * masses(scene.fluid)
    assert mass.sum() == pytest.approx(water_aboard(preset).mass, rel=1e-9)
    first = scene.fills[0]
    area = scene.fluid.particles["volume"][0, :first].sum()
    off = 100.0 * (masses(scene.fluid)[:first].sum() / (1000.0 * area) - 1.0)
    told = re.search(r"tank ([+-][\d.]+) %", dict(described(preset, scene))["density"])
    assert float(told[1]) == pytest.approx(off, abs=0.006)
