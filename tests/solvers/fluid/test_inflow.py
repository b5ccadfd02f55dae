"""Water that enters the room of a ship through an opening: how much, when, with what energy; and water that leaves."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import taichi as ti

from solvers.fluid.given import Fluid, Water, particles
from solvers.fluid.inflow.inlet import Inlet, mouth
from solvers.scene import Scene
from solvers.ship.body import Body
from solvers.ship.flooding.openings import Opening, Side, rectangle, through
from solvers.ship.loads import Floating
from solvers.ship.motion import Radiation, Ship
from solvers.ship.section import box as hull
from solvers.ship.vessel import Vessel
from solvers.ship.water import Water as Sea
from solvers.ship.waves import regular
from solvers.simulation import Simulation
from tests.oracles.water import GRAVITY, box, lattice

LENGTH, ALONG, WIDE, HIGH, SPACING = 2.0, 1.0, 0.4, 0.2, 0.0125  # m
AXIS, DRAUGHT, FREE = (0.0, 0.15), 0.15, (False, False, False)
TAKEN = "water_total", "water_viscous", "water_diffusive", "water_wall_energy"
PORT = Inlet(
    ((0.2, 0.04), (0.2, 0.08)), 0, ALONG, 0.5, 0.6
)  # an opening in her starboard side, half as long as the room


def held(keel: float) -> Vessel:
    """A box of 0.5 m × 0.3 m that does not move, her keel at a height (m) over the calm sea."""
    sea = Sea()
    load = Floating(hull(0.5, 0.30), sea, AXIS, regular(0.0, 4.4, sea), np.zeros((1, 3)))
    ship = Ship(Body(75.0, (0.0, 0.1), 2.0), load, Radiation(np.zeros((3, 3)), np.zeros((3, 3))), AXIS, free=FREE)
    return Vessel(ship, (0.0, 0.0), LENGTH, height=keel, sinks=True)


def room(keels: tuple[float, ...] = (-0.15,), inlet: Inlet = PORT, depth: float = 0.0, **changes) -> Scene:
    """A tank on her keel, WIDE and HIGH, with water up to a `depth` (m) and an opening; a world for each keel."""
    sound = 10.0 * np.sqrt(GRAVITY * HIGH)
    drops = lattice(WIDE, depth, SPACING, sound) if depth else particles(1, 0)
    places = round(WIDE * HIGH / SPACING**2) - drops.shape[1]
    more = particles(1, places)
    more["volume"] = SPACING**2
    start = np.tile(np.concatenate([drops, more], axis=1), (len(keels), 1))
    fluid = Fluid(Water(SPACING, sound, alpha=0.1), start, waiting=(places,), inlets=(inlet,))
    given = {"outline": box(WIDE, HIGH), "matters": (fluid,), "vessels": [held(keel) for keel in keels]}
    scene = Scene(**given, gravity=GRAVITY, length=ALONG, thickness=1.0, **changes)
    return replace(scene, step=scene.time_step())


def level(volume: float) -> float:
    """The level (m) of a volume (m³) in the room, over her keel."""
    return volume / (WIDE * ALONG)


def flow(levels: tuple[float, float], inlet: Inlet = PORT, turn: float = 0.0, at: float = 0.0) -> float:
    """The flow (m³/s) by the tool's own law, from the first level (m) to the second, of a ship that is heeled (rad)."""
    middle, size = np.mean(inlet.ends, axis=0), inlet.width
    corners = rectangle((0.0, *middle), inlet.share * inlet.along, size, "side")
    along = np.subtract(*inlet.ends[::-1]) / size
    corners[:, 1:] = middle + (corners[:, 2:] - middle[1]) * along
    opening = Opening("port", ("sea", "room"), corners, inlet.discharge)
    up = np.array([0.0, np.sin(turn), np.cos(turn)])
    height = at + float(np.sin(turn) * middle[0] + np.cos(turn) * middle[1])
    return through(opening, up, height, tuple(map(Side, levels)), GRAVITY, HIGH).water


def integrated(rows: list, sea: float, volume: float = 0.0) -> Iterator[float]:
    """The volume (m³) in the room at the times of rows, the sea so high (m) over her keel; Euler's steps of 5 ms."""
    time = 0.0
    for row in rows:
        while time < row["time"] - 1e-9:
            step = min(5e-3, row["time"] - time)
            volume, time = volume + step * flow((sea, level(volume))), time + step
        yield volume


@pytest.fixture(scope="module")
def filled() -> Iterator[tuple[Simulation, list]]:
    """Two ships, one 5 cm higher than the other, until one is filled to the sea and the other nearly so."""
    run = Simulation(room((-0.15, -0.10)), threads=1, arch="cpu")
    rows, every = [], round(0.05 / run.dt)
    for _ in range(160):
        run.advance(every)
        rows.append(run.observe() | {"time": run.time})
    yield run, rows
    run.close()


@pytest.mark.slow
def test_the_flow_is_that_of_the_tool(filled):
    """For openings at any slope and levels on both sides of them, both ways, to 0.1 % of the largest."""
    heads, rng = filled[0].water.inflow.heads, np.random.default_rng(1)

    @ti.kernel
    def ask(way: float) -> float:
        return ti.cast(heads.through(0, 0, ti.cast(1.0, heads.exact), way), float)

    found, wanted = [], []
    for _ in range(60):
        ends, (sea, inner) = rng.uniform(-0.1, 0.1, 2), rng.uniform(-0.15, 0.15, 2)
        seen = heads.seen.to_numpy()
        seen[0, 0] = *ends, sea, sea, inner
        heads.seen.from_numpy(seen)
        inlet = Inlet(((0.0, ends[0]), (0.03, ends[1])), 0, 1.0, 1.0)
        found.append(0.6 * inlet.width * np.sqrt(2.0 * GRAVITY) * (ask(1.0) - ask(-1.0)))
        wanted.append(flow((sea, inner), inlet))
    assert min(wanted) < -0.01 and max(wanted) > 0.01
    assert found == pytest.approx(wanted, abs=1e-3 * max(wanted))


@pytest.mark.slow
def test_the_water_that_enters_is_that_of_the_flow(filled):
    """By the level as by Q of the tool, integrated: one particle of the volume; and no more than the sea's level."""
    _, rows = filled
    cell = ALONG * SPACING**2
    for row, volume in zip(rows, integrated(rows, 0.15), strict=True):
        assert row["inflow_volume"][0, 0] == pytest.approx(volume, abs=2.0 * cell)
    assert level(rows[-1]["inflow_volume"][0, 0]) == pytest.approx(0.15, abs=2.0 * cell / (WIDE * ALONG))
    assert rows[-1]["inflow_volume"][1, 0] < rows[-1]["inflow_volume"][0, 0] - 20 * cell


@pytest.mark.slow
def test_its_energy_is_accounted_for(filled):
    """What it brings, less what models take and it still has: 1 % of what is exchanged. Its weight is on the walls."""
    _, rows = filled
    last = rows[-1]
    missing = sum(last[name] for name in TAKEN) - last["water_work"] - last["inflow_energy"]
    exchanged = np.abs(last["inflow_energy"]) + last["water_viscous"]
    assert (np.abs(missing) < 0.01 * exchanged).all()
    weight = 1000.0 * GRAVITY * last["inflow_volume"][:, 0] / ALONG
    pushed = -np.mean([row["wall_force"][:, 1] for row in rows[-20:]], axis=0)
    assert pushed == pytest.approx(weight, rel=0.01)


@pytest.mark.slow
def test_a_run_goes_on_bit_for_bit(filled):
    """As one that was not interrupted, while particles enter, in two worlds more and less of them."""
    run, _ = filled
    run.start_clock()
    run.place(np.zeros((2, 0, 2)))
    run.advance(round(0.9 / run.dt))
    kept = run.state()
    run.advance(round(0.2 / run.dt))
    wanted = run.state()
    run.restore(kept)
    run.advance(round(0.2 / run.dt))
    found = run.state()
    assert (found["water.inflow.entered"] != kept["water.inflow.entered"]).all()
    for name, values in wanted.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)


@pytest.fixture(scope="module")
def level_out(filled) -> Iterator[tuple[Simulation, list]]:
    """Two ships with 10 cm of water in the room: the sea is over the opening of one and under that of the other."""
    filled[0].close()  # whoever follows finds its kernels
    run = Simulation(room((-0.15, 0.05), depth=0.1), threads=1, arch="cpu")
    rows, every = [run.observe() | {"time": 0.0}], round(0.05 / run.dt)
    for _ in range(160):
        run.advance(every)
        rows.append(run.observe() | {"time": run.time})
    yield run, rows
    run.close()


@pytest.mark.slow
def test_water_leaves_where_the_level_inside_is_higher(level_out):
    """As the flow of the tool says, to three particles, down to the sill; and the energy that leaves is accounted."""
    _, rows = level_out
    cell, start = ALONG * SPACING**2, 0.1 * WIDE * ALONG
    for row, volume in zip(rows, integrated(rows, -0.05, start), strict=True):
        left = start + row["inflow_volume"][1, 0]
        assert left == pytest.approx(volume, abs=3.0 * cell)
    assert 0.04 < level(left) < 0.05
    first, last = rows[0], rows[-1]
    gained = [last[name] - first[name] for name in TAKEN]
    missing = sum(gained) - last["water_work"] + first["water_work"] - last["inflow_energy"]
    assert (np.abs(missing) < 0.01 * (np.abs(last["inflow_energy"]) + last["water_viscous"])).all()


def test_particles_come_at_the_jet_speed_half_a_spacing_from_the_wall():
    """The mouth lies on the wall that is nearest to the opening, and points into the room."""
    ends, inward = mouth(PORT, box(WIDE, HIGH))
    np.testing.assert_allclose(ends, PORT.ends)
    np.testing.assert_allclose(inward, (-1.0, 0.0))
    over = Inlet(((-0.05, 0.3), (0.05, 0.32)), 0)  # a hatch over the room
    ends, inward = mouth(over, box(WIDE, HIGH))
    np.testing.assert_allclose(ends, ((-0.05, HIGH), (0.05, HIGH)))
    np.testing.assert_allclose(inward, (0.0, -1.0))
