"""Hulls from surfaces of triangles: closed forms, the file's own axes, what is said of them and what is refused."""

import re
from itertools import product
from math import pi

import numpy as np
import pytest
from click.testing import CliRunner

from lab.assembly.lines.offsets import read_offsets
from lab.cli.naval import hull
from lab.naval import loaded
from lab.naval.loaded import Loaded, Wind
from lab.naval.surfaces.axes import Axes
from lab.naval.surfaces.mesh import welded
from lab.naval.surfaces.offsets import write_offsets
from lab.naval.surfaces.read import read_surface
from lab.naval.surfaces.selfcheck import self_check
from lab.naval.surfaces.whole import body
from lab.naval.weights import Weights
from solvers.ship.water import Water
from tests.oracles.presets import error_of
from tests.oracles.surfaces import box, cylinder, moved, prism, stl, tube, volume

SEA, FRESH = Water(1025.0), Water(1000.0)
DIAGONALS = list(product((0, 1), repeat=6))
OCTAGON = np.array([[3, 0], [5, 2], [5, 6], [3, 8], [-3, 8], [-5, 6], [-5, 2], [-3, 0]], dtype=float)


@pytest.mark.parametrize("stations", [3, 5, 11, 41])
def test_flat_ends_keep_their_corners(tmp_path, stations):
    """Where a face's diagonal meets a flat end, a cut beside it has a point next to a corner: the box stays a box."""
    for diagonals in DIAGONALS[:: 5 if stations == 3 else 21]:
        form, _ = read_surface(stl(tmp_path / "box.stl", box(diagonals)), stations)
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
        form, _ = read_surface(stl(tmp_path / "prism.stl", surface), stations)
        assert form.volume == pytest.approx(50.0 * area, rel=1e-6)
        assert form.hydrostatics(4.0, FRESH).lcb == pytest.approx(25.0, rel=1e-6)


def test_surface_and_offsets_are_the_same_hull(tmp_path):
    """A round barge's volume converges to π r² L/2 at half depth, and its offsets, written out, give it again."""
    off = []
    for corners in (32, 64):
        form, _ = read_surface(stl(tmp_path / "barge.stl", tube(cylinder(corners))), 11)
        found = form.hydrostatics(0.5 * form.depth, FRESH)
        off.append(abs(found.volume - 0.5 * pi * 25.0 * 40.0) / (0.5 * pi * 25.0 * 40.0))
        write_offsets(form, tmp_path)
        again = read_offsets(tmp_path / "offsets.csv").hydrostatics(0.5 * form.depth, FRESH)
        heights = {"kb": form.base, "km": form.base, "kml": form.base}  # offsets are from the keel
        assert {name: value - heights.get(name, 0.0) for name, value in vars(found).items()} == pytest.approx(
            vars(again), rel=1e-5
        )
    assert off[1] < 0.002 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)


def test_offsets_keep_ends_without_an_area(tmp_path):
    """A hull that ends in a point at both ends is as long and as large by the offsets that are written of her."""
    form, mesh = read_surface(stl(tmp_path / "diamond.stl", diamond()), 5)
    assert write_offsets(form, tmp_path) == ""
    again = read_offsets(tmp_path / "offsets.csv")
    assert (again.volume, np.ptp(again.x)) == pytest.approx((mesh.volume, 40.0), rel=1e-6)


def diamond() -> np.ndarray:
    """A hull 40 m long, 10 m broad and 5 m deep whose waterplane is a rhombus; her volume is 1000 m³."""
    square = np.array([[-5.0, 0.0], [5.0, 0.0], [5.0, 5.0], [-5.0, 5.0]])
    rings = prism(square, np.array([0.0, 20.0, 40.0]))
    rings[[0, 2], :, 1] = 0.0
    return tube(rings)


def test_volumes_of_a_mesh_have_their_closed_forms():
    """Of a box whole, up to a level and to a slope, and along her; its triangles may look any way."""
    surface = box((0, 1, 1, 0, 1, 0))
    surface[[1, 5, 6]] = surface[[1, 5, 6], ::-1]
    mesh = body(welded(surface, "box"))
    assert mesh.volume == pytest.approx(130.0 * 27.0 * 14.0) and mesh.centre == pytest.approx([65.0, 0.0, 7.0])
    assert mesh.below(8.6) == pytest.approx(30186.0) and mesh.below(99.0) == pytest.approx(mesh.volume)
    assert mesh.below(5.0, 0.02) == pytest.approx(130.0 * 27.0 * (5.0 + 0.02 * 65.0))
    assert mesh.along(np.array([0.0, 10.0, 130.0]), 8.6) == pytest.approx([0.0, 2322.0, 30186.0])


def test_stations_are_added_until_they_hold_the_volume(tmp_path):
    """Simpson's rule has 4/3 of a rhombus by three stations; by five, one of them at each quarter, it is exact."""
    form, mesh = read_surface(stl(tmp_path / "diamond.stl", diamond()), 3)
    assert (mesh.volume, form.volume) == pytest.approx((1000.0, 1000.0), rel=1e-6) and len(form.x) == 5
    rings = cylinder(24)  # a round barge that narrows to both ends as a sine does
    swell = np.sin(pi * np.linspace(0.02, 0.98, 21))[:, None]
    rings[..., 1] *= swell
    form, mesh = read_surface(stl(tmp_path / "round.stl", tube(rings)), 3)
    for level in form.base + form.depth * np.array([0.3, 0.6, 0.9]):
        off = form.displaced(np.full(len(form.x), level))[0] / mesh.below(level) - 1.0
        assert abs(off) <= 1e-3 and len(form.x) > 3  # each tenth of the depth is compared


def test_what_stands_between_stations_is_refused_with_its_place(tmp_path):
    """A wall 5 cm thick and 300 m high, 3 % of the volume, is nowhere to be seen from stations 25 cm apart."""
    places = np.array([0.0, 37.1, 37.101, 37.15, 37.151, 100.0])
    heights = np.array([5.0, 5.0, 300.0, 300.0, 5.0, 5.0])
    rings = prism(np.array([[-5.0, 0.0], [5.0, 0.0], [5.0, 1.0], [-5.0, 1.0]]), places)
    rings[..., 2] *= heights[:, None]
    found = error_of(read_surface, stl(tmp_path / "wall.stl", tube(rings)), 401)
    assert (
        "401 stations have 2.9 % another volume than the surface itself, most of it between x 37 and 37.25 m" in found
    )


def test_text_surface_and_scale(tmp_path):
    lines = ["solid hull"]
    for triangle in tube(1000.0 * cylinder(16)):
        corners = "".join(f"vertex {x:.6e} {y:.6e} {z:.6e}\n" for x, y, z in triangle)
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    (tmp_path / "hull.stl").write_text("\n".join([*lines, "endsolid"]))
    form, _ = read_surface(tmp_path / "hull.stl", 5, Axes(scale=0.001))
    assert form.volume == pytest.approx(volume(tube(cylinder(16))), rel=1e-5)


def test_surfaces_that_are_no_hull(tmp_path):
    whole = tube(cylinder(12))
    (tmp_path / "b.stl").write_text("nothing of the kind")
    assert "no STL file" in error_of(read_surface, tmp_path / "b.stl", 5)
    not_finite = whole.copy()
    not_finite[3, 1, 0] = np.nan
    assert "no STL file" in error_of(read_surface, stl(tmp_path / "n.stl", not_finite), 5)
    assert "cannot be read" in error_of(read_surface, tmp_path / "none.stl", 5)


def barge_with_a_rudder() -> np.ndarray:
    """A box of 100 × 20 × 10 m with a rudder, 3 × 0.4 m, down from 6 m above to 1 m below her keel."""
    outline = np.array([[-10, 0], [10, 0], [10, 10], [-10, 10]], dtype=float)
    blade = np.array([[-0.2, -1], [0.2, -1], [0.2, 6], [-0.2, 6]])
    rings = np.stack([blade, blade, outline, outline])
    return tube(np.concatenate([np.array([-3.0, 0.0, 0.0, 100.0])[:, None, None] + np.zeros((4, 4, 1)), rings], axis=2))


def test_the_axes_of_the_file_are_kept(tmp_path, monkeypatch):
    """Wherever the file's x and z begin, weights and openings there make the same ship; a rudder moves no height."""
    monkeypatch.setattr(loaded, "HEELS", np.radians([-40.0, -20.0, -8.0, 0.0, 8.0, 20.0, 40.0]))  # 181 take long
    ships = []
    for x, z in ((0.0, 0.0), (-50.0, -6.0)):
        form, _ = read_surface(stl(tmp_path / "barge.stl", moved(barge_with_a_rudder(), x, 0, z)), 11)
        weights = Weights(12000.0, 51.0 + x, 0.1, 6.5 + z, 800.0)
        points = {"opening": np.array([[30.0 + x, 8.0, 11.0 + z], [30.0 + x, -8.0, 11.0 + z]])}
        ship = Loaded(form, SEA, weights, points, wind=Wind(900.0, 8.0))
        ships.append(ship)
        assert form.base == pytest.approx(z, abs=1e-6) and form.depth == pytest.approx(10.0)
        assert ship.upright.kb == pytest.approx(ship.draughts[2] / 2.0 + z, abs=0.015)  # trim²/(24 T): 4 mm
        assert (ship.upright.lcb, form.x[0], form.ends[1]) == pytest.approx((51.0 + x, x - 3.0, x + 100.0), rel=1e-6)
    one, other = ships
    assert other.draughts == pytest.approx(one.draughts, rel=1e-6)
    assert one.draughts[2] == pytest.approx(12000.0 / 1.025 / 2000.0, abs=0.02)  # her rudder carries 4 mm
    assert other.metacentric_height == pytest.approx(one.metacentric_height, rel=1e-6)
    assert other.levers.lever == pytest.approx(one.levers.lever, abs=1e-6)
    assert (other.flooding, other.deck_edge_angle) == pytest.approx((one.flooding, one.deck_edge_angle), rel=1e-6)
    assert vars(other.exposed) == pytest.approx(vars(one.exposed), rel=1e-6)


BOX = box()
HALF = BOX * [1.0, 0.5, 1.0] + [0.0, 6.75, 0.0]  # her starboard half, with a wall in the middle plane
LIDLESS = BOX[~(BOX[..., 2] == 14.0).all(axis=1)]


def without_middle(half: np.ndarray) -> np.ndarray:
    return half[~(half[..., 1] == 0.0).all(axis=1)]


@pytest.mark.parametrize(
    ("surface", "axes"),
    [
        pytest.param(moved(BOX, 0.0, 13.5, 0.0), Axes(origin=(0.0, 13.5, 0.0)), id="beside"),
        pytest.param(HALF, Axes(mirror=True), id="half with a wall"),
        pytest.param(without_middle(HALF) * [1.0, -1.0, 1.0], Axes(mirror=True), id="open half, port"),
        pytest.param(without_middle(HALF)[:-2], Axes(mirror=True, close=True), id="half without a deck"),
        pytest.param(LIDLESS, Axes(close=True), id="without a deck"),
        pytest.param(1000.0 * BOX, Axes(scale=0.001), id="mm"),
        pytest.param(1000.0 * BOX[..., [0, 2, 1]] * [1, 1, -1], Axes(scale=0.001, up="y"), id="y up"),
        pytest.param(moved(BOX, 2e4, 2e4, 2e4), Axes(origin=(2e4, 2e4, 2e4)), id="far"),
        pytest.param(BOX[:, ::-1], Axes(), id="inside out"),
    ],
)
def test_asked_for_a_hull_is_read_in_her_axes(tmp_path, surface, axes):
    form, mesh = read_surface(stl(tmp_path / "box.stl", surface), 5, axes)
    found = form.hydrostatics(8.6, SEA)
    exact = 30186.0, 65.0, 4.3, 27.0**2 / 12.0 / 8.6
    assert (found.volume, found.lcb, found.kb, found.bm) == pytest.approx(exact, rel=1e-5)
    assert mesh.volume == pytest.approx(49140.0, rel=1e-5)


@pytest.mark.parametrize(
    ("surface", "axes", "said"),
    [
        pytest.param(moved(BOX, 0.0, 13.5, 0.0), Axes(), "from y 0 to 27 m.* --origin 0 13.5 0 puts", id="beside"),
        pytest.param(moved(BOX, 0.0, 3.0, 0.0), Axes(), "from y -10.5 to 16.5 m.* --origin 0 3 0 puts", id="aside"),
        pytest.param(HALF, Axes(), "if this is half of her, give --mirror", id="half"),
        pytest.param(without_middle(HALF), Axes(), "a hole .* y 0, z 0 to 14 m; .* give --mirror", id="open half"),
        pytest.param(without_middle(HALF)[:-2], Axes(), "half a hull, give --mirror", id="half without a deck"),
        pytest.param(BOX, Axes(mirror=True), "--mirror is for a half hull", id="mirrored whole"),
        pytest.param(LIDLESS, Axes(), "a hole with a rim of 4 edges, .* z 14 m; .* give --close", id="no deck"),
        pytest.param(1000.0 * BOX, Axes(), "is 130000 m long, .* give --scale 0.001", id="mm"),
        pytest.param(BOX[..., [0, 2, 1]], Axes(), "if y is up in the file, give --up y", id="y up"),
        pytest.param(BOX[..., [1, 0, 2]], Axes(), "turn her so that x is forward", id="y forward"),
        pytest.param(moved(BOX, 2e4, 0, 0), Axes(), "20000 m from its origin, .* --origin 20000 0 0", id="far"),
        pytest.param(np.concatenate([BOX, BOX]), Axes(), "12 triangles are in the file twice", id="twice"),
        pytest.param(
            np.concatenate([BOX, box(low=(130, 13.5, 0), high=(150, 20, 14))]),
            Axes(),
            r"4 triangles meet in the edge from \(130, 13.5, 0\) m to \(130, 13.5, 14\) m, .* bodies touch there",
            id="touching bodies",
        ),
        pytest.param(
            np.concatenate([BOX, box(low=(-3, -0.2, 0), high=(-1, 0.2, 6))]),
            Axes(),
            "2 bodies that do not hang together, the second largest x -3 to -1, y -0.2 to 0.2, z 0 to 6 m",
            id="two bodies",
        ),
    ],
)
def test_what_is_not_in_a_hulls_axes_or_not_closed_is_refused(tmp_path, surface, axes, said):
    found = error_of(read_surface, stl(tmp_path / "box.stl", surface), 5, axes)
    assert re.search(said, found), found


def test_a_hole_that_is_not_flat_is_not_closed(tmp_path):
    surface = stl(tmp_path / "box.stl", without_middle(HALF)[:-2])  # its deck and its middle are one bent hole
    found = error_of(read_surface, surface, 5, Axes(close=True))
    assert "is not flat, so --close does not know its lid" in found


def test_a_cut_in_two_pieces_is_refused_with_their_heights(tmp_path):
    """A rudder that hangs from a shelf aft: at the same x the shelf is above it and air between them."""
    found = error_of(read_surface, stl(tmp_path / "c.stl", hooked()), 5)
    assert "the cut at x 0 m has 2 pieces, z 0 to 2 and 8 to 10 m" in found


def hooked() -> np.ndarray:
    """A body 10 m broad whose profile is a C that opens aft: arms at 0 to 2 and at 8 to 10 m, joined ahead."""
    profile = np.array([[0, 0], [40, 0], [40, 10], [0, 10], [0, 8], [30, 8], [30, 2], [0, 2]], dtype=float)
    rings = np.array([np.column_stack([profile[:, 0], np.full(8, y), profile[:, 1]]) for y in (-5.0, 5.0)])
    surface = tube(rings)[:-16]  # without the fans, which do not fit a C
    lids = [(0, 1, 6), (0, 6, 7), (1, 2, 5), (1, 5, 6), (2, 3, 4), (2, 4, 5)]
    return np.concatenate([surface, *[ring[np.array(lids)] for ring in rings]])


def test_command_shows_what_it_read(tmp_path):
    """Size, volumes, symmetry, perpendiculars and base line are said; offsets are from AP and base line."""
    surface = stl(tmp_path / "box.stl", moved(BOX, -65.0, 0.0, -8.6))
    answer = CliRunner().invoke(hull, [str(surface), "--stations", "5", "--out", str(tmp_path)])
    assert answer.exit_code == 0, answer.output
    said = " ".join(answer.output.split())
    assert "L x B x D 130 x 27 x 14 m; x -65 to 65, y -13.5 to 13.5, z -8.6 to 5.4" in said
    assert "volume 49140 m3 by the surface, 49140 by 5 stations; at all draughts within" in said
    assert "symmetry both sides alike" in said and "AP, FP at -65 and 65 m" in said
    assert "draughts from z -8.6 m, her keel amidships" in said
    assert "offsets.csv is from her aft perpendicular (x -65 m) and her base line (z -8.6 m)" in said
    first = (tmp_path / "hydrostatics.csv").read_text().splitlines()[1].split(",")
    draught, centre = float(first[0]), float(first[4])
    assert centre == pytest.approx(0.5 * draught - 8.6, abs=0.002)
    offsets = tmp_path / "offsets.csv"
    assert read_offsets(offsets).volume == pytest.approx(49140.0, rel=1e-5) and "0,0,13.5" in offsets.read_text()
    answer = CliRunner().invoke(hull, [str(offsets), "--mirror", "--out", str(tmp_path)])
    assert answer.exit_code != 0 and "--mirror and --close are for surfaces" in str(answer.exception or answer.output)


def test_a_hull_whose_sides_differ_is_told_so(tmp_path):
    """A box with a wing on her port side above water is read; her offsets, of half-breadths, are not written."""
    outline = np.array([[-10, 0], [10, 0], [10, 10], [-16, 10], [-16, 9], [-10, 9]], dtype=float)
    form, mesh = read_surface(stl(tmp_path / "wing.stl", tube(prism(outline, np.array([0.0, 50.0, 100.0])))), 5)
    assert mesh.volume == pytest.approx(20600.0) and form.volume == pytest.approx(20600.0)
    said = " ".join(" ".join(self_check(form, mesh, 5)).split())
    assert "NOT alike: the centre of the station at x 0 m is 0.379 m to port" in said  # 6 m² × 13 m / 206 m²
    assert "offsets.csv was not written" in write_offsets(form, tmp_path)
    assert form.hydrostatics(5.0, SEA).bm == pytest.approx(20.0**2 / 12.0 / 5.0, rel=1e-6)
