"""The box of a Handysize as a ship file: one hold, a pair of wing tanks, three conditions."""

from pathlib import Path

LENGTH, HALF, DEPTH = 130.7, 13.5, 14.0
LINES = "\n".join(["station,z,half_breadth", *(f"{x},{z},{HALF}" for x in (0, 60, LENGTH) for z in (0, DEPTH))])
HOLD = [[0, 1.6], [9, 1.6], [13.3, 5.9], [13.3, 9.96], [7, 13.6], [7, 14], [0, 14]]
BOX = f"""\
name = "Box"
free_surfaces = "second-moment"

[hull]
lines = "box.csv"

[wind]
area = 1500
lever = 10

[openings.hatch]
place = [65, 12, 12]

[holds.h3]
side = "both"
aft = 50
forward = 75
section = {HOLD}

[tanks.wing]
side = "pair"
aft = 80
forward = 100
section = [[9, 2], [13, 2], [13, 6], [9, 6]]
density = 1000
permeability = 0.95

[weights.lightship]
mass = 9000
lcg = 65.35
vcg = 9.8

[weights.ore]
mass = 20000
aft = 30
forward = 100
vcg = 8

[conditions.departure.fills]
wing = {{ full = "50 %" }}

[conditions.departure.cargo]
h3 = {{ level = 7.93, stowage = 1.3, filling = "partly-filled" }}

[conditions.mid.fills]
wing-p = {{ mass = 100 }}

[conditions.mid.weights.deck-cargo]
mass = 200
lcg = 70
tcg = 1.5
vcg = 15
fsm = 30

[conditions.arrival]
density = "fresh"
"""


def write(folder: Path) -> Path:
    """Write her file and her lines; returns the former."""
    (folder / "box.csv").write_text(LINES + "\n")
    (folder / "ship.toml").write_text(BOX)
    return folder / "ship.toml"


def changed(box: Path, old: str, new: str) -> Path:
    """The file with a part of its text replaced."""
    text = box.read_text()
    assert old in text
    box.write_text(text.replace(old, new, 1))
    return box
