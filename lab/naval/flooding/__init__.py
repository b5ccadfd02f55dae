"""`cargolab flood`: a ship with rooms and openings from a file, how she floods, and what is told of it.

Metres, tonnes and degrees, x forward, y to starboard, z from the keel; heel is positive starboard down, trim by the
stern.
"""
