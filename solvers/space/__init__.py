"""The plane in cells: who is near whom, and the order of grains in memory."""
