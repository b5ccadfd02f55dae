"""Contact forces of spheres in space, found again from their places."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.preset.find import load
from lab.recording.contacts.again import Again
from lab.recording.contacts.stress import stresses
from solvers.grains.materials import hertz_stiffness, interface

RADIUS, OVERLAP = 6e-3, 1e-5
ALONG = np.array([1.0, 2.0, -2.0]) / 3.0  # in the order y, z, x


@pytest.mark.slow
def test_two_spheres_press_each_other_along_the_line_of_their_centres():
    """By Hertz, in any direction; the stress in each is that of one force on a sphere."""
    preset = load(
        "space/tilting-box",
        {"grains.distribution": "uniform", "grains.table": False}
        | {"grains.diameter": "12 mm", "grains.depth": False, "grains.count": 2},
    ).resolved
    outline = np.array(preset.tank.corners)
    radius = np.full((1, 2), RADIUS)
    known = SimpleNamespace(
        radius=radius, kind=np.zeros((1, 2)), outline=outline, open_edges=(), fixed=np.zeros((0, 3)), shapes=None
    )
    first = np.array([0.0, 0.1, 0.0])
    place = np.stack([first, first + (2.0 * RADIUS - OVERLAP) * ALONG])
    again = Again(preset, known)
    (pressing,) = again.read(0.0, place[None], np.zeros((1, 2, 3)))
    again.close()
    mass = 4.0 / 3.0 * np.pi * RADIUS**3 * preset.material.density
    between = interface(preset.material, preset.material, 0.5 * mass, 0.5 * RADIUS, preset.stiffness_scale)
    force = hertz_stiffness(between.young_modulus, 0.5 * RADIUS) * OVERLAP**1.5
    np.testing.assert_allclose(pressing.force, [-force * ALONG], rtol=1e-4)
    np.testing.assert_allclose(pressing.place[0], place.mean(axis=0), atol=1e-3 * RADIUS)
    expected = force * (RADIUS - 0.5 * OVERLAP) * np.outer(ALONG, ALONG) / (4.0 / 3.0 * np.pi * RADIUS**3)
    found = stresses(pressing, place, radius[0])
    np.testing.assert_allclose(found, [expected, expected], rtol=1e-3, atol=1e-3 * expected.max())
