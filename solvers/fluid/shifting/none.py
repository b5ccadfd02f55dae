"""No shifting."""


class NoShifting:
    """Particles move with the water alone."""

    acts = False
