"""The water of a preset: what may be said of it and of its gauges, the named schemes, checks, and what follows."""
