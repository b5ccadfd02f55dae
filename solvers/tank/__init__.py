"""The tank that holds the cargo: outline, walls, moving parts, and the load on them."""
