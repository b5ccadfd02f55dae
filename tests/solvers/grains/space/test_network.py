"""What a network of contacts in space bears: the share of the plane's steps that its largest eigenvalues allow."""

import numpy as np
import pytest
import scipy.sparse as sparse
from scipy.sparse.linalg import eigsh
from scipy.spatial import cKDTree

from solvers.grains.laws.splitting import NETWORK
from solvers.machine.quantity import PLANE, SPACE
from solvers.tank.solids.solid import Prism
from tests.oracles.scenes import box, material, simulation

TOUCH = 2.001  # radii


def crystal(cells):
    """Centres (n, 3) of a face-centred cubic crystal of spheres of radius 1 that touch."""
    sites = np.stack(np.meshgrid(*[np.arange(2 * cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    return np.sqrt(2.0) * sites[sites.sum(axis=1) % 2 == 0]


def sheet(side):
    """Centres (n, 3) of discs of radius 1 in a hexagonal crystal."""
    i, j = np.meshgrid(np.arange(side), np.arange(side))
    return np.stack([2.0 * i + j % 2, np.sqrt(3.0) * j, 0.0 * i], axis=-1).reshape(-1, 3)


def largest(place, tangents):
    """Largest eigenvalues of J M⁻¹ Jᵀ of all contacts' normals, and of their slips, in that of a single contact."""
    pairs = cKDTree(place).query_pairs(TOUCH, output_type="ndarray")
    away = place[pairs[:, 0]] - place[pairs[:, 1]]
    normal = away / np.linalg.norm(away, axis=1)[:, None]
    rows = np.repeat(np.arange(len(pairs)), 3)

    def block(end, vectors):
        columns = (3 * pairs[:, end][:, None] + np.arange(3)).ravel()
        return sparse.csr_matrix((vectors.ravel(), (rows, columns)), shape=(len(pairs), 3 * len(place)))

    pressed = block(0, normal) - block(1, normal)
    first = np.cross(normal, [0.0, 0.0, 1.0]) + 1e-9
    first /= np.linalg.norm(first, axis=1)[:, None]
    slips = []
    for tangent in (first, np.cross(normal, first))[:tangents]:
        arm = -np.cross(normal, tangent)
        spins = (block(0, arm) + block(1, arm)) / np.sqrt(0.4)
        slips.append(sparse.hstack([block(0, tangent) - block(1, tangent), spins]))
    slipped = sparse.vstack(slips)
    shares = (0.5 * pressed @ pressed.T, 2.0 / 7.0 * 0.5 * slipped @ slipped.T)
    return [float(eigsh(matrix, k=1, return_eigenvectors=False)[0]) for matrix in shares]


def test_the_densest_packing_in_space_is_a_third_stiffer_than_that_of_the_plane():
    """3 and 30/7 in the plane, 4 and 40/7 in space, from below: crystals of some hundred grains reach 93 % of these."""
    plane, space = largest(sheet(20), 1), largest(crystal(4), 2)
    for found, limit in zip((*plane, *space), (3.0, 30.0 / 7.0, 4.0, 40.0 / 7.0), strict=True):
        assert 0.93 * limit < found <= limit * (1.0 + 1e-9)
    assert NETWORK[SPACE] / NETWORK[PLANE] == pytest.approx(3.0 / 4.0)


@pytest.mark.slow
@pytest.mark.parametrize("tangential", ["haff-werner", "mindlin"])
def test_a_squeezed_crystal_comes_to_rest_at_the_longest_step(tangential):
    """A crystal pressed by its walls, with spins at random: at the longest step that may be forced it calms down."""
    radius = 1.5e-3
    place = crystal(3) * radius * 0.98
    size = np.ptp(place, axis=0) + 2.0 * radius * 0.98
    place += -place.min(axis=0) + 0.98 * radius - [0.5 * size[0], 0.0, 0.5 * size[2]]
    spin = np.random.default_rng(2).uniform(-30.0, 30.0, place.shape)
    grain = material(friction=0.5, restitution=0.5)
    common = {"tangential": tangential, "gravity": 0.0, "stiffness_scale": 1e-3, "start_speed": 0.5}
    run = simulation(place[None], radius, box(*size[:2]), grain, spin=spin[None], solid=Prism(size[2]), **common)
    limits = run.scene.step_limits()
    step = min(limit.step * limit.forced for limit in limits)
    run.arrays.release()
    run = simulation(
        place[None], radius, box(*size[:2]), grain, spin=spin[None], solid=Prism(size[2]), step=step, **common
    )
    start = run.observe()
    run.advance(2000)
    end = run.observe()
    assert end["rotational"][0] < 0.01 * start["rotational"][0]
    assert end["kinetic"][0] < 1e-3 * start["elastic"][0]
    run.arrays.release()
