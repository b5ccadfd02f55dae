"""Bodies in water as a preset gives them: what floats, hulls with rooms and openings, and their checks."""
