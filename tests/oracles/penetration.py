"""The overlap of two outlines by the discrete function representation, in the limit of infinitely many nodes."""

from dataclasses import dataclass

import numpy as np

from tests.oracles.crossing import Arc, Placed, Shared, depth, extremes, samples, shared


@dataclass(frozen=True)
class Penetration:
    """One contact of two outlines: the deepest point of either inside the other.

    `overlap` (m) is the distance of that point from the tangent of the outline it is in, taken at the point's polar
    angle; `normal` (y, z) that outline's normal there, towards the first grain; `point` (y, z) m the deepest point,
    which is on the first outline if `of_first`.
    """

    overlap: float
    normal: tuple[float, float]
    point: tuple[float, float]
    of_first: bool


def penetrations(first: Placed, second: Placed) -> tuple[Penetration, ...]:
    """The contacts of two outlines, one in each region that they share, the deepest first.

    Deepest is the point with the greatest polar depth, R_j(φ) − d; between the deepest of the first in the second and
    that of the second in the first the larger overlap counts (Spandonidis 2016, table 8.1; Hogue 1998). Raises
    BadOutline where one outline lies wholly inside the other.
    """
    found = [_deepest(first, second, region) for region in shared(first, second)]
    return tuple(sorted(found, key=lambda contact: -contact.overlap))


def _deepest(first: Placed, second: Placed, region: Shared) -> Penetration:
    of_first = [_in_arc(first, second, arc) for arc in region.first]
    of_second = [_in_arc(second, first, arc) for arc in region.second]
    overlap, normal, point = max(of_first + of_second, key=lambda found: found[0])
    is_first = overlap == max(found[0] for found in of_first)
    if not is_first:
        normal = -normal
    return Penetration(overlap, (normal.real, normal.imag), (point.real, point.imag), is_first)


def _in_arc(inner: Placed, outer: Placed, arc: Arc) -> tuple[float, complex, complex]:
    """Overlap (m), outer outline's normal and inner outline's point where this arc of the inner one is deepest."""
    theta = samples(inner, outer, arc)
    slope = depth(inner, outer, theta)[1]
    tops = extremes(inner, outer, theta, np.flatnonzero((slope[:-1] > 0.0) & (slope[1:] < 0.0)))
    theta = np.concatenate([theta, tops])
    inside = depth(inner, outer, theta)[0]
    point = complex(inner.place(theta[inside.argmax()]))
    own = outer.seen(point)
    normal = complex(outer.normal(np.angle(own)))
    radial = own / abs(own) * np.exp(1j * outer.angle)
    return float(inside.max() * (normal * radial.conjugate()).real), normal, point
