"""Grains and water in one tank beside a sieve, and aboard a ship."""

from dataclasses import replace

import numpy as np
import pytest

from lab.assembly.scene import build
from lab.base.progress import Progress
from lab.preset.find import load
from lab.runs.beds import settled, settling
from solvers.simulation import Simulation
from solvers.tank.parts import Body
from tests.oracles.soaked import DIAMETER, rows, soaked


@pytest.mark.slow
def test_a_sieve_holds_grains_and_lets_water_pass():
    """Grains on a sieve over the floor stay there, and the pressure under it is that of the water's depth, within 2 %.

    Sound runs up and down the tank in 32 ms and makes ± 4 %; the mean over 20 looks in 0.14 s has a quarter of that.
    """
    width, high, level = 0.08, 0.03, 0.08
    sieve = Body(((-0.5 * width, high), (0.5 * width, high)), sieve=True)
    run = soaked(rows(18, 4, 1.05, high + 0.6 * DIAMETER), width, 0.14, level, 80, parts=(sieve,))
    run.advance(run.whole(round(1.0 / run.dt)))
    off = []
    for _ in range(20):
        run.advance(run.whole(round(7e-3 / run.dt)))
        now = run.snapshot()
        height, pressure = now["water_position"][0, :, 1], now["water_pressure"][0]
        under = height < high - 5e-3
        off.append((pressure[under] - 9810.0 * (level - height[under])).mean())
    run.close()
    assert under.sum() > 20
    assert now["position"][0, :, 1].min() > high + 0.45 * DIAMETER
    assert abs(np.mean(off)) < 0.02 * 9810.0 * level


@pytest.mark.slow
def test_a_ship_with_soaked_cargo_rests():
    """In calm water she keeps her draught to 1e-4 of it and her heel to 0.01 deg: her cargo weighs what it should."""
    preset = load("ship/coal-soaked-quick").resolved
    preset = replace(preset, waves=None)
    scene, position = build(preset)
    run = settled(scene, position, settling(preset), lambda *of: Simulation(*of, threads=1, arch="cpu"), Progress(True))
    run.advance(run.whole(1))
    start = run.observe()["pose"][0]
    run.advance(run.whole(round(2.0 / run.dt)))
    moved = run.observe()["pose"][0] - start
    run.close()
    assert abs(moved[1]) < 1e-4 * preset.ship.draught
    assert abs(np.degrees(moved[2])) < 0.01
