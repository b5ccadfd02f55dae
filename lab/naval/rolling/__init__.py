"""Roll damping of a ship by formula or from a decay test, her roll in a sea, and extremes of records."""
