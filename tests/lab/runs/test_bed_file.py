"""A bed of a run as a file that another run starts from."""

import numpy as np
import pytest
from click.testing import CliRunner

from lab.base.errors import LabError
from lab.cli import main
from lab.preset.find import load
from lab.preset.recorded import to_table
from lab.runs.bed_file import write_bed
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
    np.testing.assert_allclose(np.array(grains)[:, :2], PLACE[:3], atol=1e-9)  # pictures have 32 bits
    np.testing.assert_allclose(np.array(grains)[:, 2], RADIUS[:3], rtol=1e-8)
    assert not np.array(grains)[:, 3:].any()


def test_a_moving_bed_has_its_velocities(run, tmp_path):
    assert write_bed(run, tmp_path / "bed.csv", 1, moving=True) == (3, 1)
    grains = load(PRESET, {"grains.bed": str(tmp_path / "bed.csv"), "run.settle": False}).resolved.grains.listed
    np.testing.assert_allclose(np.array(grains)[:, 3:5], SPEED[:3], atol=1e-7)
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
