"""Pixels: grains, water and lines in a numpy array."""
