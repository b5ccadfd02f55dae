"""Compare what presets resolve to at another revision and in the working tree, number by number.

`python -m tests.same.resolved BASE` resolves every shipped preset, every quick variant and the cases below with the
code of the revision BASE and with the working tree's, and prints each key that differs. `--dump FILE` only writes the
numbers of whatever lab is imported.
"""

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import asdict, replace
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.same.__main__ import HERE, unpack

ACETATE = """
[material]
density = "1319 kg/m^3"
young = "3.2 GPa"
poisson = 0.28
friction = 0.25
restitution = 0.6
"""
FILES = {
    "record.csv": "time,roll,heave\n" + "".join(f"{0.1 * k:.1f},{k * (20 - k) % 7},0.0{k % 5}\n" for k in range(20)),
    "grains.csv": "y,z,radius,vy,vz,omega\n0,0.005,0.003,0,0,0\n0.01,0.02,0.003,0.1,0,5\n-0.01,0.03,0.002,0,-0.1,0\n",
    "pebble.csv": "y,z\n0,0\n1.5,-0.2\n3,0\n3.7,0.4\n4,1\n3.5,2.2\n2,3\n1.2,2.9\n0.5,2.5\n-0.4,1.2\n",
    "rich.toml": """
title = "Everything at once"
[tank]
outline = [["-60 mm", "80 mm"], ["60 mm", "80 mm"], ["50 mm", "0 mm"], ["-50 mm", "0 mm"]]
lid = false
roughness = "4 mm"
thickness = "2 mm"
[grains]
distribution = "table"
table = [["4 mm", 0.3], ["6 mm", 0.7]]
shares = "mass"
spread = "5 %"
depth = "30 mm"
surface = "disturbed"
[wall]
friction = 0.4
[motion]
soft_start = "0.5 s"
[motion.history]
file = "record.csv"
length_unit = "cm"
angle_unit = "deg"
centre = ["0 mm", "40 mm"]
[motion.sway]
amplitude = "5 mm"
frequency = "1.1 Hz"
phase = "90 deg"
[parts.gate]
points = [["0 mm", "50 mm"], ["0 mm", "75 mm"]]
move = ["0 mm", "60 mm"]
start = "0.2 s"
speed = "0.5 m/s"
acceleration = "9.81 m/s^2"
[run]
repeats = 2
[record]
series_rate = "200 Hz"
"""
    + ACETATE,
    "listed.toml": """
title = "Three grains"
[tank]
width = "40 mm"
height = "40 mm"
[grains]
bed = "grains.csv"
reuse_bed = false
[run]
duration = "1 s"
settle = false
"""
    + ACETATE,
    "kinds.toml": """
title = "Three kinds"
based_on = "tilting/quick"
[wall]
dissipative_time = "2 us"
[kinds.light]
share = 0.3
density = "700 kg/m^3"
[kinds.heavy]
share = "20 %"
young = "1e9 Pa"
restitution = 0.4
[kinds.heavy.against]
friction = 0.1
""",
    "shapes.toml": """
title = "Shapes of all sorts"
[tank]
width = "120 mm"
height = "90 mm"
[grains]
diameter = "5 mm"
spread = 0.1
distribution = "normal"
shares = "mass"
count = 60
orientation = "30 deg"
[shapes.a]
share = 1
cargo = "rice"
[shapes.b]
share = 2
descriptors = [0.1, 0.05]
draws = 3
[shapes.c]
share = 1.5
descriptors = [0.0, 0.05]
phases = ["0 deg", "20 deg"]
diameter = "4 mm"
[shapes.d]
share = 1
contour = "pebble.csv"
[shapes.e]
share = 1
spectrum = { count = 12, D2 = 0.1, D3 = 0.05, D8 = 0.01 }
draws = 4
[shapes.f]
share = 0.1
disc = true
[contact]
outlines = "area"
[run]
duration = "1 s"
accuracy = "draft"
"""
    + ACETATE,
}
CASES = {  # overrides of shipped presets
    "tilting/quick": [
        {"tank.lid": False, "run.accuracy": "reference"},
        {"material.restitution": False, "material.dissipative_time": "1 us", "wall.young": "2 GPa"},
        {"grains.count": 12, "grains.region": [["0 mm", "0 mm"], ["40 mm", "0 mm"], ["40 mm", "40 mm"]]},
        {"contact.cohesion": "humid", "material.humidity": "70 %", "wall.humidity": "60 %"},
    ],
    "shapes/rice": [{"grains.diameter": "6 mm"}, {"run.step": "1 us", "run.force_step": True}],
    "ship/barge-roll": [
        {"sea.density": "1025 kg/m^3", "sea.depth": "2 m"},
        {"ship.hatch.breadth": "100 mm", "ship.hatch.coaming": "30 mm", "waves.soft_start": "1 s"},
        {"waves.kind": "jonswap", "waves.height": "20 mm", "waves.amplitude": False, "ship.axis": ["0 m", "0.1 m"]},
    ],
}


def main() -> int:
    """Compare, or only write the numbers; the exit status."""
    parser = argparse.ArgumentParser(prog="python -m tests.same.resolved", description=__doc__)
    parser.add_argument("base", nargs="?", help="a revision of the repository")
    parser.add_argument("--dump", type=Path, metavar="FILE", help="write the numbers of the imported lab as JSON")
    asked = parser.parse_args()
    if asked.dump:
        asked.dump.write_text(json.dumps(dump()))
        return 0
    with TemporaryDirectory(prefix="cargolab-") as folder:
        base = dumped(unpack(asked.base, Path(folder) / "base"), Path(folder) / "base.json")
        here = dumped(HERE, Path(folder) / "here.json")
    differences = list(differing(base, here))
    print("\n".join(differences) or f"{len(here)} presets resolve to the same numbers.")
    return 1 if differences else 0


def dumped(tree: Path, file: Path) -> dict:
    """The numbers of the presets of a tree, by the lab in it."""
    command = [sys.executable, __file__, "--dump", str(file)]
    subprocess.run(command, env={**os.environ, "PYTHONPATH": str(tree)}, check=True)
    return json.loads(file.read_text())


def dump() -> dict[str, dict]:
    """What each preset resolves to with the imported lab, by name."""
    from lab.preset.find import load, names

    found = {name: resolved_numbers(load(name).resolved) for name in names()}
    with TemporaryDirectory(prefix="cargolab-") as folder:
        for name, text in FILES.items():
            (Path(folder) / name).write_text(text)
        for name in (name for name in FILES if name.endswith(".toml")):
            found[name] = resolved_numbers(load(Path(folder) / name).resolved)
    for name, cases in CASES.items():
        for k, overrides in enumerate(cases):
            found[f"{name} case {k}"] = resolved_numbers(load(name, _in_words(overrides)).resolved)
    return found


def _in_words(overrides: Mapping) -> dict:
    """The overrides in the keys of the imported lab."""
    from lab.preset import schema

    old = hasattr(schema, "Given")
    return {key.replace("sea.", "water.") if old else key: value for key, value in overrides.items()}


def resolved_numbers(preset: object) -> dict:
    """All that a preset resolves to, in SI, as plain tables in the keys of revision 2fcec71, the sea aside."""
    if hasattr(preset, "model_dump_json"):  # of revisions before format 3
        table = json.loads(preset.model_dump_json())
        table["sea"] = table.pop("water")
        return table
    table, tank, history = asdict(preset), preset.tank, preset.motion.history
    del table["format"]
    table["tank"] = {"outline": tank.corners, "open_edges": tank.open_edges}
    table["tank"] |= {"roughness": tank.roughness, "thickness": tank.thickness}
    table["grains"] = _grains(preset)
    table["wall"] = asdict(preset.wall_material) if preset.grains else {}
    table["kinds"] = {name: {"share": kind.share, **asdict(preset.others[name])} for name, kind in preset.kinds.items()}
    table["shapes"] = {name: asdict(shape) for name, shape in preset.shape_classes.items()}
    table["contact"]["stiffness_scale"] = preset.stiffness_scale
    table["motion"]["history"] = asdict(history.history) if history else None
    table["run"]["duration"] = preset.duration
    return json.loads(json.dumps(table))


def _grains(preset: object) -> dict:
    """The grains, if there are any; where a file lists them, all else is as if it were not said."""
    if preset.grains is None:
        return {}
    grains, own = preset.grains, {"diameter": preset.mean_diameter, "listed": bool(preset.grains.listed)}
    if grains.listed:
        unsaid = asdict(replace(type(grains)(), reuse_bed=grains.reuse_bed))
        return unsaid | own | {"bed": grains.bed.name, "count": len(grains.listed)}
    return asdict(grains) | own | {"table": preset.classes or None, "region": grains.place}


def differing(base: object, here: object, key: str = "") -> Iterator[str]:
    """Sentences on each value that differs."""
    if isinstance(base, Mapping) and isinstance(here, Mapping):
        for name in sorted({*base, *here}):
            yield from differing(
                base.get(name), here.get(name), f"{key}: {name}" if ":" not in key else f"{key}.{name}"
            )
    elif base != here:
        yield f"{key}: {str(base)[:100]} before, {str(here)[:100]} now"


if __name__ == "__main__":
    sys.exit(main())
