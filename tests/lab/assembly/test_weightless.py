"""Grains without gravity: nothing settles, what rests stays at rest, a gas flies straight and cools by Haff's law."""

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.progress import Progress
from lab.preset.find import load
from lab.runs.beds import settled, settling
from solvers.simulation import Simulation

RADIUS, SPEED, RESTITUTION = 1.5e-3, 0.4, 0.8
WEIGHTLESS = {"gravity": "0 m/s^2", "repeats": 1, "duration": "1 s", "accuracy": "standard"}
SMOOTH = {
    "contact": {"normal": "linear", "tangential": "none"},
    "wall": {"restitution": 1.0},
    "motion": {"tilt": False},
}


def gas(folder, places, velocity, width: float):
    """A preset of listed grains with velocities, in a square box whose walls lose nothing; run.settle is left true."""
    rows = [f"{y},{z},{RADIUS},{vy},{vz}" for (y, z), (vy, vz) in zip(places, velocity, strict=True)]
    (folder / "gas.csv").write_text("\n".join(["y,z,radius,vy,vz", *rows]))
    keys = {
        "tank": {"width": f"{width} m", "height": f"{width} m"},
        "grains": {"bed": str(folder / "gas.csv"), "depth": False, "diameter": False},
        "material": {"restitution": RESTITUTION},
        "run": WEIGHTLESS,
    }
    return load("tilting/quick", keys | SMOOTH).resolved


def started(preset) -> Simulation:
    """The run of a preset, ready to start."""
    scene, places = build(preset)
    return settled(scene, places, settling(preset), lambda *given: Simulation(*given, 1), Progress(True))


@pytest.mark.slow
def test_grains_fly_straight_and_meet(tmp_path):
    """Two meet head-on and part with e times their speed; a third passes them by on a straight line."""
    places = [(-0.02, 0.05), (0.02, 0.05), (-0.04, 0.01)]
    run = started(gas(tmp_path, places, [(SPEED, 0.0), (-SPEED, 0.0), (0.2, 0.3)], 0.1))
    steps = round(0.1 / run.dt)
    run.advance(steps)
    state, time = run.snapshot(), steps * run.dt
    run.close()
    assert state["velocity"][0, :2, 0] == pytest.approx([-RESTITUTION * SPEED, RESTITUTION * SPEED], rel=1e-3)
    assert state["position"][0, 2] == pytest.approx(np.array(places[2]) + time * np.array([0.2, 0.3]), abs=1e-9)


@pytest.mark.slow
def test_a_fill_without_gravity_stays_where_it_was_put():
    """Also with run.settle, since nothing can settle; not even the last bit moves."""
    keys = {"run": WEIGHTLESS, "motion": {"tilt": False}, "tank": {"width": "30 mm", "height": "30 mm"}}
    preset = load("tilting/quick", keys | {"grains": {"depth": "12 mm"}}).resolved
    places = build(preset)[1]
    run = started(preset)
    run.advance(200)
    assert np.array_equal(run.snapshot()["position"], places)
    run.close()


@pytest.mark.slow
def test_a_gas_cools_by_haffs_law(tmp_path):
    """T = T₀/(1 + ζ t/2)² with ζ = (1 − e²) ω/2, ω = 2 √π χ n σ √(T₀/m) (Haff 1983; van Noije and Ernst 1998, d = 2).

    χ = (1 − 7φ/16)/(1 − φ)² of hard discs (Henderson 1975). Centres keep a radius from the walls, so n is that of the
    smaller square. √(T₀/T) − 1 is the mean over some 3 N collisions with an error of 1/√(3 N) each, 4 %; the grains
    near walls meet fewer others, over a share of about 2 σ/width of the square, 5 %.
    """
    across, width, rng = 14, 0.1, np.random.default_rng(4)
    pitch = width / across
    places = (np.stack(np.meshgrid(np.arange(across), np.arange(across)), axis=-1).reshape(-1, 2) + 0.5) * pitch
    velocity = rng.normal(size=places.shape) * SPEED / np.sqrt(2.0)
    velocity -= velocity.mean(axis=0)
    run = started(gas(tmp_path, places - [width / 2, 0.0], velocity, width))
    hot = (velocity**2).mean()  # T₀/m
    density, size = len(places) / (width - 2.0 * RADIUS) ** 2, 2.0 * RADIUS
    covered = density * np.pi * RADIUS**2
    contact = (1.0 - 7.0 / 16.0 * covered) / (1.0 - covered) ** 2
    rate = 2.0 * np.sqrt(np.pi) * contact * density * size * np.sqrt(hot)
    cooling = 0.25 * (1.0 - RESTITUTION**2) * rate
    time = 6.0 / rate
    run.advance(round(time / run.dt))
    cold = (run.snapshot()["velocity"] ** 2).mean()
    run.close()
    assert np.sqrt(hot / cold) - 1.0 == pytest.approx(cooling * time, rel=0.1)
