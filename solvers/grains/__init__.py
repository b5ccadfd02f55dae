"""Grains: state, lists of contacts, laws, integrators, and how they are filled in and moved."""
