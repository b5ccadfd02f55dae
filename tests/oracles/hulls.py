"""Hull sections that tests of the ship share."""

import numpy as np

from solvers.ship.section import Section, Stations, box


def mirrored(section: Section) -> Section:
    """The section seen from the other side."""
    return Section((section.outline * [-1.0, 1.0])[::-1])


def lopsided() -> Section:
    """A section without symmetry: one vertical and one raked side, a turned bilge, a deck with camber."""
    return Section(np.array([[-0.15, 0.0], [0.10, 0.02], [0.18, 0.10], [0.20, 0.30], [0.0, 0.33], [-0.17, 0.29]]))


def circle(radius: float, corners: int) -> Section:
    """A circle of the same area about the origin."""
    angle = 2.0 * np.pi * np.arange(corners) / corners
    outer = radius * np.sqrt(2.0 * np.pi / corners / np.sin(2.0 * np.pi / corners))
    return Section(outer * np.column_stack([np.cos(angle), np.sin(angle)]))


def catamaran() -> Section:
    """Two hulls under a bridge of deck."""
    port = [[-0.20, 0.0], [-0.12, 0.0], [-0.12, 0.2], [0.12, 0.2]]
    return Section(np.array([*port, [0.12, 0.0], [0.20, 0.0], [0.20, 0.25], [-0.20, 0.25]]))


def rounded(width: float, height: float, radius: float, arcs: int = 8) -> Section:
    """A box with rounded bilges about the middle of its bottom."""
    angle = np.linspace(-0.5 * np.pi, 0.0, arcs + 1)
    bilge = np.column_stack([0.5 * width - radius + radius * np.cos(angle), radius + radius * np.sin(angle)])
    deck = np.array([[0.5 * width, height], [-0.5 * width, height]])
    return Section(np.vstack([bilge, deck, (bilge * [-1.0, 1.0])[::-1]]))


def tapered(half: float, height: float, count: int) -> Stations:
    """Boxes whose breadth falls to nothing at the ends along a parabola, `half` (m) wide on each side amidships."""
    from scipy.integrate import simpson

    x = np.linspace(-1.0, 1.0, count)
    shares = 0.5 * simpson(np.eye(count), x=x)
    return Stations(tuple(box(2.0 * half * (1.0 - one**2), height) for one in x[1:-1]), shares[1:-1])
