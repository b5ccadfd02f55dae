"""How grains get into the tank: their sizes, where they start, and how overlaps at the start are removed."""
