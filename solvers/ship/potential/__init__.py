"""Potential flow past a section: panels, the Green function of waves, radiation, diffraction and memory."""
