"""Tables of a ship from strangers: one sentence, which does not repeat them, and no memory that they ask for."""

from pathlib import Path

import pytest

from lab.base.errors import LabError
from lab.naval.points import read_points
from lab.naval.weights import read_weights

HEAD = "name,mass,lcg,tcg,vcg,fsm\n"
LONG = "9" * 1_000_000
TABLES = {
    "many rows": HEAD + "hull,1,0,0,0,0\n" * 10_001,
    "large": HEAD + "hull,1,0,0,0,0\n" * 600_000,
    "a long number": HEAD + f"hull,{LONG}x,0,0,0,0\n",
    "a long name": HEAD + f"{LONG},x,0,0,0,0\n",
    "a long heading": f"name,mass,{LONG}\nhull,1,1\n",
    "binary": HEAD + "hull\0,1,0,0,0,0\n",
    "one line": "x" * 9_000_000,
}


@pytest.mark.parametrize("name", TABLES)
@pytest.mark.parametrize("read", [read_weights, read_points])
def test_what_is_no_table_of_a_ship_is_one_short_sentence(name, read, tmp_path):
    path = tmp_path / "table.csv"
    path.write_text(TABLES[name])
    with pytest.raises(LabError) as refused:
        read(path)
    assert len(str(refused.value)) < 400 and "table.csv" in str(refused.value)


@pytest.mark.parametrize("name", ["/dev/zero", "/proc/kmsg", "/"])
def test_devices_and_folders_are_no_tables(name):
    with pytest.raises(LabError, match=r"no table|is empty|has the columns"):
        read_weights(Path(name))
