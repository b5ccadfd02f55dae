"""The equation of state of air."""

import numpy as np
import taichi as ti

from solvers.fluid.given import Air, Water

GAMMA = 1.4  # ratio of the specific heats of air
FULL = 2.4 ** (1.0 / GAMMA) - 1.0  # density deviation at which p = ρ_a c², beyond which air resists no further
HELD = (
    (1.0 + FULL) ** (GAMMA - 1.0) / (GAMMA - 1.0) + 1.0 / (1.0 + FULL) - GAMMA / (GAMMA - 1.0)
) / GAMMA  # energy there
NEAR = 1e-2  # density deviation below which the energy is told by its series
BORNE = 0.3  # of p_a: suction that air bears without being torn apart
SHAKEN = 0.02  # of ρ c² of the water: from about 0.1 on a background pressure stirs it
STEEPEST = 0.743  # of 1/h: the gradient of the phase in a plane surface, ∫ W along a line (Wendland C2)
HOLDING = 3.0  # times what a surface under tension draws along itself: at 1 it tears, see docs/physics/air/tension.md


def background(air: Air, water: Water, weight: float = 0.0) -> float:
    """The pressure (Pa) that air and water bear besides: the air is then torn apart by no suction up to that.

    At 0.7 p_a it would stir air at rest, at 0.1 ρ c² water. Nor is it more than ρ U² of water whose highest speed U is
    known, twice the suction of such a flow (Bernoulli), or than the `weight` (Pa) of the air over the surface and
    ρ_a U², the suction of a heavy one below its lid: where the surface is strained, rows on both sides of it are not
    as far apart as their volumes say, and the next of water have some per cent of the background for a pressure, which
    stiffens waves. Tension σ draws the particles of a surface along it by σ |∇C|, which grows as 1/h: it needs a
    multiple of that. Air with a cohesion bears what that draws itself.
    """
    if air.cohesion > 0.0:
        return 0.0
    own = air.density * air.sound_speed**2 / GAMMA
    drawn = HOLDING * STEEPEST * air.tension / water.length
    borne = min(BORNE * own, SHAKEN * water.density * water.sound_speed**2)
    if water.speed > 0.0:
        lively = water.speed**2
        borne = min(borne, max(water.density * lively, weight + air.density * lively))
    return max(drawn, borne)


class Adiabatic:
    """p = p_a ((ρ/ρ_a)^1.4 − 1), p_a = ρ_a c²/1.4 (Laplace 1816): air that exchanges no heat, over its pressure p_a.

    The real air has p_a = 1.0e5 Pa and c = 343 m/s; air with a lower speed of sound is as much softer as (c/343)².
    p is at most ρ_a c², at 1.87 ρ_a: soft air under an impact is squeezed to nothing then, and does not burst out at
    several times its speed of sound.

    Limits: no heat, no vapour; a bubble of millimetres exchanges heat within milliseconds and is nearer to ρ/ρ_a.

    Units: p and p_a Pa, c m/s, ρ and ρ_a kg/m³.
    """

    @staticmethod
    @ti.func
    def share(s):
        """p/(ρ_a c²) for the density deviation s = ρ/ρ_a − 1, a single number."""
        return ti.min((ti.pow(1.0 + s, GAMMA) - 1.0) / GAMMA, 1.0)

    @staticmethod
    def pressure(s: np.ndarray) -> np.ndarray:
        """As `share`, of an array."""
        return np.minimum(np.expm1(GAMMA * np.log1p(np.asarray(s, dtype=float))) / GAMMA, 1.0)

    @staticmethod
    def deviation(share: np.ndarray) -> np.ndarray:
        """The density deviation s at which p/(ρ_a c²) is `share`."""
        return np.expm1(np.log1p(GAMMA * np.asarray(share, dtype=float)) / GAMMA)

    @staticmethod
    def elastic(s: np.ndarray) -> np.ndarray:
        """As `energy`, of an array."""
        s = np.asarray(s, dtype=float)
        low = np.minimum(s, FULL)
        whole = ((1.0 + low) ** (GAMMA - 1.0) / (GAMMA - 1.0) + 1.0 / (1.0 + low) - GAMMA / (GAMMA - 1.0)) / GAMMA
        series = s * s * (0.5 - s * (0.6 - s * (0.64 - s * 0.6608)))
        return np.where(np.abs(s) < NEAR, series, whole + 1.0 / (1.0 + low) - 1.0 / (1.0 + s))

    @staticmethod
    @ti.func
    def energy(s):
        """Elastic energy per mass in units of c², ∫ p/(ρ² c²) dρ = ((1 + s)^0.4/0.4 + 1/(1 + s) − 3.5)/1.4.

        By its series where s is small, since the terms cancel.
        """
        energy = (ti.pow(1.0 + s, GAMMA - 1.0) / (GAMMA - 1.0) + 1.0 / (1.0 + s) - GAMMA / (GAMMA - 1.0)) / GAMMA
        if ti.abs(s) < NEAR:
            energy = s * s * (0.5 - s * (0.6 - s * (0.64 - s * 0.6608)))
        if s > FULL:
            energy = HELD + 1.0 / (1.0 + FULL) - 1.0 / (1.0 + s)
        return energy
