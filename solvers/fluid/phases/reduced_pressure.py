"""Pressures over those of the upper fluid at rest, so that a heavy one does not hang below its lid by suction."""

import numpy as np
import taichi as ti


class ReducedPressure:
    """p' = p − ρ_a g·(r − r_0), m_i du_i/dt = … + m_i (1 − ρ_a/ρ_0i) g: the modified pressure (Batchelor 1967, §4.1).

    Of both fluids with the density ρ_a of the upper one, so that nothing is left out: what each lacks of its weight is
    the force of that pressure's gradient on its volume at rest m_i/ρ_0i (own derivation). The upper fluid is under no
    suction at rest, the lower one has the gravity g (ρ_w − ρ_a)/ρ_w. So the background pressure need not bear ρ_a g H,
    and rows of particles that face each other at the surface slide freely. The walls' load has the weight
    ρ_a g m_i/ρ_0i of each particle at its place, so that momentum is kept to rounding; gauges and pictures have p.
    Potential energy is less by that of ρ_a g m_i/ρ_0i over the tank's own origin.

    Limits: ρ_a g is of the fluid at its density at rest; both are squeezed by p', not by p, a relative ρ_a g H/(ρ c²).
    Not with parts, force gauges, a cohesion, or air that becomes stiff.

    Units: p Pa, g m/s², ρ kg/m³, r and r_0 m; r_0 is at the surface at rest.
    """

    @staticmethod
    def numbers(water) -> dict[str, float]:
        """The constants of a scene's water: ρ_a/ρ_w, and the height of r_0."""
        return {"buoyed": water.air.density / water.density, "reduced_level": water.air.reduced or 0.0}

    @staticmethod
    def weight(water, gravity: float) -> float:
        """The gravity (m/s²) that the lower fluid has."""
        share = water.air.density / water.density if water.air and water.air.reduced is not None else 0.0
        return gravity * (1.0 - share)

    @staticmethod
    def hanging(water, gravity: float, over: float) -> float:
        """The suction (Pa) that fluids with an upper one of a height (m) must bear at rest.

        That is the upper one's weight, or what remains: of the difference of both over one smoothing length, in which
        particles of both are together.
        """
        if water.air.reduced is None:
            return water.air.density * gravity * over
        return (water.density - water.air.density) * gravity * water.length

    @staticmethod
    def head(numbers: dict[str, float], pull: np.ndarray, place: np.ndarray) -> np.ndarray:
        """p − p' (W, n) Pa at places (W, n, 2) m, with gravity (W, 2) m/s² in the tank's axes."""
        off = place - np.array([0.0, numbers["reduced_level"]])
        return numbers["air_density"] * (off * pull[:, None]).sum(axis=-1)

    @staticmethod
    @ti.func
    def above(constants: ti.template(), pull: ti.template(), place: ti.template()):
        """As `head`, at a single place."""
        height = place[1] - constants.get("reduced_level")
        return constants.get("air_density") * (pull[0] * place[0] + pull[1] * height)

    @staticmethod
    @ti.func
    def sinking(constants: ti.template(), gas: ti.template()):
        """1 − ρ_a/ρ_0 of particles of water where `gas` is 0, of the upper fluid where it is 1."""
        return (1.0 - gas) * (1.0 - constants.get("buoyed"))
