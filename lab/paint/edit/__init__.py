"""The timeline of a film: its event, its slow motion, its last still, and the moments of a contact sheet."""
