"""Bulk in several tanks of one carrier: none knows of the others."""

import numpy as np
import pytest

from solvers.bulk.given import Bulk
from solvers.bulk.grid import grid_of
from solvers.bulk.start import at_rest
from solvers.motion.harmonic import Roll
from solvers.scene import Scene
from solvers.simulation import Simulation
from solvers.tank.tank import Tank
from tests.oracles.bulk import DENSITY, GRAVITY, bed, box

CELL, WIDE, HIGH = 0.25, 4.0, 3.0
ASIDE = np.array([0.5 * WIDE, 0.0])
LEFT, RIGHT = box(WIDE, HIGH) - ASIDE, box(WIDE, HIGH) + ASIDE
ROLL = Roll(amplitude=np.radians(30.0), frequency=0.25, centre=(0.0, 1.5))


def mirrored(points: np.ndarray) -> np.ndarray:
    """Corners (m, 2) on the other side, counter-clockwise again."""
    return (np.asarray(points) * [-1.0, 1.0])[::-1]


def filled(tanks: list[np.ndarray], regions: list[np.ndarray]) -> Bulk:
    """Bulk in a region of each tank, of one material."""
    material = bed(tanks[0], regions[0], CELL).material
    grid = grid_of([Tank(outline, 1.0) for outline in tanks], CELL)
    how = DENSITY, material.bulk_modulus, material.friction, GRAVITY
    points = [at_rest(np.asarray(region), grid, k, *how) for k, region in enumerate(regions)]
    return Bulk(np.concatenate(points)[None], material, grid, tuple(map(len, points)))


def held(tanks: list[np.ndarray], bulk: Bulk, **more: object) -> Simulation:
    """The simulation of tanks side by side."""
    further = tuple(Tank(outline, 1.0) for outline in tanks[1:])
    scene = Scene(outline=tanks[0], matters=(bulk,), more_tanks=further, schedule="per-world", **more)
    return Simulation(scene, threads=1)


def places(simulation: Simulation, seconds: float) -> np.ndarray:
    """Where the points (n, 2) are after so many seconds."""
    simulation.advance(round(seconds / simulation.dt))
    found = simulation.snapshot()["bulk_position"][0].copy()
    simulation.close()
    return found


def level(outline: np.ndarray, depth: float) -> np.ndarray:
    """The lower part of a box."""
    return np.minimum(outline, [np.inf, depth])


def test_each_of_two_tanks_that_roll_moves_as_it_does_alone():
    """The same places to rounding: of another kernel, since there are more columns. By 3 s both beds have slid."""
    regions = [level(LEFT, 1.5), level(RIGHT, 1.5)]
    both = filled([LEFT, RIGHT], regions)
    together = places(held([LEFT, RIGHT], both, motions=[(ROLL,)]), 3.0)
    start, first = both.points["position"][0], both.fill[0]
    for outline, region, own in ((LEFT, regions[0], slice(0, first)), (RIGHT, regions[1], slice(first, None))):
        alone = places(held([outline], filled([outline], [region]), motions=[(ROLL,)]), 3.0)
        assert together[own] == pytest.approx(alone, abs=1e-9)
        assert np.abs(alone - start[own]).max() > 0.1


def test_mirrored_heaps_collapse_in_mirrored_ways():
    """A steep heap at the outer wall of either tank: the same shift inwards, none of both together."""
    heap = np.array([(-4.0, 0.0), (-1.0, 0.0), (-4.0, 2.5)])
    bulk = filled([LEFT, RIGHT], [heap, mirrored(heap)])
    found = places(held([LEFT, RIGHT], bulk), 2.0)
    first, mass = bulk.fill[0], bulk.points["mass"][0]
    left, right = found[:first], found[first:] * [-1.0, 1.0]
    order = [np.lexsort(np.round(bulk.points["position"][0][own] * sign, 6).T) for own, sign in _halves(first)]
    assert left[order[0]] == pytest.approx(right[order[1]], abs=1e-6)
    moved = mass[:first] @ (left - bulk.points["position"][0][:first])[:, 0] / mass[:first].sum()
    assert moved > 0.05


def _halves(first: int) -> tuple:
    """The points of each tank, and the signs that mirror them onto the left one."""
    return (slice(0, first), [1.0, 1.0]), (slice(first, None), [-1.0, 1.0])


def test_each_tank_bears_the_weight_of_its_own_bed():
    """The load on either is booked on its own piece: half as deep, half of the weight."""
    bulk = filled([LEFT, RIGHT], [level(LEFT, 2.0), level(RIGHT, 1.0)])
    simulation = held([LEFT, RIGHT], bulk)
    simulation.advance(round(2.0 / simulation.dt))
    simulation.observe()
    simulation.advance(round(0.5 / simulation.dt))
    simulation.observe()
    on_pieces = simulation.sampler.on_pieces.to_numpy()[0, :, 1]
    simulation.close()
    weights = DENSITY * GRAVITY * WIDE * np.array([2.0, 1.0])
    assert -on_pieces == pytest.approx(weights, rel=0.01)
