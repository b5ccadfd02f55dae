"""The drag of a square by finite differences: against potential flow, and the balance of the liquid's momentum."""

import numpy as np
import pytest
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

from lab.studies.reproduce.water.theory.moving_square import MovingSquare

SIDE, BOX, START = 1.0, (10.0, 5.0), 1.5


def started(time, order):
    """A way whose velocity rises to 1 m/s within 0.6 s, smoothly."""
    s = np.clip(time / 0.6, 0.0, 1.0)
    way = 0.6 * (2.5 * s**4 - 3.0 * s**5 + s**6) + np.maximum(time - 0.6, 0.0)
    return [way, 10.0 * s**3 - 15.0 * s**4 + 6.0 * s**5, 30.0 * s**2 * (1.0 - s) ** 2 / 0.6][order]


def added_mass(cells: int) -> float:
    """Of potential flow (ρ m²), by Laplace's equation on squares, so many along the side, in one half of the box."""
    size, open_ = 1.0 / cells, np.ones((10 * cells, 5 * cells // 2), dtype=bool)
    open_[cells : 2 * cells, : cells // 2] = False
    number = np.cumsum(open_).reshape(open_.shape) - 1
    rows, columns, ties = [], [], np.zeros(open_.sum())
    for one, two, known in (
        (number[1:], number[:-1], open_[1:] & open_[:-1]),
        (number[:, 1:], number[:, :-1], open_[:, 1:] & open_[:, :-1]),
    ):
        rows += [one[known], two[known]]
        columns += [two[known], one[known]]
        ties += np.bincount(one[known], minlength=len(ties)) + np.bincount(two[known], minlength=len(ties))
    ties[0] += 1e-6
    rows, columns = np.concatenate([*rows, np.arange(len(ties))]), np.concatenate([*columns, np.arange(len(ties))])
    numbers = np.concatenate([-np.ones(len(rows) - len(ties)), ties])
    beside, flux = slice(0, cells // 2), np.zeros(len(ties))
    front, back = number[2 * cells, beside], number[cells - 1, beside]
    flux[front], flux[back] = -size, size
    potential = spsolve(coo_matrix((numbers, (rows, columns))).tocsc(), flux)
    return 2.0 * size * float(np.sum(potential[back] - potential[front] + size))


def test_without_friction_the_force_is_the_added_mass_of_potential_flow():
    """At the start, before there is a wake; both errors fall with the cells, that of squares as their size to 4/3."""
    coarse, fine = added_mass(10), added_mass(20)
    exact = fine + (fine - coarse) / (2.0 ** (4.0 / 3.0) - 1.0)
    square = MovingSquare(started, SIDE, BOX, START, 1e-7, 10)
    times, forces = square.run(0.1)
    late = times > 0.05
    mass = forces[late].sum() / started(times[late], 2).sum()
    assert mass == pytest.approx(exact, rel=0.01)


def test_what_the_square_pushes_ends_on_the_box():
    """After a second, within 5 % of the drag (the corners leave an error of first order).

    The liquid has −ρ U A of momentum, as it fills the box, which nothing changes once the square moves steadily.
    """
    square = MovingSquare(started, SIDE, BOX, START, 0.01, 6)
    on_square = square.run(1.0)[1][-1].sum()
    places, p, u, y = square.lines(square.time)[0], square.p, square.u, square.y
    ends = 1.5 * (p[0] - p[-1]) - 0.5 * (p[1] - p[-2])  # cells at the ends are nearly as long as those beside them
    near, far = square.edges_y[-1] - y[-1], square.edges_y[-1] - y[-2]
    shear = (u[:, -1] * far / near - u[:, -2] * near / far) / (far - near)
    on_box = 2.0 * np.sum(ends * square.d_y) - 2.0 * square.viscosity * np.trapezoid(shear, places)
    assert on_square == pytest.approx(-on_box, rel=0.05)
