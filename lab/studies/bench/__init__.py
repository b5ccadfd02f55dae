"""Benchmarks: accuracy, speed, stability, graphics processors, outlines, and comparisons with peer codes."""
