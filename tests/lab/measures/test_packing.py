"""The packing fraction of spheres in space, of crystals and of no bed at all."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures.packing import packing
from solvers.tank.solids.solid import Prism, Turned

WIDE = 0.1
BOX = np.array([[-WIDE, 0.0], [WIDE, 0.0], [WIDE, 2 * WIDE], [-WIDE, 2 * WIDE]])
RADIUS = 4e-3
PERIOD = 16 * np.sqrt(2.0) * RADIUS  # eight cells of the crystal
CRYSTAL = np.pi / np.sqrt(18.0)  # of a face-centred cubic one


def crystal(radius, height):
    """Centres (n, 3) m, in the order y, z, x, of a face-centred cubic crystal on the floor of the box."""
    half = np.arange(-40, 41)
    sites = np.stack(np.meshgrid(half, half, half, indexing="ij"), axis=-1).reshape(-1, 3)
    place = np.sqrt(2.0) * radius * sites[sites.sum(axis=1) % 2 == 0]
    inside = (np.abs(place[:, 0]) < WIDE - radius) & (np.abs(place[:, 2]) < WIDE - radius)
    return place[inside & (place[:, 1] > radius) & (place[:, 1] < height)]


@pytest.mark.parametrize(
    "solid", [Prism(2 * WIDE), Prism(PERIOD, periodic=True), Turned()], ids=["box", "slice", "turned"]
)
def test_a_crystal_fills_its_share(solid):
    """Within three standard errors of the points."""
    place = crystal(RADIUS, 0.12)
    if solid.period:
        place = place[(place[:, 2] > -0.5 * PERIOD - 1e-9) & (place[:, 2] < 0.5 * PERIOD - 1e-9)]
    recording = SimpleNamespace(outline=BOX, preset=SimpleNamespace(tank=SimpleNamespace(solid=solid)))
    share, error = packing(recording, place, np.full(len(place), RADIUS))
    assert error < 5e-3
    assert share == pytest.approx(CRYSTAL, abs=3.0 * error)


def test_a_layer_has_no_inside():
    place = crystal(4e-3, 0.02)
    recording = SimpleNamespace(outline=BOX, preset=SimpleNamespace(tank=SimpleNamespace(solid=Prism(2 * WIDE))))
    assert np.isnan(packing(recording, place, np.full(len(place), 4e-3))).all()
