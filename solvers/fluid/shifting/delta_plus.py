"""Shifting of the δ+ scheme."""

import taichi as ti

CROWDING = 0.2  # weight of the term against pairing


class DeltaPlus:
    """δu = −U (2 h)²/(2 Δx) Σ (1 + 0.2 (W/W(Δx))⁴) ∇W V_j/2 (Sun, Colagrossi, Marrone & Zhang 2017).

    Velocity with which places are shifted, at most U/2; U is the highest speed to be expected, and m_j/(ρ_i + ρ_j) is
    taken as V_j/2. Within 2 h of a free surface only the part along it is taken; spray is not shifted.

    Limits: the shift is one of places alone: moment of momentum, volume and energy are not corrected for it. A square
    patch of water that turns gains 2.6 % of its moment of momentum within two radians at 32 particles across. Below a
    free surface the large part across it is not wholly taken off where its direction is not, so that water rises:
    93 mm in a tank by 0.8 % within 0.4 s without the watch, which ends the run after 0.06 s. Such growth of volume is
    known (Lyu & Sun 2022). For tanks with a free surface take "delta-plus-momentum", which does not shift there.

    Units: δu and U m/s, h and Δx m.
    """

    acts = True
    carries = False

    @staticmethod
    def strength(water) -> float:
        """Factor (m³/s) of the sum over V_j (1 + …) (−W'/r) (r_i − r_j)."""
        return water.speed * water.reach**2 / (4.0 * water.spacing)

    @staticmethod
    @ti.func
    def crowded(ratio):
        """1 + 0.2 (W/W(Δx))⁴ for the ratio W/W(Δx)."""
        square = ratio * ratio
        return 1.0 + CROWDING * (square * square)
