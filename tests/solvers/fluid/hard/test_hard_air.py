"""Water and air in hard cases at the step that the lab derives: each runs to its end, keeps its water and its air."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.fluid.checks import residual
from solvers.fluid.given import Air, Fluid, Water
from solvers.fluid.phases.adiabatic import Adiabatic, background
from solvers.fluid.start.air import air_above, air_round, with_air
from solvers.fluid.start.rest import at_rest
from solvers.motion import Sway, Tilt
from solvers.scene import Scene
from solvers.simulation import Simulation
from tests.oracles.given import scene_of
from tests.oracles.water import GRAVITY, box

pytestmark = pytest.mark.slow
WIDTH, HEIGHT, SPACING, SOUND = 0.4, 0.3, 0.01, 14.0  # m, m, m, m/s


def filled(region: np.ndarray | None = None, level: float = 0.15, **changes) -> Scene:
    """A closed box with water up to a level (m) or in a region, the rest of it with air."""
    outline, air = box(WIDTH, HEIGHT), Air(sound_speed=changes.pop("air_sound", SOUND))
    water = Water(SPACING, SOUND, air=air)
    water = replace(water, background=background(air, water))
    if region is None:
        drops = with_air(at_rest(outline, level, water, GRAVITY), air_above(outline, level, water, GRAVITY))
    else:
        drops = with_air(at_rest(region, region[:, 1].max(), water, 0.0), air_round(outline, region, water, GRAVITY))
    given = {"outline": outline, "gravity": GRAVITY, "precision": "mixed"}
    return scene_of(np.zeros((1, 0)), **given, fluid=Fluid(water, drops[None]), **changes)


def course(scene: Scene, times: np.ndarray) -> list[dict[str, np.ndarray]]:
    """What is observed at the start and at the times (s); the run ends by itself if the watch stops it."""
    run = Simulation(scene, threads=1, arch="cpu")
    rows = [run.observe()]
    for time in times:
        run.advance(round(time / run.dt) - run.steps)
        rows.append({**run.observe(), **run.snapshot()})
    run.close()
    return rows


def block(gap: float) -> np.ndarray:
    """A block of water whose flat bottom is over the floor by a gap (m)."""
    return np.array([[-0.1, gap], [0.1, gap], [0.1, gap + 0.1], [-0.1, gap + 0.1]])


@pytest.mark.parametrize("sound", [SOUND, 343.0])
def test_a_film_of_air_under_a_flat_impact(sound):
    """Soft air is squeezed to nothing, real air flows out: neither leaves the tank, and no energy is made."""
    rows = course(filled(block(0.05), air_sound=sound), np.arange(1, 11) * 0.04)
    start, exchanged = residual(rows[0], 0.0)[0], rows[-1]["water_viscous"][0] + rows[-1]["water_diffusive"][0]
    assert residual(rows[-1], start)[0] < 0.01 * exchanged
    place = rows[-1]["water_position"][0]
    assert (np.abs(place[:, 0]) < 0.5 * WIDTH + SPACING).all() and (place[:, 1] > -SPACING).all()


def test_a_tank_that_is_turned_over():
    """By half a turn in two seconds: in the end the water lies on what was the lid."""
    tilt = Tilt(rate=0.5 * np.pi, angle=np.pi, centre=(0.0, 0.5 * HEIGHT))
    rows = course(filled(motions=[(tilt,)]), np.arange(1, 13) * 0.5)
    heights = rows[-1]["water_position"][0, :, 1]
    assert np.mean(heights > 0.5 * HEIGHT) > 0.95
    assert rows[-1]["air_volume"][0] == pytest.approx(WIDTH * 0.5 * HEIGHT, rel=0.03)


def test_a_bubble_of_four_spacings_rises():
    """A dozen particles of air, 60 mm deep: they come up to the air above, or near it, within a second."""
    scene = filled()
    drops = scene.fluid.particles[0]
    inside = (np.hypot(drops["position"][:, 0], drops["position"][:, 1] - 0.08) < 2.0 * SPACING) & (drops["gas"] < 0.5)
    pressure = scene.fluid.water.density * SOUND**2 * drops["deviation"][inside]
    share = pressure / (scene.fluid.water.air.density * SOUND**2)
    drops["gas"][inside], drops["deviation"][inside] = 1.0, Adiabatic.deviation(share)
    drops["velocity"][inside, 1], drops["volume"][inside] = 0.0, SPACING**2
    scene = scene.holding(replace(scene.fluid, particles=drops[np.argsort(drops["gas"], kind="stable")][None]))
    bubble = slice(int((scene.fluid.particles["gas"][0] < 0.5).sum()), None)
    own = (
        np.hypot(
            scene.fluid.particles["position"][0, bubble, 0], scene.fluid.particles["position"][0, bubble, 1] - 0.08
        )
        < 2.0 * SPACING
    )
    rows = course(scene, np.arange(1, 11) * 0.1)
    assert rows[-1]["air_position"][0, own, 1].mean() > 0.13


def test_a_hundred_cycles_do_not_mix_the_phases():
    """Sloshing a third deep, driven near its first frequency: no water stays in the air, nor air in the water."""
    sway = Sway(0.004, 1.2)
    rows = course(filled(level=0.1, motions=[(sway,)]), np.arange(1, 26) * (100.0 / 1.2 / 25.0))
    water, air = rows[-1]["water_position"][0], rows[-1]["air_position"][0]
    near = np.hypot(*(air[:, None] - water[None]).transpose(2, 0, 1)) < 1.6 * SPACING
    drowned = near.sum(axis=1) > 6
    lone = near.sum(axis=0) > 6
    assert drowned.mean() < 0.02 and lone.mean() < 0.05
