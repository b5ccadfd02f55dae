"""Named cargoes: outlines with published proportions, about their centroids, with their sources."""

import numpy as np
import pytest

from solvers.grains.shapes.cargo import cargo, cargoes
from solvers.machine.errors import Unavailable

NAMES = ("wheat", "rice", "corn", "beans", "soybeans", "sunflower", "sand", "chickpeas-6mm", "chickpeas-8mm")
# Length and width (of wheat: thickness), mm, as the entries' sources give them; the length lies along the first axis.
MEASURED = {
    "wheat": (5.46, 2.12),
    "rice": (9.83, 2.65),
    "corn": (10.09, 8.05),
    "beans": (12.48, 7.92),
    "soybeans": (6.55, 5.56),
    "sunflower": (12.14, 5.79),
}
ANGLE = np.linspace(0.0, 2.0 * np.pi, 2000, endpoint=False)


def test_the_cargoes_are_those_of_the_source():
    assert set(cargoes()) == set(NAMES)
    assert all(len(entry.source) > 20 for entry in cargoes().values())


@pytest.mark.parametrize("name", NAMES)
def test_an_outline_is_about_its_centroid_and_has_the_requested_size(name):
    outline = cargo(name).outline(np.random.default_rng(1), 4e-3)
    assert outline.equivalent_radius == pytest.approx(2e-3, rel=1e-14, abs=0.0)
    assert np.hypot(*outline.centroid) < 1e-9 * outline.radius
    assert outline.smallest_radius > 0.2 * outline.radius
    usual = cargo(name).outline(np.random.default_rng(1))
    assert 2.0 * usual.equivalent_radius == pytest.approx(cargo(name).diameter, rel=1e-14, abs=0.0)


@pytest.mark.parametrize("name", MEASURED)
def test_lengths_and_widths_are_those_measured(name):
    outline = cargo(name).outline(np.random.default_rng(1))
    assert 1e3 * np.ptp(outline.points(ANGLE), axis=0) == pytest.approx(MEASURED[name], rel=0.01)


@pytest.mark.parametrize("name", ["sand", "chickpeas-6mm", "chickpeas-8mm"])
def test_outlines_from_a_spectrum_are_drawn_independently(name):
    random = np.random.default_rng(5)
    one, other = (cargo(name).outline(random) for _ in range(2))
    assert np.abs(one.polar(ANGLE) / one.radius - other.polar(ANGLE) / other.radius).max() > 0.02
    assert cargo(name).outline(np.random.default_rng(5)) == one


def test_chickpeas_have_the_sizes_of_the_source():
    assert [cargo(f"chickpeas-{size}mm").diameter for size in (6, 8)] == pytest.approx([6e-3, 8e-3])


def test_beans_and_corn_are_concave_on_one_side_and_rice_is_not():
    def hollow(name):
        """Whether the outline is concave somewhere."""
        contour = cargo(name).outline(np.random.default_rng(1))
        tangent = contour.tangents(ANGLE)
        way = np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0]))
        return np.diff(way).min() < -1e-4

    assert hollow("beans") and hollow("corn")
    assert not hollow("rice")


def test_an_unknown_cargo_is_refused_with_a_list_of_the_known_ones():
    with pytest.raises(Unavailable, match="wheat, rice"):
        cargo("wheet")
