"""Water without weight in presets: drops, flows, pulls and periodic space, and one sentence for what cannot be."""

import numpy as np
import pytest

from lab.assembly.water import drops_of
from lab.preset.find import load
from lab.preset.sections.water.liquid import expected_speed
from solvers.fluid.start.flow import vortices
from tests.lab.preset.test_preset_water import COLUMN, GATE, GRAINS, SHIP, fault, wet

FREE = {"run__gravity": "0 m/s^2", "water__depth": False}
DROP = FREE | {"water__radius": "100 mm", "water__centre": ["100 mm", "250 mm"], "water__spacing": "10 mm"}
DROP["water__start"] = "lattice"
SWUNG = DROP | {"water__flow": {"strain": "2 1/s", "pull": "3 rad/s"}}
FULL = {"water__depth": "500 mm", "water__full": True, "water__spacing": "20 mm", "run__gravity": "0 m/s^2"}
ROUND = FULL | {"water__periodic": "yz"}
LONG = {"water__periodic": "y", "water__spacing": "20 mm"}


def test_a_drop_starts_with_its_flow_and_the_pressure_that_this_takes():
    """u = σ (y, −z) about its middle, and p = ρ (σ² + Ω²)(R² − r²)/2."""
    preset = wet(**SWUNG)
    drops, water = drops_of(preset), preset.liquid
    arm = drops["position"] - [0.1, 0.25]
    assert drops["volume"].sum() == pytest.approx(np.pi * 0.1**2, rel=1e-3)
    np.testing.assert_allclose(drops["velocity"], 2.0 * arm * [1.0, -1.0], atol=1e-9)
    pressure = drops["deviation"] * water.sound_speed**2
    np.testing.assert_allclose(pressure, 6.5 * (0.01 - (arm**2).sum(axis=1)), atol=4e-4 * 0.065)
    assert water.pull.rate == 3.0 and water.pull.centre == pytest.approx((0.1, 0.25))
    assert expected_speed(preset) == pytest.approx(0.1 * (2.0 + 3.0))


def test_a_drop_takes_the_place_of_the_depth_of_its_base():
    preset = wet(water__radius="100 mm", water__centre=["0 mm", "250 mm"])
    assert preset.water.depth is None and preset.water.radius == pytest.approx(0.1)
    assert wet(water__region=COLUMN, water__depth=False).water.radius is None


def test_a_drop_with_weight_falls_without_pressure():
    drops = drops_of(wet(**DROP | {"run__gravity": "9.81 m/s^2"}))
    assert not drops["deviation"].any() and not drops["velocity"][:, 0].any()


def test_a_turning_region_is_under_suction():
    square = [["-100 mm", "150 mm"], ["100 mm", "150 mm"], ["100 mm", "350 mm"], ["-100 mm", "350 mm"]]
    preset = wet(**FREE, water__region=square, water__spacing="10 mm", water__flow={"rotation": "5 rad/s"})
    drops = drops_of(preset)
    arm = drops["position"] - [0.0, 0.25]
    np.testing.assert_allclose(drops["velocity"][:, 0], -5.0 * arm[:, 1], atol=1e-9)
    assert drops["deviation"].min() * preset.liquid.sound_speed**2 == pytest.approx(-25.0 * 0.04 * 0.147, rel=0.02)


def test_vortices_fill_a_periodic_tank():
    preset = wet(**ROUND, water__flow={"vortices": "0.5 m/s"}, tank__width="1 m")
    drops, water = drops_of(preset), preset.liquid
    assert (water.periodic, water.walls) == (("y", "z"), False) and len(drops) == 50 * 25
    flow = 0.5 * vortices(drops["position"] - [-0.5, 0.0], (1.0, 0.5))
    np.testing.assert_allclose(drops["velocity"], flow)


def test_a_periodic_pool_keeps_its_floor_and_weight():
    preset = wet(**LONG, tank__width="1 m")
    assert (preset.liquid.periodic, preset.liquid.walls) == (("y",), True)
    assert drops_of(preset)["deviation"].max() > 0.0
    channel = wet(**ROUND | {"water__periodic": "z", "run__gravity": "0.4 m/s^2"})
    assert not drops_of(channel)["deviation"].any()  # it flows down without end


@pytest.mark.parametrize("name", ["drop-strained", "drop-pulled", "square-patch", "taylor-green"])
def test_the_presets_are_of_water_without_weight(name):
    preset = load(f"validation/{name}").resolved
    assert preset.run.gravity == 0.0 and preset.water.flow is not None


FAULTS = {
    "no unit": (DROP | {"water__flow": {"strain": 2.0}}, "water.flow.strain: 2.0 has no unit; a rate is needed, e.g. "),
    "a frequency": (SWUNG | {"water__flow": {"pull": "3 Hz"}}, "water.flow.pull: "),
    "a pull below zero": (
        SWUNG | {"water__flow": {"pull": "-3 rad/s"}},
        "water.flow.pull: must be at least 0 (got -3 rad/s).",
    ),
    "a drop nowhere": (DROP | {"water__centre": False}, "water.centre: missing for a drop; a length is needed, e.g. "),
    "a centre of nothing": (
        {"water__centre": ["0 mm", "0 mm"]},
        "water.centre: goes with radius; leave it out.",
    ),
    "a drop and a column": (
        DROP | {"water__region": COLUMN},
        "water.depth: give exactly one of depth, region and radius (got region and radius).",
    ),
    "a drop in a wall": (
        DROP | {"water__radius": "300 mm"},
        "water.radius: it reaches out of the tank at [",
    ),
    "a flow with weight": (
        SWUNG | {"run__gravity": "9.81 m/s^2"},
        'water.flow: goes with water without weight; set run.gravity = "0 m/s^2", or leave it out.',
    ),
    "a flow at a wall": (
        SWUNG | {"water__centre": ["100 mm", "130 mm"]},
        "water.flow: the water is 30 mm from a wall, which it feels within 40 mm; take a larger tank.",
    ),
    "a flow of a pool": (
        {"run__gravity": "0 m/s^2", "water__flow": {"strain": "2 1/s"}},
        "water.flow: strain, rotation and pull are of water that is free on all sides; give water.radius or ",
    ),
    "a flow past a part": (
        SWUNG | {"parts__gate": GATE},
        "water.flow: parts in water that flows at first are not computed yet; leave out either.",
    ),
    "two flows": (
        SWUNG | {"water__flow": {"strain": "2 1/s", "vortices": "1 m/s"}},
        "water.flow: vortices fill a tank, and other flows are of free water; give one of them.",
    ),
    "a centre of vortices": (
        ROUND | {"water__flow": {"vortices": "1 m/s", "centre": ["0 m", "0 m"]}},
        "water.flow.centre: goes with strain, rotation or pull; give one of them, or leave it out.",
    ),
    "vortices between walls": (
        FULL | {"water__flow": {"vortices": "1 m/s"}},
        'water.flow.vortices: they need a tank without walls; set water.periodic = "yz".',
    ),
    "grains in water without weight": (
        GRAINS | {"run__gravity": "0 m/s^2"},
        "run.gravity: grains alone or water alone can be without weight; leave out [grains], or give some gravity.",
    ),
    "a ship without weight": (
        {"ship": SHIP, "run__gravity": "0 m/s^2"},
        "run.gravity: grains alone or water alone can be without weight; leave out [ship], or give some gravity.",
    ),
    "a periodic ship": (LONG | {"ship": SHIP}, "water.periodic: goes with water alone; leave it or [ship] out."),
    "periodic with air": (LONG | {"air": {}}, "water.periodic: goes with water alone; leave it or [air] out."),
    "periodic with a gate": (
        LONG | {"parts__gate": GATE},
        "water.periodic: parts in periodic space are not computed yet; leave out either.",
    ),
    "a periodic column": (
        LONG | {"water__depth": False, "water__region": COLUMN},
        "water.periodic: goes with level water; give water.depth, or leave it out.",
    ),
    "a periodic triangle": (
        LONG | {"tank": {"outline": [["0 m", "0 m"], ["1 m", "0 m"], ["0 m", "1 m"]]}},
        "water.periodic: only the sides of a rectangle repeat; give tank.width and tank.height.",
    ),
    "a periodic roll": (
        LONG | {"motion__roll": {"amplitude": "5 deg", "frequency": "1 Hz"}},
        "water.periodic: space that repeats itself cannot roll; leave out the roll, or this.",
    ),
    "periodic with a lid": (
        LONG | {"water__periodic": "yz"},
        'water.periodic: with "yz" there is neither floor nor surface; set water.full = true with water.depth = ',
    ),
    "half a spacing": (
        LONG | {"tank__width": "910 mm"},
        "water.periodic: the tank's width, 910 mm, is no whole number of spacings of 20 mm; take a width of 9",
    ),
    "a gauge in no wall": (
        LONG | {"tank__width": "1 m", "gauges__P1": {"place": ["500 mm", "50 mm"]}},
        "gauges.P1.place: there is no wall on this side (water.periodic); move the gauge.",
    ),
    "a level of no floor": (
        ROUND | {"tank__width": "1 m", "gauges__L1": {"kind": "level", "y": "0 mm"}},
        "gauges.L1: the tank has no floor (water.periodic); leave the gauge out.",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_cannot_be_is_refused_in_a_sentence(name):
    overrides, sentence = FAULTS[name]
    assert fault(**overrides).startswith(sentence)
