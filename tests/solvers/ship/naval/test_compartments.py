"""Tanks and holds as prisms beside closed forms: volumes, centres, free surfaces, and the transfer of their liquid."""

from itertools import pairwise

import numpy as np
import pytest

from solvers.machine.errors import Unavailable
from solvers.ship.naval.compartments.compartment import Compartment, Length
from solvers.ship.naval.holds import Hold
from solvers.ship.section import Section, box

B, H, L = 10.0, 4.0, 12.0
BOX = Compartment([Length(box(B, H), 20.0, 20.0 + L)], 0.98)


def test_box_has_its_volume_centre_and_second_moment():
    volume = 0.98 * B * 1.5 * L
    assert BOX.volume == pytest.approx(0.98 * B * H * L, rel=1e-12)
    assert BOX.volume_to(1.5) == pytest.approx(volume, rel=1e-12)
    assert float(BOX.level_of(volume)) == pytest.approx(1.5, rel=1e-12)
    assert BOX.centre(volume) == pytest.approx([26.0, 0.0, 0.75], rel=1e-12, abs=1e-12)
    assert BOX.second_moment(volume) == pytest.approx(0.98 * B**3 * L / 12.0, rel=1e-12)
    assert BOX.second_moment(BOX.volume) == 0.0 == BOX.second_moment(0.0)


@pytest.mark.parametrize("depth", [0.6, 1.7, 3.4])
def test_transfer_while_the_surface_meets_both_sides(depth):
    """v ((b² tan φ/12h) cos φ + (b² tan² φ/24h) sin φ), wall-sided."""
    steepest = np.arctan(2.0 * min(depth, H - depth) / B)
    heel = steepest * np.linspace(-1.0, 1.0, 9)
    volume, tan = 0.98 * B * depth * L, np.tan(heel)
    aside, up = B**2 * tan / (12.0 * depth), B**2 * tan**2 / (24.0 * depth)
    expected = volume * (aside * np.cos(heel) + up * np.sin(heel))
    assert BOX.transfer(volume, heel) == pytest.approx(expected, rel=1e-10, abs=1e-9)


def test_transfer_when_the_floor_runs_dry():
    """A triangle in the lower corner: base √(2A/tan φ), centre a third of base and height from the corner."""
    depth, heel = 0.6, np.radians(np.array([10.0, 20.0, 35.0]))
    area, tan = B * depth, np.tan(heel)
    base = np.sqrt(2.0 * area / tan)
    assert (base < B).all() and (base * tan < H).all()
    aside, up = 0.5 * B - base / 3.0, base * tan / 3.0 - 0.5 * depth
    expected = 0.98 * area * L * (aside * np.cos(heel) + up * np.sin(heel))
    assert BOX.transfer(0.98 * area * L, heel) == pytest.approx(expected, rel=1e-10)


def test_transfer_when_the_lid_is_wet():
    """The air is a triangle in the upper corner, of the side that rises: moments of the whole box less its."""
    depth, heel = 3.5, np.radians(np.array([10.0, 20.0, 35.0]))
    air, tan = B * (H - depth), np.tan(heel)
    base = np.sqrt(2.0 * air / tan)
    assert (base < B).all() and (base * tan < H).all()
    area = B * depth
    aside = air * (0.5 * B - base / 3.0) / area
    up = (B * H * 0.5 * H - air * (H - base * tan / 3.0)) / area - 0.5 * depth
    expected = 0.98 * area * L * (aside * np.cos(heel) + up * np.sin(heel))
    assert BOX.transfer(0.98 * area * L, heel) == pytest.approx(expected, rel=1e-10)


def test_on_her_side_the_liquid_lies_on_the_wall():
    volume = 0.98 * B * 1.0 * L
    depth = B * 1.0 / H  # from the wall
    moment = volume * (0.5 * H - 0.5)  # G has risen from 0.5 to half of the height: sin 90° = 1
    assert BOX.centre(volume, np.radians(90.0)) == pytest.approx([26.0, 0.5 * B - 0.5 * depth, 0.5 * H], rel=1e-9)
    assert float(BOX.transfer(volume, np.radians(90.0))) == pytest.approx(moment, rel=1e-9)


def test_lengths_communicate():
    """Two lengths of other breadths have one level; i is the sum where both are in the middle, less if one is not."""
    two = Compartment([Length(box(10.0, H), 0.0, 6.0), Length(box(4.0, H), 6.0, 12.0)])
    volume = 1.5 * (10.0 + 4.0) * 6.0
    assert float(two.level_of(volume)) == pytest.approx(1.5)
    assert two.centre(volume)[0] == pytest.approx((60.0 * 3.0 + 24.0 * 9.0) / 84.0)
    assert two.second_moment(volume) == pytest.approx((10.0**3 + 4.0**3) * 6.0 / 12.0)
    assert [share for *_, share in two.parts(volume)] == pytest.approx([10.0 / 14.0, 4.0 / 14.0])
    wings = [Length(Section(box(2.0, H).outline + np.array([way * 5.0, 0.0])), 0.0, 6.0) for way in (1.0, -1.0)]
    together, apart = Compartment(wings), Compartment(wings[:1])
    steiner = 2.0 * (2.0**3 / 12.0 + 2.0 * 5.0**2) * 6.0
    assert together.second_moment(20.0) == pytest.approx(steiner, rel=1e-12)
    assert apart.second_moment(10.0) == pytest.approx(2.0**3 * 6.0 / 12.0, rel=1e-9)


def test_small_heels_give_the_second_moment():
    """A hopper, not alike on both sides: M/ρ → i φ."""
    hopper = Compartment(
        [Length(Section(np.array([[-2.0, 0.0], [3.0, 0.0], [6.0, 3.0], [-2.0, 3.0]])), 0.0, 10.0)], 0.9
    )
    volume, heel = 0.55 * hopper.volume, 1e-5
    assert float(hopper.transfer(volume, heel)) == pytest.approx(hopper.second_moment(volume) * heel, rel=1e-4)
    other = Compartment([Length(Section(hopper.lengths[0].section.outline[::-1] * [-1.0, 1.0]), 0.0, 10.0)], 0.9)
    heels = np.radians([5.0, 30.0])
    assert other.transfer(volume, heels) == pytest.approx(-hopper.transfer(volume, -heels), rel=1e-10)


def test_a_hold_has_the_volumetric_moments_of_hold_tables():
    outline = np.array([[-9.0, 1.6], [9.0, 1.6], [13.0, 5.9], [13.0, 10.0], [7.0, 13.6], [-7.0, 13.6], [-13.0, 10.0],
                        [-13.0, 5.9]])  # fmt: skip
    new, old = Compartment([Length(Section(outline), 0.0, 25.0)]), Hold(Section(outline), 25.0)
    for share, surface in ((0.3, 15.0), (0.6, 25.0), (0.97, 25.0)):
        volume, angle = share * old.volume, np.radians(surface)
        assert new.volumetric_moment(volume, angle) == pytest.approx(old.volumetric_moment(volume, angle), rel=1e-9)
        assert float(new.level_of(volume)) == pytest.approx(old.filled_with(volume).level, rel=1e-12)


def test_the_largest_free_surface_of_a_tank_that_is_emptied():
    """A wedge is broadest when full: at the filling that counts as full. A box: half full, of which most moves."""
    wedge = Compartment([Length(Section(np.array([[0.0, 0.0], [4.0, 4.0], [-4.0, 4.0]])), 0.0, 5.0)])
    volumes = [0.2, 0.5, 0.9]
    moments = [wedge.second_moment(share * wedge.volume) for share in volumes]
    assert all(one < other for one, other in pairwise([*moments, wedge.second_moment(wedge.freest_volume)]))
    assert 0.9 < wedge.freest_volume / wedge.volume < 0.98
    assert BOX.freest_volume == pytest.approx(0.5 * BOX.volume, rel=0.02)


def test_what_a_tank_cannot_hold_is_refused():
    with pytest.raises(Unavailable, match=r"at most the 470\.4 m3 that it holds"):
        BOX.level_of(480.0)
    with pytest.raises(Unavailable, match="a level of 5 m must be at least 0 and at most 4 m"):
        BOX.volume_to(5.0)
