"""Pictures of bulk: loose cargo as a continuum."""
