"""Grains in water: what of a preset makes it wet cargo, and what it cannot be."""
