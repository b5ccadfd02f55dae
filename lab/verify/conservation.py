"""What must be kept: momenta and energy, and the source's own checks of its code (Spandonidis 2016, tables 4.3, 6.3)."""

import numpy as np

from lab.verify.case import Case, Found, Line
from lab.verify.references import sphere_mass
from lab.verify.scenes import ACETATE, WEIGHTLESS, Setup, grain, simulated

SECTION = "Conservation"
RADIUS, SOFT = 1.5e-3, 1e-3  # m; of the stiffness
COVERED = 0.3  # share of the plane that the gas covers
FASTEST = 0.6  # m/s, at the start, all along y
WARMING, LOOKS = 0.15, 400  # share of the run that is left out of the averages; looks at what remains
SOURCE = "source: below 0.5 %", "source: below 2 %"
KEPT, AVERAGES = 5e-3, 2e-2  # the source's deviations


def gas_setup(count: int, seed: int) -> Setup:
    """Smooth elastic grains in a square box without gravity, whose energy is all in their motion along y."""
    random = np.random.default_rng(seed)
    side = np.sqrt(count * np.pi * RADIUS**2 / COVERED)
    across = int(np.ceil(np.sqrt(count)))
    pitch = side / across
    sites = np.stack(np.meshgrid(np.arange(across), np.arange(across)), axis=-1).reshape(-1, 2)[:count]
    jitter = random.uniform(-0.5, 0.5, (count, 2)) * (pitch - 2.0 * RADIUS) * 0.9
    places = (sites + 0.5) * pitch + jitter - [side / 2.0, 0.0]
    speed = random.uniform(-FASTEST, FASTEST, count)
    rows = [grain(y, z, RADIUS, v) for (y, z), v in zip(places, speed, strict=True)]
    contact = {"normal": "hertz", "tangential": "none", "stiffness_scale": SOFT}
    box = {"width": side, "height": side}
    return Setup(np.array(rows), ACETATE | {"restitution": 1.0}, box, contact=contact, run={"gravity": WEIGHTLESS})
