"""How the water stands along a hull that floats upright at a draught, or by a displacement, with a trim."""

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import TONNE, Form
from solvers.ship.water import Water


def level_at(form: Form, draught: float, trim: float = 0.0) -> np.ndarray:
    """Heights z (n,) m of the water at the stations for a mean draught (m) at the perpendiculars.

    trim (m): the draught aft less that forward. Raises Unavailable where water would come over her, or not reach her.
    """
    aft, fore = form.ends
    level = form.base + draught + trim * (0.5 * (aft + fore) - form.x) / (fore - aft)
    least, most = float(level.min()) - form.base, float(level.max()) - form.base
    if not 0.0 < draught <= form.depth or most > form.depth * (1.0 + 1e-12):
        raise Unavailable(
            f"the draught of {draught:.4g} m with a trim of {trim:.4g} m puts {least:.4g} to {most:.4g} m of her under "
            f"water; above 0 and at most the {form.depth:.4g} m of her stations can be."
        )
    return level


def draught_for(form: Form, displacement: float, water: Water, trim: float = 0.0) -> float:
    """The mean draught (m) at the perpendiculars at which she displaces so much (t) with this trim (m).

    Raises Unavailable for what she cannot carry.
    """
    from scipy.optimize import brentq

    needed, slope = displacement * TONNE / water.density, trim / (form.ends[1] - form.ends[0])
    tilt = slope * (0.5 * sum(form.ends) - form.x)
    deepest = form.depth - float(tilt.max())
    surplus = lambda draught: form.displaced(form.base + draught + tilt)[0] - needed  # noqa: E731
    if not (needed > 0.0 and deepest > 0.0 and surplus(0.0) < 0.0 < surplus(deepest)):
        most = (surplus(deepest) + needed) * water.density / TONNE if deepest > 0.0 else 0.0
        raise Unavailable(
            f"the displacement of {displacement:.5g} t with a trim of {trim:.4g} m is not hers: up to her deck she "
            f"displaces {most:.5g} t."
        )
    return float(brentq(surplus, 0.0, deepest, xtol=1e-12 * form.depth, rtol=1e-14))
