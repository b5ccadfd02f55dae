"""Surfaces of triangles, from files."""
