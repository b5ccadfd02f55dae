"""Grids of runs, calibration, and runs on other machines."""
