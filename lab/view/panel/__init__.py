"""The parts beside and over the picture of a live experiment: sliders, readings, curves, help."""
