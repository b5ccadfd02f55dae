"""A whole hull by strip theory at rest: sections side by side, each as if alone in its plane (Korvin-Kroukovsky 1955).

Axes are right-handed: x aft from the point about which the hull turns, y to starboard, z up; modes are surge, sway,
heave, roll, pitch and yaw. A section at x moves with (η₂ + x η₆, η₃ − x η₅, η₄) = T(x) η, so A = ∫ Tᵀ a T dx and, in
waves from abeam, X = ∫ Tᵀ X_2D dx (Salvesen, Tuck & Faltinsen 1970, without speed).

Limits: slender hulls and waves that are not much longer than she is: waves do not run round her ends, and she makes
none along herself; so at low frequencies damping is too high. No surge.
"""

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from solvers.machine.errors import Unavailable
from solvers.ship.naval.form import Form
from solvers.ship.potential.radiation import Hydrodynamics, hydrodynamics
from solvers.ship.water import Water

MODES = "surge", "sway", "heave", "roll", "pitch", "yaw"
ABEAM = (1, 2, 3)  # those of a section's plane
PANELS = 80
LEAST = 1e-4  # of the largest immersed area: smaller sections count as dry


def reference(form: Form, draught: float) -> float:
    """Station (m from the aft perpendicular) about which the hull pitches and yaws: that of her centre of buoyancy."""
    return float(form.displaced(np.full(len(form.x), draught))[1][0])


def strips(
    form: Form, draught: float, water: Water, frequency: Sequence[float], height: float, count: int = PANELS
) -> Hydrodynamics:
    """Coefficients (…, 6) of a whole hull at an even draught (m), moments about the axis `height` (m) above her keel.

    kg, kg m, kg m² and so on. Raises `Unavailable` for a dry hull, and as `hydrodynamics` does.
    """
    areas = [0.0 if one is None else float(one.immersion(-draught, 0.0).area) for one in form.sections]
    wet = [k for k, area in enumerate(areas) if area > LEAST * max(areas)]
    if not wet:
        raise Unavailable(f"at a draught of {draught:.4g} m the hull is dry.")
    middle, solved, total = reference(form, draught), {}, {}
    for k in wet:
        section = form.sections[k]
        key = section.outline.tobytes()
        if key not in solved:
            solved[key] = hydrodynamics(section, water, -draught, frequency, about=(0.0, height), count=count)
        for name, values in _placed(solved[key], middle - float(form.x[k])).items():
            total[name] = total.get(name, 0.0) + form.weights[k] * values
    return Hydrodynamics(np.asarray(frequency, dtype=float), **total)


def _placed(table: Hydrodynamics, x: float) -> dict[str, np.ndarray]:
    """The arrays of a section's table as those of a hull's modes, of a metre at x (m)."""
    moves = np.zeros((3, 6))
    moves[np.arange(3), ABEAM] = 1.0
    moves[0, 5], moves[1, 4] = x, -x
    found = {}
    for one in fields(table):
        values = getattr(table, one.name)
        if one.name == "frequency":
            continue
        square = not np.iscomplexobj(values)  # forces are complex, matrices are not
        found[one.name] = moves.T @ values @ moves if square else values @ moves
    return found


def abeam(table: Hydrodynamics, length: float) -> Hydrodynamics:
    """Sway, heave and roll of a whole hull's table for each metre of a length (m): the table of a section."""
    found = {}
    for one in fields(table):
        values = getattr(table, one.name)
        if one.name != "frequency":
            square = not np.iscomplexobj(values)
            values = (values[..., ABEAM, :][..., ABEAM] if square else values[..., ABEAM]) / length
        found[one.name] = values
    return Hydrodynamics(**found)
