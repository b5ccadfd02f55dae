"""Naval architecture of a whole ship: hydrostatics from her stations, righting levers, and the criteria of the codes.

Metres, tonnes and radians; x forward from the aft perpendicular, z from the keel. Codes and their criteria are data:
each `Criterion` has a limit, what was attained and a verdict.
"""
