"""From a preset to the solver's scene."""
