"""Pictures and videos of a recording, painted without a display."""
