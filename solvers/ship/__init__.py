"""The ship's water: hull section, hydrostatics, radiation and diffraction, memory, waves. All per metre of length.

Axes as in `solvers.motion.frame`: y to starboard, z up from the calm surface, roll counter-clockwise positive. A hull's
pose is its heave (m, the height of the origin of its own frame above the calm surface) and its roll (rad).
"""
