"""Experiments of the source with grains in a tank: numbers, rows and figures that claims name."""
