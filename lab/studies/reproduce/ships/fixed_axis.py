"""Step many ships that roll about a fixed axis together: `motion.sail` for scans, without memory and springs."""

from collections.abc import Sequence

import numpy as np

from solvers.ship.hydrostatics import buoyancy, turned
from solvers.ship.linear import ROLL
from solvers.ship.motion import Ship, runge_kutta
from solvers.ship.waves import soft_start


def roll_together(
    ships: Sequence[Ship], heave: float, interval: float, duration: float, limit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Times (n,) s and rolls (n, k) rad of ships in a regular wave each, from rest, the hull's origin at a heave (m).

    They share section, water and body, and differ in waves, radiation coefficients and damping. Once a roll has passed
    ± `limit` (rad) it is NaN.
    """
    moment = _moment(ships, heave)
    inertia = np.array([ship.inertia(0.0)[ROLL, ROLL] for ship in ships])
    linear = np.array([ship.radiation.damping[ROLL, ROLL] + ship.damping.linear for ship in ships])
    quadratic = np.array([ship.damping.quadratic for ship in ships])

    def rate(state: np.ndarray, time: float) -> np.ndarray:
        roll, speed = state
        resisted = (linear + quadratic * np.abs(speed)) * speed
        return np.array([speed, (moment(roll, time) - resisted) / inertia])

    state, time = np.zeros((2, len(ships))), interval * np.arange(round(duration / interval) + 1)
    rolls = [state[0]]
    for now in time[:-1]:
        state = runge_kutta(rate, state, now, interval)
        state[:, np.abs(state[0]) > limit] = np.nan
        rolls.append(state[0])
    return time, np.array(rolls)


def _moment(ships: Sequence[Ship], heave: float):
    """Function of rolls (k,) and time (s): moment (N) of water and weight on each ship about the axis."""
    first = ships[0]
    load, body, about = first.load, first.body, first.about
    waves = [ship.load.waves for ship in ships]
    amplitude, number, frequency = (
        np.array([getattr(w, name)[0] for w in waves]) for name in ("amplitude", "wave_number", "frequency")
    )
    factors = np.array([ship.load.factors[0] for ship in ships])
    lasts = waves[0].soft_start
    weight, arm = body.mass * first.gravity, tuple(np.subtract(body.centre, about))

    def moment(roll: np.ndarray, time: float) -> np.ndarray:
        place = turned(about, roll)
        y, z = about[0] - place[:, 0], heave + about[1] - place[:, 1]
        crest = soft_start(time, lasts) * amplitude * np.exp(1j * (number * y - frequency * time))
        elevation, slope, *_, excess = (crest[:, None] * factors).real.T
        water = buoyancy(load.section, load.water, z, roll, elevation, slope, about)[:, ROLL]
        return water + excess - weight * turned(arm, roll)[:, 0]

    return moment
