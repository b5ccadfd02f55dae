"""Water that enters a ship: rooms, openings, air, how she floats with it, and how long it takes; numpy only.

Metres, kilograms, seconds and radians; x forward, y to starboard, z up in the hull's own axes. Roll is positive port
side down, as in `solvers.ship.section`.
"""
