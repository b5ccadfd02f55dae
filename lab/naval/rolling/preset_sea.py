"""The roll of a preset's ship in her random sea by linear theory, beside what a run of it finds."""

from math import degrees

import numpy as np

from lab.assembly.scene import vessels
from lab.base.errors import LabError
from lab.naval.linear_water import by, linear_motion, table_in_calm
from lab.preset.schema import Preset
from solvers.machine.errors import Unavailable
from solvers.ship.damping.random_roll import Answer, linearised
from solvers.ship.waves import jonswap, pierson_moskowitz

FINE = 2000  # frequencies
HOURS = 3.0
KINDS = "jonswap", "pierson-moskowitz"


def has_spectrum(preset: Preset) -> bool:
    """Whether her waves are those of a spectrum that is known."""
    return bool(preset.ship and preset.waves and preset.waves.kind in KINDS)


def in_her_sea(preset: Preset, hydrodynamics: str) -> Answer:
    """Her roll with the coefficients of her section, of strips or of her hull in space. Raises LabError."""
    preset, waves = by(preset, hydrodynamics), preset.waves
    table, ship = table_in_calm(preset), vessels(preset)[0].ship
    omega = np.geomspace(table.frequency[0], table.frequency[-1], FINE)[1:-1]
    known = jonswap(waves.height, waves.frequency, waves.peakedness) if waves.kind == "jonswap" else None
    density = known or pierson_moskowitz(waves.height, waves.frequency)
    try:
        return linearised(lambda more: linear_motion(preset, omega, more), omega, density, 0.0, ship.damping.quadratic)
    except Unavailable as error:
        raise LabError(f"waves: {error}") from None


def told(answer: Answer) -> str:
    """Her roll in a line."""
    _, mean, sure = answer.largest(3600.0 * HOURS)
    return (
        f"in her sea: significant roll {degrees(answer.significant):.3g} deg, every {answer.period:.3g} s; largest in "
        f"{HOURS:g} h {degrees(mean):.3g} deg on average, below {degrees(sure):.3g} deg with 95 %"
    )
