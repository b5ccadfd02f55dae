"""What is known about the lab: verification, the sources' experiments, benches, the gallery."""
