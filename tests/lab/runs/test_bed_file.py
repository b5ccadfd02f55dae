"""A bed of a run as a file that another run starts from."""

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.cli import main
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.runs.bed_file import write_bed
from solvers.grains.bed.relaxing import relaxed
from solvers.grains.timestep import closing_speed
from solvers.tank.solids.solid import Prism
from tests.oracles.presets import error_of
from tests.oracles.synthetic import frame, recorder, sample

PRESET = "tilting/quick"
PLACE = np.array([[-0.02, 0.0015], [0.0, 0.0015], [0.02, 0.0016], [0.0, -0.3]])  # m; the last has fallen out
RADIUS = np.array([0.0015, 0.0014, 0.0016, 0.0015])
SPEED = np.array([[0.1, 0.0], [0.0, -0.2], [0.3, 0.4], [0.0, 0.0]])  # m/s


@pytest.fixture
def run(tmp_path):
    """Two beds of a tilting tank whose grains lie elsewhere in the second, and there in its last picture alone."""
    resolved = load(PRESET).resolved
    outline, radius = np.array(resolved.tank.corners), np.stack([RADIUS, RADIUS])
    with recorder(
        tmp_path, 2, count=4, preset=PRESET, resolved=to_table(resolved), outline=outline, radius=radius
    ) as writer:
        for now, shift in ((0.0, 0.01), (1.0, 0.0)):
            writer.sample(sample(now, 2))
            places = np.stack([np.add(PLACE, [0.005, 0.0]), np.add(PLACE, [shift, 0.0])])
            writer.frame(frame(now, 2, count=4, position=places, velocity=np.stack([0.0 * SPEED, SPEED])))
        writer.close("complete")
    return tmp_path


def test_a_bed_is_written_and_read_again(run, tmp_path):
    told = CliRunner().invoke(main, ["bed", str(run), "--world", "1", "--out", str(tmp_path / "bed.csv")])
    assert told.exit_code == 0 and "3 grains; 1 have left the tank" in told.output
    grains = load(PRESET, {"grains.bed": str(tmp_path / "bed.csv"), "run.settle": False}).resolved.grains.listed
    np.testing.assert_allclose(grains.place[:, :2], PLACE[:3], atol=1e-9)  # pictures have 32 bits
    np.testing.assert_allclose(grains.radius, RADIUS[:3], rtol=1e-8)
    assert not grains.move


def test_a_moving_bed_has_its_velocities(run, tmp_path):
    assert write_bed(run, tmp_path / "bed.csv", 1, moving=True) == (3, 1)
    grains = load(PRESET, {"grains.bed": str(tmp_path / "bed.csv"), "run.settle": False}).resolved.grains.listed
    np.testing.assert_allclose(grains.velocity[:, :2], SPEED[:3], atol=1e-7)
    assert "settle first" in error_of(load, PRESET, {"grains.bed": str(tmp_path / "bed.csv")})


def test_what_is_no_bed_is_refused(run, tmp_path):
    with pytest.raises(LabError, match=r"--world: .* has beds 0 to 1 \(got 2\)"):
        write_bed(run, tmp_path / "bed.csv", 2)


def test_grains_as_soft_as_in_draft_may_lie_as_deep(tmp_path):
    """Two of 1.5 mm pressed together by 2.5 % of it: at a thousandth of the moduli, not at the material's own."""
    (tmp_path / "bed.csv").write_text("y,z,radius\n0,0.0015,0.0015\n0.0029625,0.0015,0.0015\n")
    given = {"grains.bed": str(tmp_path / "bed.csv"), "run.settle": False}
    assert len(load(PRESET, given).resolved.grains.listed) == 2
    assert "overlap" in error_of(load, PRESET, given | {"contact.stiffness_scale": 1.0})


BOX = {"tank.along": "40 mm", "run.settle": False}
ROWS = "0,0.0015,0.0199,0.0015,0\n0,0.0015,-0.0199,0.0015,1\n"  # y, z, x, radius, kind


def in_space(tmp_path, rows=ROWS, header="y,z,x,radius,kind", **given):
    (tmp_path / "bed.csv").write_text(f"{header}\n{rows}")
    return PRESET, BOX | {"grains.bed": str(tmp_path / "bed.csv"), **given}


def test_a_bed_in_space_has_a_third_axis_and_end_walls(tmp_path):
    rows = ROWS.replace("0.0199", "0.01")
    scene, place = build(load(*in_space(tmp_path, rows, **{"kinds.ball.share": 0.5})).resolved)
    np.testing.assert_array_equal(place[0], [[0.0, 0.0015, 0.01], [0.0, 0.0015, -0.01]])
    np.testing.assert_array_equal(scene.grains.kind[0], [0, 1])
    assert "is not inside the tank" in error_of(load, *in_space(tmp_path, **{"kinds.ball.share": 0.5}))


@pytest.mark.parametrize(
    ("rows", "header", "given", "sentence"),
    [
        ("0,0.0015,0.0015\n", "y,z,radius", {}, "in space it has a column x, too"),
        (ROWS, "y,z,x,radius,kind", {"tank.periodic": True, "kinds.ball.share": 0.5}, "rows 1 and 2 overlap"),
        ("0,0.0015,0,0.0015,2\n", "y,z,x,radius,kind", {"kinds.ball.share": 0.5}, "must be a number from 0 to 1"),
        ("0,0.0015,0,0.0015,1\n", "y,z,x,radius,kind", {}, "must be 0, as there are no [kinds]"),
        ("0,0.0015,0,0.0015,0\n", "y,z,x,radius,kind", {"tank.along": None}, "column x is of scenes in space"),
    ],
)
def test_what_is_no_bed_in_space_is_refused(rows, header, given, sentence, tmp_path):
    preset, changes = in_space(tmp_path, rows, header, **given)
    told = error_of(load, preset, {key: value for key, value in changes.items() if value is not None})
    assert sentence in told and told.startswith("grains.bed: ")


@pytest.mark.parametrize("periodic", [True, False])
def test_grains_that_overlap_in_space_are_moved_apart_before_they_settle(periodic, tmp_path):
    """In a slice the two also overlap across its end, by 1.99 of their radii; elsewhere with the end walls."""
    overlapping = np.array([[0.0, 0.1, 0.0199], [0.0, 0.1, -0.0199]])
    radius, solid = np.full(2, 1.5e-3), Prism(0.04, periodic)
    edges = np.array([[[-0.05, 0.0], [0.05, 0.0]]])
    place = relaxed(overlapping, radius, edges, 1e-6, 1e-7, solid)
    apart = 0.04 - np.ptp(place[:, 2]) if periodic else 0.02 - np.abs(place[:, 2]).max() + 1.5e-3
    assert apart == pytest.approx(3e-3, abs=2e-7)


def test_the_fastest_two_of_grains_in_space_meet_even_if_all_move_in_one_plane():
    random = np.random.default_rng(1)
    ways = np.linalg.qr(random.normal(size=(3, 3)))[0][:2]
    velocity = random.normal(size=(40, 2)) @ ways
    apart = np.linalg.norm(velocity[:, None] - velocity, axis=-1).max()
    assert closing_speed(velocity) == pytest.approx(apart, rel=1e-12)
