"""Benchmarks: accuracy, speed, stability, survival, graphics processors, outlines, and comparisons with peer codes."""
