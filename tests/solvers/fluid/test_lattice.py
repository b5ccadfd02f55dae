"""The lattice of water at rest: it fills the tank up to the level, and its pressure is hydrostatic."""

import numpy as np
import pytest

from solvers.fluid.given import Water
from solvers.fluid.start.lattice import from_edges, lattice
from solvers.fluid.start.rest import at_rest, hydrostatic_deviation
from solvers.tank.outline import area_below
from solvers.tank.tank import Tank
from tests.oracles.water import kernel

BOX = np.array([(-0.45, 0.0), (0.45, 0.0), (0.45, 0.5), (-0.45, 0.5)])
PRISM = np.array(
    [(-0.1, 0.0), (0.1, 0.0), (0.15, 0.05), (0.15, 0.16), (0.1, 0.21), (-0.1, 0.21), (-0.15, 0.16), (-0.15, 0.05)]
)
TILTED = BOX @ np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])


@pytest.mark.parametrize(
    ("polygon", "level", "spacing"),
    [(BOX, 0.1, 0.01), (BOX, 0.093, 0.00465), (PRISM, 0.0525, 0.0021), (PRISM, 0.18, 0.004), (TILTED, 0.2, 0.01)],
)
def test_the_particles_are_inside_and_their_volumes_are_that_of_the_water(polygon, level, spacing):
    points, volume = lattice(polygon, level, spacing)
    assert Tank(polygon, 1.0).holds(points).all() and points[:, 1].max() < level
    assert from_edges(points, polygon).min() > 0.24 * spacing
    assert len(points) * volume == pytest.approx(area_below(polygon, level - polygon[:, 1].min()), rel=1e-12)
    assert volume == pytest.approx(spacing**2, rel=0.08)


def test_in_a_box_the_gaps_at_the_walls_are_half_of_those_within():
    points, volume = lattice(BOX, 0.093, 0.00465)
    y, z = np.unique(points[:, 0].round(12)), np.unique(points[:, 1].round(12))
    assert len(z) == 20 and np.diff(z) == pytest.approx(0.00465) and z[0] == pytest.approx(0.00465 / 2)
    across = np.diff(y)
    assert np.ptp(across) < 1e-9 and y[0] + 0.45 == pytest.approx(across[0] / 2)
    assert across[0] == pytest.approx(0.00465, rel=0.5 * 0.00465 / 0.9)  # half a spacing over the whole width
    assert volume == pytest.approx(across[0] * 0.00465)


def test_a_region_is_filled_as_a_tank_of_its_own():
    column = np.array([(-0.45, 0.1), (-0.25, 0.1), (-0.25, 0.4), (-0.45, 0.4)])
    points, volume = lattice(column, 0.4, 0.02)
    assert len(points) == 150 and volume == pytest.approx(4e-4)
    assert points.min(axis=0) == pytest.approx((-0.44, 0.11))


@pytest.mark.parametrize(("state", "exponent"), [("linear", 1), ("tait", 7)])
def test_the_pressure_balances_the_weight_at_every_depth(state, exponent):
    """dp/dz = −ρ g of the equation of state, by differences."""
    gravity, sound, depth = 9.81, 5.0, np.linspace(0.0, 0.4, 4001)
    s = hydrostatic_deviation(depth, gravity, sound, state)
    pressure = sound**2 / exponent * ((1.0 + s) ** exponent - 1.0)  # over ρ0
    rise = np.gradient(pressure, depth)[1:-1]
    assert rise == pytest.approx(((1.0 + s) * gravity)[1:-1], rel=1e-6)
    assert s[0] == 0.0 and s[-1] == pytest.approx(gravity * 0.4 / sound**2, rel=0.3)


def test_the_water_weighs_what_its_floor_bears():
    water = Water(spacing=0.005, sound_speed=10.0)
    drops = at_rest(BOX, 0.2, water, 9.81)
    mass = water.density * ((1.0 + drops["deviation"]) * drops["volume"]).sum()
    floor = water.density * 10.0**2 * hydrostatic_deviation(0.2, 9.81, 10.0, "linear")
    assert 9.81 * mass == pytest.approx(0.9 * floor, rel=1e-4)
    assert not drops["velocity"].any()


def test_particles_that_do_not_fit_are_refused():
    sliver = np.array([(0.0, 0.0), (0.1, 0.0), (0.1, 1e-4)])
    with pytest.raises(ValueError, match="no particle of this spacing"):
        lattice(sliver, 1e-4, 0.05)


@pytest.mark.parametrize(("smoothing", "stretch", "shear"), [(2.0, 0.018, 0.007), (2.5, 0.009, -0.001)])
def test_a_square_lattice_under_pressure_is_elastic(smoothing, stretch, shear):
    """Moduli over p, from S_abcd = Σ V ∂²W/∂r_a∂r_b r_c r_d, by differences of −W'/r; none in a liquid."""
    half = np.arange(-6, 7)
    place = np.stack(np.meshgrid(half, half), axis=-1).reshape(-1, 2)
    place = place[(place != 0).any(axis=1)].astype(float)

    def pull(r: np.ndarray) -> np.ndarray:
        return kernel(np.linalg.norm(r, axis=1), smoothing)[1][:, None] * r  # ∇W

    step = 1e-5
    hessian = np.stack([(pull(place + step * e) - pull(place - step * e)) / (2.0 * step) for e in np.eye(2)], axis=-1)
    s = np.einsum("nab,nc,nd->abcd", hessian, place, place)
    along, across, mixed = s[0, 0, 0, 0] - 2.0, s[0, 0, 1, 1], s[0, 1, 0, 1] - 1.0
    assert (along - mixed, across + mixed) == pytest.approx((stretch, shear), abs=6e-4)
