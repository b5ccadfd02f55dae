"""Water in presets: what follows from its keys, and one sentence with the key for everything that cannot be."""

import tomllib

import numpy as np
import pytest

from lab.assembly.water import drops_of
from lab.preset.merge import merged, nested
from lab.preset.recorded import from_table, resolved_from, to_table
from lab.preset.schema import Preset, resolve
from lab.preset.sections.water.liquid import depth, expected_speed, spacing, tank_speed
from lab.preset.sections.water.schemes import SCHEMES
from tests.oracles.presets import error_of

TANK = """
format = 3
title = "a tank"
[tank]
width = "900 mm"
height = "500 mm"
[water]
depth = "100 mm"
[run]
duration = "1 s"
"""
COLUMN = [["-450 mm", "0 mm"], ["-250 mm", "0 mm"], ["-250 mm", "300 mm"], ["-450 mm", "300 mm"]]
GRAINS = {"grains": {"diameter": "3 mm", "depth": "30 mm"}, "material": {"density": "1319 kg/m^3", "young": "3 GPa"}}
GRAINS["material"] |= {"poisson": 0.28, "friction": 0.25, "restitution": 0.6}
SHIP = {"breadth": "2 m", "height": "1 m", "draught": "0.4 m", "gravity_height": "0.3 m", "gyradius": "0.5 m"}
GATE = {"points": [["0 mm", "0 mm"], ["0 mm", "150 mm"]], "speed": "1 m/s", "acceleration": "10 m/s^2"}
THIN = [["0 mm", "20 mm"], ["20 mm", "20 mm"], ["20 mm", "90 mm"], ["0 mm", "90 mm"]]
STEPPED = [("-300", "0"), ("300", "0"), ("300", "400"), ("0", "400"), ("0", "200"), ("-300", "200")]
STEPPED = [[f"{y} mm", f"{z} mm"] for y, z in STEPPED]  # narrower from 200 mm on
CUT = [["-105 mm", "100 mm"], ["105 mm", "310 mm"]]  # 3.5 mm of it, between the points at which sides are looked at
FREE = [["-99 mm", "100 mm"], ["111 mm", "310 mm"]]
GOES = {"speed": "1 m/s", "acceleration": "10 m/s^2"}
ROLL = {"amplitude": "5 deg", "frequency": "1 Hz", "phase": "1 rad"}


def wet(**overrides) -> Preset:
    """The tank with dotted keys (double underscores for dots) over it."""
    dotted = {key.replace("__", "."): value for key, value in overrides.items()}
    return resolve(merged(tomllib.loads(TANK), nested(dotted)))


def fault(**overrides) -> str:
    return error_of(lambda: wet(**overrides))


def test_the_spacing_divides_the_depth_and_is_the_nearest_that_does():
    for asked, layers in (("7 mm", 14), ("6.9 mm", 14), ("10 mm", 10), ("80 mm", 1)):
        assert spacing(wet(water__spacing=asked)) == pytest.approx(0.1 / layers)


@pytest.mark.parametrize(("level", "layers"), [("draft", 20), ("standard", 40), ("reference", 80)])
def test_the_level_of_accuracy_sets_the_spacing_only_where_none_is_given(level, layers):
    assert spacing(wet(run__accuracy=level)) == pytest.approx(0.1 / layers)
    assert spacing(wet(run__accuracy=level, water__spacing="10 mm")) == pytest.approx(0.01)


def test_the_sound_is_ten_times_the_fastest_wave_column_or_tank():
    calm = wet()
    assert calm.liquid.sound_speed == pytest.approx(10.0 * (9.81 * 0.1) ** 0.5)
    fast = wet(motion__sway={"amplitude": "1 m", "frequency": "1 Hz"})
    assert expected_speed(fast) == pytest.approx(tank_speed(fast)) == pytest.approx(6.2832, rel=1e-4)
    rolled = wet(motion__roll={"amplitude": "30 deg", "frequency": "1 Hz"})
    assert tank_speed(rolled) == pytest.approx(0.5236 * 6.2832 * (0.45**2 + 0.5**2) ** 0.5, rel=1e-4)  # of a corner
    column = wet(water__region=COLUMN)
    assert depth(column) == pytest.approx(0.3)
    assert column.liquid.sound_speed == pytest.approx(20.0 * (9.81 * 0.3) ** 0.5)
    assert wet(water__sound_speed="12 m/s").liquid.sound_speed == 12.0


def test_a_scheme_gives_what_is_not_given():
    source = wet(water__scheme="as_P").liquid
    assert (source.state, source.diffusion, source.viscosity, source.alpha) == ("tait", "molteni", "approaching", 0.07)
    assert source.smoothing == 1.70 and source.sound_speed == pytest.approx(60.0 * (9.81 * 0.1) ** 0.5)
    mixed = wet(water__scheme="as_P", water__alpha=0.0, water__kernel="wendland-c4", water__delta=0.05).liquid
    assert (mixed.alpha, mixed.kernel, mixed.delta, mixed.state) == (0.0, "wendland-c4", 0.05, "tait")
    assert wet(water__scheme="as_K").liquid.sound_speed == 10.0
    assert set(SCHEMES) == {"lab", "as_P", "as_K", "as_F"}


def test_gauges_are_handed_on_in_their_order():
    level, pressure = {"kind": "level", "y": "100 mm"}, {"place": ["450 mm", "20 mm"], "response": "1 ms"}
    water = wet(gauges={"B": level, "A": pressure, "C": {"place": ["0 mm", "0 mm"], "length": "5 mm"}}).liquid
    assert [(gauge.place, gauge.length, gauge.response) for gauge in water.gauges] == [
        ((0.45, 0.02), 0.0, 0.001),
        ((0.0, 0.0), 0.005, 0.0),
    ]
    assert [gauge.y for gauge in water.levels] == [0.1]


def test_a_recorded_preset_is_the_same():
    preset = wet(gauges={"A": {"place": ["450 mm", "20 mm"]}}, water__region=COLUMN, water__spacing="20 mm")
    assert from_table(to_table(preset)) == preset == resolved_from(to_table(preset))


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("spacing", 1e-12),
        ("density", float("nan")),
        ("region", [[1e-7 * k, (k * k % 7) * 1e-7] for k in range(2000)]),
        ("sound_speed", 1e-3),
        ("smoothing", 100.0),
        ("kernel", "cubic"),
    ],
)
def test_a_recorded_preset_beyond_the_limits_is_refused(key, value):
    table = to_table(wet())
    table["water"][key] = value
    with pytest.raises(ValueError, match="water"):
        resolved_from(table)


FAULTS = {
    "neither": ({"water__depth": False}, "water.depth: give exactly one of depth, region and radius (got none)."),
    "negative depth": ({"water__depth": "-1 mm"}, "water.depth: must be greater than 0 (got -1 mm)."),
    "no unit": ({"water__depth": 0.1}, 'water.depth: 0.1 has no unit; a length is needed, e.g. "3 mm".'),
    "too deep": ({"water__depth": "600 mm"}, "water.depth: 600 mm is more than the tank's height, 500 mm."),
    "to the lid": (
        {"water__depth": "500 mm"},
        "water.depth: 500 mm fills the tank up to its lid; set water.full = true, or take less.",
    ),
    "not full": (
        {"water__full": True},
        "water.full: the water is 100 mm deep in a tank 500 mm high; it must fill a tank with a lid.",
    ),
    "a background at a surface": (
        {"water__background_pressure": "5 Pa"},
        "water.background_pressure: goes with water.full or [air]; a free surface would be blown apart.",
    ),
    "a heavy background": (
        {"water__depth": "500 mm", "water__full": True, "water__background_pressure": "1 MPa"},
        "water.background_pressure: 1 MPa is more than a tenth of ρ c² at 22.15 m/s; take at most 49.05 kPa, or raise "
        "water.sound_speed.",
    ),
    "wide particles": (
        {"water__spacing": "120 mm"},
        "water.spacing: particles of 120 mm are larger than the water, which is 100 mm deep.",
    ),
    "wider than the tank": (
        {"water__spacing": "90 mm", "tank__width": "80 mm"},
        "water.spacing: particles of 90 mm are larger than the water, which is 80 mm wide.",
    ),
    "too many": (
        {"water__spacing": "1 um"},
        "water.spacing: particles of 1 µm are too small for so much water.",
    ),
    "soft water": (
        {"water__sound_speed": "2 m/s"},
        "water.sound_speed: at 2 m/s the water's weight would compress it by more than 10 %; take at least 3.132 m/s, ",
    ),
    "region outside": (
        {"water__region": [["-500 mm", "0 mm"], ["0 mm", "0 mm"], ["0 mm", "100 mm"]]},
        "water.region: it reaches out of the tank at [-500 mm, 0 m]; keep it inside.",
    ),
    "region crossing itself": (
        {"water__region": [["0 mm", "0 mm"], ["100 mm", "100 mm"], ["100 mm", "0 mm"], ["0 mm", "100 mm"]]},
        "water.region: the outline crosses or touches itself.",
    ),
    "gauge in the water": (
        {"gauges__P1": {"place": ["-440 mm", "50 mm"]}},
        "gauges.P1.place: [-440 mm, 50 mm] is 10 mm away from the tank's walls; the nearest point on one is "
        "[-450 mm, 50 mm].",
    ),
    "gauge without a place": (
        {"gauges__P1": {"length": "5 mm"}},
        'gauges.P1.place: missing for a pressure gauge; give y and z on a wall, e.g. ["0 mm", "10 mm"].',
    ),
    "force gauge without a place": (
        {"gauges__gate": {"kind": "force"}},
        'gauges.gate.place: missing for a force gauge; give y and z on a wall, e.g. ["0 mm", "10 mm"].',
    ),
    "gauge round a corner": (
        {"gauges__P1": {"place": ["-450 mm", "2 mm"], "length": "10 mm"}},
        "gauges.P1.length: 10 mm reaches past the end of its wall.",
    ),
    "gauge of both kinds": (
        {"gauges__P1": {"place": ["-450 mm", "50 mm"], "y": "0 mm"}},
        'gauges.P1.y: goes with kind = "level"; a pressure gauge has a place.',
    ),
    "level outside": (
        {"gauges__L": {"kind": "level", "y": "500 mm"}},
        "gauges.L.y: 500 mm is outside of the tank, which reaches from -450 mm to 450 mm.",
    ),
    "level without a place": (
        {"gauges__L": {"kind": "level"}},
        'gauges.L.y: missing for a level gauge; a length is needed, e.g. "3 mm".',
    ),
    "level with a length": (
        {"gauges__L": {"kind": "level", "y": "0 mm", "length": "5 mm"}},
        'gauges.L.length: goes with kind = "pressure"; a level gauge has y alone.',
    ),
    "laminar of nothing": (
        {"water__viscosity": "laminar"},
        'water.kinematic_viscosity: missing for viscosity = "laminar"; a kinematic viscosity is needed, e.g. '
        '"1e-6 m^2/s".',
    ),
    "viscosity unused": (
        {"water__kinematic_viscosity": "1e-6 m^2/s"},
        'water.kinematic_viscosity: goes with viscosity = "laminar"; leave out either.',
    ),
    "alpha unused": (
        {"water__viscosity": "laminar", "water__kinematic_viscosity": "1e-6 m^2/s", "water__alpha": 0.1},
        'water.alpha: goes with an artificial viscosity, not with viscosity = "laminar".',
    ),
    "delta unused": (
        {"water__diffusion": "none", "water__delta": 0.1},
        'water.delta: there is no diffusion of density with diffusion = "none".',
    ),
    "no ship": (
        {"water__model": "linear"},
        'water.model: "linear" is for tanks in a ship; add a table [ship], or take "sph".',
    ),
    "a bent plate": (
        {"parts__gate": {"points": [["0 mm", "0 mm"], ["0 mm", "50 mm"], ["10 mm", "90 mm"]]}},
        "parts.gate.points: a plate in water is straight (got 3 points); give two points, or set closed = true for a "
        "solid body.",
    ),
    "a plate through a wall": (
        {"parts__gate": {"points": [["0 mm", "20 mm"], ["470 mm", "20 mm"]]}},
        "parts.gate.points: it stands in a wall of the tank at [455.3 mm, 20 mm]; keep it inside, or "
        "let it out through the top.",
    ),
    "a gate that cuts a corner": (
        {"tank__width": False, "tank__height": False, "tank__outline": STEPPED, "parts__gate": {"points": CUT}},
        "parts.gate.points: it stands in a wall of the tank at [-2.5 mm, 202.5 mm]; keep it inside, or let it out "
        "through the top.",
    ),
    "a gate that cuts a corner on its way": (
        {
            "tank__width": False,
            "tank__height": False,
            "tank__outline": STEPPED,
            "parts__gate": {"points": FREE, "move": ["-7 mm", "0 mm"], **GOES},
        },
        "parts.gate.move: it stands in a wall of the tank at [",
    ),
    "a gate through the floor": (
        {"parts__gate": GATE | {"move": ["0 mm", "-100 mm"]}},
        "parts.gate.move: it stands in a wall of the tank at [0 m, -2.5 mm] on its way; keep it inside, or let it out "
        "through the top.",
    ),
    "a piston that leaves": (
        {"parts__piston": {"points": GATE["points"], "sway": {"amplitude": "500 mm", "frequency": "1 Hz"}}},
        "parts.piston.sway: it stands in a wall of the tank at [-500 mm, 0 m] on its way; keep it inside, "
        "or let it out through the top.",
    ),
    "a part that starts elsewhere": (
        {"parts__flap": {"points": GATE["points"], "roll": ROLL}},
        "parts.flap.roll.phase: a part starts where it is drawn; leave the phase out.",
    ),
    "a thin body": (
        {"water__spacing": "4 mm", "parts__wall": {"points": THIN, "closed": True}},
        "parts.wall.points: this body is 20 mm thin, under 4 h = 32 mm; take smaller particles, or draw it as a "
        "plate of two points.",
    ),
    "a part in a tank that is not": (
        {"parts__wall": {"points": THIN, "closed": True, "tank": "aft"}},
        "parts.wall.tank: is 'aft', and there are no further tanks here; leave it out for [tank].",
    ),
    "repeats": (
        {"run__repeats": 3},
        "run.repeats: water starts without chance, so that all repeats would be the same; take one.",
    ),
    "friction": (
        {"contact__rolling": "constant-torque"},
        "contact: goes with grains, and there are none; add a table ",
    ),
    "gauges of nothing": (
        {"water": False, "gauges__P1": {"place": ["-450 mm", "50 mm"]}},
        "gauges: goes with water, and there is none; add a table [water], or set gauges = false.",
    ),
}


@pytest.mark.parametrize("name", FAULTS)
def test_what_cannot_be_is_refused_in_a_sentence(name):
    overrides, sentence = FAULTS[name]
    assert fault(**overrides).startswith(sentence)


def test_a_gate_beside_a_corner_is_allowed():
    """Past it, from wall to wall across another one, and along the walls; above the tank there are none."""
    beside = [["-99 mm", "100 mm"], ["111 mm", "310 mm"]], [["-300 mm", "5 mm"], ["-295 mm", "0 mm"]]
    along = [["-300 mm", "0 mm"], ["-300 mm", "200 mm"]], [["0 mm", "200 mm"], ["0 mm", "400 mm"]]
    for points in (*beside, *along, [["100 mm", "0 mm"], ["100 mm", "450 mm"]]):
        assert wet(tank__width=False, tank__height=False, tank__outline=STEPPED, parts__gate={"points": points}).parts


def test_both_depth_and_region_are_refused_in_one_table_but_the_later_wins_over_a_base():
    table = tomllib.loads(TANK)
    table["water"]["region"] = COLUMN
    assert (
        error_of(lambda: resolve(table))
        == "water.depth: give exactly one of depth, region and radius (got depth and region)."
    )
    assert wet(water__region=COLUMN).water.depth is None


def test_a_full_tank_and_an_open_one_filled_to_its_rim_are_allowed():
    assert wet(water__depth="500 mm", water__full=True).water.full
    assert wet(water__depth="500 mm", tank__lid=False).tank.open_edges == (2,)
    gone = fault(tank__lid=False, gauges__P1={"place": ["0 mm", "500 mm"]})  # where no wall is
    assert gone.startswith("gauges.P1.place: [0 m, 500 mm] is 450 mm away from the tank's walls")


def test_a_gate_may_leave_through_the_top_and_its_speed_counts():
    """A gate that is lifted out; the expected speed of the water, and with it that of sound, is at least the gate's."""
    gate = wet(parts__gate=GATE | {"move": ["0 mm", "600 mm"], "speed": "9 m/s", "acceleration": "1e3 m/s^2"})
    assert expected_speed(gate) == pytest.approx(9.0)
    assert expected_speed(gate) > expected_speed(wet())


def test_water_leaves_room_for_bodies_and_stands_at_its_level_on_either_side_of_a_gate():
    block = [["-50 mm", "0 mm"], ["50 mm", "0 mm"], ["50 mm", "60 mm"], ["-50 mm", "60 mm"]]
    given = {"water__spacing": "5 mm", "run__gravity": "10 m/s^2"}
    drops = drops_of(wet(parts__block={"points": block, "closed": True}, **given))
    assert not ((np.abs(drops["position"][:, 0]) < 0.05) & (drops["position"][:, 1] < 0.06)).any()
    assert drops["volume"].sum() == pytest.approx(0.9 * 0.1 - 0.1 * 0.06, rel=1e-6)
    steps = [["-450 mm", "0 mm"], ["450 mm", "0 mm"], ["450 mm", "50 mm"], ["0 mm", "50 mm"], ["0 mm", "100 mm"]]
    region = {"water__depth": False, "water__region": [*steps, ["-450 mm", "100 mm"]]}
    drops = drops_of(wet(parts__gate=GATE, **given, **region))
    sound = wet(parts__gate=GATE, **given, **region).liquid.sound_speed
    level = np.where(drops["position"][:, 0] < 0.0, 0.1, 0.05)
    np.testing.assert_allclose(
        np.log1p(drops["deviation"]) * sound**2, 10.0 * (level - drops["position"][:, 1]), rtol=1e-9
    )


def test_water_is_packed_beside_slanted_plates_and_cut_from_a_lattice_beside_others():
    """A lattice has ten heights; both have the water's volume and its weight's pressure."""
    for top, packs in (("0 mm", False), ("40 mm", True)):
        plate = {"points": [["0 mm", "0 mm"], [top, "60 mm"]]}
        made = wet(parts__baffle=plate, water__spacing="10 mm", run__gravity="10 m/s^2")
        drops, sound = drops_of(made), made.liquid.sound_speed
        assert (len(np.unique(np.round(drops["position"][:, 1], 6))) > 100) == packs
        assert drops["volume"].sum() == pytest.approx(0.9 * 0.1, rel=1e-9)
        np.testing.assert_allclose(
            np.log1p(drops["deviation"]) * sound**2, 10.0 * (0.1 - drops["position"][:, 1]), rtol=1e-9
        )
        lattice = wet(parts__baffle=plate, water__spacing="10 mm", water__start="lattice")
        assert len(np.unique(np.round(drops_of(lattice)["position"][:, 1], 6))) == 10
