"""Roll damping of a cargo ship from her particulars alone: the formulas of Kawahara, Maekawa and Ikeda (2009).

Polynomials fitted to Ikeda's method for a series of hulls made from one cargo ship, of which length, breadth, draught
and fullness were changed. Printed again in the book of 2011 (Springer, Fluid Mechanics and Its Applications 97); the
coefficients here are those of the authors' program of July 2009. All is without speed, with the breadth B in

    B̂ = B44/(ρ ∇ B²) √(B/2g),  ω̂ = ω √(B/2g)

Limits: those of the authors, 2.5 ≤ B/d ≤ 4.5, 0.5 ≤ C_b ≤ 0.85, 0.9 ≤ C_m ≤ 0.99, −1.5 ≤ OG/d ≤ 0.2, ω̂ ≤ 1, keels
0.01 ≤ b/B ≤ 0.06 and 0.05 ≤ l/L ≤ 0.4. Beyond, wave damping above all is wrong (Alexandersson, Mao & Ringsberg 2021).
"""

from dataclasses import dataclass
from math import exp, log, pi

import numpy as np

from solvers.machine.errors import Unavailable

RANGES = {
    "B/d": (2.5, 4.5),
    "the block coefficient": (0.5, 0.85),
    "the midship coefficient": (0.9, 0.99),
    "OG/d": (-1.5, 0.2),
    "ω √(B/2g)": (0.0, 1.0),
    "keel breadth/B": (0.01, 0.06),
    "keel length/L": (0.05, 0.4),
}
ROUNDING = 1e-9


@dataclass(frozen=True)
class Ratios:
    """What the formulas take: B/d, C_b, C_m, OG/d (G below the waterline positive), ω̂, keels' b/B and l/L (0: none)."""

    beam: float
    block: float
    midship: float
    below: float
    frequency: float
    keel_breadth: float = 0.0
    keel_length: float = 0.0

    def beyond(self) -> list[str]:
        """Which of them are outside the range of the formulas, in words."""
        values = (self.beam, self.block, self.midship, self.below, self.frequency, self.keel_breadth, self.keel_length)
        return [
            f"{name} is {value:.3g}, not {low:g} to {high:g}"
            for (name, (low, high)), value in zip(RANGES.items(), values, strict=True)
            if not low - ROUNDING <= value <= high + ROUNDING and (value or not name.startswith("keel"))
        ]

    def require(self) -> None:
        """Raise Unavailable outside the range of the formulas."""
        if beyond := self.beyond():
            raise Unavailable(f"the formulas of Kawahara et al. do not reach so far: {'; '.join(beyond)}.")


def keels(ship: Ratios, degrees: float) -> float:
    """B̂ of bilge keels at an amplitude (deg); 0 without any."""
    if not ship.keel_length or not ship.keel_breadth:
        return 0.0
    block, beam, deep, wide, long = ship.block, ship.beam, ship.below, ship.keel_breadth, ship.keel_length
    hull = (-0.3651 * block + 0.3907) * (beam - 2.83) ** 2 - 2.21 * block + 2.632
    angle = np.polyval([0.00255, 0.122, 0.4794], degrees)
    size = np.polyval([-0.8913 * wide**2 - 0.0733 * wide, 5.2857 * wide**2 - 0.01185 * wide + 0.00189, 0.0], long)
    height = 5.0 * wide + 0.3 * beam - 0.2 * long + 0.00125 * degrees**2 - 0.0425 * degrees - 1.86
    full = -15.0 * wide + 1.2 * block - 0.1 * beam - 0.0657 * deep**2 + 0.0586 * deep + 1.6164
    grown = exp(height * deep + full * ship.midship ** (2.5 * deep + 15.75))
    return float(hull * angle * size * grown * ship.frequency)


def eddies(ship: Ratios, degrees: float) -> float:
    """B̂ of eddies of the bare hull at an amplitude (deg)."""
    block, beam, deep = ship.block, ship.beam, ship.below
    size = (-0.0182 * block + 0.0155) * (beam - 1.8) ** 3
    size += np.polyval([-79.414, 215.695, -215.883, 93.894, -14.848], block)
    height = (3.98 * block - 5.1525) * (-0.2 * beam + 1.6) * deep
    height *= np.polyval([0.9717, -1.55, 0.723], block) * deep + 0.04567 * block + 0.9408
    full = (0.25 * deep + 0.95) * deep + np.polyval([-219.2, 443.7, -283.3, 59.6], block)
    power = -15.0 * block * beam + 46.5 * block + 11.2 * beam - 28.6
    coefficient = size * exp(height + full * ship.midship**power)
    return float(4.0 * ship.frequency * np.radians(degrees) / (3.0 * pi * block * beam**3) * coefficient)


def waves(ship: Ratios) -> float:
    """B̂ of waves that she makes: A₁/ω̂ exp(−A₂ (ln ω̂ − A₃)²/1.44)."""
    high = 1.0 - ship.below  # of the axis above the keel line, over the draught
    by_block = np.array([np.polyval([_of(row, ship.beam) for row in rows], ship.block) for rows in HEIGHT])
    tilt = [_of(row, ship.beam) for row in MIDSHIP]
    lean = np.polyval(tilt[:3], ship.block) * ship.midship + np.polyval(tilt[3:], ship.block)
    size = np.polyval(by_block, high) * (lean * (1.0 - high) + 1.0)
    sharp = np.polyval([-1.402, 7.189, -10.993, 9.45], high)
    peak = np.polyval([np.polyval(row, ship.block) for row in PEAK], high) + _shift(ship, high)
    return float(size / ship.frequency * exp(-sharp * (log(ship.frequency) - peak) ** 2 / 1.44))


def _of(row: list[float], beam: float) -> float:
    return float(np.polyval(row, beam))


def _shift(ship: Ratios, high: float) -> float:
    """What the breadth changes of the peak's place A₃."""
    block, beam = ship.block, ship.beam
    size = np.polyval([-17.102, 41.495, -33.234, 8.8007], block) * high
    size += np.polyval([36.566, -89.203, 71.8, -18.108], block)
    size *= np.polyval([-0.3767, 3.39, -10.356, 11.588], beam)
    at = high - np.polyval([-0.0727, 0.7, -1.2818], beam)
    return float(size * (np.polyval(SHIFT, at) + np.polyval([-0.0495, 0.4518, -0.61655], beam)))


# Coefficients of A₁: of a power of the axis' height, of a power of C_b, polynomials in B/d; highest powers first.
HEIGHT = (
    (
        [-0.002222, 0.040871, -0.286866, 0.599424],
        [0.010185, -0.161176, 0.904989, -1.641389],
        [-0.015422, 0.220371, -1.084987, 1.834167],
    ),
    (
        [-0.0628667, 0.4989259, 0.52735, -10.7918672, 16.616327],
        [0.1140667, -0.8108963, -2.2186833, 25.1269741, -37.7729778],
        [-0.0589333, 0.2639704, 3.1949667, -21.8126569, 31.4113508],
        [0.0107667, 0.0018704, -1.2494083, 6.9427931, -10.2018992],
    ),
    (
        [0.192207, -2.787462, 12.507855, -14.764856],
        [-0.350563, 5.222348, -23.974852, 29.007851],
        [0.237096, -3.535062, 16.368376, -20.539908],
        [-0.067119, 0.966362, -4.407535, 5.894703],
    ),
)
MIDSHIP = (  # three that C_m multiplies, three that it does not; polynomials in B/d
    [17.945, -166.294, 489.799, -493.142],
    [-25.507, 236.275, -698.683, 701.494],
    [9.077, -84.332, 249.983, -250.787],
    [-16.872, 156.399, -460.689, 463.848],
    [24.015, -222.507, 658.027, -660.665],
    [-8.56, 79.549, -235.827, 236.579],
)
PEAK = (  # of a power of the axis' height, from the sixth down: polynomials in C_b
    [-7686.0287, 30131.5678, -49048.9664, 42480.7709, -20665.147, 5355.2035, -577.8827],
    [61639.9103, -241201.0598, 392579.5937, -340629.4699, 166348.6917, -43358.7938, 4714.7918],
    [-130677.4903, 507996.2604, -826728.7127, 722677.104, -358360.7392, 95501.4948, -10682.8619],
    [-110034.6584, 446051.22, -724186.4643, 599411.9264, -264294.7189, 58039.7328, -4774.6414],
    [709672.0656, -2803850.2395, 4553780.5017, -3888378.9905, 1839829.259, -457313.6939, 46600.823],
    [-822735.9289, 3238899.7308, -5256636.5472, 4500543.147, -2143487.3508, 538548.1194, -55751.1528],
    [299122.8727, -1175773.1606, 1907356.1357, -1634256.8172, 780020.9393, -196679.7143, 20467.0904],
)
SHIFT = [-1.05584, 12.688, -63.70534, 172.84571, -274.05701, 257.68705, -141.40915, 44.13177, -7.1654, 0.0]
