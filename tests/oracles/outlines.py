"""Outlines that several tests of shapes share."""

import numpy as np

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.spectrum import draw, spectrum


def ellipse_radius(a, b, angle):
    """Polar radius of an ellipse with semi-axes a (along the first axis) and b about its middle."""
    return a * b / np.hypot(b * np.cos(angle), a * np.sin(angle))


def ellipse(a, b):
    """An ellipse by so many descriptors that it is one to 1e-14."""
    count = 2 * int(np.ceil(np.log(1e-14) / np.log((a - b) / (a + b))))
    angle = 2.0 * np.pi / (4 * count) * np.arange(4 * count)
    return Contour.through(ellipse_radius(a, b, angle), count)


def star(lobes, height, radius=1.0):
    """A star with a lobe along the first axis."""
    return Contour(radius, [0.0] * (lobes - 1) + [height * radius], [0.0] * lobes)


def irregular(seed, harmonics=12, radius=1.0):
    """A random outline, far from round and in places concave."""
    descriptors = radius * spectrum(0.16, 0.08, 0.02, harmonics)
    return draw(radius, descriptors, np.random.default_rng(seed))
