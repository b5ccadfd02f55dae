"""The film of levels of a run of flooding: her section at the damage, her profile, and curves that grow."""
