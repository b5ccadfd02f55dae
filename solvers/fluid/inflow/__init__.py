"""Water that enters the rooms of a ship through openings in her hull, particle by particle."""
