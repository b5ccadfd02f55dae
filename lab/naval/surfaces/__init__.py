"""Hulls from closed surfaces of triangles."""
