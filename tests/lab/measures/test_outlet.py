"""What is measured where grains run out of an outlet: the heap's angle, the rate, arches; made up and run."""

import numpy as np
import pytest

import lab
from lab.measures import measure_all
from lab.recording import open_recording
from tests.oracles.synthetic import box, frame, preset, record

D, HALF, TIP = 0.006, 0.018, 0.20  # m: a grain's diameter, half the outlet's width, its height
PARTS = {
    "right": np.array([(HALF, TIP), (0.2, 0.5)]),
    "gate": np.array([(HALF, TIP), (-HALF, TIP)]),
    "left": np.array([(-0.2, 0.5), (-HALF, TIP)]),
}
MOVES = {
    name: {"points": PARTS[name].tolist(), "move": [0.0, move]}
    for name, move in (("gate", -0.2), ("left", 0.1), ("right", 0.1))
}
FUNNEL = {**preset(), "parts": MOVES, "material": {"density": 1000.0}, "run": {"gravity": 9.81}}
MASS = 1000.0 * np.pi / 6 * D**3


def measured(folder, time, positions, parts=PARTS, resolved=FUNNEL, rise=0.0):
    """Measures of pictures of positions (F, n, 2) of one bed; the plates but the gate have risen by `rise` (m)."""
    count, still = len(positions[0]), np.zeros((len(time), 3))
    moved = np.array([[(0.0, -0.2 if name == "gate" else rise) for name in parts]])
    frames = [
        frame(now, count=count, position=place[None], part=moved) for now, place in zip(time, positions, strict=True)
    ]
    scene = {"radius": np.full((1, count), D / 2), "parts": parts, "resolved": resolved, "outline": box(1.2, 0.7)}
    record(folder, time, pose=still, centre=np.zeros((len(time), 1, 2)), frames=frames, **scene)
    with open_recording(folder) as recording:
        return measure_all(recording)


def heaped(port, starboard, height=0.12, apex=0.01, seed=1):
    """Grains (n, 2) strewn under two slopes (deg), a blunt top, and some at the foot and in the air."""
    random = np.random.default_rng(seed)
    y = random.uniform(-0.5, 0.5, 8000)
    slope = np.tan(np.radians(np.where(y < apex, port, starboard)))
    top = np.minimum(height - np.abs(y - apex) * slope, 0.93 * height)
    y, top = y[top > D], top[top > D]
    deep = np.where(random.uniform(0, 1, len(y)) < 0.3, 1.0, random.uniform(0, 1, len(y)))  # the surface is covered
    z = np.maximum(deep * top - D / 2, D / 2)
    stray = np.stack([random.uniform(-0.58, 0.58, 40), np.full(40, D / 2)], axis=1)
    air = np.array([(0.1, 0.17), (-0.12, 0.15), (0.0, 0.4)])
    return np.concatenate([np.stack([y, z], axis=1), stray, air])


@pytest.mark.parametrize(("port", "starboard"), [(21.0, 21.0), (18.0, 26.0)])
def test_the_angles_of_a_heap_are_found_within_their_errors(tmp_path, port, starboard):
    values = measured(tmp_path, [0.0], [heaped(port, starboard)])
    for name, angle in {"_port": port, "_starboard": starboard, "": (port + starboard) / 2}.items():
        found = values[f"heap_angle{name}"]
        assert 0 < found.uncertainty < 1.5
        assert found.value == pytest.approx(angle, abs=2.5 * found.uncertainty)
    assert values["heap_height"].value == pytest.approx(0.93 * 0.12 / D, abs=1.0)


def test_grains_in_a_rising_funnel_do_not_count_as_heap(tmp_path):
    heap = heaped(21.0, 21.0)
    full = np.concatenate([heap, np.random.default_rng(2).uniform((-0.01, 0.21), (0.01, 0.4), (500, 2))])
    found = [measured(tmp_path / name, [0.0], [bed], rise=0.005) for name, bed in (("a", heap), ("b", full))]
    assert found[0]["heap_angle"].value == found[1]["heap_angle"].value


def test_a_few_grains_on_the_base_do_not_count_as_heap(tmp_path):
    values = measured(tmp_path, [0.0], [heaped(20.0, 20.0, height=4 * D)])
    assert values["heap_angle"].value is None and values["heap_angle"].note == "no heap"


@pytest.mark.parametrize(
    "moves",
    [{}, {"gate": MOVES["gate"] | {"move": [0.0, 0.0]}}, {"left": MOVES["left"]}],
    ids=["none", "still", "other"],
)
def test_without_a_gate_that_opens_there_is_no_outlet(tmp_path, moves):
    values = measured(tmp_path, [0.0, 1.0], [heaped(20.0, 20.0)] * 2, resolved={**FUNNEL, "parts": moves})
    assert not {"heap_angle", "flow_rate", "clogged"} & set(values)


def running_out(time, rate, count=400, end=np.inf, below=False):
    """Positions (F, n, 2): grains that leave the funnel at a rate (1/s) until `end` (s), the last ones held back."""
    leaves = np.arange(count) / rate
    leaves[leaves > end] = np.inf
    fallen = time[:, None] >= leaves
    across = np.tile(np.linspace(-0.5, 0.5, count), (len(time), 1))
    across[~fallen] = 0.0
    z = np.where(fallen, D / 2, TIP + 0.05)
    if below:
        across[:, 0], z[:, 0] = 0.0, TIP - 2 * D
    return np.stack([across, z], axis=2)


def test_the_rate_is_that_at_which_grains_pass(tmp_path):
    time = np.arange(0, 6.001, 0.04)
    values = measured(tmp_path, time, running_out(time, 100.0))
    assert values["flow_rate"].value == pytest.approx(100.0, rel=0.01)
    assert values["flow_rate"].uncertainty < 2.0
    assert values["mass_flow_rate"].value == pytest.approx(1e5 * MASS, rel=0.01)
    assert values["outlet_width"].value == pytest.approx(6.0)
    assert values["passed_fraction"].value == pytest.approx(100.0)
    assert values["clogged"].value == 0.0


@pytest.mark.parametrize(
    ("end", "below", "clogs"),
    [(2.0, False, 1.0), (2.0, True, 0.0), (5.9, False, 0.0)],
    ids=["an arch", "a heap up to the outlet", "still running"],
)
def test_a_flow_that_stops_over_an_empty_space_has_clogged(tmp_path, end, below, clogs):
    time = np.arange(0, 6.001, 0.04)
    values = measured(tmp_path, time, running_out(time, 50.0, end=end, below=below))
    assert values["clogged"].value == clogs


@pytest.mark.slow
def test_grains_in_a_funnel_stay_until_its_gate_opens_and_run_out(tmp_path):
    given = {"grains": {"count": 100}, "tank": {"roughness": "20 mm"}, "record": {"picture_rate": "100 Hz"}}
    run = {"repeats": 2, "duration": "0.7 s", "accuracy": "draft", "settle": False}
    result = lab.run("funnel/fixed", tmp_path / "run", video=False, quiet=True, run=run, **given)
    with open_recording(result.folder) as recording:
        first, shut = (recording.frames["position"][row] for row in (0, 19))
    for place in (first, shut):
        assert place[..., 1].min() > 0.06 and np.abs(place[..., 0]).max() < 0.1
    assert shut[..., 1].mean() < first[..., 1].mean() - 0.005
    assert result.measures["passed_fraction"].worlds == (100.0, 100.0)
    assert 200.0 < result.measures["flow_rate"].value < 1500.0
    assert (tmp_path / "run" / "heap.png").is_file()


@pytest.mark.slow
def test_the_rate_follows_beverloos_law_in_a_plane(tmp_path):
    """The area A of the grains a second is C sqrt(g) (D - k d)^(3/2): A^(2/3) is linear in D/d, with k about one."""
    given = {"run": {"repeats": 2, "duration": "1.5 s", "accuracy": "draft"}, "grains": {"count": 1500}}
    sizes = {"grains.diameter": "9, 6, 4 mm"}
    result = lab.sweep("funnel/discharge", sizes, tmp_path / "sweep", video=False, quiet=True, **given)
    diameter = np.array([9.0, 6.0, 4.0]) * 1e-3
    rate = np.array([row["flow_rate (1/s)"] for row in result.rows])
    scaled = (rate * np.pi / 4 * diameter**2 / np.sqrt(9.81 * diameter**3)) ** (2 / 3)
    slope, intercept = np.polyfit(2 * HALF / diameter, scaled, 1)
    np.testing.assert_allclose(scaled, slope * 2 * HALF / diameter + intercept, rtol=0.05)
    assert 0.0 < -intercept / slope < 2.0


@pytest.mark.slow
def test_a_sweep_over_the_outlet_of_a_funnel_gives_its_discharge(tmp_path):
    """By the same law, with C and k that hold for the grains: wider outlets carry more, as (D/d - k)^(3/2)."""
    given = {"run": {"repeats": 2, "duration": "1.5 s", "accuracy": "draft"}, "grains": {"count": 1500}}
    widths = {"tank.funnel.outlet": "24, 36, 54 mm"}
    result = lab.sweep("funnel/discharge", widths, tmp_path / "sweep", video=False, quiet=True, **given)
    outlet = np.array([row["outlet_width (d)"] for row in result.rows])
    np.testing.assert_allclose(outlet, [4.0, 6.0, 9.0], rtol=0.03)  # in mean diameters as drawn
    scaled = np.array([row["flow_rate (1/s)"] for row in result.rows]) ** (2 / 3)
    slope, intercept = np.polyfit(outlet, scaled, 1)
    np.testing.assert_allclose(scaled, slope * outlet + intercept, rtol=0.05)
    assert 0.0 < -intercept / slope < 2.0
