"""What a preset may say of bulk, and what is refused with its key and a remedy."""

import math

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.errors import LabError
from lab.preset.find import load
from solvers.bulk.given import Bulk

BOX, HOLD = "bulk/box", "bulk/hold"


@pytest.mark.parametrize(
    ("preset", "changes", "said"),
    [
        (BOX, {"bulk.region": [["0 m", "0 m"], ["1 m", "0 m"], ["0 m", "5 m"]]}, r"bulk\.depth: give either"),
        (
            BOX,
            {"bulk.repose": "20 deg", "bulk.friction": 0.4},
            r"bulk\.repose: give either an angle of repose or a friction",
        ),
        (BOX, {"bulk.wall_friction": 0.5}, r"bulk\.wall_friction: 0\.5 is more than .*set bulk\.rough = true"),
        (BOX, {"bulk.wall_friction": 0.1, "bulk.rough": True}, r"bulk\.rough: .*leave bulk\.wall_friction out"),
        (BOX, {"bulk.fast_friction": 0.2}, r"bulk\.fast_friction: is less than the 0\.32"),
        (BOX, {"bulk.start_friction": 0.2}, r"bulk\.start_friction: is less than the 0\.32"),
        (BOX, {"bulk.depth": "0.9 m"}, r"bulk\.spacing: the bed is .* deep, less than 2 cells"),
        (BOX, {"bulk.depth": "17 m"}, r"bulk\.depth: the tank is 16 m high"),
        (BOX, {"bulk.depth": "-1 m"}, r"bulk\.depth"),
        (BOX, {"bulk.spacing": "9 parsec"}, r"bulk\.spacing"),
        (BOX, {"bulk.spacing": "10 mm"}, r"bulk\.spacing: the tank would have .* cells"),
        (HOLD, {"bulk.spacing": "6 m"}, r"bulk\.spacing: .*make cells of"),
        (BOX, {"tank.lid": False}, r"tank\.lid: bulk needs a closed tank"),
        (BOX, {"water.depth": "1 m", "water.spacing": "0.5 m"}, r"bulk: goes with no \[water\] yet"),
        (BOX, {"tank.along": "5 m"}, r"bulk: is plane only"),
    ],
)
def test_what_cannot_be_is_refused_with_key_and_remedy(preset, changes, said):
    with pytest.raises(LabError, match=said):
        load(preset, changes)


def test_a_region_out_of_the_tank_is_refused():
    with pytest.raises(LabError, match=r"bulk\.region: reaches out of the tank"):
        load("bulk/collapse", {"bulk.region": [["0 m", "0 m"], ["9 m", "0 m"], ["0 m", "1 m"]]})


def test_a_hopper_that_is_too_narrow_for_its_cells_is_refused():
    """Two cells above its point a funnel of 90 deg is four cells wide, one of 60 deg is not."""
    for angle, refused in ((100.0, False), (60.0, True)):
        half = 8.0 * math.tan(math.radians(0.5 * angle))
        outline = [["0 m", "0 m"], [f"{half} m", "8 m"], [f"-{half} m", "8 m"]]
        changes = {"tank.outline": outline, "bulk.depth": "5 m"}
        if refused:
            with pytest.raises(LabError, match=r"two cells above its floor the tank is .* wide"):
                load(HOLD, changes)
        else:
            assert load(HOLD, changes).resolved.bulk.depth == 5.0


def test_a_scene_has_the_mass_and_the_friction_that_were_asked_for():
    preset = load(BOX, {"bulk.spacing": "1 m"}).resolved
    scene, _ = build(preset)
    bulk = scene.of(Bulk)
    assert bulk.mass == pytest.approx(850.0 * 24.0 * 9.0)
    assert bulk.material.friction == 0.32 and bulk.material.wall_friction == 0.32
    assert bulk.material.young == pytest.approx(50.0 * 850.0 * 9.81 * 9.0)
    assert scene.step <= scene.step_limits()[0].step
    assert np.ptp(bulk.points["position"][0, :, 1]) < 9.0


def test_an_angle_of_repose_is_the_tangent_of_friction():
    preset = load("ship/handysize-grain-bulk").resolved
    assert preset.bulk.slow_friction == pytest.approx(math.tan(math.radians(25.0)))
