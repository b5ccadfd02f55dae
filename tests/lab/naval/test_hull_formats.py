"""Hulls from Wavefront OBJ and GHS geometry files: a box and a wedge in each, and what is refused."""

from pathlib import Path

import numpy as np
import pytest

from lab.naval.hull import read_hull
from tests.oracles.presets import error_of

BOX = """\
# a box, 100 x 20 x 8 m, faces of four corners, some counted from the last
o hull
v 0 -10 0
v 100 -10 0
v 100 10 0
v 0 10 0
v 0 -10 8
v 100 -10 8
v 100 10 8
v 0 10 8
vn 0 0 1
s off
f 1//1 4//1 3//1 2//1
f 5 6 7 8
f 1/2/1 2/3/1 6/4/1 5/5/1
f -7 -6 -2 -3
f 3 4 8 7
f 1 5 8 4
"""
FOOT = 0.3048


def wedge(side: int = 0, effective: float = 1.0, parts: int = 1) -> str:
    """A ship with vertical sides, 300 ft long and 20 ft deep: 60 ft broad amidships, pointed at both ends, in feet."""
    stations = np.linspace(-150.0, 150.0, 31)
    lines = ["Wedge", "\\ a remark", "L:300", "*", "HULL", str(len(stations))]
    for x in stations:
        half = 30.0 * (1.0 - (x / 150.0) ** 2)
        points = [(0.0, 0.0), (half, 0.0), (half, 20.0, 0, 0, "DK"), (0.0, 20.0)] if half else [(0.0, 0.0)]
        lines += [f"{x:g}, {len(points)}", *(",".join(map(str, point)) for point in points)]
    lines += ["**", "HULL.C", str(side), f"{effective:g}", "10, 0, 1", "HULL"]
    for k in range(parts):
        lines += ["***", f"HULL{k}\\main", "SEA WATER", "1", "1.025", "0,0,0", "1", "HULL.C"]
    return "\n".join([*lines, "*CRT", "1, vent", "20, 5, 40", "****", "what follows is not read"]) + "\n"


def written(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text)
    return folder / name


def test_a_box_as_obj(tmp_path):
    hull = read_hull(written(tmp_path, "box.obj", BOX))
    assert hull.at(4.0).volume == pytest.approx(100.0 * 20.0 * 4.0, rel=1e-9)
    assert hull.mesh.volume == pytest.approx(16_000.0, rel=1e-9)


def test_a_wedge_as_gf(tmp_path):
    """Parabolic waterlines, which Simpson's rule sums exactly: V = 2/3 L B T; x forward, moved by the shift."""
    hull = read_hull(written(tmp_path, "wedge.gf", wedge()))
    draught = 10.0 * FOOT
    found = hull.at(draught)
    assert found.volume == pytest.approx(2.0 / 3.0 * 300.0 * 60.0 * 10.0 * FOOT**3, rel=1e-9)
    assert found.lcb == pytest.approx(-10.0 * FOOT, abs=1e-6)
    assert found.kb == pytest.approx(6.0 * FOOT, rel=1e-9)  # 5 ft above the keel, which the shift raises by 1 ft
    assert hull.form.base == pytest.approx(FOOT) and hull.form.depth == pytest.approx(20.0 * FOOT)
    assert found.breadth == pytest.approx(60.0 * FOOT)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (wedge(effective=0.9), "the hull's effectiveness is 0.9"),
        (wedge(parts=2), "displacing parts and their components are HULL0 of 1, HULL1 of 1"),
        (wedge(parts=0), "displacing parts and their components are none"),
        (wedge().replace("-140, 4", "-140, four"), "line 9: a section's place and number of points is needed there"),
        ("nothing\n", "displacing parts and their components are none"),
    ],
)
def test_geometry_files_that_are_refused(tmp_path, text, said):
    assert said in error_of(read_hull, written(tmp_path, "a.gf", text))


def test_obj_files_that_are_refused(tmp_path):
    assert "line 16: is no face of corners above it" in error_of(
        read_hull, written(tmp_path, "a.obj", BOX.replace("f -7 -6 -2 -3", "f -7 -6 -2 -30"))
    )
    assert "is no OBJ file of faces" in error_of(read_hull, written(tmp_path, "a.obj", "v 0 0 0\n"))
