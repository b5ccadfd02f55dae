"""Hulls from surfaces of triangles: closed forms, the file's own axes, what is said of them and what is refused."""

from itertools import product
from math import pi

import numpy as np
import pytest

from lab.assembly.offsets import from_offsets, rows_of
from lab.naval.surface import read_surface
from solvers.ship.water import Water
from tests.oracles.presets import error_of
from tests.oracles.surfaces import box, cylinder, prism, stl, tube, volume

SEA, FRESH = Water(1025.0), Water(1000.0)
DIAGONALS = list(product((0, 1), repeat=6))
OCTAGON = np.array([[3, 0], [5, 2], [5, 6], [3, 8], [-3, 8], [-5, 6], [-5, 2], [-3, 0]], dtype=float)


@pytest.mark.parametrize("stations", [3, 5, 11, 41])
def test_flat_ends_keep_their_corners(tmp_path, stations):
    """Where a face's diagonal meets a flat end, a cut beside it has a point next to a corner: the box stays a box."""
    for diagonals in DIAGONALS if stations == 3 else DIAGONALS[::9]:
        form = read_surface(stl(tmp_path / "box.stl", box(diagonals)), stations)
        found = form.hydrostatics(8.6, SEA)
        assert (found.volume, found.lcb, found.kb) == pytest.approx((30186.0, 65.0, 4.3), rel=1e-6), diagonals
        assert found.bm == pytest.approx(27.0**2 / 12.0 / 8.6, rel=1e-6)


@pytest.mark.parametrize("section", [OCTAGON, OCTAGON[[1, 3, 5, 7]]])
@pytest.mark.parametrize("rings", [2, 3, 6])
def test_prisms_with_alternating_diagonals(tmp_path, section, rings):
    """Area times length, and the centre in the middle, however its panels are divided."""
    surface = tube(prism(section, np.linspace(0.0, 50.0, rings)), alternate=True)
    y, z = section.T
    area = 0.5 * float(y @ np.roll(z, -1) - z @ np.roll(y, -1))
    for stations in (3, 11, 20):
        form = read_surface(stl(tmp_path / "prism.stl", surface), stations)
        assert form.volume == pytest.approx(50.0 * area, rel=1e-6)
        assert form.hydrostatics(4.0, FRESH).lcb == pytest.approx(25.0, rel=1e-6)


def test_surface_and_offsets_are_the_same_hull(tmp_path):
    """A round barge's volume converges to π r² L/2 at half depth, and its offsets, written out, give it again."""
    off = []
    for corners in (32, 64):
        form = read_surface(stl(tmp_path / "barge.stl", tube(cylinder(corners))), 11)
        found = form.hydrostatics(0.5 * form.depth, FRESH)
        off.append(abs(found.volume - 0.5 * pi * 25.0 * 40.0) / (0.5 * pi * 25.0 * 40.0))
        again = from_offsets(*np.array(list(rows_of(form))).T).hydrostatics(0.5 * form.depth, FRESH)
        assert vars(again) == pytest.approx(vars(found), rel=1e-5)
    assert off[1] < 0.002 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)


def test_text_surface_and_scale(tmp_path):
    lines = ["solid hull"]
    for triangle in tube(1000.0 * cylinder(16)):
        corners = "".join(f"vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in triangle)
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    (tmp_path / "hull.stl").write_text("\n".join([*lines, "endsolid"]))
    form = read_surface(tmp_path / "hull.stl", 5, scale=0.001)
    assert form.volume == pytest.approx(volume(tube(cylinder(16))), rel=1e-5)


def test_surfaces_that_are_no_hull(tmp_path):
    whole = tube(cylinder(12))
    assert "has holes, 3 of its edges" in error_of(read_surface, stl(tmp_path / "a.stl", whole[1:]), 5)
    (tmp_path / "b.stl").write_text("nothing of the kind")
    assert "no STL file" in error_of(read_surface, tmp_path / "b.stl", 5)
    twins = np.concatenate([whole, whole + np.array([0.0, 30.0, 0.0])])
    assert "several pieces" in error_of(read_surface, stl(tmp_path / "c.stl", twins), 5)
    assert "cannot be read" in error_of(read_surface, tmp_path / "none.stl", 5)
