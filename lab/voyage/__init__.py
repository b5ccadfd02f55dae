"""Whether a cargo shifts in a ship in a sea: many seeds of the sea, counted with their interval."""
