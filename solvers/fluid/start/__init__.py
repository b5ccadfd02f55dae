"""Water at rest: where its particles are at the start, and how dense."""
