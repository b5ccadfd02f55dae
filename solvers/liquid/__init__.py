"""Water in a ship's tanks that needs no particles: frozen, or by linear potential theory."""
