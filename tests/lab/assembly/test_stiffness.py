"""The stiffness that is derived for grains of very different sizes: the smallest has to stop the largest."""

import pytest

from lab.assembly.scene import build
from lab.preset.accuracy import LEVELS
from lab.preset.find import load
from solvers.grains.checks import DEEPEST_OVERLAP
from solvers.simulation import Simulation

GAP, SPEED = 0.1e-3, 1.0  # m, m/s: of a fall from 5 cm


def struck(folder, ratio: float, level: str):
    """A ball that falls on a row of grains of 1 mm on the floor; nobody gives a stiffness."""
    ball = 0.5e-3 * ratio
    rows = [f"{1.1e-3 * k},0.5e-3,0.5e-3,0" for k in range(-5, 6)] + [f"0.3e-3,{1e-3 + ball + GAP},{ball},{-SPEED}"]
    (folder / "bed.csv").write_text("\n".join(["y,z,radius,vz", *rows]))
    keys = {
        "tank": {"width": "100 mm", "height": "100 mm"},
        "grains": {"bed": str(folder / "bed.csv"), "depth": False, "diameter": False},
        "run": {"accuracy": level, "settle": False, "repeats": 1},
    }
    return load("tilting/quick", keys).resolved


@pytest.mark.parametrize("level", LEVELS)
def test_the_smallest_grain_under_the_largest_is_pressed_as_deep_as_the_level_means_it(tmp_path, level):
    """(ξ/r)^(5/2) = (5/4) M v²/(k r^(5/2)) ~ M/(m E), kept from diameters as 1 to 2 on; up to the material's own E."""
    scale = {ratio: struck(tmp_path, ratio, level).stiffness_scale for ratio in (1.0, 2.0, 4.0, 20.0)}
    assert scale[1.0] == scale[2.0] == LEVELS[level].stiffness_scale
    assert [scale[4.0], scale[20.0]] == pytest.approx([min(1.0, more * scale[2.0]) for more in (8.0, 1000.0)])
    given = load("tilting/quick", {"grains": {"spread": 0.5}, "contact": {"stiffness_scale": 3e-3}}).resolved
    assert given.stiffness_scale == 3e-3


@pytest.mark.slow
@pytest.mark.parametrize("level", ["draft", "standard"])
def test_small_grains_stop_a_ball_of_ten_times_their_size(tmp_path, level):
    """They throw it back, pressed by less than the watch allows."""
    scene, places = build(struck(tmp_path, 10.0, level))
    run, deepest, steps = Simulation(scene, places, 1), 0.0, round(1e-3 / scene.step)
    for _ in range(50):
        run.advance(max(1, steps // 50))
        deepest = max(deepest, float(run.observe()["overlap"][0]))
    upwards = run.snapshot()["velocity"][0, -1, 1]
    run.close()
    assert 0.03 < deepest < DEEPEST_OVERLAP
    assert upwards > 0.0
