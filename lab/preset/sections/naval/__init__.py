"""What a preset says of a whole ship, for the naval architect."""
