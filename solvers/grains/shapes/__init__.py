"""Outlines of irregular grains: their description, their sources, and the rules of contact between them."""
