"""Tanks from STL files: what is read from them, and what is refused."""

import numpy as np
import pytest

from lab.assembly.grains import grain_count
from lab.base.errors import LabError
from lab.preset.find import load
from lab.preset.recorded import resolved_from, to_table
from solvers.tank.solids.mesh import Mesh
from tests.oracles.holds import BOX, HOPPER, drawn_out, hold, write_stl

HOLD = "space/hold-quick"


def damaged(change):
    """The triangles (n, 3, 3) of the open hold, changed."""
    mesh = hold(HOPPER, open_top=True)
    points = mesh.points.copy()
    return Points(change(points))


class Points:
    """Triangles in place of a mesh."""

    def __init__(self, points):
        self.points = points


def without(*numbers):
    """Triangles without some."""
    return lambda points: np.delete(points, numbers, axis=0)


def turned(points):
    points[7] = points[7, ::-1]
    return points


def thin(points):
    """The middle of the first edge in place of a corner, and no more than that."""
    points[0, 2] = 0.5 * (points[0, 0] + points[0, 1])
    return points


DAMAGED = {
    "no triangles": (lambda p: p[:0], "is no STL file of triangles"),
    "a hole below": (without(0), "has a hole of 3 edges, from "),
    "two bodies": (lambda p: np.concatenate([p, np.add(p, [0.5, 0.0, 0.0])]), "holds 2 surfaces that do not hang"),
    "a double triangle": (lambda p: np.concatenate([p, p[:1]]), "3 edges are of more than two triangles"),
    "a turned triangle": (turned, "normals differ across the edge from "),
    "no area": (thin, "1 triangle has no area, as at "),
    "a low rim": (without(11), "has a hole of 5 edges, "),
}


@pytest.mark.parametrize("name", DAMAGED)
def test_a_damaged_surface_is_refused_in_a_sentence(name, tmp_path):
    """With the key, the file, the place and a remedy."""
    change, said = DAMAGED[name]
    path = write_stl(tmp_path / "hold.stl", damaged(change))
    with pytest.raises(LabError) as refusal:
        load(HOLD, {"tank.mesh": str(path)}).resolved  # noqa: B018
    assert str(refusal.value).startswith(f"tank.mesh: hold.stl: {said}"), str(refusal.value)
    assert str(refusal.value).count(". ") == 0


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"tank.unit": False}, "tank.unit: missing; a file of triangles has no unit, so give one of m, dm"),
        ({"tank.unit": "ft"}, "grains.table: grains of up to 24 mm are too small for so large a tank"),
        ({"tank.unit": "m", "tank.mesh": "FAR"}, "tank.mesh: far.stl: is 4 km large; look at tank.unit"),
        ({"grains.table": [["300 mm", 1]]}, "grains.table: grains of up to 300 mm do not fit into the tank"),
        ({"grains.count": 4000}, "grains.count: 4000 grains do not fit into the region"),
        ({"grains.count": 4000, "grains.region": False}, "grains.count: 4000 grains do not fit into the tank"),
        ({"tank.width": "1 m"}, "tank.width: a mesh says all of a tank's shape; leave this out, or tank.mesh"),
        ({"tank.along": "1 m"}, "tank.along: a mesh says all of a tank's shape"),
        ({"tank.turned": "x"}, "tank.turned: a mesh says all of a tank's shape"),
        ({"tank.lid": False}, "tank.lid: a mesh that is open at the top has no lid; leave this out"),
        ({"parts.vane.points": [["0 mm", "0 mm"], ["0 mm", "9 mm"]]}, "parts.vane: no parts stand in a tank that is"),
        ({"tank.mesh": "none.stl"}, "tank.mesh: "),
        ({"tank.mesh": False}, "tank.unit: goes with the file of a mesh"),
    ],
)
def test_what_does_not_go_with_a_mesh_is_refused_in_a_sentence(changes, said, tmp_path):
    """With the key and what to do."""
    if changes.get("tank.mesh") == "FAR":
        far = hold(HOPPER, open_top=True)
        changes = changes | {"tank.mesh": str(write_stl(tmp_path / "far.stl", far, scale=1e4))}
    if changes.get("tank.mesh") is False:
        changes = changes | {"tank.width": "1 m", "tank.height": "1 m"}
    with pytest.raises(LabError) as refusal:
        grain_count(load(HOLD, changes).resolved)
    assert str(refusal.value).startswith(said)


def test_either_way_round_and_with_a_lid_a_surface_is_the_same_tank(tmp_path):
    """Inward normals, a volume, and a mouth or none; z is up, x along, y across."""
    for outward in (True, False):
        for open_top in (True, False):
            path = write_stl(tmp_path / "hold.stl", hold(HOPPER, open_top), outward=outward)
            tank = load(HOLD, {"tank.mesh": str(path)}).resolved.tank
            assert tank.solid.volume(BOX, 0.2) == pytest.approx(hold(HOPPER).volume(BOX, 0.2), rel=1e-6)
            assert tank.solid.open == bool(tank.open_edges) == open_top
            np.testing.assert_allclose(np.ptp(tank.solid.corners, axis=0), [0.28, 0.2, 0.4], rtol=1e-6)


def test_the_hold_of_the_lab_is_that_of_the_recipe(tmp_path):
    """Its file has the hold of `tests.oracles.holds`, in mm; the preset keeps it when it is written down."""
    loaded = load("space/hold").resolved
    again = resolved_from(to_table(loaded))
    assert again == loaded
    wanted = hold(HOPPER, open_top=True)
    for solid in (loaded.tank.solid, again.tank.solid):
        assert isinstance(solid, Mesh)
        near = np.linalg.norm(solid.points.mean(axis=1)[:, None] - wanted.points.mean(axis=1), axis=2).min(axis=1)
        assert len(solid.triangles) == len(wanted.triangles) and near.max() < 1e-8
    assert len(drawn_out(BOX, 0.4).triangles) == 12
