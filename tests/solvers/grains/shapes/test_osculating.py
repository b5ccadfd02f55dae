"""Contacts updated on osculating circles: exact between discs, of third order in the slide for other outlines."""

from dataclasses import replace

import numpy as np
import pytest
import taichi as ti

from solvers.grains.shapes.contour import Contour
from solvers.grains.shapes.rules.osculating import OFF, Osculating, slide_of
from solvers.grains.shapes.rules.rest import SAID
from solvers.grains.shapes.rules.tracked import CURVED_I, CURVED_J
from solvers.machine import runtime
from solvers.machine.state import State
from solvers.machine.units import Units
from tests.oracles.axes import axes
from tests.oracles.outlines import ellipse, star
from tests.oracles.shape_kernels import Asked, Pairs, random_pairs

COUNT = 512
EGG = ellipse(1.3, 0.8)
OUTLINES = [Contour(1.0), EGG, star(3, 0.05)]


@ti.data_oriented
class Carrying:
    """What `Osculating` makes of contacts (n, 10) of pairs with ways (n, 2) from j to i, after these moves (n, 4)."""

    def __init__(self, count: int, precision: str = "f64"):
        runtime.initialise(1)
        arrays = State(precision)
        self.blocks = count // 8
        units = Units(self.blocks, 1, 1, 1)
        self.rest = Osculating(arrays, units, OUTLINES)
        for name in self.rest.memory:
            (field,) = arrays.vectors(axes(self.blocks, 1, 8), name)
            setattr(self, name, field)
        self.moves = arrays.vectors(axes(self.blocks, 8), *(f"move {k}" for k in range(4)))
        self.now = arrays.vectors(axes(self.blocks, 8), *SAID)
        (self.slid,) = arrays.vectors(axes(self.blocks, 8), "slid")
        arrays.finish()
        self.arrays = arrays

    def carry(
        self, found: np.ndarray, apart: np.ndarray, moves: np.ndarray, forgotten: bool = False
    ) -> tuple[np.ndarray, np.ndarray]:
        """Overlap, normal and point (n, 5) after the moves, and how far the contacts have slid (n,).

        The contacts may have been `forgotten` before they are moved.
        """
        known = np.concatenate([found[:, : len(SAID)], found[:, CURVED_I : CURVED_J + 1]], axis=1)
        for name, values in zip(self.rest.contact, known.T, strict=True):
            getattr(self, name).from_numpy(values.reshape(-1, 1, 8))
        self.apart_y.from_numpy(apart[:, 0].reshape(-1, 1, 8))
        self.apart_z.from_numpy(apart[:, 1].reshape(-1, 1, 8))
        for field, values in zip(self.moves, moves.T, strict=True):
            field.from_numpy(values.reshape(-1, 8))
        self._carry(forgotten)
        now = [field.to_numpy().reshape(-1) for field in self.now]
        return np.stack(now, axis=1), self.slid.to_numpy().reshape(-1)

    @ti.kernel
    def _carry(self, forgotten: bool):
        for u in range(self.blocks):
            for p in range(8 if forgotten else 0):
                self.rest.forget(self, u, p, False)
            moves = [self.moves[0][u], self.moves[1][u], self.moves[2][u], self.moves[3][u]]
            overlap, ny, nz, py, pz, slid = self.rest.carried(self.rest.contact, self, u, 0, moves)
            self.now[0][u], self.now[1][u], self.now[2][u], self.now[3][u], self.now[4][u] = overlap, ny, nz, py, pz
            self.slid[u] = slid


def moved_pairs(size: float):
    """Random pairs that overlap, as they are and after moves of this size, and these moves (n, 4)."""
    pairs, random = random_pairs(OUTLINES[:1], COUNT, 1, (-0.03, -0.005)), np.random.default_rng(2)
    shift, turn = size * random.uniform(-1.0, 1.0, pairs.place.shape), size * random.uniform(-1.0, 1.0, (COUNT, 2))
    moved = replace(pairs, place=pairs.place + shift, angle=pairs.angle + turn)
    return pairs, moved, np.concatenate([shift[:, 0] - shift[:, 1], turn], axis=1)


def carried(outline: Contour, *sizes: float):
    """Contacts of pairs of one outline after moves of each size, as they are carried, as they are, how far they slid.

    They overlap where discs do, as far as that goes.
    """
    asked, carrying = Asked([outline], COUNT), Carrying(COUNT)
    for size in sizes:
        pairs, moved, moves = moved_pairs(size)
        found = asked.scanned(pairs, 0.1)[1][:, 0]
        now, slid = carrying.carry(found, pairs.place[:, 0] - pairs.place[:, 1], moves)
        for _ in range(4):
            expected = asked.followed(moved)[:, 0]
        touching = (found[:, 0] > 0.0) & (expected[:, 0] > 0.0)
        assert touching.sum() > 100
        yield now[touching], expected[touching, : len(SAID)], slid[touching]
    asked.arrays.release()
    carrying.arrays.release()


def between_discs(pairs: Pairs) -> tuple[np.ndarray, np.ndarray]:
    """Contacts of discs, their sizes being the pairs' scales, and the ways (n, 2) from j to i."""
    apart = pairs.place[:, 0] - pairs.place[:, 1]
    distance = np.linalg.norm(apart, axis=1)
    overlap, normal = pairs.scale.sum(axis=1) - distance, apart / distance[:, None]
    point = -(pairs.scale[:, 0] - 0.5 * overlap)[:, None] * normal
    unused = np.zeros((COUNT, CURVED_I - len(SAID)))
    return np.concatenate([overlap[:, None], normal, point, unused, pairs.scale], axis=1), apart


def test_contacts_between_discs_are_exact_to_rounding():
    pairs, moved, moves = moved_pairs(3e-3)
    carrying = Carrying(COUNT)
    now, _ = carrying.carry(*between_discs(pairs), moves)
    carrying.arrays.release()
    assert now == pytest.approx(between_discs(moved)[0][:, : len(SAID)], abs=1e-12)


def test_a_forgotten_contact_has_no_normal_however_far_off_its_mate_is():
    """In 32 bits such levers times a grain's spin became infinite, and its torque not a number."""
    pairs, _, moves = moved_pairs(3e-3)
    carrying = Carrying(COUNT, "f32")
    far = np.where([True, True, False, False], 1e3, moves).astype(np.float32)
    found, apart = (values.astype(np.float32) for values in between_discs(pairs))
    now, _ = carrying.carry(found, apart, far, forgotten=True)
    carrying.arrays.release()
    assert np.isfinite(now).all()
    assert (now[:, 0] < -1e3).all()
    assert (now[:, 1:3] == 0.0).all()


@pytest.mark.slow  # the largest error is in `test_the_allowed_slide_bounds_the_error_of_the_overlap`
@pytest.mark.parametrize("outline", [EGG, OUTLINES[2]], ids=["ellipse", "three lobes"])
def test_errors_of_overlaps_are_of_third_order_in_the_moves(outline):
    """Normals and points have errors of second order."""
    errors = [np.abs(now - expected) for now, expected, _ in carried(outline, 8e-3, 4e-3)]
    orders = [np.log2(np.median(a) / np.median(b)) for a, b in zip(*(error.T for error in errors), strict=True)]
    assert 2.7 < orders[0] < 3.3
    assert all(1.7 < order < 2.3 for order in orders[1:])


def test_the_allowed_slide_bounds_the_error_of_the_overlap():
    """Both outlines contribute; the smallest grains are half as large as EGG."""
    ((now, expected, slid),) = carried(EGG, 2e-3)
    allowed = slid < 0.5 * slide_of(EGG)
    assert allowed.sum() > 100
    assert np.abs(now - expected)[allowed, 0].max() < 2.0 * OFF


def test_the_sharpest_change_of_curvature():
    """Of an ellipse, κ = a b/(a² sin² t + b² cos² t)^(3/2), by differences."""
    a, b = 1.3, 0.8
    t = np.linspace(0.0, 2.0 * np.pi, 200_001)
    size = np.sqrt((a * np.sin(t)) ** 2 + (b * np.cos(t)) ** 2)
    change = np.abs(np.gradient(a * b / size**3, t) / size).max()
    assert EGG.sharpest_change == pytest.approx(change, rel=1e-2)
