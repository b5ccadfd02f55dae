"""Ships of the source: their rolls drawn, and scans of their equations without grains that runs are held against."""
