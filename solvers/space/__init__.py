"""The plane in cells: neighbour search by a cell grid, and the spatial order of grains in memory."""
