"""Grains and water in one tank: momentum, weight, and the laws of drag."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
import taichi as ti

from lab.studies.verify.wet.laws import di_felice
from solvers.machine import runtime
from solvers.machine.state import State
from solvers.mixture.drag import DRAG
from solvers.simulation import Simulation
from tests.oracles.soaked import DIAMETER, rows, soaked

GRAVITY, WIDTH, LEVEL = 9.81, 0.08, 0.05
DENSITY, VISCOSITY = 1000.0, 1e-3


@pytest.fixture(scope="module")
def run() -> Iterator[Simulation]:
    """Grains that fall into water: 72 of glass, from over its surface."""
    made = soaked(rows(12, 6, 1.05, 0.06), WIDTH, 0.12, LEVEL, 62)
    yield made
    made.close()


def masses(run: Simulation) -> tuple[np.ndarray, np.ndarray]:
    """Masses (n,) kg of the grains and of the particles of water."""
    return run.grains.mass[0], run.water.particles.read(run.water.particles.mass)[0][0] * DIAMETER


def momentum(run: Simulation) -> np.ndarray:
    """The momentum (2,) kg m/s of all that is in the tank."""
    of_grains, of_water = masses(run)
    state = run.grains.grains.velocity
    speed = np.stack([field.to_numpy()[0, : len(of_grains)] for field in state], axis=-1)
    flow = np.stack(run.water.particles.read(*run.water.particles.velocity), axis=-1)[0]
    lift = [field.to_numpy()[0, : len(of_grains)].sum() for field in run.grains.mover.water.lift]
    ahead = 0.5 * run.exchange_interval * run.dt * np.array(lift)  # by which grains are ahead of the water
    return of_grains @ speed + of_water @ flow - ahead


def on_walls(run: Simulation) -> np.ndarray:
    """The impulse (2,) N s on the tank up to now."""
    loads = [matter.load.impulse[:2] for matter in run.matters.values()]
    return np.sum([[field.to_numpy().sum() for field in load] for load in loads], axis=0)


def test_momentum_is_kept_to_rounding(run):
    """What grains and water gain together is gravity's impulse less that on the walls, through splash and landing."""
    run.advance(run.exchange_interval)
    weight = GRAVITY * sum(mass.sum() for mass in masses(run))
    start, borne, begun = momentum(run), on_walls(run), run.time
    for _ in range(4):
        run.advance(run.whole(round(0.06 / run.dt)))
        found = momentum(run) - start + on_walls(run) - borne
        found[1] += weight * (run.time - begun)
        np.testing.assert_allclose(found, 0.0, atol=1e-12 * weight * run.time)
    assert run.snapshot()["position"][0, :, 1].min() < DIAMETER  # grains are at the floor


def test_the_floor_bears_the_weight_of_all(run):
    """At rest, within 1e-3, in the mean over half a second."""
    run.advance(run.whole(round(0.8 / run.dt)))
    of_grains, of_water = on_floor(run, 0.5)
    assert of_grains + of_water == pytest.approx(GRAVITY * sum(mass.sum() for mass in masses(run)), rel=1e-3)


def on_floor(run: Simulation, lasts: float) -> tuple[float, float]:
    """The mean forces (N) of grains and water on the floor, for so long (s) from now on."""
    before, begun = [matter.load.impulse[1].to_numpy().sum() for matter in run.matters.values()], run.time
    run.advance(run.whole(round(lasts / run.dt)))
    after = [matter.load.impulse[1].to_numpy().sum() for matter in run.matters.values()]
    grains, water = np.subtract(before, after) / (run.time - begun)
    return grains, water


def test_a_run_goes_on_from_its_state_bit_for_bit(run):
    """Places of grains and water after a while more are those of a run that was put back in between."""
    kept, found = run.state(), []
    for _ in range(2):
        run.restore(kept)
        run.advance(run.whole(round(0.02 / run.dt)))
        found.append(run.snapshot())
    for name in ("position", "water_position", "water_porosity"):
        np.testing.assert_array_equal(found[0][name], found[1][name])


@pytest.fixture(scope="module")
def coefficient():
    """The laws' coefficients, from the kernels."""
    runtime.initialise(1)
    held = State()
    out = held.holding("out", np.zeros(1), "one")
    held.finish()
    laws = {name: law() for name, law in DRAG.items()}

    @ti.kernel
    def find(law: ti.template(), speed: float, porosity: float, size: float):
        out[0] = law.coefficient(speed, porosity, size, DENSITY, VISCOSITY)

    def found(name: str, speed: float, porosity: float, size: float = DIAMETER) -> float:
        find(laws[name], speed, porosity, size)
        return float(out.to_numpy()[0])

    yield found
    held.release()


def test_laws_of_drag_have_their_limits(coefficient):
    """Ergun's is the pressure drop of 150 and 1.75, Wen and Yu's is Stokes' alone; Gidaspow's is the one or other."""
    speed, porosity, size = 0.02 / 0.4, 0.4, 3e-3  # 20 mm/s through a bed: 1875 + 2187 Pa/m
    drop = 0.6 / porosity * coefficient("ergun", speed, porosity, size) * speed
    assert drop == pytest.approx(1875.0 + 2187.5, rel=1e-3)
    stokes = 18.0 * VISCOSITY / DIAMETER**2
    assert coefficient("wen-yu", 1e-9, 1.0) == pytest.approx(stokes, rel=1e-3)
    assert coefficient("di-felice", 1e-9, 1.0) == pytest.approx(0.75 * 4.8**2 * VISCOSITY / DIAMETER**2, rel=1e-2)
    assert coefficient("gidaspow", speed, 0.4) == pytest.approx(coefficient("ergun", speed, 0.4), rel=0.01)
    assert coefficient("gidaspow", speed, 0.99) == pytest.approx(coefficient("wen-yu", speed, 0.99), rel=0.02)
    for porosity in (0.4, 0.7, 0.95):
        for speed in (1e-3, 0.1, 1.0):
            told = di_felice(speed, porosity, DIAMETER)
            assert coefficient("di-felice", speed, porosity) == pytest.approx(told, rel=1e-5)


@pytest.mark.slow
def test_water_and_grains_that_do_not_meet_move_as_alone():
    """Dry grains far above the water, with the exchange compiled in: as water alone and as grains alone.

    Not bit for bit: the compiler orders the sums of longer kernels otherwise.
    """
    place = rows(12, 2, 1.05, 0.2)
    both = soaked(place, WIDTH, 0.3, LEVEL, 60)
    start = both.water.laying.lay(place)
    step, scene = both.dt, both.scene
    water = Simulation(
        replace(scene, matters=(replace(scene.fluid, particles=start),), mixture=None, motions=[()]),
        threads=1,
        arch="cpu",
    )
    grains = Simulation(replace(scene, matters=(scene.grains,), mixture=None), place, threads=1, arch="cpu")
    steps = both.whole(round(0.05 / step))
    for run in (both, grains):
        run.advance(steps)
    water.advance(steps)
    for name, alone in (("position", grains), ("water_position", water)):
        np.testing.assert_allclose(both.snapshot()[name], alone.snapshot()[name], atol=1e-12 * DIAMETER)
    for run in (both, grains, water):
        run.close()


@pytest.mark.slow
def test_bands_of_a_world_move_as_one():
    """Cut into two, grains and water are where they are as a whole, to what rounding makes of a splash in 60 ms."""
    found = []
    for units in (1, 2):
        run = soaked(rows(12, 6, 1.05, 0.055), WIDTH, 0.12, LEVEL, 62, units=units)
        run.advance(run.whole(round(0.06 / run.dt)))
        found.append(run.snapshot())
        run.close()
    for name in ("position", "water_position"):
        np.testing.assert_allclose(found[0][name], found[1][name], atol=1e-6 * DIAMETER)
