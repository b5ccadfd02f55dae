"""From a preset to the scene: sizes, surfaces, tanks and grains from a file, and the sentences where it cannot be."""

from itertools import product

import numpy as np
import pytest

from lab.assembly.grains import filling_outline, fixed_grains, grain_count
from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset import bed_file
from lab.preset.accuracy import LEVELS
from lab.preset.find import load
from lab.preset.recorded import from_table, to_table
from lab.preset.schema import Preset
from lab.studies.verify.scenes import ACETATE, WEIGHTLESS, Setup, again, grain, simulated
from solvers.grains.checks import DEEPEST_OVERLAP
from solvers.grains.timestep import calm_speed
from tests.oracles.presets import error_of

SMALL = {"tank": {"width": "30 mm", "height": "30 mm"}, "grains": {"depth": "12 mm"}, "run": {"repeats": 2}}
PEAS = {"distribution": "table", "table": [["3 mm", 35.2], ["4 mm", 64.8]]}
REGION = {"grains.region": [["0 mm", "2 mm"], ["10 mm", "2 mm"], ["10 mm", "12 mm"]]}
TRIANGLE = [["0 mm", "0 mm"], ["40 mm", "0 mm"], ["20 mm", "40 mm"]]


def resolved(**sections) -> Preset:
    """The small preset with keys of its sections over it."""
    table = {name: dict(keys) for name, keys in SMALL.items()}
    for name, keys in sections.items():
        table.setdefault(name, {}).update(keys)
    return load("tilting/quick", table).resolved


def fault(**sections) -> str:
    return error_of(lambda: build(resolved(**sections)))


def csv(folder, *rows: str, header: str = "y,z,radius,vy,vz,omega") -> dict:
    """A bed of single grains in a file, as keys of `grains`."""
    path = folder / "bed.csv"
    path.write_text("\n".join([header, *rows]))
    return {"bed": str(path)}


@pytest.mark.parametrize(
    ("keys", "diameter", "low", "high"),
    [
        ({"diameter": "3 mm", "spread": 0.2}, 3e-3, 2.4e-3, 3.6e-3),
        ({"diameter": "3 mm", "spread": 0.1, "distribution": "normal"}, 3e-3, 2.1e-3, 3.9e-3),
        ({"diameter": "2 mm", "spread": 0.4, "distribution": "normal"}, 2e-3, 0.2e-3, 4.4e-3),
        ({"spread": 0.0, **PEAS}, 3.648e-3, 3e-3, 4e-3),
        ({"spread": 0.1, **PEAS}, 3.648e-3, 2.7e-3, 4.4e-3),
    ],
    ids=["uniform", "normal", "wide normal", "table", "spread table"],
)
def test_the_scene_has_the_range_of_its_sizes(keys, diameter, low, high):
    preset = resolved(grains=keys)
    scene, position = build(preset)
    assert preset.mean_diameter == pytest.approx(diameter)
    assert scene.grains.sizes == (pytest.approx(0.5 * low), pytest.approx(0.5 * high))
    assert scene.grains.sizes[0] <= scene.grains.radius.min() and scene.grains.radius.max() <= scene.grains.sizes[1]
    assert position.shape == (*scene.grains.radius.shape, 2)
    assert not np.array_equal(scene.grains.radius[0], scene.grains.radius[1])


def test_the_accuracy_sets_stiffness_and_step_unless_the_preset_does():
    found = {
        (level, scale): build(resolved(run={"accuracy": level}, contact={"stiffness_scale": scale} if scale else {}))[0]
        for level in LEVELS
        for scale in (None, 3e-3)
    }
    for level, sets in LEVELS.items():
        assert found[level, None].grains.stiffness_scale == sets.stiffness_scale
        assert found[level, 3e-3].grains.stiffness_scale == 3e-3
        longest = found[level, 3e-3].step_limits()[0].step * found[level, 3e-3].grains.base_share * sets.longer_steps
        assert 0.99 * longest < found[level, 3e-3].step <= longest
    steps = [found[level, None].step for level in ("draft", "standard", "reference")]
    assert steps == sorted(steps, reverse=True)
    given = build(resolved(run={"accuracy": "draft", "step": "1 us"}))[0]
    assert given.step == pytest.approx(1e-6)


def test_a_step_that_cannot_be_doubled_for_want_of_a_tenth_is_shortened_by_it():
    """The stiffer, the nearer Rayleigh's bound, which no slowness lifts; a collision lasts as v^(−1/5)."""
    seen = set()
    for scale in np.geomspace(1e-3, 1.0, 13):
        scene = build(resolved(run={"accuracy": "standard"}, contact={"stiffness_scale": float(scale)}))[0]
        derived, slowest = scene.step_limits()[0].step, scene.step_limits(0.0)[0].step
        room, calm = slowest / derived, calm_speed(scene, 2.0)
        seen.add(np.digitize(room, (1.8, 2.0)))
        if 1.8 <= room < 2.0:
            assert 0.99 * slowest < 2.0 * scene.step <= slowest
            assert calm == pytest.approx(scene.credible_speed() * room**-5, rel=0.2)
        else:
            assert scene.grains.base_share == 1.0 and scene.step > 0.99 * derived and (calm > 0.0) == (room >= 2.0)
    assert seen == {0, 1, 2}
    afloat = build(load("ship/capsize-map", {"run.repeats": 1}).resolved)[0]
    assert (
        1.8 < afloat.step_limits(0.0)[0].step / afloat.step_limits()[0].step < 2.0 and afloat.grains.base_share == 1.0
    )


def test_the_shares_of_a_table_add_up_to_one_and_may_be_any_numbers():
    preset = resolved(grains=PEAS)
    assert preset.classes == ((3e-3, pytest.approx(0.352)), (4e-3, pytest.approx(0.648)))
    again = from_table(to_table(preset))
    assert again == preset and again.sizes == preset.sizes


@pytest.mark.parametrize("surface", ["undisturbed", "slightly-disturbed", "disturbed"])
def test_the_surface_does_not_change_count_and_sizes(surface):
    plain, _ = build(resolved())
    scene, position = build(resolved(grains={"surface": surface}))
    np.testing.assert_array_equal(scene.grains.radius, plain.grains.radius)
    again = build(resolved(grains={"surface": surface}))[1]
    np.testing.assert_array_equal(position, again)
    assert not np.array_equal(position[0], position[1])


def test_a_tank_without_lid_is_open_at_its_top_and_may_be_filled_to_it():
    preset = resolved(tank={"lid": False}, grains={"depth": "30 mm"})
    assert preset.tank.open_edges == (2,)
    scene, position = build(preset)
    assert scene.open_edges == (2,) and not resolved().tank.open_edges
    assert position[..., 1].max() > 0.03  # the lattice is looser than the bed
    top = filling_outline(preset)[:, 1].max()
    assert np.all(position[..., 1] + scene.grains.radius < top)
    assert np.ptp(scene.outline[:, 1]) == pytest.approx(0.03)
    assert np.abs(position[..., 0]).max() < 0.015


def test_a_closed_tank_is_filled_directly_if_there_is_room():
    preset = resolved()
    np.testing.assert_array_equal(filling_outline(preset), np.array(preset.tank.corners))
    nearly_full = resolved(grains={"depth": "27 mm"})
    raised = filling_outline(nearly_full)
    assert raised[:, 1].max() > 0.03
    position = build(nearly_full)[1]
    assert 0.03 < position[..., 1].max() < raised[:, 1].max()
    with pytest.raises(LabError, match=r"^grains\.depth: .* do not fit the tank"):
        build(resolved(grains={"depth": "27 mm"}, run={"settle": False}))


def test_a_rough_tank_is_lined_with_the_same_grains_in_all_repeats():
    preset = resolved(tank={"roughness": "2 mm"})
    scene, position = build(preset)
    np.testing.assert_array_equal(scene.grains.fixed, fixed_grains(preset))
    assert 2.0 * scene.grains.fixed[:, 2].sum() == pytest.approx(0.09, rel=0.1)
    apart = np.linalg.norm(position[:, :, None] - scene.grains.fixed[:, :2], axis=-1)
    assert np.all(apart > scene.grains.radius[:, :, None] + scene.grains.fixed[:, 2])
    assert grain_count(preset) < grain_count(resolved())
    other = fixed_grains(resolved(tank={"roughness": "2 mm"}, run={"seed": 7}))
    assert not np.array_equal(other[: len(scene.grains.fixed)], scene.grains.fixed[: len(other)])


def test_listed_grains_start_as_given_in_the_file(tmp_path):
    rows = ["-0.005,0.01,0.0015,0.3,0,2", "0.005,0.01,0.001,0,-0.4,0"]
    preset = resolved(grains=csv(tmp_path, *rows), run={"settle": False, "repeats": 3})
    (tmp_path / "bed.csv").unlink()
    preset = from_table(to_table(preset))  # complete without the file
    scene, position = build(preset)
    np.testing.assert_array_equal(position, [[[-0.005, 0.01], [0.005, 0.01]]] * 3)
    np.testing.assert_array_equal(scene.grains.radius, [[0.0015, 0.001]] * 3)
    np.testing.assert_array_equal(scene.grains.velocity, [[[0.3, 0.0], [0.0, -0.4]]] * 3)
    np.testing.assert_array_equal(scene.grains.spin, [[2.0, 0.0]] * 3)
    assert scene.grains.start_speed == pytest.approx(0.5) and scene.grains.sizes == (0.001, 0.0015)
    assert (grain_count(preset), preset.grains.bed.name) == (2, "bed.csv")


def test_listed_grains_may_settle_and_lie_against_each_other_and_the_walls(tmp_path):
    rows = ["-0.0135,0.0015,0.0015", "-0.0105,0.0015,0.0015", "-0.012,0.00409,0.0015"]  # the third sunk in by 1e-6 m
    scene, _ = build(resolved(grains=csv(tmp_path, *rows, header="y,z,radius")))
    assert scene.grains.velocity is None and scene.grains.spin is None and scene.grains.start_speed == 0.0


@pytest.mark.parametrize(
    ("rows", "sentence"),
    [
        (["0,0.01,0.001,1,0,0"], "grains.bed: its grains move, but settle first; "),
        (["0,0.01,0"], "grains.bed: the radius in row 1 must be greater than 0 (got 0)."),
        (["0,0.01,0.001", "0,0.02,-1"], "grains.bed: the radius in row 2 must be greater than 0 (got -1)."),
        (
            ["0,0.02,0.001", "0.1,0.01,0.001"],
            "grains.bed: the grain in row 2, at 100 mm, 10 mm, is not inside the tank.",
        ),
        (["0.0142,0.01,0.001"], "grains.bed: the grain in row 1, at 14.2 mm, 10 mm, is not inside the tank."),
        (
            ["0,0.01,0.001", "0.01,0.01,0.001", "0.004,0.0111,0.0035"],
            "grains.bed: the grains in rows 1 and 3 overlap.",
        ),
        (["0,0.01,0.001", "0,0.011,0.0001"], "grains.bed: the grains in rows 1 and 2 overlap."),
    ],
)
def test_invalid_files_of_grains_are_refused(rows, sentence, tmp_path):
    header = "y,z,radius,vy,vz,omega" if rows[0].count(",") > 2 else "y,z,radius"
    assert fault(grains=csv(tmp_path, *rows, header=header)).startswith(sentence)


def test_a_region_is_filled_without_changing_the_walls():
    preset = load(
        "tilting/quick", {**REGION, "grains.count": 3, "grains.diameter": "1.5 mm", "tank.lid": False}
    ).resolved
    _, position = build(preset)
    y, z = position[..., 0], position[..., 1]
    assert np.all((y > 0) & (y < 0.01) & (z > 0.002) & (z < 0.002 + y))
    np.testing.assert_array_equal(filling_outline(preset), preset.tank.corners)


@pytest.mark.parametrize(
    ("keys", "sentence"),
    [
        ({"depth": "9 mm"}, "grains.region: goes with a count of grains; a depth would fill the whole tank."),
        ({"count": 9, "surface": "disturbed"}, "grains.region: grains in a region settle as they lie;"),
        ({"count": 9, "region": []}, "grains.region: from 3 to 200 corners are needed (got 0)."),
        ({"count": 90}, "grains.count: 90 grains do not fit into the region."),
        ({"count": 5}, "grains.count: 5 grains of up to 3.2"),
    ],
)
def test_errors_of_a_region(keys, sentence):
    with pytest.raises(LabError) as caught:
        build(load("tilting/quick", {**REGION, "grains": keys}).resolved)
    assert str(caught.value).startswith(sentence) and "\n" not in str(caught.value)


def test_unusable_files_of_grains_are_refused(tmp_path):
    assert fault(grains={"bed": str(tmp_path / "absent.csv")}).startswith("grains.bed: ")
    many = ["0,0.01,0.001"] * (bed_file.MOST + 1)
    assert "more than 100000 rows" in fault(grains=csv(tmp_path, *many, header="y,z,radius"))
    listed = csv(tmp_path, "0,0.01,0.001", header="y,z,radius")
    assert fault(grains={**listed, "surface": "disturbed"}).startswith("grains.surface: says how a bed is poured")


@pytest.mark.parametrize(
    ("sections", "sentence"),
    [
        ({"grains": {"table": [["3 mm", 1]]}}, 'grains.table: goes with distribution = "table" (got distribution = "'),
        ({"grains": {"distribution": "table"}}, 'grains.table: goes with distribution = "table" (got no table).'),
        ({"grains": {"distribution": "table", "table": []}}, "grains.table: at least one class is needed"),
        ({"grains": {"distribution": "table", "table": [["3 mm"]]}}, "grains.table[0]: a list of 2 is needed"),
        ({"grains": {"distribution": "table", "table": [[1, "3 mm"]]}}, "grains.table[0][0]: 1 has no unit; a length"),
        ({"grains": {"distribution": "table", "table": [["3 mm", 0]]}}, "grains.table[0][1]: must be greater than 0"),
        ({"grains": {"distribution": "table", "table": [["40 mm", 1]]}}, "grains.table: grains of up to 44 mm do not"),
        ({"grains": {"distribution": "normel"}}, "grains.distribution: \"normel\" is unknown; did you mean 'normal'?"),
        ({"grains": {"distribution": "normal", "diameter": "20 mm", "spread": 0.3}}, "grains.diameter: grains of up t"),
        ({"grains": {"surface": "flat"}}, 'grains.surface: "flat" is unknown; choose one of undisturbed, slightly-d'),
        ({"grains": {"surface": "disturbed"}, "run": {"settle": False}}, "grains.surface: a bed is disturbed by how i"),
        ({"grains": {"depth": "30 mm"}}, "grains.depth: 30 mm must be less than the tank's height, 30 mm."),
        ({"grains": {"depth": "31 mm"}, "tank": {"lid": False}}, "grains.depth: 31 mm is more than the tank's height"),
        ({"tank": {"lid": False, "outline": TRIANGLE}}, "tank.lid: this outline has no edge along its top"),
        ({"tank": {"roughness": "8 mm"}}, "tank.roughness: grains of 8 mm are too large to line the tank."),
        ({"tank": {"roughness": "1 um"}}, "tank.roughness: more than 20000 grains of 1 µm go around."),
    ],
)  # fmt: skip
def test_errors_name_the_key(sections, sentence):
    if "outline" in sections.get("tank", {}):
        with pytest.raises(LabError) as caught:
            load("tilting/quick", {**sections, "grains": {"depth": "12 mm"}})
        assert str(caught.value).startswith(sentence)
    else:
        assert fault(**sections).startswith(sentence)


SPEEDS, YOUNGS = (0.1, 1.0, 10.0, 30.0, 100.0), (100.0, 1e3, 1e5, 1e7, 1e9, 1e11)  # m/s, Pa


@pytest.mark.parametrize("level", [pytest.param(n, marks=() if n == "draft" else pytest.mark.slow) for n in LEVELS])
def test_the_watch_accepts_every_scene_that_is_built(level):
    """Two grains that meet, of any speed and stiffness: refused in one sentence, or run through their impact."""
    built, refused = [], {}
    for case in product(SPEEDS, YOUNGS):
        speed, young = case
        rows = [grain(side * 2e-3, 0.05, 1.5e-3, -0.5 * side * speed) for side in (-1.0, 1.0)]
        material = ACETATE | {"young": young}
        run = {"gravity": WEIGHTLESS, "accuracy": level}
        try:
            built.append((case, Setup(np.array(rows), material, {"width": 0.1, "height": 0.1}, run=run)))
            built[-1] += (built[-1][1].build()[0].step,)
        except LabError as error:
            refused[case] = str(error)
            built.pop()
    assert (0.1, 1e11) not in refused and (100.0, 100.0) in refused
    assert all(said.startswith("contact.stiffness_scale: ") and said.count(". ") == 0 for said in refused.values())
    with simulated(*(setup for _, setup, _ in built)) as run:
        start = run.snapshot()
        for k, (case, _, step) in enumerate(built):
            velocity = np.zeros_like(start["velocity"])
            velocity[k] = start["velocity"][k]
            again(run, start["position"], step, velocity)
            deepest = 0.0
            for _ in range(40):  # 1 mm, and an impact that is at most as deep as a third of a radius
                run.advance(max(1, int(1e-4 / case[0] / step)))
                deepest = max(deepest, run.observe()["overlap"][k])
            assert run.snapshot()["velocity"][k, 0, 0] < 0.0 and deepest < DEEPEST_OVERLAP, case
