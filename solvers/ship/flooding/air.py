"""The air in rooms that are not vented, whose pressure is p = p_0 (M / V)^n in each.

V is the room that the water leaves it, M what it fills at the pressure p_0 outside, n its index: 1.4 when it has no
time to give off heat (adiabatic), 1 when it has (Boyle 1662). M changes by what flows through the dry parts of
openings: Q = C_d A √(2 Δp / ρ_air), the law of incompressible flow.

Limits: overpressures far below that outside; no heat is reckoned; air that enters below water rises at once.
Units: Pa, m³.
"""

import numpy as np

DENSITY = 1.2  # kg/m³, of air at 20 °C
PRESSURE = 101325.0  # Pa, the standard atmosphere
POCKET = 1e-4  # of a room's volume: between beams and in pipes, so much air always stays


def overpressure(amount: np.ndarray, room: np.ndarray, full: np.ndarray, index: np.ndarray, outside: float):
    """Pressure (Pa) above that outside of amounts (n,) m³ of air in `room` (n,) m³ that water leaves of `full`."""
    pocket = POCKET * full
    return outside * (((np.maximum(amount, 0.0) + pocket) / (np.maximum(room, 0.0) + pocket)) ** index - 1.0)


def as_air(water: float, density: float, upstream: float, index: float, outside: float) -> float:
    """What a flow that was reckoned as of water (m³/s) is of air, as m³/s at the pressure outside.

    The head Δp / ρ g drives air √(ρ / ρ_air) times as fast; `upstream` (Pa) is the overpressure where it comes from.
    """
    return water * np.sqrt(density / DENSITY) * (1.0 + upstream / outside) ** (1.0 / index)
