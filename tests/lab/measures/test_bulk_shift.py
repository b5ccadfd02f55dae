"""Measures and pictures of bulk, on a short run of a small box."""

import numpy as np
import pytest

import lab
from lab.measures import measure_all
from lab.paint.bulk.colours import FIELDS
from lab.paint.film import choose_beds
from lab.paint.footage import open_footage
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
