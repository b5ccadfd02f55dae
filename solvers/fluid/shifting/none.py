"""No shifting."""


class NoShifting:
    """δu = 0: particles move with the water alone.

    Source: none is needed, nothing is shifted.

    Limits: particles clump and part where the flow strains them for long.

    Units: δu m/s.
    """

    acts = False
    carries = False
