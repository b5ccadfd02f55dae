"""The contacts of recorded grains and their forces, found again from recorded places: as data, and for pictures."""
