"""Which particles of water are near each other: cells, their order in memory, neighbour lists."""
