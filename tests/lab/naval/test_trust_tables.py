"""Tables of a ship from strangers: one sentence, which does not repeat them, and no memory that they ask for."""

import random
from pathlib import Path

import pytest

from lab.assembly.lines.offsets import read_offsets
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


LINES = "station,z,half_breadth\n" + "".join(f"{x},{z},{1 + z}\n" for x in (0, 5, 9) for z in (0, 1, 2))
SOUND = {
    "weights": (read_weights, HEAD + "hull,100,5,0,3,0\ncargo,50,6,0.5,2.5,7\n"),
    "points": (read_points, "name,kind,x,y,z\nhatch,opening,4,2,5\nedge,deck,0,3,4\n"),
    "offsets": (read_offsets, LINES),
}


@pytest.mark.parametrize("name", SOUND)
def test_a_damaged_table_is_read_or_refused_in_a_sentence(name, tmp_path):
    read, text = SOUND[name]
    path, chance = tmp_path / "table.csv", random.Random(8)
    path.write_text(text)
    read(path)
    refused = 0
    for _ in range(200):
        content = bytearray(text.encode())
        place = chance.randrange(len(content))
        if chance.random() < 0.5:
            content[place] ^= 1 << chance.randrange(8)
        else:
            del content[place : place + chance.choice((1, 10, len(content)))]
        path.write_bytes(content)
        try:
            read(path)
        except LabError as error:
            refused += 1
            assert "\n" not in str(error) and len(str(error)) < 400
    assert refused > 50
