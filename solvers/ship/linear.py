"""Small motions: response in the frequency domain, modes and their damping, inertia from a roll period."""

from dataclasses import replace

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.body import Body
from solvers.ship.hydrostatics import stiffness
from solvers.ship.motion import Ship, rate
from solvers.ship.potential.radiation import Hydrodynamics
from solvers.ship.section import Immersible
from solvers.ship.water import Water

STEP = 1e-5  # m, rad, m/s and rad/s, step of the difference quotients
STILL = 1e-4  # of the fastest rate: a slower mode is drift or heel, not an oscillation
GROWTH = 5e-6  # of the fastest rate: growth allowed, some 10 % in a run of a thousand periods
ROLL = 2


def impedance(
    ship: Ship, section: Immersible, water: Water, heave: float, table: Hydrodynamics, roll: float = 0.0
) -> np.ndarray:
    """Impedance Z (n, 3, 3) about P at each frequency of a table, Z x = X: −ω² (M + A) − iω (B + viscous) + C.

    At an equilibrium; x and X are the amplitudes of motion and excitation, as e^(−iωt). Quadratic damping is left out.
    """
    own = replace(ship, radiation=replace(ship.radiation, added_mass=np.zeros((3, 3)))).inertia(roll)
    y, z = ship.lever(roll)
    to_centre = np.array([[1.0, 0.0, -z], [0.0, 1.0, y], [0.0, 0.0, 1.0]])
    spring = to_centre.T @ stiffness(section, ship.body.loading, water, heave, roll) @ to_centre
    viscous = np.diag(ship.rig.damping + np.array([0.0, 0.0, ship.damping.linear]))
    omega = table.frequency[:, None, None]
    inertia, resistance = own + table.added_mass, table.damping + viscous
    return -(omega**2) * inertia - 1j * omega * resistance + spring + np.diag(ship.rig.spring)


def response(
    ship: Ship,
    section: Immersible,
    water: Water,
    heave: float,
    table: Hydrodynamics,
    roll: float = 0.0,
    diffraction: bool = True,
) -> np.ndarray:
    """Complex amplitudes (n, 3) of sway, heave and roll of P per metre of wave amplitude, 0 in fixed modes."""
    free = np.flatnonzero(ship.free)
    force = table.excitation if diffraction else table.froude_krylov
    whole = impedance(ship, section, water, heave, table, roll)
    found = np.zeros((len(table.frequency), 3), complex)
    found[:, free] = np.linalg.solve(whole[:, free[:, None], free], force[:, free, None])[..., 0]
    return found


def inertia_for_roll(
    ship: Ship, section: Immersible, water: Water, heave: float, table: Hydrodynamics, roll: float = 0.0
) -> Body:
    """The ship's body with the inertia whose undamped natural roll frequency is the only one of a table about P.

    There the impedance of roll, with the other free motions eliminated, has no real part. Raises `Unavailable` if the
    inertia would have to be negative: the frequency is too high for the righting moment.
    """
    body = ship.body
    whole = impedance(replace(ship, body=replace(body, inertia=0.0)), section, water, heave, table, roll)[0]
    others = np.array([k for k in np.flatnonzero(ship.free) if k != ROLL], dtype=int)
    seen = whole[ROLL, ROLL]
    if len(others):
        seen = seen - whole[ROLL, others] @ np.linalg.solve(whole[np.ix_(others, others)], whole[others, ROLL])
    inertia = float(seen.real / table.frequency[0] ** 2)
    if inertia <= 0.0:
        raise Unavailable(
            f"no inertia gives a roll of {table.frequency[0]:.4g} rad/s: lower the frequency or the centre of gravity."
        )
    return replace(body, inertia=inertia)


def flow(ship: Ship, state: np.ndarray) -> np.ndarray:
    """Jacobian (6 + s, 6 + s) of the state's rate in calm water, by central differences."""
    calm = replace(ship, load=ship.load.still)
    columns = [rate(calm, state + d, 0.0) - rate(calm, state - d, 0.0) for d in STEP * np.eye(len(state))]
    return np.array(columns).T / (2.0 * STEP)


def oscillations(ship: Ship, state: np.ndarray) -> np.ndarray:
    """Eigenvalues (n,) 1/s of small oscillations about an equilibrium, the least damped first; positive Im only."""
    moving = np.concatenate([np.tile(ship.free, 2), np.ones(len(state) - 6, bool)])
    values = np.linalg.eigvals(flow(ship, state)[np.ix_(moving, moving)])
    values = values[values.imag > STILL * np.abs(values).max()]
    return values[np.argsort(values.real / np.abs(values))[::-1]]


def require_damped(ship: Ship, state: np.ndarray) -> None:
    """Raise `Unavailable` if a small oscillation about an equilibrium grows by itself in calm water.

    A real hull cannot do that: here the fitted radiation memory supplies energy at a frequency with little damping.
    """
    values = oscillations(ship, state)
    if len(values) and values.real.max() > GROWTH * np.abs(values).max():
        worst = values[values.real.argmax()]
        raise Unavailable(
            f"the fitted memory drives the hull at {worst.imag:.4g} rad/s, by {100.0 * worst.real:.3g} % a second: fit "
            "it with another order or a table of more and higher frequencies, or give roll a viscous damping."
        )
