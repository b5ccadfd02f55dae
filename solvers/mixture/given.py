"""What a scene says of grains in water."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Mixture:
    """Grains and water share the tank of the grains.

    `drag` names a law of `solvers.mixture.drag`, `kinematic` is the water's viscosity ν (m²/s) in it. A computed grain
    stands for smaller ones with the same volume in all, which have 1/`finer` of its diameter: the bed has their
    permeability. The water reaches up to the `level` (m) in the tank's axes, or fills the share `saturation` of the
    settled bed's pores, from the floor on; neither: there is as much as the fluid's particles have.
    """

    drag: str = "di-felice"
    kinematic: float = 1.0e-6
    finer: float = 1.0
    level: float | None = None
    saturation: float | None = None
