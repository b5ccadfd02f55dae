"""Pictures and videos of recordings, painted without a display."""
