"""Water as a matter: weakly compressible smoothed-particle hydrodynamics (δ-SPH) in a tank that moves."""
