"""Water in a ship's tanks that needs no particles: frozen, by linear potential theory, or level at any heel."""
