"""Water between grains: porosity, drag, and the exchange of momentum."""
