"""Friction of the walls before and behind: water in a narrow tank that is computed in the plane."""

from solvers.fluid.given import Water

PROFILE = 12.0  # of laminar flow between two walls: its mean friction over ν u/b² (Hele-Shaw 1898; Lamb 1932, § 330)


class Between:
    """du/dt = … − (12 ν/b²)(u − U), with b the distance of the walls before and behind and U their velocity.

    That is the friction of laminar flow between two walls, a parabola over their distance, on its mean u. It is right
    for slow flow, b²ω/ν up to some 20. (Glycerine that rolls in the tank of SPHERIC's benchmark 9, b 62 mm at
    3.2 rad/s, has 17: there 2.39 1/s by Stokes' flow between oscillating walls, 12 ν/b² = 2.31 1/s.) What the walls
    take from the water is on the tank, and its power counts as viscosity's.

    Limits: in Stokes' flow the mean also has a fifth more inertia (Ruyer-Quil 2001), which is left out. Thin boundary
    layers take more than this: of water in that tank 0.041 1/s, where this has 0.003.
    """

    @staticmethod
    def rate(water: Water) -> float:
        """12 ν/b² (1/s); 0 where no such walls are."""
        return PROFILE * water.kinematic / water.apart**2 if water.apart else 0.0
