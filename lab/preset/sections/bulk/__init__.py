"""Bulk, loose cargo as a continuum, in a preset."""
