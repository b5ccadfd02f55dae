"""Presets in space: what they refuse, what they record, and how many grains a depth takes."""

import numpy as np
import pytest

from lab.assembly.grains import _ordered, filling_outline, grain_count
from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.kept.recorded import content
from lab.preset.recorded import to_table
from lab.recording.layout import tables_of
from lab.view.live import steerable

WATER = {"water": {"depth": "40 mm", "spacing": "20 mm"}}
CHICKPEAS, DRUM, BARGE = "space/tilting-box-quick", "space/drum-quick", "space/barge-quick"
SLOSHING = "space/sloshing-quick"
LOPSIDED = {"tank.outline": [["-0.1 m", "0 m"], ["0.1 m", "0 m"], ["0.2 m", "0.1 m"]]}
NARROW = {"tank.outline": [["-0.1 m", "0 m"], ["0.1 m", "0 m"], ["0.1 m", "0.01 m"], ["-0.1 m", "0.01 m"]]}
BIG = {"kinds.big.diameter": "300 mm", "kinds.big.share": 0.5, "grains.table": False, "grains.diameter": "12 mm"}
BIG |= {"grains.distribution": "uniform", "tank.along": "1 m", "tank.height": "310 mm"}
TABLE = {"grains.table": [["6 mm", 1], ["8 mm", 1]], "grains.distribution": "table"}
YAW = {"amplitude": "5 deg", "frequency": "1 Hz"}
VANE = {"points": [["20 mm", "60 mm"], ["40 mm", "90 mm"]]}
LID = {"points": [["-20 mm", "60 mm"], ["20 mm", "60 mm"]], "move": ["1 mm", "0 mm"]}
LID |= {"speed": "1 m/s", "acceleration": "1 m/s^2"}
AFT = {"width": "100 mm", "height": "100 mm", "length": "100 mm"}

LEVEL = {"gauges.L1.kind": "level", "gauges.L1.y": "210 mm", "gauges.L1.x": "0 mm"}
PLANE = "gauges.L1.x: a gauge has this in space alone; give tank.along, or leave this out"


def gauge(**keys) -> dict[str, object]:
    """A gauge in the side at y = 200 mm, 50 mm above the floor, with these keys."""
    whole = {"place": ["200 mm", "50 mm"], "x": "0 mm"} | keys
    return {f"gauges.P1.{name}": value for name, value in whole.items()}


@pytest.mark.parametrize(
    ("preset", "changes", "said"),
    [
        (CHICKPEAS, WATER, "grains: in space water is alone in its tank so far; leave this out, or tank.along"),
        (SLOSHING, {"air.density": "1.2 kg/m^3"}, "air: in space water is alone in its tank so far"),
        (SLOSHING, {"gauges.P1.place": ["0 mm", "0 mm"]}, "gauges.P1.x: missing for a gauge in space"),
        (SLOSHING, {**gauge(), "gauges.P1.x": "310 mm"}, "gauges.P1.x: 310 mm is outside of the tank"),
        (SLOSHING, {**gauge(), "gauges.P1.length": "5 mm"}, "gauges.P1.length: in space a pressure gauge is a disc"),
        (SLOSHING, gauge(place=["0 mm", "50 mm"]), "gauges.P1.place: [0 m, 50 mm] at x = 0 m is 50 mm away from"),
        (SLOSHING, gauge(radius="51 mm"), "gauges.P1.radius: 51 mm reaches past the edge of its face, which is 50 mm"),
        (SLOSHING, gauge(x="295 mm", radius="6 mm"), "gauges.P1.radius: 6 mm reaches past the edge of its face"),
        (SLOSHING, gauge(kind="force"), "gauges.P1.kind: in space forces on all faces are told without a gauge"),
        (SLOSHING, gauge(kind="level"), 'gauges.P1.place: goes with kind = "pressure"; a level gauge has y and x'),
        (SLOSHING, LEVEL, "gauges.L1.y: 210 mm is outside of the tank, which reaches from -200 mm to 200 mm"),
        ("sloshing/sway-quick", {"gauges.L1.kind": "level", "gauges.L1.y": "0 mm", "gauges.L1.x": "1 mm"}, PLANE),
        (SLOSHING, {"tank.along": "5 mm"}, "tank.along: must be 80 mm or more, two reaches of the water's kernel"),
        (SLOSHING, {"video.colour": "vorticity"}, "video.colour: vorticity is known in the plane only"),
        (SLOSHING, {"water.between_walls": True}, "water.between_walls: this is of the plane alone"),
        (SLOSHING, {"tank.along": False, "tank.turned": True}, "water: water in space fills a tank that is drawn out"),
        (CHICKPEAS, {"tank.roughness": "5 mm"}, "tank.roughness: this is of the plane alone"),
        (CHICKPEAS, {"tank.thickness": "5 mm"}, "tank.thickness: this is of the plane alone"),
        (CHICKPEAS, {"grains.surface": "undisturbed"}, "grains.surface: a bed is levelled in the plane alone"),
        (CHICKPEAS, {"run.integrator": "gear"}, "run.integrator: in space it is verlet or symplectic-euler"),
        (CHICKPEAS, {"tank.along": "15 mm"}, "tank.along: must be more than one grain, 16 mm each"),
        (CHICKPEAS, {"tank.periodic": True, "tank.along": "70 mm"}, "tank.along: must be more than 5 of the largest"),
        (CHICKPEAS, {"tank.turned": True}, "tank.turned: a tank is either turned about its axis or drawn out"),
        (CHICKPEAS, {"tank.turned": "z"}, 'tank.turned: true or false is needed (or "x")'),
        (CHICKPEAS, {"tank.turned": "x"}, "tank.height: a tank that is turned about x is as high as it is wide"),
        (DRUM, {"tank.along": False}, "tank.along: missing; give width and along, or an outline"),
        (DRUM, {"tank.periodic": True}, "tank.periodic: a tank that is turned about x has end walls"),
        (DRUM, {"tank.lid": False}, "tank.lid: this outline has no edge along its top to leave open"),
        (DRUM, {"tank.along": "10 mm"}, "tank.along: must be more than one grain, 12 mm each"),
        (DRUM, {**LOPSIDED, "tank.width": False, "tank.along": False}, "tank.outline: a tank that is turned about x"),
        (DRUM, {**NARROW, "tank.width": False, "tank.along": False}, "tank.outline: its 10 mm along x must be more"),
        (DRUM, {"parts.vane.points": [["0 mm", "0 mm"], ["0 mm", "9 mm"]]}, "parts.vane: no parts stand in a tank"),
        (DRUM, {"grains.count": 12_000}, "grains.count: 12000 grains do not fit into the tank"),
        (DRUM, {"kinds": False}, "grains.layered: kinds of grains that are poured start in layers; add a table"),
        (DRUM, {"grains.diameter": False}, "grains.diameter: missing; a length is needed"),
        (DRUM, {"grains.surface": "disturbed"}, "grains.layered: layers settle as they lie"),
        (DRUM, {**TABLE, "grains.diameter": False}, "kinds.small.diameter: grains.table says how large grains are"),
        (CHICKPEAS, {**BIG, "material.restitution": 0.5}, "kinds.big.diameter: grains of up to 300 mm do not fit"),
        ("tilting/quick", {"tank.periodic": True}, "tank.periodic: goes with the length of a slice; give tank.along"),
        ("tilting/quick", {"contact.twisting": "marshall"}, "contact.twisting: grains twist in space alone"),
        ("space/silo", {"parts.vane": VANE}, "parts.vane.points: in a tank that is turned each part has its like"),
        ("space/silo", {"parts.lid": LID}, "parts.lid: in a tank that is turned a part moves up"),
        (CHICKPEAS, {"grains.depth": "1 m"}, "grains.depth: 1 m must be less than the tank's height"),
        ("space/silo", {"grains.count": 900_000}, "grains.count: 900000 grains do not fit into the region"),
        (
            BARGE,
            {"tank.turned": True, "tank.along": False, "tank.periodic": False},
            "tank.turned: a ship's hold is drawn",
        ),
        (BARGE, {"ship.length": "1 m", "tanks.aft": AFT}, "tanks: a ship has no further tanks in space"),
        (BARGE, {"ship.length": "1 m", "tank.length": "50 mm"}, "tank.along: is longer than her hold, 50 mm"),
        ("tilting/quick", {"motion.yaw": YAW}, "motion.yaw: a tank moves so in space alone; give tank.along"),
        ("space/slice-quick", {"motion.yaw": YAW}, "motion.yaw: a slice of a tank without an end moves in the plane"),
    ],
)
def test_what_does_not_go_in_space_is_refused_in_a_sentence(preset, changes, said):
    """With the key and what to do."""
    with pytest.raises(LabError) as refusal:
        grain_count(load(preset, changes).resolved)
    assert str(refusal.value).startswith(said)


def test_a_recording_has_three_axes():
    """Vectors have three components, rotations three, poses six; a recorded preset says so without the schema."""
    preset = load(CHICKPEAS).resolved
    tables = {one.name: one.shape for table in tables_of(preset, False).values() for one in table}
    assert tables["position"] == tables["velocity"] == tables["spin"] == tables["angle"] == (3,)
    assert tables["pose"] == tables["wall_force"] == (6,)
    assert tables["centre_of_mass"] == (3,)
    assert content(to_table(preset)).axes == 3
    assert content(to_table(load("tilting/quick").resolved)).axes == 2


QUICK = ["space/tilting-box-quick", "space/slice-quick", "space/silo-quick", "space/drum-quick", "space/hold-quick"]


@pytest.mark.parametrize("preset", QUICK)
def test_a_bed_starts_within_its_tank_without_overlaps(preset):
    """And a depth takes the grains that fill its volume to 57 %."""
    from scipy.spatial import cKDTree

    loaded = load(preset).resolved
    scene, position = build(loaded)
    place, radius = position[0], scene.grains.radius[0]
    if scene.solid.period:
        place = np.concatenate([place, np.add(place, [0.0, 0.0, scene.solid.period])])
    pairs = cKDTree(place).query_pairs(2.0 * radius.max(), output_type="ndarray")
    apart = np.linalg.norm(place[pairs[:, 0]] - place[pairs[:, 1]], axis=1)
    assert not np.any(apart < radius[pairs % len(radius)].sum(axis=1) * (1.0 - 1e-9))
    assert np.all(scene.solid.over(filling_outline(loaded)).clear(position[0], filling_outline(loaded), radius))
    if loaded.grains.depth:
        volume = loaded.tank.solid.volume(np.array(loaded.tank.corners), loaded.grains.depth)
        share = np.pi / 6.0 * loaded.sizes.mean_cube * len(radius) / volume
        assert share == pytest.approx(0.57, rel=1e-3)


def test_a_ship_carries_the_plane_s_cargo_in_space():
    """As much mass a metre in a slice as in the plane's slab, of any thickness, and the load counts accordingly."""
    plane, space, coarse = (load(name).resolved for name in ("ship/capsize-map-quick", "space/barge", BARGE))
    a_metre = [grain_count(one) * one.sizes.mean_cube * one.a_metre for one in (plane, space, coarse)]
    np.testing.assert_allclose(a_metre, a_metre[0], rtol=1e-3)
    hold = load(BARGE, {"ship.length": "1 m", "tank.length": "500 mm"}).resolved
    assert hold.a_metre == pytest.approx(0.5 / 0.06)


def test_kinds_of_grains_lie_in_layers_each_with_its_size():
    """In a drum 8 of 38 are large, below; and the small ones above them are closer together than a large one."""
    scene, position = build(load("space/drum-quick").resolved)
    radius, kind, height = scene.grains.radius[0], scene.grains.kind[0], position[0][:, 1]
    assert np.bincount(kind).tolist() == [296, 1111]
    np.testing.assert_allclose(radius, np.array([6e-3, 3e-3])[kind])
    assert (height + radius)[kind == 0].max() < (height - radius)[kind == 1].min()
    assert np.bincount(_ordered(load("space/drum").resolved, 38_000)).tolist() == [8000, 30_000]


def test_a_scene_in_space_is_not_steered():
    with pytest.raises(LabError, match=r"^tank.turned: a scene in space cannot be steered yet"):
        steerable(load("space/silo"))


def test_a_bed_starts_level():
    """Its last layer, which is not full, is filled evenly: the centre lies within three deviations of the middle."""
    loaded = load(CHICKPEAS).resolved
    _, position = build(loaded)
    place = position[0]
    layer = np.count_nonzero(np.abs(place[:, 1] - place[:, 1].max()) < 0.25 * loaded.mean_diameter)
    most = 3.0 * np.sqrt(layer / 12.0) * loaded.tank.width / len(place)
    assert abs(place[:, 0].mean()) < most


def test_a_body_floats_only_in_a_tank_whose_corners_point_outwards():
    """The faces that it touches are planes without ends."""
    notched = ["-0.25 m", "0 m"], ["0.25 m", "0 m"], ["0.25 m", "0.6 m"], ["0 m", "0.55 m"], ["-0.25 m", "0.6 m"]
    changes = {"tank.width": False, "tank.height": False, "tank.outline": [list(corner) for corner in notched]}
    with pytest.raises(LabError, match=r"tank\.outline: a body that floats in space"):
        load("flooding/cabin", changes)
