"""The area that two outlines share, and the contact that a force law built on it needs."""

from dataclasses import dataclass
from math import ceil

import numpy as np

from tests.oracles.crossing import Arc, Placed, Shared, shared

LEAST_NODES = 16  # of Gauss's rule, beside those that an arc's harmonics need


@dataclass(frozen=True)
class AreaContact:
    """One region that two outlines share, as a potential E(A) of its area A sees it (Feng and Owen 2004).

    The force on the first grain is E'(A) `width` × `normal` at `point`, or anywhere on the normal through it; `area` in
    m², `width` and `point` (y, z) in m. Of a region with two corners the width is the chord between them, the point its
    middle. A region with more, of outlines that cut through each other, has no one chord: then width and normal are
    those of the resultant, and where its forces cancel both are zero.
    """

    area: float
    width: float
    normal: tuple[float, float]
    point: tuple[float, float]


def area_contacts(first: Placed, second: Placed) -> tuple[AreaContact, ...]:
    """The contacts of two outlines, one in each region that they share, the largest first.

    Raises BadOutline where one outline lies wholly inside the other.
    """
    found = [_contact(first, second, region) for region in shared(first, second)]
    return tuple(sorted(found, key=lambda contact: -contact.area))


def _contact(first: Placed, second: Placed, region: Shared) -> AreaContact:
    ends = np.array([first.place(np.array(arc)) for arc in region.first])
    corner, middle = complex(ends[0, 0]), complex(ends.mean())
    area = sum(_swept(first, arc, corner) for arc in region.first)
    area += sum(_swept(second, arc, corner) for arc in region.second)
    # Moving the first grain by u moves its arcs, whose normals add up to −i times their chords: dA = −(i Σ chord) · u.
    push = 1j * np.diff(ends).sum()
    width = abs(push)
    normal = push / width if width else 0j
    turn = 0.5 * np.diff(np.abs(ends - middle) ** 2).sum()  # by which a turn about the middle changes −A
    point = middle - 1j * normal * (turn / width) if width else middle
    return AreaContact(float(area), float(width), _pair(normal), _pair(point))


def _swept(grain: Placed, arc: Arc, corner: complex) -> float:
    """Area (m²) that the line from a corner of the region to a point on an arc sweeps: ½ ∫ r × dr (Green's theorem)."""
    length = arc[1] - arc[0]
    nodes, weights = np.polynomial.legendre.leggauss(LEAST_NODES + ceil(length * (1 + len(grain.contour.descriptors))))
    theta = arc[0] + 0.5 * length * (1.0 + nodes)
    point, along = grain.trace(theta)
    return 0.25 * length * float(weights @ ((point - corner).conjugate() * along).imag)


def _pair(number: complex) -> tuple[float, float]:
    return float(number.real), float(number.imag)
