"""Measures and pictures of bulk, on a short run of a small box."""

import numpy as np
import pytest

import lab
from lab.measures import measure_all
from lab.paint.bulk.colours import FIELDS
from lab.paint.film import choose_beds
from lab.paint.footage import open_footage
from lab.paint.water.basins import breadth
from lab.recording import open_recording

SMALL = {
    "tank.width": "6 m",
    "tank.height": "5 m",
    "bulk.depth": "2 m",
    "bulk.spacing": "0.5 m",
    "bulk.friction": 0.3,
    "motion.roll.amplitude": "30 deg",
    "motion.roll.frequency": "0.25 Hz",
    "motion.roll.centre": ["0 m", "2 m"],
    "motion.soft_start": "0 s",
    "run.duration": "16 s",
    "record.picture_rate": "1 Hz",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return lab.run(
        "bulk/box", tmp_path_factory.mktemp("bulk") / "run", video=False, plots=False, quiet=True, **SMALL
    ).folder


def test_measures_follow_from_the_centre_of_mass(folder):
    with open_recording(folder) as recording:
        values, series = measure_all(recording), recording.series
        moved = 100.0 * (series["centre_of_mass"][:, 0, 0] - series["centre_of_mass"][0, 0, 0]) / 6.0
        assert values["bulk_shift"].value == pytest.approx(moved[-1])
        assert values["bulk_largest_shift"].value == pytest.approx(np.abs(moved).max())
        last = series["time"] >= 12.0 - 1e-9
        assert values["bulk_half_range"].value == pytest.approx(0.5 * np.ptp(moved[last]), rel=0.1)
        assert values["bulk_half_range"].value > 1.0
        assert values["bulk_carried"].value == pytest.approx(1.0, abs=0.02)  # over whole periods of a steady motion


def test_the_mass_on_record_is_that_of_the_bed(folder):
    with open_recording(folder) as recording:
        assert recording.bulk_volume.sum() == pytest.approx(6.0 * 2.0)


def test_every_colour_has_a_scale_and_mobilised_friction_ends_at_one(folder):
    with open_footage(folder) as footage:
        (bed,) = choose_beds(footage)
        for name, field in FIELDS.items():
            scale = field([bed])
            share = scale.shares(bed, 5)
            assert np.isfinite(share).all() and share.min() >= 0.0, name
        sliding = FIELDS["sliding"]([bed])
        assert sliding.high == 1.0 and sliding.values(bed, 5).max() == pytest.approx(1.0)


@pytest.fixture(scope="module")
def aboard(tmp_path_factory):
    """A ship with two holds of bulk, the starboard one twice as long, whose bed is heaped at its outer wall."""
    heaped = {
        "bulk.depth": False,
        "bulk.region": [["-13.3 m", "4.3 m"], ["-9 m", "0 m"], ["0 m", "0 m"], ["-13.3 m", "8.3 m"]],
        "tanks.starboard.length": "50 m",
        "waves": False,
        "run.duration": "4 s",
        "record.picture_rate": "1 Hz",
    }
    folder = tmp_path_factory.mktemp("aboard") / "run"
    name = "ship/handysize-grain-bulk-two-holds-quick"
    return lab.run(name, folder, video=False, plots=False, quiet=True, **heaped).folder


def test_the_shift_of_several_holds_is_that_of_each_by_mass_and_length(aboard):
    """The steep heap to port slides inwards, the level bed to starboard stays; both tell of the whole."""
    with open_recording(aboard) as recording:
        values, series = measure_all(recording), recording.series
        port, starboard = values["bulk_shift_tank"].value, values["bulk_shift_starboard"].value
        assert port > 1.0 > 20.0 * abs(starboard)
        area = np.array([13.3 * 8.3 - 0.5 * 4.3**2 - 0.5 * 13.3 * 8.3, 74.94])
        mass = area * [25.0, 50.0]
        whole = mass @ [port, starboard] / mass.sum() * 13.3 / 26.6
        assert values["bulk_shift"].value == pytest.approx(whole, rel=0.05)
        start = series["centre_of_mass"][0, 0, 0]
        place, own = recording.frames["bulk_position"][0][0, :, 0], recording.bulk_volume[0] * 1.0
        own[place > 0.0] *= 2.0
        assert start == pytest.approx(own @ place / own.sum(), abs=1e-4)
        assert values["bulk_carried"].value == pytest.approx(1.0, abs=0.05)


def test_a_picture_shows_the_bulk_of_both_holds(aboard):
    with open_footage(aboard) as footage:
        assert [basin.outline[:, 0].min() for basin in footage.basins] == pytest.approx([-13.3, 0.0])
        assert breadth(footage.basins) == pytest.approx(26.6)
