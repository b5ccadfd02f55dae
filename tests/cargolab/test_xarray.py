"""xarray opens recordings by itself, by the engine "cargolab"."""

import subprocess
import sys
import tomllib
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest
import xarray

import cargolab
from cargolab._xarray import Engine
from tests.oracles.synthetic import frame, recorder, sample

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def file(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("engine")
    with recorder(folder, 2, 4) as run:
        for k in range(6):
            run.sample(sample(0.1 * k, 2, kinetic=[k, -k]))
            run.frame(frame(0.1 * k, 2, position=np.full((2, 4, 2), k)))
    return folder / "recording.h5"


def test_the_wheel_announces_the_engine():
    entry = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]["entry-points"]["xarray.backends"]
    module, _, name = entry["cargolab"].partition(":")
    assert getattr(import_module(module), name) is Engine


@pytest.mark.parametrize("chunks", [None, {}])
def test_a_tree_a_node_and_the_series_open(file, chunks):
    pytest.importorskip("dask") if chunks is not None else None
    with xarray.open_datatree(file, engine=Engine, chunks=chunks) as tree:
        assert tree["frames/position"].isel(time=3).values.tolist() == np.full((2, 4, 2), 3.0).tolist()
        assert tree["series/kinetic"].sel(world=1).values.tolist() == [0, -1, -2, -3, -4, -5]
    with xarray.open_dataset(file, engine=Engine, group="frames", chunks=chunks, drop_variables="spin") as frames:
        assert "spin" not in frames and frames["position"].mean("time").values.max() == 2.5
        assert frames.attrs["preset"] == "tilting/acetate"
    with xarray.open_dataset(file.parent, engine=Engine, chunks=chunks) as series:
        assert series["kinetic"].attrs["units"] == "J" and "position" not in series


def test_what_is_closed_lets_go_of_the_file(file):
    tree = xarray.open_datatree(file, engine=Engine)
    tree.close()
    with pytest.raises(cargolab.Error, match="has been closed"):
        tree["frames/velocity"].load()


def test_a_group_that_is_not_there_is_named(file):
    with pytest.raises(cargolab.Error, match=r"no group 'water'; it has series, frames, tank, grains"):
        xarray.open_dataset(file, engine=Engine, group="water")


def test_the_engine_knows_its_files_and_no_others(file, tmp_path):
    import h5py

    guess = Engine().guess_can_open
    assert guess(file) and guess(str(file)) and guess(file.parent)
    with h5py.File(tmp_path / "other.h5", "w") as other:
        other.attrs["format"] = "another"
    (tmp_path / "text.h5").write_text("cargo-shift-lab")
    (tmp_path / "torn.h5").write_bytes(file.read_bytes()[:100])
    for name in ("other.h5", "text.h5", "torn.h5", "missing.h5", "."):
        assert not guess(tmp_path / name)
    assert not guess(b"\x89HDF") and not guess({})


def test_xarray_lists_the_engine_without_loading_the_lab():
    script = "import sys, cargolab._xarray; print([m for m in sys.modules if m in ('lab', 'solvers', 'taichi')])"
    told = subprocess.run([sys.executable, "-c", script], cwd=ROOT, capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "[]"
