"""The angle of a heap under a round outlet, by azimuth, and surfaces of beds in space."""

from types import SimpleNamespace

import numpy as np
import pytest

from lab.measures.heap_angle import SECTORS, heap
from lab.measures.wave import column_tops
from solvers.tank.solids.solid import Turned

RADIUS, WIDE = 1e-3, 0.1
BIN = np.array([[-WIDE, 0.0], [WIDE, 0.0], [WIDE, 0.2], [-WIDE, 0.2]])
LIPS = np.array([[[-0.01, 0.15], [0.01, 0.15]]])


def cone(slope, lean=0.0):
    """Spheres of a lattice under a cone of this slope (rad), steeper by `lean` towards +y and less towards −y."""
    pitch = 2.0 * RADIUS
    across = np.arange(-WIDE, WIDE, pitch)
    y, z, x = (axis.ravel() for axis in np.meshgrid(across, np.arange(RADIUS, 0.08, pitch), across, indexing="ij"))
    place = np.column_stack([y, z, x]) + np.random.default_rng(0).uniform(-0.3, 0.3, (len(y), 3)) * RADIUS
    away, azimuth = np.hypot(place[:, 0], place[:, 2]), np.arctan2(place[:, 2], place[:, 0])
    return place[place[:, 1] < 0.06 - away * np.tan(slope + lean * np.cos(azimuth))]


def seen(place):
    return SimpleNamespace(
        worlds=1,
        radius=np.full((1, len(place)), RADIUS),
        mean_diameter=np.array([2.0 * RADIUS]),
        outline=BIN,
        frames={"position": [place[None]]},
        preset=SimpleNamespace(tank=SimpleNamespace(solid=Turned())),
    )


def flanks(place):
    outlet = SimpleNamespace(lips_at=lambda *_: LIPS)
    return heap(seen(place), outlet, 0)


@pytest.mark.parametrize("slope", [20.0, 35.0])
def test_a_cone_has_its_slope_in_all_directions(slope):
    """To half a diameter, the roughness of the lattice, over the length of the flank."""
    found, heights = flanks(cone(np.radians(slope)))
    angles = np.degrees(found[0, :, 0])
    assert len(angles) == SECTORS
    length = 0.6 * 0.06 / np.tan(np.radians(slope))
    assert angles.mean() == pytest.approx(slope, abs=np.degrees(RADIUS / length))
    assert heights[0] == pytest.approx(0.06, abs=4.0 * RADIUS)  # the tip is too narrow for a grain


def test_a_heap_that_leans_is_steeper_on_one_side():
    found, _ = flanks(cone(np.radians(30.0), np.radians(6.0)))
    by_azimuth = np.degrees(found[0, :, 0])  # from −y round by −x
    towards, opposite = by_azimuth[[3, 4]].mean(), by_azimuth[[0, 7]].mean()
    assert towards - opposite == pytest.approx(2 * 6.0 * np.cos(np.pi / 8), abs=2.0)


def test_too_low_a_heap_has_no_angle():
    place = cone(np.radians(35.0))
    found, _ = flanks(place[place[:, 1] < 4.0 * RADIUS])
    assert np.isnan(found).all()


def test_a_surface_in_space_is_the_mean_over_the_columns_behind_each_other():
    """Half of the length stands twice as high as the other."""
    pitch, half = 2.0 * RADIUS, 0.04
    across, up = np.arange(-WIDE + RADIUS, WIDE, pitch), np.arange(RADIUS, 0.04, pitch)
    behind = np.arange(-half + RADIUS, half, pitch)
    y, z, x = (axis.ravel() for axis in np.meshgrid(across, up, behind, indexing="ij"))
    kept = (z < 0.02) | (x > 0.0)
    place = np.column_stack([y, z, x])[kept]
    tops = column_tops(place, np.full(len(place), RADIUS), BIN, pitch, half)
    np.testing.assert_allclose(tops, 0.03, atol=1e-9)
