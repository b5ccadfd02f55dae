"""Water and air as one fluid of two phases: the air's state, what acts between the phases, and their constants."""
