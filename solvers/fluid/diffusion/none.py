"""No diffusion of density."""


class NoDiffusion:
    """ψ = 0 (Monaghan 1994): no diffusion of density, plain weakly compressible SPH.

    Limits: pressures are noisy.

    Units: ψ kg/m⁴.
    """

    acts = False
    renormalised = False
    dynamic = False
