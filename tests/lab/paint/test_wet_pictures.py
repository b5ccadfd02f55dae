"""Wet cargo in pictures: the pressure over rest, the porosity, small grains, and the line of the water table."""

from dataclasses import replace

import numpy as np
import pytest

from lab.paint.painter import Camera
from lab.paint.water.colours import field, mean_level
from lab.paint.water.layer import SMALL, TABLE, WaterLayer
from solvers.machine.runtime import initialise
from tests.oracles.pools import DENSITY, GRAVITY, MadeFootage, filled, tank

SPACING, DEPTH, SCALE, SIZE = 0.01, 0.2, 400.0, (300, 480)
POROSITY = 0.4


@pytest.fixture(autouse=True, scope="module")
def _taichi():
    initialise(fields=False)


def soaked(roll=0.0, more=0.0, porous=True):
    """Water at rest in a bed up to DEPTH in the middle of a tank that has rolled, with some more pressure (Pa)."""
    apart = SPACING / np.sqrt(POROSITY) if porous else SPACING
    place = filled(lambda p: p[:, 1] < DEPTH + p[:, 0] * np.tan(-roll), tank(), apart)
    pressure = DENSITY * GRAVITY * ((DEPTH - place[:, 1]) * np.cos(roll) - place[:, 0] * np.sin(roll)) + more
    now = {"time": np.zeros(1), "series_time": np.zeros(1), "series": {"water_centre": np.zeros((1, 2))}}
    pose = np.array([[0.0, 0.0, roll]])
    made = MadeFootage(tank(), SPACING, [place], [np.zeros_like(place)], [pressure], pose=pose, **now)
    volume = np.full((1, len(place)), 0.9 * DEPTH * (POROSITY if porous else 1.0) / len(place))
    made.water = replace(made.water, volume=volume, porous=porous, tabled=porous, density=DENSITY, gravity=GRAVITY)
    made.porosity = [np.full(len(place), POROSITY)]
    return made


@pytest.mark.parametrize("porous", [True, False])
@pytest.mark.parametrize("roll", [0.0, 0.3])
def test_water_at_rest_has_no_excess_pressure(roll, porous):
    """Level in the earth's axes, whatever the tank's roll; what is added shows, everywhere alike."""
    made = soaked(roll, porous=porous)
    assert mean_level(made.bed, 0) == pytest.approx(DEPTH)
    found = field("excess-pressure", [made.bed])
    assert np.abs(found.values(made.bed, 0)).max() < 0.01 * DENSITY * GRAVITY * DEPTH
    pressed = soaked(roll, 500.0, porous)
    scale = field("excess-pressure", [pressed.bed])
    np.testing.assert_allclose(scale.values(pressed.bed, 0), 500.0, atol=0.01 * DENSITY * GRAVITY * DEPTH)
    assert scale.low == -scale.high and scale.label == "pressure over rest (Pa)"


def test_the_level_of_water_that_has_a_depth_is_that_depth():
    """The amount that a recording tells is that of the preset's level only about."""
    made = soaked()
    made.water = replace(made.water, volume=1.04 * made.water.volume, level=DEPTH)
    assert mean_level(made.bed, 0) == pytest.approx(DEPTH)


def test_porosity_is_shown_up_to_clear_water():
    made = soaked()
    scale = field("porosity", [made.bed])
    assert (scale.low, scale.high) == (0.4, 1.0)
    assert (scale.values(made.bed, 0) == POROSITY).all()
    assert (field("porosity", [soaked(porous=False).bed]).values(soaked(porous=False).bed, 0) == 1.0).all()


def test_grains_are_small_where_a_field_of_water_between_them_is_shown():
    for colour, size in (("excess-pressure", SMALL), ("porosity", SMALL), ("water", 1.0), ("pressure", 1.0)):
        assert WaterLayer([soaked().bed], colour, 20.0).grain_size == size
    assert WaterLayer([soaked(porous=False).bed], "excess-pressure", 20.0).grain_size == 1.0


@pytest.mark.parametrize("roll", [0.0, 0.2])
def test_the_water_table_is_a_line_where_the_water_ends(roll):
    """Over what hides the water: at its surface, to half a spacing, and none for water alone."""
    camera = Camera(SCALE, (0.5 * SIZE[1], SIZE[0] - 40.0))
    for porous in (True, False):
        made, picture = soaked(roll, porous=porous), np.full((*SIZE, 3), 200, dtype=np.uint8)
        WaterLayer([made.bed], "water", 20.0).paint_table(picture, camera, made.bed, 0)
        drawn = np.abs(picture.astype(int) - TABLE).max(axis=2) < 40
        if not porous:
            assert (picture == 200).all()
            continue
        rows, columns = np.nonzero(drawn)
        y = (columns + 0.5 - camera.offset[0]) / SCALE
        height = (camera.offset[1] - rows - 0.5) / SCALE
        inner = np.abs(y) < 0.4
        apart = height[inner] - (DEPTH - y[inner] * np.tan(roll))
        assert len(np.unique(columns[inner])) > 0.95 * 0.8 * SCALE
        assert np.abs(apart).max() < 1.0 * SPACING / np.sqrt(POROSITY) and abs(apart.mean()) < 0.5 * SPACING
