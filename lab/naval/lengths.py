"""Lengths of a hull that her stations do not tell: between her perpendiculars, and in the waterline."""

from dataclasses import replace

import numpy as np

from lab.base.errors import LabError
from solvers.ship.naval.form import Form

LEAST, MOST = 0.5, 1.2  # of the distance of the outermost stations: what a length of a ship may be


def between(form: Form, lbp: float | None, lwl: float | None, ap: float) -> Form:
    """The hull with perpendiculars `lbp` (m) apart, the aft one at x = `ap` (m); as she is without a length.

    Raises LabError for lengths, the waterline's `lwl` (m) too, that cannot be those of this hull.
    """
    whole = float(np.ptp(form.x))
    for name, length in (("lbp", lbp), ("lwl", lwl)):
        if length is not None and not LEAST * whole <= length <= MOST * whole:
            raise LabError(f"--{name}: {length:g} m is no length of a hull whose stations reach over {whole:.5g} m.")
    if lbp is None:
        if ap:
            raise LabError("--ap: says where the length between perpendiculars begins; give --lbp, too.")
        return form
    found = replace(form, length=lbp, aft=ap)
    aft, fore = found.ends
    if not min(fore, form.x[-1]) - max(aft, form.x[0]) >= LEAST * whole:
        raise LabError(
            f"--lbp: her perpendiculars would be at {aft:.5g} and {fore:.5g} m, and her stations reach from "
            f"{form.x[0]:.5g} to {form.x[-1]:.5g} m; give --ap, the place of the aft one."
        )
    return found


def perpendiculars(form: Form) -> str:
    """Where they are, in words."""
    aft, fore = form.ends
    told = "" if form.length else ", at her outermost stations; --lbp gives her own"
    return f"at {aft:.6g} and {fore:.6g} m, {form.perpendiculars:.6g} m apart{told}"
