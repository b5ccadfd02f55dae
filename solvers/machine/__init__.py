"""The runtime below the physics: starting Taichi, fields in memory, units of work, markers of units and ranges."""
