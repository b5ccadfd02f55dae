"""Descriptors from points: known outlines are recovered, and points that do not form an outline are refused."""

import numpy as np
import pytest

from solvers.grains.shapes.fitting import fit, read_points
from solvers.machine.errors import BadOutline
from tests.oracles.outlines import irregular


def scattered(contour, count, random):
    """Points of a contour in order, at uneven angles."""
    step = random.uniform(0.5, 1.5, count)
    return contour.points(2.0 * np.pi * np.cumsum(step) / step.sum())


def test_a_known_outline_is_recovered_better_with_more_points():
    contour = irregular(11, radius=2e-3).centred(1e-12)
    angle, random, errors = np.linspace(0.0, 2.0 * np.pi, 500), np.random.default_rng(1), []
    for count in (200, 800, 3200):
        found = fit(scattered(contour, count, random), 60).contour
        errors.append(np.abs(found.polar(angle) - contour.polar(angle)).max())
    assert errors[2] < 1e-5 * contour.radius
    assert errors[0] / errors[1] > 8.0 and errors[1] / errors[2] > 8.0  # second order at least


def test_position_direction_and_a_repeated_last_point_do_not_matter():
    contour = irregular(12).centred()
    points = scattered(contour, 400, np.random.default_rng(2))
    plain = fit(points, 30)
    for other in (points[::-1], np.concatenate([points, points[:1]]), np.roll(points, 77, axis=0)):
        assert fit(other, 30).contour.polar(1.0) == pytest.approx(plain.contour.polar(1.0), rel=1e-9)
    moved = fit(points + np.array([3.0, -20.0]), 30)
    assert moved.centre == pytest.approx((plain.centre[0] + 3.0, plain.centre[1] - 20.0), abs=1e-10)
    assert moved.contour.descriptors == pytest.approx(plain.contour.descriptors, abs=1e-9)


def test_the_contour_is_about_its_own_centroid():
    found = fit(scattered(irregular(13), 300, np.random.default_rng(3)), 12)
    assert np.hypot(*found.contour.centroid) < 1e-13


def test_the_errors_are_those_at_the_points():
    """Points off an outline by known amounts of a high harmonic, which few descriptors cannot follow."""
    contour = irregular(14).centred()
    angle = 2.0 * np.pi / 400 * np.arange(400)
    off = 0.003 * np.cos(90.0 * angle)
    found = fit((contour.polar(angle) + off)[:, None] * contour.points(angle) / contour.polar(angle)[:, None], 50)
    assert found.rms == pytest.approx(0.003 / np.sqrt(2.0), rel=0.02)
    assert found.largest == pytest.approx(0.003, rel=0.1)


def test_a_noisy_outline_gets_the_descriptors_for_an_error_of_a_thousandth():
    contour = irregular(15, 12).centred()
    points = scattered(contour, 2000, np.random.default_rng(4))
    found = fit(points)
    assert 8 <= len(found.contour.descriptors) <= 40
    assert found.rms < 1.2e-3
    fewer = fit(points, len(found.contour.descriptors) - 1)
    assert fewer.rms > 0.8e-3


def test_a_square_needs_more_descriptors_for_less_error():
    side = np.linspace(-1.0, 1.0, 100, endpoint=False)
    one = np.ones(100)
    square = np.concatenate([np.stack(p, axis=1) for p in ((side, -one), (one, side), (-side, one), (-one, -side))])
    errors = [fit(square, count).rms for count in (4, 16, 64)]
    assert errors[0] > 4.0 * errors[1] > 16.0 * errors[2]
    assert fit(square, 64).contour.area == pytest.approx(4.0, rel=1e-3)


def arc(start, stop, radius, count):
    angle = np.linspace(start, stop, count)
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)


CRESCENT = np.concatenate([arc(0.0, 1.8 * np.pi, 1.0, 200), arc(1.8 * np.pi, 0.0, 0.9, 200)])
EIGHT = np.stack([np.sin(np.linspace(0.0, 6.28, 100)), 0.6 + 0.5 * np.sin(np.linspace(0.0, 12.56, 100))], axis=1)


@pytest.mark.parametrize(
    ("points", "says"),
    [
        (CRESCENT, "star-shaped"),
        (EIGHT, "star-shaped|no area"),
        (arc(0.0, 4.0 * np.pi, 1.0, 100)[:-1], "more than once"),
        (arc(0.0, 5.0, 1.0, 7), "at least 8 points"),
        (np.stack([np.arange(9.0), 2.0 * np.arange(9.0)], axis=1), "no area"),
        (np.full((9, 2), np.nan), "finite"),
        (np.ones((9, 3)), "shape"),
    ],
)
def test_points_that_form_no_outline_are_refused(points, says):
    with pytest.raises(BadOutline, match=says) as refused:
        fit(points)
    assert str(refused.value).endswith(".")


def test_too_many_descriptors_for_the_points_are_refused():
    points = arc(0.0, 6.0, 1.0, 21)
    assert len(fit(points, 10).contour.descriptors) == 10
    with pytest.raises(BadOutline, match="0 to 10"):
        fit(points, 11)


@pytest.mark.parametrize("text", ["1,2\n3.5,-4e-1\n", "y,z\n1,2\n3.5,-0.4\n", "\ufeff# mm\ny, z\n\n1, 2\n 3.5,-.4\n"])
def test_points_of_a_file(tmp_path, text):
    path = tmp_path / "outline.csv"
    path.write_text(text, "utf-8")
    assert read_points(path) == pytest.approx(np.array([[1.0, 2.0], [3.5, -0.4]]))


@pytest.mark.parametrize(
    "content", [b"", b"y,z\n", b"1,2,3\n4,5,6\n", b"1,2\n3\n", b"1,2\nx,3\n", b"\xff\xfe\x00", b"1;2\n3;4\n"]
)
def test_a_file_without_points_is_refused(tmp_path, content):
    path = tmp_path / "outline.csv"
    path.write_bytes(content)
    with pytest.raises(BadOutline, match=r"outline\.csv: two numbers"):
        read_points(path)


def test_a_file_that_cannot_be_read_is_refused(tmp_path):
    with pytest.raises(BadOutline, match="cannot be read"):
        read_points(tmp_path / "none.csv")
    with pytest.raises(BadOutline, match="cannot be read"):
        read_points(tmp_path)
