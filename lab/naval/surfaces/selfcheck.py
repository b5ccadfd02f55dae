"""What a hull shows of herself before anything is read from her: size, volume, symmetry, and where she is measured."""

import numpy as np

from lab.naval.lengths import perpendiculars
from lab.naval.surfaces.axes import CENTRED
from lab.naval.surfaces.mesh import Mesh
from lab.naval.surfaces.read import disagreement
from solvers.ship.naval.form import Form


def self_check(form: Form, mesh: Mesh | None = None, fewest: int = 0) -> list[str]:
    """Lines on a hull: L × B × D, volume by surface and by stations, symmetry, perpendiculars and base line.

    `mesh` is the surface that she was cut from, `fewest` the stations that were asked for; none for offsets.
    """
    low, high = (mesh.low, mesh.high) if mesh else _box(form)
    length, breadth, depth = high - low
    facts = [
        ("L x B x D", f"{length:.5g} x {breadth:.5g} x {depth:.5g} m; {_spans(low, high)}"),
        ("volume", _volume(form, mesh, fewest)),
        ("symmetry", _symmetry(form, breadth)),
        ("AP, FP", perpendiculars(form)),
        ("draughts", f"from z {form.base:.5g} m" + (", her keel amidships" if mesh else ", the base line")),
    ]
    width = max(len(name) for name, _ in facts)
    return [f"  {name:<{width}}  {text}" for name, text in facts]


def asymmetry(form: Form) -> tuple[float, float]:
    """The furthest that the centre of a station's area lies from y = 0 (m, to starboard), and the station's x (m)."""
    worst = 0.0, float(form.x[0])
    for x, section in zip(form.x, form.sections, strict=True):
        if section is not None:
            whole = section.immersion(-section.outline[:, 1].max(), 0.0)
            worst = max(worst, (float(whole.moment / whole.area), float(x)), key=lambda one: abs(one[0]))
    return worst


def _box(form: Form) -> tuple[np.ndarray, np.ndarray]:
    """Least and largest x, y, z (3,) m of the stations."""
    corners = np.concatenate([section.outline for section in form.sections if section is not None])
    low, high = corners.min(axis=0), corners.max(axis=0)
    return np.array([form.x[0], *low]), np.array([form.x[-1], *high])


def _spans(low: np.ndarray, high: np.ndarray) -> str:
    spans = zip("xyz", low + 0.0, high + 0.0, strict=True)
    return ", ".join(f"{name} {a:.6g} to {b:.6g}" for name, a, b in spans)


def _volume(form: Form, mesh: Mesh | None, fewest: int) -> str:
    count = len(form.x)
    if mesh is None:
        return f"{form.volume:.6g} m3 by {count} stations"
    more = f" ({fewest} were too few)" if count > fewest else ""
    off = 100.0 * disagreement(form, mesh)[0]
    return (
        f"{mesh.volume:.6g} m3 by the surface, {form.volume:.6g} by {count} stations{more}; at all draughts within "
        f"{off:.2g} %"
    )


def _symmetry(form: Form, breadth: float) -> str:
    off, x = asymmetry(form)
    if abs(off) <= CENTRED * breadth:
        return f"both sides alike: no station's centre is further than {abs(off):.1g} m from y = 0"
    side = "starboard" if off > 0.0 else "port"
    return f"NOT alike: the centre of the station at x {x:.5g} m is {abs(off):.3g} m to {side}"
