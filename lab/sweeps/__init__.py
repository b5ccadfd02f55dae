"""Sweeps (grids of runs), calibration, and runs on other machines."""
