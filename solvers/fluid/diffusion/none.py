"""No diffusion of density."""


class NoDiffusion:
    """Plain weakly compressible SPH (Monaghan 1994): pressures are noisy."""

    acts = False
    renormalised = False
    dynamic = False
