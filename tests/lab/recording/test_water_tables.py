"""Recordings of water: its tables are read as they were written, and what a preset has no gauges for is not there."""

import h5py
import numpy as np
import pytest

from lab.base.errors import LabError, Unusable
from lab.recording import Recorder, older, open_recording
from lab.recording.layout import COLUMNS
from tests.oracles.recorded_water import DROPS, pool, record_pool

TIME = 0.1 * np.arange(5)
PRESSURE = np.arange(10.0).reshape(5, 1, 2)
PLACE = np.random.default_rng(1).uniform(-0.4, 0.4, (3, 1, DROPS, 2))


@pytest.fixture
def recorded(tmp_path):
    series = {"gauge_pressure": PRESSURE, "water_kinetic": TIME[:, None], "level_depth": 2.0 * TIME[:, None, None]}
    frames = {"water_position": PLACE, "water_pressure": 1e5 * PLACE[..., 0]}
    return record_pool(tmp_path / "run", TIME, series, frames)


def test_what_is_written_is_read(recorded):
    with open_recording(recorded) as found:
        assert found.preset == pool() and found.radius.shape == (1, 0)
        assert (found.volume == 4e-4).all() and found.volume.shape == (1, DROPS)
        assert found.series["gauge_pressure"].tolist() == PRESSURE.tolist()
        assert found.series["water_kinetic"][:, 0].tolist() == TIME.tolist()
        assert found.frames["water_position"][:].tolist() == PLACE.astype("f4").tolist()
        assert found.frames["water_pressure"].shape == (3, 1, DROPS)
        assert found.layout("frames/water_position")[1] == np.float32
        assert not {"position", "velocity"} & set(found.frames) and "kinetic" not in found.series


def test_labelled_arrays_name_the_gauges(recorded):
    with open_recording(recorded) as found:
        series, frames = found.labelled(), found.labelled(frames=slice(0, 3))
    assert series["gauge_pressure"].dims == ("time", "world", "gauge")
    assert series["gauge_pressure"].sel(gauge="P2", world=0).values.tolist() == PRESSURE[:, 0, 1].tolist()
    assert series["level_depth"].sel(level="L-1").attrs["units"] == "m"
    assert frames["water_position"].dims == ("time", "world", "water_particle", "axis") and "gauge" not in frames.dims


@pytest.fixture
def of_format_3(recorded):
    """The same with the names of format 3."""
    before = {name: old for old, name in older.RENAMED.items()}
    with h5py.File(recorded / "recording.h5", "r+") as file:
        file.attrs["format"] = older.WITH_OTHER_NAMES
        for table in ("series", "frames"):
            for name, data in dict(file[table]).items():
                axes = [before.get(axis.decode(), axis) for axis in data.attrs["axes"]]
                data.attrs["axes"] = np.array(axes, dtype="S")
                if name in before:
                    file.move(data.name, f"{table}/{before[name]}")
            checks = file[f"checks/{table}"]
            names = [before.get(name.decode(), name) for name in checks.attrs[COLUMNS]]
            checks.attrs[COLUMNS] = np.array(names, dtype="S")
    return recorded


def test_a_recording_of_format_3_is_read_under_the_present_names(of_format_3):
    with open_recording(of_format_3) as found:
        assert found.frames["water_position"][:].tolist() == PLACE.astype("f4").tolist()
        assert {"water_wall_energy", "water_density_deviation"} <= set(found.series)
        assert found.quantities["water_position"].axes == ("time", "world", "water_particle", "axis")
        assert not {"water_place", "water_held"} & found.quantities.keys()


def test_a_recording_of_format_3_is_gone_on_with(of_format_3):
    with open_recording(of_format_3) as before:
        frame = {name: before.frames[name][2] for name in before.frames}
        samples = len(before.series["time"])
    with Recorder(of_format_3, samples=samples, frames=3) as recorder:
        recorder.frame(frame | {"water_position": 2.0 * PLACE[2]})
    with open_recording(of_format_3) as found:
        assert found.frames["water_position"][3].tolist() == (2.0 * PLACE[2]).astype("f4").tolist()


def test_without_gauges_their_quantities_are_not_recorded(tmp_path):
    with open_recording(record_pool(tmp_path / "run", TIME, {}, preset=pool(gauges=False))) as found:
        assert not {"gauge_pressure", "gauge_peak", "level_depth"} & set(found.series)
        assert "water_centre" in found.series
        with pytest.raises(LabError, match=r"no \"gauge_peak\" .* a preset with a table \[gauges.NAME\] records it"):
            found.series["gauge_peak"]
        with pytest.raises(LabError, match=r"; it is in the series"):
            found.series["kinetic"]


def test_a_flipped_bit_in_the_water_is_reported(recorded):
    with h5py.File(recorded / "recording.h5", "r+") as file:
        places = file["frames/water_position"]
        values = places[1]
        values[0, 2, 1] += 1e-3
        places[1] = values
    with open_recording(recorded) as found:
        assert found.frames["water_position"][0].shape == (1, DROPS, 2)
        with pytest.raises(Unusable, match="frames/water_position is damaged from row 1 of 3"):
            found.frames["water_position"][1]


@pytest.mark.parametrize("volume", [np.zeros((1, DROPS)), np.full((2, DROPS), 4e-4), np.full((1, 2 * DROPS), 4e-4)])
def test_volumes_that_do_not_fit_are_refused(recorded, volume):
    with h5py.File(recorded / "recording.h5", "r+") as file:
        del file["water/volume"]
        file["water/volume"] = volume
    with pytest.raises(Unusable, match="is not what the lab writes there"):
        open_recording(recorded)
