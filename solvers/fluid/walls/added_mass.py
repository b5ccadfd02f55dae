"""Wall added mass: how walls resist an acceleration of their tank at once, by the layer of water before them."""

from itertools import pairwise

import numpy as np

from solvers.fluid.given import Water
from solvers.fluid.kernels import KERNELS
from solvers.fluid.walls.wall_layers import WallLayers
from solvers.motion.carrier import per_slab

TINY = 1e-6  # of a smoothing length: half the step of a difference


def wall_added_mass(scene, layers: WallLayers) -> np.ndarray:
    """A (W, 3, 3) of the load F − A a of water as it lies at the start of a scene, per metre of its ships' lengths.

    a is the acceleration of the tanks' origin (y, z, roll). A wall particle w feels it by p_w = … − q_w·a_w with q_w =
    Σ m_f W (r_w − r_f)/Σ V_f W (see `Extrapolation`), and loads the wall by p_w g_w, g_w = V_w Σ V_f (−W'/r)(r_w −
    r_f). So

        A = Σ_w (g_w; r_w × g_w) ⊗ (q_w; r_w × q_w),

    exactly (own derivation): some 0.3 ρ h S of a wetted side S. What is taken from g_w along straight faces
    (`TangentialCorrection`) acts where the water before the wall particle is in the mean. Not clipped: at rest all wall
    particles that see water push.
    """
    found = np.zeros((len(scene.vessels), 3, 3))
    if not len(found):
        return found
    factor, ends, present = per_slab(scene), np.cumsum([0, *scene.fills]), scene.fluid.present
    for w in range(len(found)):
        for tank, (first, end) in enumerate(pairwise(ends)):
            own = (layers.tanks == tank) & (layers.volumes > 0.0)
            there = scene.fluid.particles[w, first:end][present[first:end]]
            if len(there):
                walls = layers.points[own], layers.volumes[own], layers.straight[own]
                of_tank = _of_tank(scene.fluid.water, there, *walls)
                found[w] += factor[w, first] * of_tank
    return found


def _of_tank(
    water: Water, particles: np.ndarray, points: np.ndarray, volumes: np.ndarray, straight: np.ndarray
) -> np.ndarray:
    """A (3, 3) of the wall particles of a tank at `points` (n, 2) m, with `straight` of them, per metre of slab."""
    from scipy.spatial import cKDTree  # slow to import

    pairs = cKDTree(points).sparse_distance_matrix(cKDTree(particles["position"]), water.reach, output_type="ndarray")
    w, f, away = pairs["i"], pairs["j"], pairs["v"]
    kernel, step = KERNELS[water.kernel], TINY * water.length
    near = np.minimum(away + step, water.reach), np.maximum(away - step, 0.0)
    value = kernel.printed(away, water.length)
    steep = (kernel.printed(near[1], water.length) - kernel.printed(near[0], water.length)) / (near[0] - near[1]) / away
    way, volume = points[w] - particles["position"][f], particles["volume"][f]
    heavy = water.density * (1.0 + particles["deviation"][f]) * volume
    seen = np.maximum(np.bincount(w, volume * value, len(points)), 1e-30)
    lever = _summed(w, (heavy * value)[:, None] * way, len(points)) / seen[:, None]
    push = _summed(w, (volume * steep)[:, None] * way, len(points)) * volumes[:, None]
    along = (push * straight).sum(axis=1, keepdims=True) * straight
    before = points - _summed(w, (volume * value)[:, None] * way, len(points)) / seen[:, None]
    return (_turning(points, push) - _turning(before, along)).T @ _turning(points, lever)


def _summed(owner: np.ndarray, values: np.ndarray, count: int) -> np.ndarray:
    """Sums (count, 2) of vectors (n, 2) by their owners."""
    return np.stack([np.bincount(owner, values[:, axis], count) for axis in range(2)], axis=1)


def _turning(points: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Vectors (n, 2) with their moments about the origin, (n, 3)."""
    moment = points[:, 0] * vectors[:, 1] - points[:, 1] * vectors[:, 0]
    return np.concatenate([vectors, moment[:, None]], axis=1)
