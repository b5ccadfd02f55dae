"""The contact rule of overlap areas: exact for polygons that approximate outlines, and energy-conserving."""

from functools import cache

import numpy as np
import pytest
import taichi as ti

from solvers.grains.shapes.cargo import cargo
from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.pose import posed, turned_back
from solvers.grains.shapes.rules.area import contact_of
from solvers.grains.shapes.rules.polygons import AREA, PUSH_X, PUSH_Y, XY, YX, Polygons
from solvers.machine import runtime
from solvers.machine.state import State
from tests.oracles.axes import axes
from tests.oracles.outlines import ellipse, irregular, star
from tests.oracles.overlap_area import area_contacts
from tests.oracles.shape_kernels import Pairs, random_pairs

COUNT, SOME = 400, 40  # pairs; those that are looked at one by one
MARGIN = 0.1
SHAKEN = 1e-6  # m and rad, to see gradients
ROUGH = Contour(1.0, [0.0] * 49 + [0.0133], [0.0] * 50)
AXES = 1.4, 0.6


def outline_of(name):
    return cargo(name).outline(np.random.default_rng(7), 2.0)


OUTLINES = [star(5, 0.25), irregular(3, 9), outline_of("rice"), outline_of("corn"), ROUGH, ellipse(*AXES), Contour(1.0)]
ELLIPSE, DISC = 5, 6


@ti.data_oriented
class Shared:
    """Overlaps of polygons with so many corners, in the frame of the second grain, and their contacts."""

    def __init__(self, nodes):
        runtime.initialise(1)
        arrays = State()
        self.polygons = Polygons(arrays, OUTLINES, nodes)
        (self.shape,) = arrays.integers(axes(COUNT, 2), "shape")
        (self.scale,) = arrays.reals(axes(COUNT, 2), "scale")
        (self.turn,) = arrays.reals(axes(COUNT, 2, 2), "turn")
        sizes = {"apart": 2, "total": 7, "contact": 6}
        self.apart, self.total, self.contact = (arrays.reals(axes(COUNT, n), name)[0] for name, n in sizes.items())
        arrays.finish()

    def of(self, pairs):
        """The seven sums (n, 7) and the contacts (n, 6) of these pairs."""
        self.load(pairs)
        self._share()
        return self.total.to_numpy(), self.contact.to_numpy()

    def behind(self, pairs):
        """The same of first grains and half-planes: `place` of the second is the normal, times the distance."""
        self.load(pairs)
        self._share_wall()
        return self.total.to_numpy(), self.contact.to_numpy()

    def gaps(self, pairs, margin):
        """At least how far (n,) those edges of the first are from the second that may be within a margin."""
        self.load(pairs)
        self._gaps(margin)
        return self.contact.to_numpy()[:, 0]

    def edge_points(self, pairs, k, n):
        """Points of a grain's polygon as complex numbers, ten an edge."""
        corners = self.polygons.corner.to_numpy()[pairs.shape[k, n]] @ [1.0, 1j] * pairs.scale[k, n]
        along = np.linspace(0.0, 1.0, 11)[:-1, None]
        points = ((1.0 - along) * corners + along * np.roll(corners, -1)).ravel()
        return points * np.exp(1j * pairs.angle[k, n]) + complex(*pairs.place[k, n])

    def load(self, pairs):
        self.shape.from_numpy(np.ascontiguousarray(pairs.shape, dtype=np.int32))
        self.scale.from_numpy(np.ascontiguousarray(pairs.scale))
        self.turn.from_numpy(np.stack([np.cos(pairs.angle), np.sin(pairs.angle)], axis=-1))
        self.apart.from_numpy(np.ascontiguousarray(pairs.place[:, 0] - pairs.place[:, 1]))

    @ti.func
    def outline(self, p, n: ti.template()):
        return posed(self.shape[p, n], self.scale[p, n], ti.Vector([self.turn[p, n, 0], self.turn[p, n, 1]]))

    @ti.kernel
    def _share(self):
        for p in range(COUNT):
            one, two = self.outline(p, 0), self.outline(p, 1)
            between, centre, reach = self.seen(p, one, two)
            start, edges = self.polygons.facing(one, between, centre, reach)
            start, edges = self.polygons.shared(one, between, centre, two, start, edges, 0.0)[2:]
            total = self.polygons.shared(one, between, centre, two, start, edges, 0.0)[0]
            self.note(p, total, contact_of(total, one.scale * two.scale / (one.scale + two.scale), two.turn))

    @ti.kernel
    def _gaps(self, margin: ti.f64):
        for p in range(COUNT):
            one, two = self.outline(p, 0), self.outline(p, 1)
            between, centre, reach = self.seen(p, one, two)
            start, edges = self.polygons.facing(one, between, centre, reach + margin)
            start, edges = self.polygons.shared(one, between, centre, two, start, edges, margin)[2:]
            self.contact[p, 0] = self.polygons.shared(one, between, centre, two, start, edges, margin)[1]

    @ti.kernel
    def _share_wall(self):
        for p in range(COUNT):
            away, one = ti.Vector([self.apart[p, 0], self.apart[p, 1]]), self.outline(p, 0)
            own, far = turned_back(one.turn, away / away.norm()), away.norm()
            start, edges = self.polygons.below(one.shape, own, -far / one.scale)
            start, edges = self.polygons.behind(one, own, far, start, edges, 0.0)[1:]
            total = self.polygons.behind(one, own, far, start, edges, 0.0)[0]
            self.note(p, total, contact_of(total, one.scale, one.turn))

    @ti.func
    def seen(self, p, one: ti.template(), two: ti.template()):
        centre = turned_back(two.turn, ti.Vector([self.apart[p, 0], self.apart[p, 1]]))
        return turned_back(two.turn, one.turn), centre, two.scale * self.polygons.bounding[two.shape]

    @ti.func
    def note(self, p, total, contact):
        for n in ti.static(range(7)):
            self.total[p, n] = total[n]
        for n in ti.static(range(6)):
            self.contact[p, n] = contact[n]


@pytest.fixture(scope="module")
def shared():
    """Those with so many nodes, each made once; they end with this file, for others look for their kernels after it."""
    return cache(Shared)


@pytest.fixture(scope="module")
def polygons(shared):
    return shared(100)


@pytest.fixture(scope="module")
def pairs():
    return random_pairs(OUTLINES, COUNT, 1, (-0.03, 0.01))


def in_the_world(total, angle):
    """Area, force (n, 2) and moment about the first grain's centre, computed in a turned frame."""
    push, turn = total[:, PUSH_X] + 1j * total[:, PUSH_Y], np.exp(1j * angle)
    push = push * turn
    return total[:, AREA], np.stack([push.real, push.imag], axis=1), total[:, XY] - total[:, YX]


def test_area_force_and_torque_do_not_depend_on_the_order_of_the_grains(polygons, pairs):
    """For any number of crossings, including corners of one polygon that lie inside the other."""
    (there, contacts), (back, others) = polygons.of(pairs), polygons.of(pairs.swapped())
    area, push, moment = in_the_world(there, pairs.angle[:, 1])
    again, pull, turn = in_the_world(back, pairs.angle[:, 0])
    assert (area > 1e-3).sum() > COUNT // 2
    assert np.abs(area - again).max() < 1e-13
    assert np.abs(push + pull).max() < 1e-12
    apart = pairs.place[:, 0] - pairs.place[:, 1]
    assert np.abs(moment + turn + apart[:, 0] * push[:, 1] - apart[:, 1] * push[:, 0]).max() < 1e-12
    touching = area > 1e-6
    places = contacts[:, 3:5] + pairs.place[:, 0] - others[:, 3:5] - pairs.place[:, 1]
    assert np.abs(places[touching]).max() < 1e-10


def test_no_gap_is_smaller_than_the_reported_bound(polygons):
    """Compared with closely spaced points on the polygons' edges; all near edges are examined."""
    open_pairs = random_pairs(OUTLINES, COUNT, 6, (0.0, 0.1))
    area, said = polygons.of(open_pairs)[0][:, AREA], polygons.gaps(open_pairs, MARGIN)
    shut = np.flatnonzero(area == 0.0)[:SOME]
    gaps = []
    for k in shut:
        first, second = (polygons.edge_points(open_pairs, k, n) for n in range(2))
        gaps.append(np.abs(first[:, None] - second).min())
    least = np.minimum(said[shut], MARGIN)
    assert (least < np.array(gaps) + 1e-12).all()
    assert np.median(np.maximum(least, 0.0) / np.minimum(gaps, MARGIN)) > 0.3  # else it would be of no use


@pytest.mark.parametrize("wall", [False, True], ids=["grain", "wall"])
def test_force_and_torque_are_the_gradient_of_the_area(polygons, pairs, wall):
    """With respect to shifts and turns of the first grain, so normal and lever are those of the overlap."""
    if wall:
        way = np.random.default_rng(3).uniform(-np.pi, np.pi, COUNT)
        reach = [
            0.95 * pairs.scale[k, 0] * np.abs(OUTLINES[pairs.shape[k, 0]].polar(way[k] + np.pi - pairs.angle[k, 0]))
            for k in range(COUNT)
        ]
        away = np.array(reach)[:, None] * np.stack([np.cos(way), np.sin(way)], axis=1)
        normal = away / np.linalg.norm(away, axis=1, keepdims=True)
        pairs = Pairs(pairs.shape, pairs.scale, pairs.angle, np.stack([away, 0.0 * away], axis=1))

    def asked(y=0.0, z=0.0, angle=0.0):
        if wall:  # only the distance from it counts
            moved = pairs.place[:, 0] + normal * (normal @ [y, z])[:, None]
            return polygons.behind(
                Pairs(pairs.shape, pairs.scale, pairs.angle + angle, moved[:, None] * [[1.0], [0.0]])
            )
        shift, turn = np.array([[y, z], [0.0, 0.0]]), np.array([angle, 0.0])
        return polygons.of(Pairs(pairs.shape, pairs.scale, pairs.angle + turn, pairs.place + shift))

    total, contact = asked()
    area, push, moment = in_the_world(total, pairs.angle[:, 0 if wall else 1])
    assert (area > 1e-3).sum() > COUNT // 2
    gradients = []
    for way in np.eye(3) * SHAKEN:
        (ahead, there), (behind, here) = asked(*way), asked(*-way)
        gradients.append(np.stack([ahead[:, AREA] - behind[:, AREA], there[:, 0] - here[:, 0]]) / (2.0 * SHAKEN))
    gradient, overlaps = np.array(gradients).transpose(1, 2, 0)
    assert np.abs(gradient - np.column_stack([push, moment])).max() < 1e-7
    deep = area > 1e-3
    turning = contact[:, 3] * contact[:, 2] - contact[:, 4] * contact[:, 1]
    assert np.abs(overlaps + np.column_stack([contact[:, 1:3], turning]))[deep].max() < 1e-5


def test_overlap_areas_converge_with_the_square_of_the_nodes(shared, pairs):
    smooth = np.array([sum(one.area for one in area_contacts(*pairs.placed(OUTLINES, k))) for k in range(SOME)])
    error = [np.abs(shared(nodes).of(pairs)[0][:SOME, AREA] - smooth) for nodes in (200, 400)]
    # Of the mean, since an outline with 50 lobes is not seen by so few nodes; and of most that is 2.
    assert np.median(error[1]) < 1e-4
    assert np.median(error[0]) / np.median(error[1]) == pytest.approx(4.0, rel=0.25)


def test_discs_and_ellipses_against_closed_forms(shared):
    """Overlap of discs, to 0.05 ξ/R and the nodes' square; area of an ellipse beyond a line, a circle's segment."""
    random = np.random.default_rng(5)
    way, angle = random.uniform(-np.pi, np.pi, COUNT), random.uniform(-np.pi, np.pi, (COUNT, 2))
    towards, shape = np.stack([np.cos(way), np.sin(way)], axis=1), np.full((COUNT, 2), DISC)
    overlap = random.uniform(1e-3, 0.03, COUNT)
    scale, polygons = random.uniform(0.5, 2.0, (COUNT, 2)), shared(400)
    place = np.stack([0.0 * towards, (scale.sum(axis=1) - overlap)[:, None] * towards], axis=1)
    contact = polygons.of(Pairs(shape, scale, angle, place))[1]
    assert np.abs(contact[:, 0] / overlap - 1.0).max() < 0.02
    assert np.abs(contact[:, 1:3] + towards).max() < 0.02
    middle = (scale[:, 0] - 0.5 * overlap)[:, None] * towards
    assert np.abs(contact[:, 3:5] - middle).max() < 0.012

    far = random.uniform(0.6, 1.0, COUNT)  # of the ellipse's support against the line
    support = np.hypot(AXES[0] * np.cos(way - angle[:, 0]), AXES[1] * np.sin(way - angle[:, 0]))
    wall = Pairs(
        shape * 0 + ELLIPSE,
        0.0 * scale + 1.0,
        angle,
        np.stack([(far * support)[:, None] * towards, 0.0 * towards], axis=1),
    )
    area = polygons.behind(wall)[0][:, AREA]
    segment = AXES[0] * AXES[1] * (np.arccos(far) - far * np.sqrt(1.0 - far**2))
    assert np.abs(area - segment).max() < 3e-4
