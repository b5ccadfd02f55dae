"""Sweeps (grids of runs), calibration, and runs on a cluster."""
