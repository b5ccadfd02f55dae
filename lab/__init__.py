"""Cargo Shift Lab: pick an experiment on loose cargo, run it, watch it, and get a number with its error."""
