"""A ship's roll in a JONSWAP sea from abeam by linear theory, with the damping of `damping`."""

from math import degrees, pi

import numpy as np

from lab.base.errors import LabError
from lab.naval.rolling.damping import Asked, Damping
from lab.naval.tables import Table
from solvers.machine.errors import Unavailable
from solvers.ship.damping.random_roll import Afloat, Answer, random_roll
from solvers.ship.waves import jonswap

SOLVED, FINE = 24, 3000  # frequencies of potential flow, and of the response between them
LOW, HIGH = 0.5, 3.0  # of the slower of peak and roll, and of the faster: the range
MOST_STEEP = 0.1  # H_s over the length of waves of the peak period: steeper seas break
HOUR = 3600.0  # s


def in_sea(asked: Asked, found: Damping) -> Answer:
    """Her roll in the sea asked for. Raises LabError for a ship without lines, or a sea that cannot be."""
    rolling = found.rolling
    if rolling.hull is None:
        raise LabError("--sea: needs the lines of her hull, by which waves act on her; give a file of them.")
    height, period = asked.sea
    peak, water = 2.0 * pi / period, rolling.hull.water
    longest = 2.0 * pi / float(water.wave_number(peak))
    if height > MOST_STEEP * longest:
        raise LabError(f"--sea: waves of {period:g} s cannot be {height:g} m high; give height, then peak period.")
    try:
        ship = afloat(found, peak)
        return random_roll(ship, jonswap(height, peak, asked.peakedness), found.linear, found.quadratic)
    except Unavailable as error:
        raise LabError(f"--sea: {error}") from None


def afloat(found: Damping, peak: float) -> Afloat:
    """The ship for small motions in a sea with a peak frequency (rad/s)."""
    rolling, water = found.rolling, found.rolling.hull.water
    low = LOW * min(rolling.frequency, peak)
    high = HIGH * max(rolling.frequency, peak)
    solved = rolling.table(np.geomspace(low, high, SOLVED))
    inertia = rolling.inertia - float(solved.at([rolling.frequency]).added_mass[0, 2, 2])
    if inertia <= 0.0:
        raise Unavailable("her inertia in roll is less than that of the water with her; look at --period.")
    spring = water.density * water.gravity * rolling.waterplane
    return Afloat(solved.at(np.geomspace(low, high, FINE)[1:-1]), rolling.mass, inertia, spring, rolling.spring)


def told(asked: Asked, found: Damping, answer: Answer) -> dict[str, float]:
    """The numbers of her roll in the sea: angles in deg, times in s. Raises LabError for too short a time."""
    try:
        likely, mean, sure = answer.largest(asked.hours * HOUR)
    except Unavailable as error:
        raise LabError(f"--hours: {error}") from None
    return {
        "significant roll deg": degrees(answer.significant),
        "mean period s": answer.period,
        "rolls": answer.cycles(asked.hours * HOUR),
        "most probable largest deg": degrees(likely),
        "mean largest deg": degrees(mean),
        "not exceeded with 95 % deg": degrees(sure),
        "viscous zeta in this sea": float(found.rolling.share(answer.damping)),
    }


def table(answer: Answer) -> Table:
    """The response over frequency."""
    header = "frequency rad/s", "roll per metre of wave deg/m", "waves m2 s", "roll deg2 s"
    turn = degrees(1.0)
    columns = np.column_stack([answer.frequency, turn * answer.ratio, answer.waves, turn**2 * answer.roll])
    return header, [[f"{value:.6g}" for value in row] for row in columns[::10]]
