"""Bulk: loose cargo as a continuum, material points that carry mass, stress and volume over a grid in the tank."""
