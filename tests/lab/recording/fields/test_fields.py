"""Fields conserve what they spread, and carry the weight above them; water is what it is at its particles."""

import numpy as np
import pytest

import cargolab
from lab.recording.fields.grains import coarse_grained
from lab.recording.fields.grid import grid_over, lucy
from solvers.grains.pressing import NOBODY, Pressing

RANDOM = np.random.default_rng(5)


@pytest.mark.parametrize("axes", [2, 3])
def test_lucys_function_has_the_integral_one(axes):
    r = np.linspace(0.0, 0.7, 200_001)
    ring = 2.0 * np.pi * r if axes == 2 else 4.0 * np.pi * r**2
    assert np.trapezoid(lucy(r, 0.7, axes) * ring, r) == pytest.approx(1.0, rel=1e-8)


def spread(axes: int, count: int = 40, **how) -> dict:
    """Fields of grains at random in a box with room around them; with the sums that they must have."""
    place, velocity = RANDOM.uniform(-1.0, 1.0, (count, axes)), RANDOM.normal(size=(count, axes))
    mass, size = RANDOM.uniform(1.0, 2.0, count), RANDOM.uniform(0.01, 0.02, count)
    pairs = np.array([(one, other) for one in range(6) for other in range(one + 1, 6)] + [(7, NOBODY)])
    force, wall = RANDOM.normal(size=(len(pairs), axes)), RANDOM.uniform(-1.0, 1.0, (len(pairs), axes))
    grid = grid_over(np.full(axes, -1.6), np.full(axes, 1.6), 0.08 if axes == 2 else 0.12)
    pressing = Pressing(pairs, wall, force)
    found = coarse_grained(grid, 0.5, place, velocity, mass, size, pressing, 2.0, **how)
    ends = np.where(pairs[:, 1:] == NOBODY, wall, place[pairs[:, 1]])
    virial = -np.einsum("ka,kb->ab", force, ends - place[pairs[:, 0]])
    cell = grid.spacing**axes
    return {"found": found, "cell": cell, "mass": mass, "size": size, "velocity": velocity, "virial": virial}


@pytest.mark.parametrize("axes", [2, 3])
def test_mass_momentum_place_and_virial_are_kept(axes):
    """Sums over the nodes are those of the grains, to the error of sums over a grid: 0.3 % asked in all."""
    told = spread(axes)
    found, cell, whole = told["found"], told["cell"], tuple(range(axes))
    assert cell * found["density"].sum() == pytest.approx(told["mass"].sum() / 2.0, rel=3e-3)
    assert cell * found["solid"].sum() == pytest.approx(told["size"].sum(), rel=3e-3)
    momentum = cell * np.nansum(found["density"][..., None] * found["velocity"], axis=whole)
    assert momentum == pytest.approx((told["mass"] @ told["velocity"]) / 2.0, abs=3e-3 * told["mass"].sum())
    stress = cell * found["stress"].sum(axis=whole)
    assert stress == pytest.approx(told["virial"] / 2.0, abs=3e-3 * np.abs(told["virial"]).max())


def test_grains_that_are_gone_are_left_out():
    place = np.array([[0.0, 0.0], [np.nan, np.nan], [0.4, 0.0]])
    pressing = Pressing(np.array([[0, 1], [0, 2]]), np.zeros((2, 2)), np.array([[1.0, 0.0], [-3.0, 0.0]]))
    grid = grid_over(np.array([-1.0, -1.0]), np.array([1.0, 1.0]), 0.02)
    found = coarse_grained(grid, 0.3, place, np.zeros((3, 2)), np.ones(3), np.ones(3), pressing, 1.0)
    assert 0.02**2 * found["density"].sum() == pytest.approx(2.0, rel=1e-3)
    assert 0.02**2 * found["stress"][..., 0, 0].sum() == pytest.approx(3.0 * 0.4, rel=1e-3)


@pytest.fixture(scope="module")
def column(tmp_path_factory):
    """Forty smooth grains at rest in a narrow box."""
    rest = {"rate": "1 deg/s", "angle": "0.001 deg", "hold": "0.05 s"}
    preset = cargolab.Preset(
        "tilting/quick",
        tank={"width": "12 mm", "height": "60 mm"},
        grains={"count": 40, "spread": 0.1},
        material={"friction": 0.0},
        motion={"tilt": rest},
        run={"repeats": 1, "threads": 1},
    )
    folder = tmp_path_factory.mktemp("column")
    with cargolab.Simulation(preset, folder / "run", quiet=True) as simulation:
        now = cargolab.fields(simulation)
        simulation.run()
    return preset, cargolab.open(folder / "run"), now


def test_the_upright_stress_carries_the_weight_above(column):
    """Without friction walls carry none: σ_zz times the width is the weight over it, within 8 % of the whole.

    The width of Lucy's function smears the weight of one layer of grains over its neighbours.
    """
    preset, recording, now = column
    fields = cargolab.fields(recording, width=0.003, spacing=0.001)
    grains = 4.0 / 3.0 * np.pi * recording.radius[0] ** 3 * preset["material.density"]
    weight = grains.sum() * preset["run.gravity"]
    carried = fields.stress.sel(axis="z", across="z").sum("y") * 0.001 * preset.values.thickness
    place = recording.frames["position"][-1][0][:, 1]
    above = np.array([grains[place > z].sum() for z in fields.z.values]) * preset["run.gravity"]
    inside = (fields.z > 0.006) & (fields.z < place.max() - 0.006)
    assert np.abs(carried - above).where(inside).max() < 0.08 * weight
    assert set(fields.data_vars) >= {"porosity", "density", "velocity", "stress", "kinetic_stress", "pressure"}
    assert 0.1 < float(fields.porosity.sel(y=0.0, z=0.02, method="nearest")) < 0.35
    assert fields.attrs["width"] == 0.003 and fields.stress.attrs["units"] == "Pa"
    assert now.pressure.sum() == pytest.approx(float(cargolab.fields(recording).pressure.sum()), rel=0.1)


def test_sizes_that_make_no_grid_are_refused(column):
    recording = column[1]
    with pytest.raises(cargolab.Error, match="fields: width and spacing are lengths in m, greater than 0"):
        cargolab.fields(recording, width=-1.0)
    with pytest.raises(cargolab.Error, match=r"more than .* take a larger spacing"):
        cargolab.fields(recording, spacing=1e-6)
    with pytest.raises(cargolab.Error, match="no particles of water"):
        cargolab.water_at(recording, [[0.0, 0.01]])
