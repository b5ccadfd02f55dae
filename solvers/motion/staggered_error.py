"""The error of the staggered coupling of a ship with what is in her tanks: how it grows from step to step.

In the scheme of `motion.staggered_ships` (Serván-Camas, Cercós-Pita, Colom-Cobb, García-Espinosa & Souto-Iglesias 2016,
section 4) a ship takes long steps with a load that is extrapolated from those of the last steps (Lagrange). Her
equation of motion is weighted after Bossak, (1 − b) M a' + b M a = F*, and the contents follow her in short steps of
their own. In `motion.floating_ships` she takes the load of the instant instead, with the contents' added mass on her
own side.
"""

from math import comb, pi

import numpy as np

BOSSAK = -0.1  # b: the source does not say; usual values are −0.3 to 0 (Wood, Bossak & Zienkiewicz 1980)
GAMMA = 0.5 - BOSSAK  # of Newmark's velocity: no other is of second order
BETA = 1.0 / 12.0  # of Newmark's pose: no other keeps periods to fourth order, see `elongation`
EVEN = 0.25 * (1.0 - BOSSAK) ** 2  # β' of an even average of accelerations
SMOOTHING = 0.25  # share of the latest acceleration in the smoothed one, see `motion.staggered_ships`
LARGEST = 2.35  # ω H (rad) up to which an oscillation is stable with these
POINTS = 5


def lagrange(points: int = POINTS) -> np.ndarray:
    """Weights (points,) of the last equidistant values, newest first, in the next one: 5, −10, 10, −5, 1 of five."""
    return np.array([(-1.0) ** k * comb(points, k + 1) for k in range(points)])


def growth(ratio: float, points: int = POINTS) -> float:
    """Largest factor by which an error of the acceleration grows in a step, for contents whose added mass acts at once.

    Contents of `ratio` times the mass of the ship, added mass included, push back with −ratio · M s, where
    s = (1 − b) a' + b a is the acceleration at the end of a step. So its errors obey s' + ratio Σ w_k s_k = 0 whatever
    b, and the factor is the largest root of this. Above 1 the scheme is unstable with steps of any length (added-mass
    instability; Causin, Gerbeau & Nobile 2005). Five points are stable up to a ratio of 1/31. Own derivation.
    """
    return float(np.abs(np.roots(np.append(1.0, ratio * lagrange(points)))).max())


def elongation(angle: float, beta: float = BETA) -> float:
    """Share by which steps after Newmark and Bossak lengthen a period 2π/ω, for `angle` = ω H (rad), to second order.

    (ω H)² (β − 1/12)/2 whatever b: none of second order with β = 1/12 (Fox & Goodwin 1949), 1/12 (ω H)² with ¼ (Hughes
    1987, section 9.1). Own expansion with b. After a time t motion is off by this share of ω t, of its amplitude.
    """
    return 0.5 * angle**2 * (beta - 1.0 / 12.0)


def longest_step(period: float) -> float:
    """The longest step (s) that is stable for a ship with this shortest period (s)."""
    return LARGEST * period / (2.0 * pi)
