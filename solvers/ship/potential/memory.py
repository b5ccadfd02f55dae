"""Radiation memory of a hull: retardation functions, and linear systems fitted to them.

Cummins' (1962) equation: (M + A_∞) v̇ + ∫₀^∞ K(τ) v(t − τ) dτ + restoring = excitation. By Ogilvie (1964)

    B(ω) = ∫₀^∞ K cos ωt dt,   ω (A(ω) − A_∞) = −∫₀^∞ K sin ωt dt,   K(t) = (2/π) ∫₀^∞ B cos ωt dω,

so that K̂(iω) = ∫₀^∞ K e^(−iωt) dt = B + iω (A − A_∞) is known from the tables.
"""

from dataclasses import dataclass
from math import pi

import numpy as np

from solvers.ship.potential.radiation import Hydrodynamics

TAIL_POWER = 3.0  # B falls as ω^−3 where a wall at the waterline makes waves (Havelock 1929)
TAIL_REACH, TAIL_POINTS = 30.0, 400
ITERATIONS = 30
COUPLED = 1e-4  # of √(K_ii K_jj): a weaker coupling counts as zero by symmetry
MODES = 3


def retardation(frequency: np.ndarray, damping: np.ndarray, time: np.ndarray) -> np.ndarray:
    """K (t, 3, 3) at times (t,) s from B (n, 3, 3) at rising frequencies (n,) rad/s (Ogilvie 1964).

    B is taken as 0 at ω = 0, linear between the table's points (Filon's quadrature) and falling as ω^−3 beyond them.
    """
    beyond = frequency[-1] * np.geomspace(1.0, TAIL_REACH, TAIL_POINTS)[1:]
    tail = damping[-1] * (frequency[-1] / beyond[:, None, None]) ** TAIL_POWER
    omega = np.concatenate([[0.0], frequency, beyond])
    values = np.concatenate([np.zeros((1, *damping.shape[1:])), damping, tail])
    step, middle = np.diff(omega), 0.5 * (omega[1:] + omega[:-1])
    slope = np.diff(values, axis=0) / step[:, None, None]
    t = np.asarray(time, dtype=float)[:, None]
    # ∫ B cos ωt dω by parts; (cos bt − cos at)/t² = −(b² − a²)/2 sinc(mt) sinc((b − a)t/2) has no 0/0.
    kernel = -step * middle * _sinc(middle * t) * _sinc(0.5 * step * t)
    end = values[-1] * (omega[-1] * _sinc(omega[-1] * t))[:, :, None]
    return 2.0 / pi * (end + np.einsum("tn,nij->tij", kernel, slope))


def _sinc(x: np.ndarray) -> np.ndarray:
    return np.sinc(x / pi)


@dataclass(frozen=True, eq=False)
class Memory:
    """A linear system that approximates the retardation: ẋ = `matrix` x + `entry` v, memory force = −`exit` x.

    `matrix` (s, s) 1/s is stable; `entry` is (s, 3), `exit` (3, s) in the units of K; v are the velocities of sway,
    heave and roll. `order` (3,) is the number of states per mode, `error` (3, 3) the rms error of K̂ over the table,
    relative to the rms of √(K̂_ii K̂_jj). `least_damping` is the lowest eigenvalue of the damping matrix over the
    table's range and beyond, relative to its largest (each mode scaled); below zero the system can supply energy.
    """

    matrix: np.ndarray
    entry: np.ndarray
    exit: np.ndarray
    order: np.ndarray
    error: np.ndarray
    least_damping: float

    def transfer(self, frequency: np.ndarray) -> np.ndarray:
        """K̂ (n, 3, 3) of the system at frequencies (n,) rad/s."""
        unit = np.eye(len(self.matrix))
        inverse = np.linalg.inv(1j * np.asarray(frequency)[:, None, None] * unit - self.matrix)
        return self.exit @ inverse @ self.entry

    def retardation(self, time: np.ndarray) -> np.ndarray:
        """K (t, 3, 3) of the system at times (t,) s."""
        values, vectors = np.linalg.eig(self.matrix)
        left, right = self.exit @ vectors, np.linalg.solve(vectors, self.entry)
        decay = np.exp(np.asarray(time, dtype=float)[:, None] * values)
        return np.einsum("is,ts,sj->tij", left, decay, right).real


def padded(memory: "Memory | None", name: str, shape: tuple[int, int]) -> np.ndarray:
    """The array of a memory of that name, with zeros up to a shape; all zeros without a memory."""
    whole = np.zeros(shape)
    if memory is not None:
        part = getattr(memory, name)
        whole[: part.shape[0], : part.shape[1]] = part
    return whole


def fit_memory(table: Hydrodynamics, order: int, deep: bool = True) -> Memory:
    """Fit a system of `order` states per mode to a table's retardation, by least squares.

    Vector fitting (Gustavsen and Semlyen 1999): coupled modes share their poles, which are kept stable. The residues
    are symmetric. In `deep` water they give K̂(0) = 0, since a steady motion makes no waves there. In water of finite
    depth h a slow heave of breadth b does: it radiates long waves, K̂(0) = ρ b² √(g h)/2h.
    """
    transfer = table.damping + 1j * table.frequency[:, None, None] * (table.added_mass - table.infinite_added_mass)
    transfer = 0.5 * (transfer + transfer.transpose(0, 2, 1))
    scale = np.sqrt(np.sqrt((np.abs(np.diagonal(transfer, axis1=1, axis2=2)) ** 2).mean(axis=0)))
    scaled = transfer / np.outer(scale, scale)
    size = np.sqrt((np.abs(scaled) ** 2).mean(axis=0))
    states = MODES * order
    matrix, entry, leave = np.zeros((states, states)), np.zeros((states, MODES)), np.zeros((MODES, states))
    for group in _coupled(size > COUPLED):
        pairs = [(i, j) for i in group for j in group if i <= j and size[i, j] > COUPLED]
        wanted = np.array([scaled[:, i, j] for i, j in pairs])
        poles = _poles(table.frequency, wanted, order)
        residues = _residues(table.frequency, wanted, poles, deep)
        block, drive = _real_system(poles)
        for j in group:
            own = slice(j * order, (j + 1) * order)
            matrix[own, own], entry[own, j] = block, drive
        for (i, j), residue in zip(pairs, residues, strict=True):
            for a, b in {(i, j), (j, i)}:
                leave[a, b * order : (b + 1) * order] = residue * scale[i] * scale[j]
    system = Memory(matrix, entry, leave, np.full(MODES, order), np.zeros((MODES, MODES)), 0.0)
    error = np.sqrt((np.abs(system.transfer(table.frequency) - transfer) ** 2).mean(axis=0)) / np.outer(scale, scale)
    return Memory(matrix, entry, leave, system.order, error, _least_damping(system, table.frequency[-1], scale))


def _coupled(linked: np.ndarray) -> list[list[int]]:
    """Groups of modes that are coupled, directly or through another mode."""
    from scipy.sparse.csgraph import connected_components

    count, label = connected_components(linked, directed=False)
    return [[int(k) for k in np.flatnonzero(label == group)] for group in range(count)]


def _poles(frequency: np.ndarray, wanted: np.ndarray, order: int) -> np.ndarray:
    """Common stable poles (order,), pairs side by side, of functions `wanted` (f, n) at frequencies (n,)."""
    imaginary = np.geomspace(frequency[0] + 0.1 * frequency[-1], frequency[-1], (order + 1) // 2)
    poles = np.concatenate([[-0.3 * w + 1j * w, -0.3 * w - 1j * w] for w in imaginary])[:order]
    if order % 2:
        poles[-1] = poles[-1].real
    for _ in range(ITERATIONS):
        basis = _basis(frequency, poles)
        system, right = [], []
        for k, f in enumerate(wanted):
            row = np.zeros((len(frequency), (len(wanted) + 1) * order), complex)
            row[:, k * order : (k + 1) * order] = basis
            row[:, -order:] = -basis * f[:, None]
            system.append(row)
            right.append(f)
        solution = np.linalg.lstsq(_split(np.concatenate(system)), _split(np.concatenate(right)))[0]
        block, drive = _real_system(poles)
        poles = _ordered(np.linalg.eigvals(block - np.outer(drive, solution[-order:])))
    return poles


def _residues(frequency: np.ndarray, wanted: np.ndarray, poles: np.ndarray, deep: bool) -> np.ndarray:
    """Real residues (f, order) in the basis of the poles, by least squares; in deep water with no force at ω = 0."""
    from scipy.linalg import null_space

    free = null_space(_basis(np.zeros(1), poles).real) if deep else np.eye(len(poles))
    solution = np.linalg.lstsq(_split(_basis(frequency, poles)) @ free, _split(wanted.T))[0]
    return (free @ solution).T


def _real_system(poles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Real matrix (order, order) and input (order,) with given poles; a pair α ± iβ is [[α, β], [−β, α]], [2, 0]."""
    order = len(poles)
    block, drive = np.diag(poles.real), np.ones(order)
    for k in range(order - 1):
        if poles[k].imag > 0.0:
            block[k, k + 1], block[k + 1, k] = poles[k].imag, -poles[k].imag
            drive[k : k + 2] = 2.0, 0.0
    return block, drive


def _basis(frequency: np.ndarray, poles: np.ndarray) -> np.ndarray:
    """Response (n, order) of each state of `_real_system` to a velocity e^(iωt)."""
    block, drive = _real_system(poles)
    return np.linalg.solve(1j * frequency[:, None, None] * np.eye(len(poles)) - block, drive[:, None])[..., 0]


def _ordered(poles: np.ndarray) -> np.ndarray:
    """Poles flipped into the left half-plane: first the pairs, each with its upper pole first, then the real ones."""
    poles = -np.abs(poles.real) + 1j * poles.imag
    upper = poles[poles.imag > 0.0]
    pairs = np.column_stack([upper, upper.conj()]).ravel()
    return np.concatenate([pairs, poles[poles.imag == 0.0]])


def _split(values: np.ndarray) -> np.ndarray:
    return np.concatenate([values.real, values.imag])


def _least_damping(system: Memory, highest: float, scale: np.ndarray) -> float:
    """Lowest eigenvalue of the scaled damping matrix up to twice the highest frequency, over its largest."""
    frequency = np.linspace(0.0, 2.0 * highest, 800)
    damping = system.transfer(frequency).real / np.outer(scale, scale)
    values = np.linalg.eigvalsh(damping)
    return float(values.min() / values.max())
