"""The ship in water: hull section, hydrostatics, radiation and diffraction, memory, waves. All per metre of length.

Axes as in `solvers.motion.frame`: y to starboard, z up from the calm surface, roll positive counter-clockwise. A hull's
pose is its heave (m, the height of its own origin above the calm surface) and its roll (rad).
"""
