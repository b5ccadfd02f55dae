"""Air in presets: what follows from its keys, how it lies over the water, and one sentence for what cannot be."""

import tomllib
from dataclasses import replace

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.assembly.water import air_volumes_of, drops_of, updates, volumes_of
from lab.base.errors import LabError
from lab.preset.merge import merged, nested
from lab.preset.recorded import from_table, to_table
from lab.preset.schema import Preset, resolve
from solvers.fluid.phases.adiabatic import Adiabatic, background
from solvers.fluid.phases.cohesion import Cohesion
from solvers.fluid.start.air import hydrostatic_air
from tests.oracles.presets import error_of

TANK = """
format = 3
title = "a closed tank"
[tank]
width = "400 mm"
height = "200 mm"
[water]
depth = "100 mm"
spacing = "10 mm"
[air]
[run]
duration = "1 s"
"""
COLUMN = [["-200 mm", "0 mm"], ["-100 mm", "0 mm"], ["-100 mm", "150 mm"], ["-200 mm", "150 mm"]]


REAL = {"air__sound_speed": "real"}


def airy(**overrides) -> Preset:
    """The tank with dotted keys (double underscores for dots) over it."""
    dotted = {key.replace("__", "."): value for key, value in overrides.items()}
    return resolve(merged(tomllib.loads(TANK), nested(dotted)))


def fault(**overrides) -> str:
    return error_of(lambda: airy(**overrides))


def test_the_air_has_the_sound_of_the_water_or_its_own():
    water = airy().liquid
    assert water.air.sound_speed == water.sound_speed and water.air.density == 1.2
    assert airy(air__sound_speed="real").liquid.air.sound_speed == 343.0
    assert airy(air__sound_speed="50 m/s").liquid.air.sound_speed == 50.0
    assert airy(air=False).liquid.air is None
    assert airy(water__alpha=0.03).liquid.air.alpha == 0.03


def test_air_that_becomes_stiff_begins_with_the_sound_of_the_water():
    """Both have one background, that of the softer, and the soft air has the mass of the stiff one."""
    late = {**REAL, "air__stiff_from": "0.75 s"}
    water = airy(**late).liquid
    assert (water.air.sound_speed, water.air.soft_speed, water.air.stiff_from) == (343.0, water.sound_speed, 0.75)
    assert water.softened.air.sound_speed == water.sound_speed
    assert water.background == airy().liquid.background < airy(**REAL).liquid.background
    masses = [drops["volume"] @ ((1.0 + drops["deviation"]) * drops["gas"]) for drops in map(drops_of, made(late))]
    assert masses[0] == pytest.approx(masses[1], rel=1e-9) and masses[2] < (1.0 - 1e-3) * masses[1]


def made(late: dict) -> tuple[Preset, Preset, Preset]:
    """The tank with air that becomes stiff, with real air, and with soft air."""
    return airy(**late), airy(**REAL), airy()


def test_steps_are_long_while_air_is_soft():
    """A power of two of the stiff air's steps, within the bounds of both, with the fewest steps in all."""
    late = airy(**REAL, air__stiff_from="0.75 s", run__precision="mixed")
    scene, stiff, soft = (build(preset)[0] for preset in (late, airy(**REAL), airy()))
    assert scene.fluid.soft_multiple in (16, 32)  # 343 over 9.9 m/s is 35
    assert (
        scene.step <= stiff.step_limits()[0].step
        and scene.fluid.soft_multiple * scene.step <= soft.step_limits()[0].step
    )
    rows = round(1.0 / late.record.series_rate / scene.step)
    assert rows % scene.fluid.soft_multiple == 0
    taken = updates(scene, round(1.0 / scene.step)) / scene.particles
    assert 1.0 / soft.step < taken < 0.36 / stiff.step
    forced = build(airy(**REAL, air__stiff_from="0.75 s", run__step=f"{1e6 * stiff.step} us"))[0]
    assert forced.fluid.soft_multiple == 1 and forced.step == pytest.approx(stiff.step)


def test_a_preset_with_air_comes_back_from_its_table():
    preset = airy(air__sound_speed="real", water__background_pressure="20 Pa", air__surface_tension="0.072 N/m")
    assert from_table(to_table(preset)) == preset
    assert preset.matters == ("water", "air")


def test_a_key_whose_model_was_taken_out_is_refused_in_a_preset_and_read_in_a_recording():
    with pytest.raises(LabError, match=r"^air\.vent_area: this version has no such model any more; leave the key out"):
        airy(air__vent_area="1 cm^2")
    table = to_table(airy())
    assert from_table({**table, "air": {**table["air"], "vent_area": 0.0}}) == airy()


def test_air_fills_what_the_water_leaves():
    """Both phases have their areas, each particle a place within its own, and masses by the pressure there."""
    scene = build(airy(run__repeats=1))[0]
    drops = scene.fluid.particles
    assert volumes_of(scene).sum() == pytest.approx(0.04) and air_volumes_of(scene).sum() == pytest.approx(0.04)
    gas = drops["gas"][0]
    assert (np.diff(gas.astype(int)) >= 0).all()  # the water first
    assert (drops["position"][0, ~gas, 1] < 0.1).all() and (drops["position"][0, gas, 1] > 0.1).all()
    assert (drops["deviation"][0, ~gas] > 0.0).all() and (drops["deviation"][0, gas] < 0.0).all()


def test_air_lies_round_a_column():
    drops = drops_of(airy(water__region=COLUMN))
    gas, inside = drops["gas"] > 0.5, (drops["position"][:, 0] < -0.1) & (drops["position"][:, 1] < 0.15)
    np.testing.assert_array_equal(inside, ~gas)
    assert drops["volume"][gas].sum() == pytest.approx(0.4 * 0.2 - 0.1 * 0.15)


def test_air_at_rest_is_in_balance_with_its_weight():
    """dp/dz = −ρ g, by differences."""
    height, sound, state = np.linspace(0.0, 0.3, 301), 5.0, Adiabatic()
    s = hydrostatic_air(height, 9.81, sound)
    slope = np.gradient(sound**2 * state.pressure(s), height)[1:-1]
    np.testing.assert_allclose(slope, -9.81 * (1.0 + s)[1:-1], rtol=1e-4)
    np.testing.assert_allclose(state.deviation(state.pressure(s)), s, atol=1e-12)


@pytest.mark.parametrize(
    ("overrides", "key"),
    [
        ({"tank__lid": False}, "air"),
        ({"water__depth": "200 mm", "water__full": True}, "air"),
        ({"parts__gate": {"points": [["0 mm", "0 mm"], ["0 mm", "50 mm"]]}}, "air"),
        ({"water__shifting": "delta-plus-momentum"}, "water.shifting"),
        ({"water__viscosity": "laminar", "water__kinematic_viscosity": "1e-5 m^2/s"}, "water.viscosity"),
        ({"water__viscosity": "laminar-stress", "water__kinematic_viscosity": "1e-5 m^2/s"}, "air.kinematic_viscosity"),
        ({"air__kinematic_viscosity": "1e-5 m^2/s"}, "air.kinematic_viscosity"),
        ({"air__density": "2000 kg/m^3"}, "air.density"),
        ({"air__sound_speed": "0.5 m/s"}, "air.sound_speed"),
        ({"air__sound_speed": "fast"}, "air.sound_speed"),
        ({"water__scheme": "as_P", "air__sound_speed": "30 m/s"}, "air.sound_speed"),
        ({"air__stiff_from": "0.5 s"}, "air.stiff_from"),
        ({**REAL, "air__stiff_from": "-0.5 s"}, "air.stiff_from"),
        ({**REAL, "air__stiff_from": "0 s"}, "air.stiff_from"),
        ({**REAL, "air__stiff_from": "1 s"}, "air.stiff_from"),
        ({**REAL, "air__stiff_from": "0.5 s", "water__scheme": "as_P"}, "air.stiff_from"),
        ({**REAL, "air__stiff_from": "0.5 s", "water__sound_speed": "0.5 m/s"}, "water.sound_speed"),
        ({"water": False}, "air"),
    ],
)
def test_what_cannot_be_is_one_sentence_with_its_key(overrides, key):
    said = fault(**overrides)
    assert said.startswith(f"{key}:") and said.count("\n") == 0


def test_the_source_scheme_has_air_with_cohesion():
    """Smoothing of its two-phase runs, X = 1.5 g L (ρ_w − ρ_a) with the depth for L, no other background."""
    made = airy(water__scheme="as_P", air__sound_speed="real").liquid
    assert made.smoothing == 1.34 and airy(water__scheme="as_P", air=False).liquid.smoothing == 1.70
    assert made.air.interface == "cohesion" and made.background == 0.0
    assert made.air.cohesion == pytest.approx(1.5 * 9.81 * 0.1 * (1000.0 - 1.2), rel=1e-3)
    assert airy(water__scheme="as_P", air__interface="weighted").liquid.air.cohesion == 0.0


def test_cohesion_softens_air_and_bounds_its_sound():
    """The pressure with X − a ρ² falls by 2 a ρ_a = 2 X/ρ_a of c² (numpy differences); its energy is ∫ p/ρ² dρ."""
    pull, s = 700.0, np.linspace(-1e-3, 1e-3, 2001)
    slope = np.gradient(Cohesion.pressure(pull, s), s)[1000]
    assert slope == pytest.approx(-1.2 * Cohesion.slowest(pull, 1.2) ** 2, rel=1e-6)


def test_air_bears_suction_unless_the_preset_says_else():
    """0.3 ρ c²/1.4 of the air, at most ρ U² (or what a heavy one draws) or 0.02 ρ c² of the water; none without air."""
    sound = airy().liquid.sound_speed
    assert airy().liquid.background == pytest.approx(0.3 * 1.2 * sound**2 / 1.4)
    real = airy(air__sound_speed="real", water__sound_speed="12 m/s")
    assert real.liquid.background == pytest.approx(1000.0 * real.liquid.speed**2)
    assert background(real.liquid.air, replace(real.liquid, speed=0.0)) == pytest.approx(0.02 * 1000.0 * 12.0**2)
    heavy = airy(tank__height="300 mm", air__density="500 kg/m^3")  # 0.2 m of it hang below the lid
    assert heavy.liquid.background == pytest.approx(500.0 * (9.81 * 0.2 + heavy.liquid.speed**2), rel=1e-3)
    assert airy(water__background_pressure="0 Pa").liquid.background == 0.0
    assert airy(air=False).liquid.background == 0.0
    taut = airy(air__surface_tension="1 N/m")
    assert taut.liquid.background == pytest.approx(3.0 * 0.743 / taut.liquid.length, rel=1e-3)


def test_pressures_over_those_of_a_heavy_fluid():
    """Reduced, nothing hangs below the lid: the background bears less, and the upper fluid has no pressure at rest."""
    heavy = {"tank__height": "300 mm", "air__density": "500 kg/m^3"}
    whole, reduced = airy(**heavy).liquid, airy(**heavy, air__reduced=True)
    made = reduced.liquid
    assert made.air.reduced == pytest.approx(0.1) and whole.air.reduced is None
    assert made.background == pytest.approx(
        max(1000.0 * made.speed**2, 500.0 * (9.81 * made.length + made.speed**2)), rel=1e-6
    )
    assert made.background < whole.background
    drops = build(reduced)[0].fluid.particles[0]
    assert (drops["deviation"][drops["gas"]] == 0.0).all() and drops["deviation"].max() > 0.0
