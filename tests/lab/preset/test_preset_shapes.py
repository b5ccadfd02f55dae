"""Irregular grains in a preset: valid settings, the outlines drawn from it, and the initial positions."""

import json
from types import SimpleNamespace

import h5py
import numpy as np
import pytest
from PIL import Image
from scipy.spatial import cKDTree

from lab.assembly.drawn import classes
from lab.assembly.grains import filling_outline, grain_count
from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.paint.video import poster, render_grid
from lab.preset.find import load
from lab.preset.recorded import from_table, to_table
from lab.preset.schema import Preset
from lab.preset.sections.shapes import ShapeClass
from lab.recording import Recorder, open_recording
from lab.report.explain import explain
from lab.runs.bed_key import bed_key
from lab.runs.beds import settling
from lab.runs.run import prepare
from lab.runs.runner import run_preset
from solvers.grains.shapes.contour import Contour
from tests.oracles.presets import error_of
from tests.oracles.synthetic import frame, sample

SMALL = {
    "tank": {"width": "60 mm", "height": "60 mm"},
    "grains": {"count": 40},
    "run": {"repeats": 2, "accuracy": "draft"},
}
OVAL = {"descriptors": [0.0, 0.2, 0.05], "phases": ["0 deg", "0 deg", "90 deg"]}
ROUGH = {"spectrum": {"count": 12, "D2": 0.1, "D3": 0.04, "D8": 0.01}}
TWO = {"oval": OVAL | {"diameter": "3 mm", "share": 1}, "rough": ROUGH | {"diameter": "5 mm", "share": 3}}


def loaded(shapes: dict, **sections):
    """A small tank of such grains, with keys of other sections over it."""
    table = {name: dict(keys) for name, keys in SMALL.items()}
    for name, keys in sections.items():
        table.setdefault(name, {}).update(keys)
    return load("tilting/quick", table | {"shapes": shapes})


def resolved(shapes: dict, **sections) -> Preset:
    return loaded(shapes, **sections).resolved


def fault(shapes: dict, **sections) -> str:
    return error_of(lambda: build(resolved(shapes, **sections)))


@pytest.mark.parametrize(
    ("shape", "key", "said"),
    [
        ({}, "shapes.a", "give exactly one of cargo, descriptors, contour, spectrum, disc (got none)"),
        ({"cargo": "rice", "disc": True}, "shapes.a", "(got cargo and disc)"),
        ({"cargo": "ryce"}, "shapes.a.cargo", "did you mean 'rice'?"),
        ({"cargo": "rice", "phases": ["0 deg"]}, "shapes.a.phases", "go with descriptors"),
        ({"descriptors": [0.1, 0.2], "phases": ["0 deg"]}, "shapes.a.descriptors", "each descriptor needs a phase"),
        ({"descriptors": [0.1], "phases": [0.5]}, "shapes.a.phases[0]", "an angle is needed"),
        ({"descriptors": [0.0, 1.2], "phases": ["0 deg"] * 2}, "shapes.a.descriptors", "the polar radius falls to"),
        ({"descriptors": [0.0, 1.2]}, "shapes.a", "random phases"),
        ({"descriptors": [0.0, 2.5]}, "shapes.a.descriptors[1]", "must be less than 2"),
        ({"descriptors": [0.0] * 101}, "shapes.a.descriptors", "at most 100 are possible"),
        ({"spectrum": {"D2": 0.1}}, "shapes.a.spectrum.count", "missing"),
        ({"spectrum": {"count": 20, "d2": 0.1}}, "shapes.a.spectrum.d2", "known here: count, D2"),
        ({"disc": True, "share": 0}, "shapes.a.share", "must be greater than 0"),
        ({"disc": True, "draws": 0}, "shapes.a.draws", "must be at least 1"),
        ({"disc": True, "diameter": "3 g"}, "shapes.a.diameter", "a length"),
        ({"contour": "nowhere.csv"}, "shapes.a.contour", "cannot be read"),
        ({"disc": True, "diameter": "70 mm"}, "shapes.a.diameter", "do not fit into the tank"),
    ],
)
def test_an_invalid_shape_is_refused_with_its_key(shape, key, said):
    sentence = fault({"a": shape})
    assert sentence.startswith(f"{key}: ") and said in sentence


@pytest.mark.parametrize(
    ("sections", "key"),
    [
        ({"grains": {"bed": "bed.csv"}}, "grains.bed"),
        ({"grains": {"surface": "undisturbed"}}, "grains.surface"),
        ({"grains": {"distribution": "table", "table": [["3 mm", 1]]}}, "grains.table"),
        ({"kinds": {"stones": {"share": 0.1, "friction": 0.5}}}, "kinds"),
        ({"contact": {"cohesion": "humid"}, "material": {"humidity": "70 %"}}, "contact.cohesion"),
        ({"contact": {"nodes": 4}}, "contact.nodes"),
        ({"contact": {"outlines": "polygons"}}, "contact.outlines"),
        ({"grains": {"orientation": "30 mm"}}, "grains.orientation"),
        ({"run": {"repeats": 3000}}, "run.repeats"),
    ],
)
def test_settings_incompatible_with_shapes_are_refused_with_their_key(sections, key):
    assert fault(TWO, **sections).startswith(f"{key}: ")


@pytest.mark.parametrize(
    ("section", "key", "value"),
    [("grains", "orientation", "30 deg"), ("contact", "outlines", "nodes"), ("contact", "nodes", 60)],
)
def test_settings_for_shapes_are_refused_without_shapes(section, key, value):
    assert fault({}, **{section: {key: value}}).startswith(f"{section}.{key}: goes with irregular grains")
    assert fault({}, grains={"shares": "mass"}).startswith("grains.shares: goes with shapes")
    assert fault({"a": {**OVAL, "share": 1}, "b": {**OVAL}}).startswith("shapes.b.share: missing")


def test_the_size_of_a_shape_is_its_own_the_grains_or_its_cargos():
    shapes = {"own": {"cargo": "rice", "diameter": "2 mm"}, "all": {"cargo": "rice"}}
    found = resolved(shapes).shape_classes
    assert found["own"].diameter == pytest.approx(2e-3) and found["all"].diameter == pytest.approx(3e-3)
    assert resolved(shapes, grains={"diameter": False}).shape_classes["all"].diameter == pytest.approx(5.09e-3)
    assert "shapes.a.diameter: missing" in fault({"a": {"disc": True}}, grains={"diameter": False})


def test_an_outline_from_a_file_is_found_beside_its_preset(tmp_path):
    angle = np.linspace(0.0, 2.0 * np.pi, 181)[:-1]
    ellipse = np.column_stack([5.0 + 3.0 * np.cos(angle), 7.0 + 2.0 * np.sin(angle)])
    (tmp_path / "tables").mkdir()
    rows = "\n".join(f"{y:.6f},{z:.6f}" for y, z in ellipse)
    (tmp_path / "tables" / "pebble.csv").write_text(f"y,z\n{rows}\n")
    path = tmp_path / "mine.toml"
    path.write_text('title = "pebbles"\nbased_on = "tilting/quick"\n[shapes.pebble]\ncontour = "tables/pebble.csv"\n')
    (outline,) = load(path).resolved.shape_classes["pebble"].outlines()
    exact = 6.0 / np.hypot(2.0 * np.cos(angle), 3.0 * np.sin(angle)) / np.sqrt(6.0)
    np.testing.assert_allclose(outline.polar(angle), exact, rtol=5e-3)
    (tmp_path / "tables" / "pebble.csv").write_text("y,z\n0,0\n1,0\nx,1\n")
    with pytest.raises(LabError, match=r"shapes.pebble.contour: .*pebble.csv, line 4: y"):
        load(path)


@pytest.mark.slow
def test_shares_by_mass_are_those_of_the_masses():
    preset = resolved(TWO, grains={"shares": "mass", "count": 4000}, tank={"width": "1 m", "height": "1 m"})
    scene = build(preset)[0]
    mass = scene.grains.radius**3
    rough = classes(preset)[scene.grains.shapes.which] == 1
    np.testing.assert_allclose((mass * rough).sum(axis=1) / mass.sum(axis=1), 0.75, atol=0.01)
    numbers = [shape.share for shape in preset.shape_classes.values()]
    np.testing.assert_allclose(numbers, np.array([1 / 27, 3 / 125]) / (1 / 27 + 3 / 125))
    assert preset.mean_diameter == pytest.approx(3e-3 * numbers[0] + 5e-3 * numbers[1])


def test_shares_by_number_are_those_of_the_numbers():
    preset = resolved(TWO)
    scene = build(preset)[0]
    np.testing.assert_array_equal((classes(preset)[scene.grains.shapes.which] == 1).sum(axis=1), [30, 30])


def test_sizes_are_spread_about_those_of_the_classes():
    preset = resolved(TWO, grains={"spread": 0.1})
    scene = build(preset)[0]
    of_class = np.array([1.5e-3, 2.5e-3])[classes(preset)[scene.grains.shapes.which]]
    relative = scene.grains.radius / of_class
    assert 0.9 <= relative.min() < 0.93 and 1.07 < relative.max() <= 1.1
    np.testing.assert_allclose(scene.grains.sizes, [1.35e-3, 2.75e-3])


def test_the_outlines_are_centred_and_as_large_as_a_disc_of_radius_one():
    shapes = build(resolved(TWO))[0].grains.shapes
    assert len(shapes.outlines) == 1 + 2 * 25
    for outline in shapes.outlines:
        assert outline.equivalent_radius == pytest.approx(1.0, rel=1e-12)
        np.testing.assert_allclose(outline.centroid, 0.0, atol=1e-8)


def test_each_repeat_is_drawn_from_its_own_seed():
    both, later = build(resolved(TWO)), build(resolved(TWO, run={"seed": 2, "repeats": 1}))
    (two, places), (one, place) = both, later
    np.testing.assert_array_equal(two.grains.radius[1], one.grains.radius[0])
    np.testing.assert_array_equal(two.grains.shapes.angle[1], one.grains.shapes.angle[0])
    np.testing.assert_array_equal(places[1], place[0])
    assert [two.grains.shapes.outlines[k] for k in two.grains.shapes.which[1]] == [
        one.grains.shapes.outlines[k] for k in one.grains.shapes.which[0]
    ]
    assert set(two.grains.shapes.outlines[1:26]).isdisjoint(two.grains.shapes.outlines[26:])
    assert not np.array_equal(two.grains.shapes.angle[0], two.grains.shapes.angle[1])


def test_the_same_outlines_come_from_the_preset_as_it_is_recorded():
    preset = resolved(TWO, grains={"orientation": "30 deg"}, contact={"outlines": "nodes", "nodes": 60})
    table = to_table(preset)
    here, there = (build(one)[0].grains.shapes for one in (preset, from_table(table)))
    assert len(json.dumps(table)) < 10_000
    assert here.outlines == there.outlines and (here.contact, here.nodes) == ("nodes", 60)
    np.testing.assert_array_equal(here.which, there.which)
    np.testing.assert_allclose(there.angle, np.pi / 6)


def test_no_outline_exceeds_the_largest_radius_of_its_class():
    random = np.random.default_rng(1)
    for descriptors in [(0.3,), (0.1, 0.4), (0.05, 0.2, 0.1, 0.0, 0.05), tuple(np.full(12, 0.06))]:
        shape = ShapeClass(1.0, 2e-3, descriptors, None, 40)
        assert max(outline.bounding_radius for outline in shape.outlines(random)) <= shape.reach
    exact = ShapeClass(1.0, 2e-3, (0.0, 0.4), (0.0, 0.0))
    assert exact.reach == pytest.approx(1.4 / np.sqrt(1.08))


@pytest.mark.parametrize(
    "sections",
    [{}, {"grains": {"surface": "disturbed"}}, {"tank": {"lid": False}}, {"grains": {"count": 90}}],
    ids=["level", "thrown", "no lid", "too many for the closed tank"],
)
def test_grains_start_far_enough_apart_to_turn(sections):
    preset = resolved({"rice": {"cargo": "rice", "diameter": "4 mm"}, "disc": {"disc": True}}, **sections)
    scene, position = build(preset)
    reach = (
        scene.grains.radius
        * np.array([outline.bounding_radius for outline in scene.grains.shapes.outlines])[scene.grains.shapes.which]
    )
    raised = filling_outline(preset)
    for places, bound in zip(position, reach, strict=True):
        pairs = cKDTree(places).query_pairs(2.0 * bound.max(), output_type="ndarray")
        apart = np.linalg.norm(places[pairs[:, 0]] - places[pairs[:, 1]], axis=1)
        assert np.all(apart > bound[pairs].sum(axis=1))
        assert np.all(places - bound[:, None] > raised.min(axis=0) - 1e-12)
        assert np.all(places + bound[:, None] < raised.max(axis=0) + 1e-12)


def test_a_depth_is_filled_by_area():
    shapes = {"rice": {"cargo": "rice", "diameter": "4 mm"}}
    preset = resolved(shapes, grains={"depth": "20 mm", "count": False})
    area = grain_count(preset) * build(preset)[0].grains.shapes.outlines[0].with_diameter(4e-3).area
    assert area == pytest.approx(0.81 * 60e-3 * 20e-3, rel=0.01)


@pytest.mark.slow
def test_beds_of_other_outlines_or_angles_are_other_beds():
    def key(**sections) -> str:
        preset = resolved({"rough": ROUGH}, **{"run": {"repeats": 1, "accuracy": "draft"}, **sections})
        scene, position = build(preset)
        about = {"arch": "cpu", "schedule_name": "per-world", "units_a_world": 1, "skin": 1e-4}
        return bed_key(SimpleNamespace(scene=scene, dt=scene.step, **about), 0, position[0], settling(preset))

    same = key(), key(motion={"tilt": {"angle": "20 deg"}})
    others = key(grains={"orientation": "0 deg"}), key(contact={"outlines": "nodes"}), key(grains={"count": 39})
    assert len({*same, *others}) == 4


def test_a_run_records_its_outlines(tmp_path):
    preset = loaded(TWO)
    run = prepare(preset, tmp_path)
    run.make_recording()
    with open_recording(tmp_path) as recording:
        shapes = recording.shapes
        assert shapes.contours == run.scene.grains.shapes.outlines
        np.testing.assert_array_equal(shapes.which, run.scene.grains.shapes.which)
        np.testing.assert_array_equal(shapes.kind, classes(preset.resolved))


def test_a_recording_of_discs_holds_no_outlines_and_damaged_ones_are_refused(tmp_path):
    prepare(loaded({}), tmp_path / "discs").make_recording()
    with h5py.File(tmp_path / "discs" / "recording.h5") as file:
        assert "shapes" not in file
    with open_recording(tmp_path / "discs") as recording:
        assert recording.shapes is None
    prepare(loaded(TWO), tmp_path / "two").make_recording()
    with h5py.File(tmp_path / "two" / "recording.h5", "r+") as file:
        file["shapes/which"][0, 0] = 51
    with pytest.raises(LabError, match="damaged"):
        open_recording(tmp_path / "two")


@pytest.mark.slow
def test_a_run_of_shapes_completes_and_its_summary_describes_them(tmp_path):
    preset = {"shapes": TWO, **SMALL, "motion": {"tilt": {"angle": "1 deg", "rate": "20 deg/s", "hold": "0 s"}}}
    run_preset("tilting/quick", preset | {"video": {"colour": "shape"}}, tmp_path, quiet=True)
    summary = (tmp_path / "summary.md").read_text()
    assert "25 % oval, 75 % rough" in summary and (tmp_path / "video.mp4").exists()


def picture(folder, shapes: dict, angle: float = 0.0) -> np.ndarray:
    """The picture of a bed as it starts, its grains all turned by this angle (rad)."""
    run = prepare(loaded(shapes, run={"repeats": 1}, grains={"diameter": "6 mm"}), folder)
    run.make_recording()
    worlds, count = run.scene.grains.radius.shape
    with Recorder(folder) as recorder:
        recorder.sample(sample(0.0, worlds))
        turned = {"position": run.position, "angle": np.full((worlds, count), angle)}
        recorder.frame(frame(0.0, worlds, count, **turned))
    return np.asarray(Image.open(poster(folder, colour="size", frame="tank", width=640, height=360))).astype(int)


def differing(one: np.ndarray, other: np.ndarray) -> int:
    """Pixels that differ by more than shading."""
    return int((np.abs(one - other).max(axis=-1) > 60).sum())


def test_a_film_shows_outlines_as_they_are_turned(tmp_path):
    oval = {"oval": {"descriptors": [0.0, 0.3], "phases": ["0 deg", "0 deg"]}}
    angles = {"flat": 0.0, "half": np.pi, "up": 0.5 * np.pi}
    flat, half, up = (picture(tmp_path / name, oval, angle) for name, angle in angles.items())
    marks = differing(flat, half)  # after half a turn all that has changed
    assert 40 < marks < 0.25 * differing(flat, up)


def test_a_film_of_round_outlines_is_one_of_discs(tmp_path):
    there, here = picture(tmp_path / "outlines", {"a": {"disc": True}}), picture(tmp_path / "discs", {})
    np.testing.assert_allclose(there, here, atol=3)


@pytest.mark.slow  # each of them is painted above, and grids in `tests/lab/paint/test_video.py`
def test_discs_and_outlines_are_filmed_side_by_side(tmp_path):
    shown = {"discs": {}, "two": TWO}
    for name, shapes in shown.items():
        picture(tmp_path / name, shapes)
    both = render_grid([tmp_path / name for name in shown], list(shown), tmp_path / "both.png", colour="shape")
    assert np.asarray(Image.open(both)).std() > 10


def test_explain_describes_the_shapes():
    text = explain(loaded(TWO))
    assert "25 % oval, the area of a disc of 3 mm: 3 descriptors" in text
    assert "75 % rough, the area of a disc of 5 mm: 12 descriptors, phases at random, 25 outlines a repeat" in text
    assert "51 different ones, continuous" in text and "turned at random" in text


def test_a_disc_among_shapes_is_a_disc():
    (outline,) = resolved({"a": {"disc": True}}).shape_classes["a"].outlines()
    assert outline == Contour(1.0)


@pytest.mark.slow
def test_a_warning_names_sharp_concavities_that_may_gain_energy():
    lobed = {"lobed": {"descriptors": [0.0] * 49 + [0.0133]}}
    assert 'contact.outlines = "area"' in explain(loaded(lobed))
    assert "dents" not in explain(loaded(lobed, contact={"outlines": "area"}))
    assert "dents" not in explain(loaded(TWO))
