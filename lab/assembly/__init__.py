"""Build the solver's scene from a preset."""
