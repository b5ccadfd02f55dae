"""A square patch of an ideal liquid that is let go as it turns: its pressure in the middle, without the solver.

The vorticity 2 ω stays uniform, so that u = ω × r + ∇φ with a harmonic φ. Particles of the edge follow u, and there
Bernoulli's equation holds for p = 0, with ψ the whole stream function: ∂φ/∂t + u²/2 + 2 ω ψ + p/ρ = 0. Own derivation.
By symmetry φ + iψ' = Σ c_n z^(4n); the c_n fit φ on the edge by least squares.
"""

import numpy as np

TERMS, MARKERS = 6, 60  # on a side; with 4 to 8 terms the pressure in the middle is the same to 1e-4 up to ωt = 1
STEP = 0.01  # of Runge and Kutta's scheme of fourth order, in 1/ω


def middle_pressure(times: tuple[float, ...]) -> np.ndarray:
    """Pressure in the middle (T,) over ρ ω² L², negative, at times (T,) in 1/ω, whole STEPs, at most 1."""
    side = 0.5 + 0.5j * np.cos(np.pi * (np.arange(MARKERS) + 0.5) / MARKERS)
    state, steps, found = np.stack([side, np.zeros(MARKERS)]), 0, []
    for time in times:
        while steps < round(time / STEP):
            state, steps = stepped(state), steps + 1
        place, potential = state
        velocity, whole, _ = flow(place, potential.real)
        found.append(-fitted(place, -0.5 * np.abs(velocity) ** 2 - 2.0 * whole)[0])
    return np.array(found)


def stepped(state: np.ndarray) -> np.ndarray:
    """The places and potentials (2, m) of the edge a STEP later."""
    first = rate(state)
    second = rate(state + 0.5 * STEP * first)
    third = rate(state + 0.5 * STEP * second)
    return state + STEP / 6.0 * (first + 2.0 * second + 2.0 * third + rate(state + STEP * third))


def rate(state: np.ndarray) -> np.ndarray:
    """Velocity y + iz of the edge, and how fast its φ changes as it moves."""
    velocity, whole, irrotational = flow(state[0], state[1].real)
    work = (velocity.conj() * irrotational).real
    return np.stack([velocity, work - 0.5 * np.abs(velocity) ** 2 - 2.0 * whole])


def flow(place: np.ndarray, potential: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Velocity u, stream function ψ of the whole, and ∇φ at the edge; ω and L are 1."""
    _, factors, reach = fitted(place, potential)
    powers = (place[:, None] / reach) ** orders() * factors
    irrotational = (powers * orders() / place[:, None]).sum(axis=1).conj()
    return irrotational + 1j * place, powers.sum(axis=1).imag - 0.5 * np.abs(place) ** 2, irrotational


def fitted(place: np.ndarray, values: np.ndarray) -> tuple[float, np.ndarray, float]:
    """Constant, complex factors c_n of (z/R)^(4n), and R, whose real part fits values on the edge best."""
    reach = np.abs(place).max()
    powers = (place[:, None] / reach) ** orders()
    columns = np.concatenate([np.ones((len(place), 1)), powers.real, -powers.imag], axis=1)
    weight = np.sqrt(np.abs(np.gradient(place)))
    found = np.linalg.lstsq(columns * weight[:, None], values * weight, rcond=1e-11)[0]
    return found[0], found[1 : TERMS + 1] + 1j * found[TERMS + 1 :], reach


def orders() -> np.ndarray:
    """The powers of z that turns by a right angle leave as they are."""
    return 4 * np.arange(1, TERMS + 1)
