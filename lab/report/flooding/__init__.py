"""The page, figures and film of a run of flooding."""
