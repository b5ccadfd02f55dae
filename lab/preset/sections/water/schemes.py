"""Named schemes of water: the models and numbers that published studies used, as far as the solver has them.

All of them run with the lab's own walls (wall particles after Adami, Hu & Adams 2012), time step and precision. What a
source did otherwise and the solver does not offer:

- as_P: walls of dynamic particles with a gap, shifting after Lind (2012), a symplectic step of second order with 0.2
  of the acoustic limit. Its smoothing length is that of its runs in the plane, with one phase or with air. Its air
  needs `air.sound_speed = "real"`, and water of 46.5 m/s.
- as_K: walls by boundary integrals, a modified predictor–corrector step. It says neither h/Δx nor the strength of its
  viscosity, for which those of the lab stand.
- as_F: a Runge–Kutta step of fourth order.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Scheme:
    """Models by their names, their numbers, and the speed of sound: `mach` times the expected speed, or `sound` m/s."""

    kernel: str = "wendland-c2"
    smoothing: float = 2.0  # h/Δx
    state: str = "linear"
    diffusion: str = "antuono"
    delta: float = 0.1
    viscosity: str = "artificial"
    alpha: float = 0.01
    mach: float = 10.0
    sound: float | None = None
    smoothing_with_air: float | None = None  # h/Δx, where it is another
    interface: str = "weighted"  # beside air


SCHEMES = {
    "lab": Scheme(),
    # "Sway and roll of a prismatic tank", J. Mar. Sci. Eng. 7 (2019) 247: c = 60 √(gd), coefh √2 = 1.70, 1.34 with air
    "as_P": Scheme(
        smoothing=1.70,
        state="tait",
        diffusion="molteni",
        viscosity="approaching",
        alpha=0.07,
        mach=60.0,
        smoothing_with_air=1.34,
        interface="cohesion",
    ),
    # Serván-Camas et al., Ocean Eng. 123 (2016) 383: c = 10 m/s in tanks of 0.2 to 0.4 m
    "as_K": Scheme(state="tait", delta=0.2, sound=10.0),
    # Guo et al., J. Hydrodyn. B (2017)
    "as_F": Scheme(smoothing=1.23, alpha=0.1),
}
