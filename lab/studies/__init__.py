"""Studies of the lab itself: verification, reproduction of the sources' experiments, benchmarks, the gallery."""
