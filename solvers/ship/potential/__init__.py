"""Potential flow past a section: panels, the Green function of waves, radiation and what the water remembers."""
