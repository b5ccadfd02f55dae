"""Benchmarks: accuracy, speed, stability, graphics processors, outlines, and comparisons with peer codes.

They are in the source only, not in what is installed from a package; `cargolab bench` calls them.
"""
