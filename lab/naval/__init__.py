"""The naval architect's view of a preset's ship: her condition, criteria, and tables as stability programs have them.

Metres, tonnes and degrees, z from the keel. Heel is positive starboard down in all that is printed as naval output;
the lab's own roll is positive port side down.
"""
